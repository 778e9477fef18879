//! Beam 2004: the tutorial's demo.

use crate::figures::{Figure, Paper};
use crate::settings::Technique;

pub(super) static TABLE: &[Figure] = &[Figure {
    name: "b01",
    paper: Paper::Beam,
    number: "Demo picture",
    title: "The tutorial's demo",
    seen: "Turning cubes over a floor with the tutorial's own way: a volume for each polygon, and a dark quad where a caster counts.",
    instead: "",
    scene: "cubes",
    view: |settings| settings.technique = Technique::Beam,
}];
