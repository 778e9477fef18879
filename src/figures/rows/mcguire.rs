//! McGuire et al. 2003: what a volume costs, and what bounds it.

use super::{camera, look};
use crate::figures::{Figure, Paper};
use crate::settings::{Diagram, LightBounds, Show};

pub(super) static TABLE: &[Figure] = &[
    Figure {
        name: "m-f1",
        paper: Paper::McGuire,
        number: "Figure 1",
        title: "Shadow volumes in a plane",
        seen: "A ray from the viewport to the point P and on to infinity: z-pass sums what is entered and left before P, z-fail what is beyond, and both find how many volumes hold it.",
        instead: "the live scene, cut open, for a drawing",
        scene: "slabs",
        view: |settings| {
            settings.show = Show::Rays;
            settings.diagram = Diagram::Ends;
            look(settings, [-4.4, 1.7, 0.0], [2.6, 0.5, 0.0]);
        },
    },
    Figure {
        name: "m-f2a",
        paper: Paper::McGuire,
        number: "Figure 2, left",
        title: "The occlusion pyramid before the viewport",
        seen: "Solid red, from the light to the viewport: only what reaches into it can shade the viewport. Dashed blue, the view frustum.",
        instead: "the live scene, cut open, for a drawing",
        scene: "slabs",
        view: |settings| {
            settings.show = Show::Rays;
            settings.diagram = Diagram::Pyramid;
            look(settings, [4.2, 1.1, 0.0], [0.4, 3.1, 0.0]);
        },
    },
    Figure {
        name: "m-f2b",
        paper: Paper::McGuire,
        number: "Figure 2, right",
        title: "The occlusion pyramid behind the viewport",
        seen: "The eye looks away from the light: the pyramid lies behind the viewport, and so does what may shade it.",
        instead: "the live scene, cut open, for a drawing",
        scene: "slabs",
        view: |settings| {
            settings.show = Show::Rays;
            settings.diagram = Diagram::Pyramid;
            look(settings, [-1.9, 1.3, 0.0], [-5.0, 1.0, 0.0]);
        },
    },
    Figure {
        name: "m-f3",
        paper: Paper::McGuire,
        number: "Figure 3",
        title: "A fan for a cap of any shape",
        seen: "The letter's silhouette, seen from the light, and a triangle from one corner to each of its edges: front faces yellow, back faces cyan. Where both lie, green, the count goes up and down again, and the letter is left.",
        instead: "a letter of ours for his polygon",
        scene: "hello2rts",
        view: |settings| {
            settings.show = Show::Rays;
            settings.diagram = Diagram::Fan;
            look(settings, [-1.02, 2.5, 5.0], [-1.1, 2.5, 0.5]);
        },
    },
    Figure {
        name: "m-f4a",
        paper: Paper::McGuire,
        number: "Figure 4, case 1",
        title: "The viewport is not in shadow",
        seen: "The slab throws no shadow on the viewport: the sides of its volume are enough, counted before each surface.",
        instead: "the live scene, cut open, for a drawing",
        scene: "slice",
        view: |settings| {
            settings.show = Show::Rays;
            settings.diagram = Diagram::Pyramid;
        },
    },
    Figure {
        name: "m-f4b",
        paper: Paper::McGuire,
        number: "Figure 4, case 2",
        title: "The viewport is in shadow, looking away from the light",
        seen: "The slab may shade the viewport, and is out of view: sides and dark cap, counted behind each surface.",
        instead: "the live scene, cut open, for a drawing",
        scene: "slice",
        view: |settings| {
            settings.show = Show::Rays;
            settings.diagram = Diagram::Pyramid;
            camera(settings, "away");
        },
    },
    Figure {
        name: "m-f4c",
        paper: Paper::McGuire,
        number: "Figure 4, case 3",
        title: "The viewport is in shadow, looking towards the light",
        seen: "The slab may shade the viewport, and is in view: sides and both caps.",
        instead: "the live scene, cut open, for a drawing",
        scene: "slice",
        view: |settings| {
            settings.show = Show::Rays;
            settings.diagram = Diagram::Pyramid;
            camera(settings, "towards the light");
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
