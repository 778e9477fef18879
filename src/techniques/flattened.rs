//! Silhouettes flattened into cut-outs (K 6.2.2; his `shadowfun` and `hello2rts`).
//!
//! For each light the caster is projected onto a plane behind it, a polygon library unites what
//! came out, and the outline is a planar cut-out whose volume is thrown by one matrix
//! ([`crate::geometry::flatten`], [`crate::geometry::cutout`]). The volume is a prism over a flat
//! figure: few faces, each light's side seen once, however often the silhouette overlaps itself.
//!
//! It is an approximation, as K says. A receiver beyond the plane gets the caster's exact shadow; but
//! the caster gets none from itself, and what stands or lies beside it before the plane gets none
//! either. It never darkens what is lit.
//!
//! The cut-out lies on no surface, so its light cap is always compared with depth. A caster that the
//! light stands in, or so close to that it cannot be projected, goes by z-fail.

use super::{Caster, Row, z_fail};
use crate::frame::{Cutout, CutoutShape, Method, Reason};
use crate::geometry::Outline;
use crate::geometry::flatten::flattening_plane;
use crate::settings::Technique;

pub(super) const ROW: Row = Row {
    technique: Technique::Flattened,
    title: "Flattened silhouettes",
    about: "Every caster becomes a flat cut-out behind itself, by a union of polygons; no shadow of it on itself, or before that plane.",
    exact: false,
    source: "Kilgard 1999, 6.2.2",
    decide: |caster| Some(decide(caster)),
    outline: Outline::Silhouette,
    extrusion: None,
    darkens: None,
    groups: &[z_fail::GROUPS],
};

fn decide(caster: &Caster<'_>) -> (Method, Reason) {
    let light = caster.light_in_object();
    let positions = caster.pose.positions(caster.scene, caster.node_index);
    let weld = &caster.mesh.topology.weld().vertex_of_welded;
    let welded = weld.iter().map(|&vertex| positions[vertex as usize]);
    let bounds = caster.pose.bounds(caster.scene, caster.node_index);
    let Some(plane) = flattening_plane(welded, &bounds, light) else {
        return (z_fail::decide(caster).0, Reason::LightTooNear);
    };
    let throw = plane.throw(light, &caster.receivers_in_object());
    caster.cutout.get_or_init(|| Cutout { shape: CutoutShape::Flattened, plane, throw });
    (Method::ZFailCompared, Reason::Flattened)
}
