//! CSCI 4229: z-pass against z-fail.

use crate::figures::{Figure, Paper};
use crate::settings::Technique;

pub(super) static TABLE: &[Figure] = &[
    Figure {
        name: "c01a",
        paper: Paper::Csci4229,
        number: "Z-pass",
        title: "Z-pass with the eye in a shadow",
        seen: "Light and shadow have changed places: counting in front starts from the wrong number.",
        instead: "",
        scene: "eye-in-shadow",
        view: |settings| settings.technique = Technique::ZPass,
    },
    Figure {
        name: "c01b",
        paper: Paper::Csci4229,
        number: "Z-fail",
        title: "Z-fail from the same place",
        seen: "Counted behind each surface, from infinity, where no eye ever is: right.",
        instead: "",
        scene: "eye-in-shadow",
        view: |settings| settings.technique = Technique::ZFail,
    },
];
