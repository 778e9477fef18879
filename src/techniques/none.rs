//! No shadows: every light reaches everything in its range. What shadows cost is measured against this.

use super::Row;
use crate::geometry::Outline;
use crate::settings::Technique;

pub(super) const ROW: Row = Row {
    technique: Technique::None,
    title: "No shadows",
    about: "Every light reaches everything in its range.",
    exact: false,
    source: "the baseline",
    decide: |_| None,
    outline: Outline::Silhouette,
    extrusion: None,
    darkens: None,
    groups: &[],
};
