//! Lengyel 2002: volumes with and without caps, and the scissor rectangle.

use super::camera;
use crate::figures::{Figure, Paper};
use crate::settings::{Show, Technique};

pub(super) static TABLE: &[Figure] = &[
    Figure {
        name: "l01a",
        paper: Paper::Lengyel,
        number: "Uncapped shadow volumes",
        title: "Depth-pass: sides alone",
        seen: "With the eye outside every volume the sides do, counted in front of each surface.",
        instead: "",
        scene: "eye-in-shadow",
        view: |settings| {
            settings.technique = Technique::ZPass;
            settings.show = Show::Stencil;
            camera(settings, "beside");
        },
    },
    Figure {
        name: "l01b",
        paper: Paper::Lengyel,
        number: "Capped shadow volumes",
        title: "Depth-fail: sides and caps",
        seen: "From within a shadow the same volumes, closed at both ends, are counted behind each surface, to the same numbers.",
        instead: "",
        scene: "eye-in-shadow",
        view: |settings| {
            settings.technique = Technique::ZFail;
            settings.show = Show::Stencil;
        },
    },
    Figure {
        name: "l02",
        paper: Paper::Lengyel,
        number: "Scissor optimization",
        title: "A light's scissor rectangle",
        seen: "From above: the part of the view that the light's range takes up, outside of which nothing is drawn for it.",
        instead: "",
        scene: "courtyard",
        view: |settings| {
            settings.show = Show::Bounds;
            settings.light = 2;
        },
    },
];
