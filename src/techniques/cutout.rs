//! Planar cut-outs (K 6.2.1, appendix C, and the "Advanced" note).
//!
//! A caster all of whose triangles lie on one plane, with holes or without, is its own cut-out: it
//! never shadows itself, its outline is known once and for all, and when the light or the caster
//! moves only a matrix changes, which throws the outline onto a parallel plane behind every receiver
//! ([`crate::geometry::cutout`]). Its volume is counted by z-fail, the cut-out being the light cap,
//! so it is exact wherever the eye is; K counts by z-pass and inverts one bit.
//!
//! Casters that are no cut-outs, and cut-outs that the light sees edge-on, go by plain z-fail; the
//! plan says which, and why.

use super::{Caster, Row, z_fail};
use crate::frame::{Cutout, CutoutShape, Method, Reason};
use crate::geometry::Outline;
use crate::settings::Technique;

pub(super) const ROW: Row = Row {
    technique: Technique::Cutout,
    title: "Planar cut-outs",
    about: "Flat casters throw their outline by one matrix, onto a plane behind everything; exact, all others by z-fail.",
    exact: true,
    source: "Kilgard 1999, 6.2.1 and appendix C",
    decide: |caster| Some(decide(caster)),
    outline: Outline::Silhouette,
    extrusion: None,
    darkens: None,
    groups: &[z_fail::GROUPS],
};

/// The least sine of the angle at which a light may look onto a cut-out: the far plane would have to
/// lie a thousand times as far away as the receivers.
const LEAST_STEEPNESS: f64 = 1e-3;

fn decide(caster: &Caster<'_>) -> (Method, Reason) {
    let (method, _) = z_fail::decide(caster);
    let topology = &caster.mesh.topology;
    let plane = match &caster.pose.deformed[caster.node_index] {
        Some(deformed) => topology.plane_of(&deformed.positions),
        None => topology.plane(),
    };
    let Some(plane) = plane else { return (method, Reason::NotPlanar) };
    let light = caster.light_in_object();
    let corners = caster.pose.bounds(caster.scene, caster.node_index).corners();
    if plane.steepness(light, &corners).abs() < LEAST_STEEPNESS {
        return (method, Reason::LightInPlane);
    }
    let throw = plane.throw(light, &caster.receivers_in_object());
    caster.cutout.get_or_init(|| Cutout { shape: CutoutShape::Planar, plane, throw });
    (method, Reason::Planar)
}
