//! Beam 2004: the tutorial's diagrams and its demo.

use super::camera;
use crate::figures::{Figure, Paper};
use crate::settings::{Diagram, Show, Technique};

pub(super) static TABLE: &[Figure] = &[
    Figure {
        name: "b-f1",
        paper: Paper::Beam,
        number: "shadowvolumes_f1",
        title: "The corners of a surface, in their order",
        seen: "Counter-clockwise as the eye sees them, so this side is the front; the surface's volume hangs below it.",
        instead: "the live scene for a drawing",
        scene: "slice",
        view: |settings| {
            settings.show = Show::Rays;
            settings.diagram = Diagram::Order;
            camera(settings, "from above");
        },
    },
    Figure {
        name: "b-f2",
        paper: Paper::Beam,
        number: "shadowvolumes_f2",
        title: "A ball partly within a shadow volume",
        seen: "A slab blocks the light: what of the ball lies within its volume should be in shadow.",
        instead: "the live scene, cut open, for a drawing",
        scene: "slice",
        view: |settings| {
            settings.show = Show::Rays;
            settings.diagram = Diagram::Slice;
            camera(settings, "low");
        },
    },
    Figure {
        name: "b-f3",
        paper: Paper::Beam,
        number: "shadowvolumes_f3",
        title: "The first pass: back faces, counted up",
        seen: "Within the frustum everything before the volume's back faces is counted: the lit side of the ball, too, which is wrong.",
        instead: "the live scene, cut open, for a drawing",
        scene: "slice",
        view: |settings| {
            settings.show = Show::Rays;
            settings.diagram = Diagram::BackFaces;
            camera(settings, "low");
        },
    },
    Figure {
        name: "b-f4",
        paper: Paper::Beam,
        number: "shadowvolumes_f4",
        title: "The second pass: front faces, counted down",
        seen: "What lies before the front faces is taken off again, and what is left counted is what lies within the volume.",
        instead: "the live scene, cut open, for a drawing",
        scene: "slice",
        view: |settings| {
            settings.show = Show::Rays;
            settings.diagram = Diagram::BothFaces;
            camera(settings, "low");
        },
    },
    Figure {
        name: "b01",
        paper: Paper::Beam,
        number: "Demo picture",
        title: "The tutorial's demo",
        seen: "Turning cubes over a floor with the tutorial's own way: a volume for each polygon, and a dark quad where a caster counts.",
        instead: "",
        scene: "cubes",
        view: |settings| settings.technique = Technique::Beam,
    },
];
