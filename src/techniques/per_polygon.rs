//! Per-polygon counting (K 6.3; B "Shadow Volumes"): a volume for each polygon, no silhouette.
//!
//! With counting instead of parity volumes may overlap, so nobody has to find a caster's outline:
//! each light-facing triangle throws a volume of its own, three sides, a light cap and a dark cap.
//! K calls it simple and far too expensive, and it is: inside a caster every edge has two sides that
//! do nothing but cancel.
//!
//! ```text
//!      ____ ____ ____          the sides between neighbours stand in one place,
//!     |    ||    ||    |       entered by one volume, left by the other: +1 - 1
//!     |    ||    ||    |
//! ```
//!
//! They cancel exactly only if both have the same depth to the last bit; K and B both saw cracks
//! there. So of two sides in one place one is drawn in the other's vertex order, with the operations
//! swapped ([`crate::geometry::silhouette::polygon_edges`]). What is left then is the silhouette's
//! sides, and every pixel's count is z-fail's. K counts from the eye; here faces behind the surface
//! are counted, as in B, with volumes that end behind everything, so that eye and near plane do not
//! matter. B's own look, with its finite volumes, is [`super::beam`].

use super::{Group, Row, z_fail};
use crate::frame::stencil::StencilState;
use crate::frame::{Method, Part};
use crate::geometry::Outline;
use crate::settings::Technique;

pub(super) const ROW: Row = Row {
    technique: Technique::PerPolygon,
    title: "Per polygon",
    about: "Z-fail with a volume for each light-facing triangle instead of the silhouette's; exact, and dear.",
    exact: true,
    source: "Kilgard 1999, 6.3; Beam 2004, Shadow Volumes",
    decide: |caster| Some(z_fail::decide(caster)),
    outline: Outline::Polygons,
    extrusion: None,
    darkens: None,
    groups: &[z_fail::GROUPS, CANCELLING],
};

const CANCELLING: &[Group] = &[cancelling(Method::ZFail), cancelling(Method::ZFailCompared)];

const fn cancelling(method: Method) -> Group {
    Group {
        method,
        parts: &[Part::SidesTurned],
        label: "count cancelling sides, z-fail",
        why: "Where two polygons meet, one's side is drawn as the other's with the operations swapped: both cancel to the last bit.",
        stencil: StencilState::count_z_fail_turned,
        ..Group::PLAIN
    }
}
