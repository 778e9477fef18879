//! McGuire et al. 2003: what a volume costs, and what bounds it.

use super::{camera, look};
use crate::figures::{Figure, Paper};
use crate::settings::{LightBounds, Show};

pub(super) static TABLE: &[Figure] = &[
    Figure {
        name: "m-f1",
        paper: Paper::McGuire,
        number: "Figure 1",
        title: "Shadow volumes in a plane",
        seen: "The same, with the eye itself in a shadow: its rays begin with a count that is not 0.",
        instead: "the live scene, cut open, for a drawing",
        scene: "eye-in-shadow",
        view: |settings| {
            settings.show = Show::Rays;
        },
    },
    Figure {
        name: "m01a",
        paper: Paper::McGuire,
        number: "Image 1, left",
        title: "The scene's triangles",
        seen: "Every edge of the nave: what the shadow volumes are made of.",
        instead: "a Gothic nave and pilgrims of our own for the cathedral and the Quake III characters",
        scene: "cathedral",
        view: |settings| settings.show = Show::Wireframe,
    },
    Figure {
        name: "m01b",
        paper: Paper::McGuire,
        number: "Image 1, right",
        title: "Characters in a nave, by point lights",
        seen: "Everything shadows everything: figures, piers, vaults, a swinging crown of light.",
        instead: "a Gothic nave and pilgrims of our own for the cathedral and the Quake III characters",
        scene: "cathedral",
        view: |_| {},
    },
    Figure {
        name: "m02",
        paper: Paper::McGuire,
        number: "Image 2",
        title: "Its shadow volumes",
        seen: "The volumes of one light as coloured glass over the picture; the caps are hidden by the objects themselves.",
        instead: "a Gothic nave and pilgrims of our own",
        scene: "cathedral",
        view: |settings| settings.show = Show::Volumes,
    },
    Figure {
        name: "m03a",
        paper: Paper::McGuire,
        number: "Image 3, left",
        title: "A light on top of a flight of stairs",
        seen: "At the foot 256 volumes lie one in another, as many as eight bits count to none, and yet it is dark there: the count goes in batches.",
        instead: "",
        scene: "stairs",
        view: |_| {},
    },
    Figure {
        name: "m03b",
        paper: Paper::McGuire,
        number: "Image 3, right",
        title: "The nested volumes",
        seen: "Each step's volume lies in those of all steps above it.",
        instead: "",
        scene: "stairs",
        view: |settings| settings.show = Show::Volumes,
    },
    Figure {
        name: "m04a",
        paper: Paper::McGuire,
        number: "Image 4, left",
        title: "A light without bounds, from above",
        seen: "Nothing bounds the light's count: its volumes are drawn over all the view.",
        instead: "a Gothic nave of our own",
        scene: "cathedral",
        view: |settings| {
            settings.show = Show::Bounds;
            settings.light = 1;
            settings.culling.light_bounds = LightBounds::None;
        },
    },
    Figure {
        name: "m04b",
        paper: Paper::McGuire,
        number: "Image 4, right",
        title: "The same light within its scissor",
        seen: "What the light can reach bounds the pixels in which anything is counted: a slice of the view.",
        instead: "a Gothic nave of our own",
        scene: "cathedral",
        view: |settings| {
            settings.show = Show::Bounds;
            settings.light = 1;
        },
    },
    Figure {
        name: "m05a",
        paper: Paper::McGuire,
        number: "Image 5, left",
        title: "A light in a grid of cubes",
        seen: "The light wanders among the cubes, each of which shadows those behind it.",
        instead: "an amphitheatre for the cathedral's inside",
        scene: "grid",
        view: |_| {},
    },
    Figure {
        name: "m05b",
        paper: Paper::McGuire,
        number: "Image 5, right",
        title: "The cubes' volumes",
        seen: "The cubes' shadow volumes, away from the light on all sides.",
        instead: "an amphitheatre for the cathedral's inside",
        scene: "grid",
        view: |settings| settings.show = Show::Volumes,
    },
    Figure {
        name: "m06",
        paper: Paper::McGuire,
        number: "Image 6",
        title: "Which cubes need caps",
        seen: "From behind the grid, towards the light: blue cubes are counted by their sides alone, and only the red one, which may shade the eye, needs caps.",
        instead: "an amphitheatre for the cathedral's inside; our own colours for the cases",
        scene: "grid",
        view: |settings| {
            settings.show = Show::Cases;
            look(settings, [-2.89, 3.24, -0.94], [1.807, 1.55, 0.587]);
        },
    },
    Figure {
        name: "m07",
        paper: Paper::McGuire,
        number: "Image 7",
        title: "Three coloured lights, and one light's volumes",
        seen: "Light is added where no volume is, so a shadow of one light takes the colour of the others.",
        instead: "a Gothic nave and pilgrims of our own",
        scene: "cathedral",
        view: |settings| {
            settings.show = Show::Volumes;
            settings.light = 2;
            camera(settings, "choir");
        },
    },
];
