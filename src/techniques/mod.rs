//! The table of techniques: one row, one file, one shader twin each.
//!
//! A counting technique decides, for one light, how each caster's shadow volume is counted
//! ([`crate::frame::Method`]) and why, and brings the states that the parts of such volumes are
//! counted with ([`Group`]); [`counting`] turns both into steps. What all techniques share lives
//! there, what makes each different lives in its own file.
//!
//! A further technique is a line in [`Technique`], a file here with its `ROW`, and its name in
//! [`TABLE`]; panel, command line, lists and the tour read those.

pub mod above;
mod auto;
pub mod beam;
pub mod birdseye;
pub mod bounds;
pub mod cases;
pub mod complexity;
pub mod counting;
pub mod csg;
pub mod culling;
mod cutout;
pub mod decals;
pub mod deferred;
pub mod depth_bounds;
pub mod diagram;
mod exact_z_pass;
pub mod fill;
mod flattened;
pub mod halo;
pub mod labels;
pub mod mirrors;
mod none;
pub mod off_mirror;
mod one_sided;
mod overflow;
pub mod own_bits;
mod parity;
mod per_polygon;
pub mod planar;
pub mod playground;
pub mod show;
pub mod surfaces;
pub mod wide;
pub mod windows;
pub mod workspace;
mod z_fail;
mod z_pass;
mod z_plus;

use crate::frame::{Method, Part, Reason, VolumePlan};
use crate::geometry::Outline;
use crate::settings::{Overflow, Settings, Technique};

pub use counting::{Caster, Group};
pub use overflow::TOO_MANY;

/// One technique, for people and for the director.
pub struct Row {
    /// Which.
    pub technique: Technique,
    /// A few words.
    pub title: &'static str,
    /// One sentence: what it does.
    pub about: &'static str,
    /// True where every pixel is right on every scene.
    pub exact: bool,
    /// Paper and section.
    pub source: &'static str,
    /// How one caster is counted, and why; `None` leaves all shadows out.
    pub decide: fn(&Caster<'_>) -> Option<(Method, Reason)>,
    /// Whether a caster has one volume, or each of its polygons one.
    pub outline: Outline,
    /// Metres from the light to where volumes end, for techniques whose volumes do not reach as far as
    /// there is something to shadow.
    pub extrusion: Option<f64>,
    /// Linear RGBA laid over the lit picture where a caster's count is not zero, for techniques that
    /// darken instead of adding light where it is.
    pub darkens: Option<[f32; 4]>,
    /// The states that its volumes' parts are counted with, in order; those of a technique that it
    /// falls back on among them.
    pub groups: &'static [&'static [Group]],
}

impl Row {
    /// Whether a volume may be counted piece by piece: its count claims to be exact, and knows the caps of pieces.
    #[must_use]
    pub fn clamps(&self, volume: &VolumePlan) -> bool {
        let mut groups = self.groups.iter().copied().flatten();
        let with_caps = groups.any(|group| group.method == volume.method && group.parts.contains(&Part::StartCap));
        let plain = volume.cutout.is_none() && volume.extrusion.is_none() && volume.outline == Outline::Silhouette;
        self.exact && with_caps && plain && volume.piece.is_whole()
    }

    /// Whether a count that does not overflow is the right one: of exact techniques, and of ZP+, whose
    /// cracks are another matter.
    #[must_use]
    pub fn counts_exactly(&self) -> bool {
        self.exact || self.technique == Technique::ZPlus
    }
}

/// Every technique, in the order of [`Technique::ALL`].
pub static TABLE: &[Row] = &[
    none::ROW,
    z_pass::ROW,
    z_fail::ROW,
    exact_z_pass::ROW,
    auto::ROW,
    wide::ROW,
    z_plus::ROW,
    one_sided::ROW,
    per_polygon::ROW,
    beam::ROW,
    parity::ROW,
    cutout::ROW,
    flattened::ROW,
];

/// What these settings ask for that spoils counting on purpose, so that no technique claims to be exact; none
/// where nothing does.
#[must_use]
pub fn spoiled_by(settings: &Settings) -> Option<&'static str> {
    [
        (settings.failure.is_some(), "a failure of the gallery"),
        (settings.far.is_some(), "the far plane"),
        (settings.counting.overflow == Overflow::Naive, "naive counting"),
    ]
    .into_iter()
    .find_map(|(asked, words)| asked.then_some(words))
}

/// Whether every decided pixel must be right: by what counts volumes, or on receivers alone by planar shadows in its
/// place.
#[must_use]
pub fn claims_exact(settings: &Settings) -> bool {
    let exact = if planar::is_on(settings) { settings.planar.is_exact() } else { row(settings.technique).exact };
    exact && spoiled_by(settings).is_none()
}

/// The row of a technique.
#[must_use]
pub fn row(technique: Technique) -> &'static Row {
    // A test holds every technique to a row of its own.
    TABLE.iter().find(|row| row.technique == technique).unwrap_or(&none::ROW)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_lists_every_technique_once_in_order() {
        let listed: Vec<_> = TABLE.iter().map(|row| row.technique).collect();
        assert_eq!(listed, Technique::ALL);
        for technique in Technique::ALL {
            assert_eq!(row(technique).technique, technique);
        }
    }
}
