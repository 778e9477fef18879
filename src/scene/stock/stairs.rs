//! McGuire's image 3: a light on top of a flight of steps, each a caster of its own. Where the
//! court meets the terrace, 256 volumes lie one in another: eight bits count to 256 and stand at
//! zero, so that what should be the deepest shadow is lit. The building comes from its model whole;
//! `examples/make_assets/models/stairs.rs` says how it is measured for this.

use glam::DVec3;

use super::compose::{Composer, FLOORS, FURNITURE, STAIRS, STRIDE, WALKER, at, circle};
use crate::scene::gltf::ImportError;
use crate::scene::{LightKind, Scene};

/// Where the beacon stands: a little below the line of the noses, continued over the platform.
pub(super) const BEACON: DVec3 = DVec3::new(0.0, 35.55, -53.78);

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("stairs", &[STAIRS, FLOORS, FURNITURE, WALKER])?;
    c.environment([0.25, 0.25, 0.38], [0.030, 0.026, 0.036], [0.016, 0.026, 0.085], [0.30, 0.155, 0.135]);
    c.put_figure(None, STAIRS, "building", at(0.0, 0.0, 0.0));
    let paving = c.prop("paving");
    for (i, (x, z)) in [(-12.0, 32.0), (12.0, 32.0), (-12.0, 8.0), (12.0, 8.0)].into_iter().enumerate() {
        c.put(&format!("court {i}"), paving, at(x, 0.0, z));
    }

    let beacon = c.group("beacon", None, at(BEACON.x, BEACON.y, BEACON.z));
    c.light(beacon, LightKind::Point, [1.0, 0.74, 0.42], 30_000.0, 160.0);
    c.moves(beacon, 8.0, 32, |turns| circle(BEACON, 0.12, turns));
    let flame = c.prop("flame");
    let glow = c.glowing(flame, [3.0, 2.2, 1.3]);
    c.put_on(Some(beacon), "fire", glow, at(0.0, 0.0, 0.0).sized(14.0));

    c.point_light("dusk", [22.0, 22.0, 46.0], [0.62, 0.62, 1.0], 900.0, 60.0);
    let obelisk = c.prop("obelisk");
    for (i, (x, z)) in [(-11.0, 24.5), (11.0, 24.5), (-11.0, 38.5), (11.0, 38.5)].into_iter().enumerate() {
        c.put(&format!("obelisk {i}"), obelisk, at(x, 0.0, z));
    }

    let radius = 20.0 * STRIDE / std::f64::consts::TAU;
    let walker = c.put_figure(None, WALKER, "walker", at(0.0, 0.0, 0.0));
    c.walks(walker, 20, |turns| circle(DVec3::new(2.5, 0.0, 31.5), radius, turns + 0.6));

    c.camera("court", [3.2, 5.2, 46.0], [0.0, 8.5, 0.0], 50.0);
    c.camera("terrace", [-9.0, 9.5, 33.0], [0.5, 3.0, 18.0], 50.0);
    c.camera("top", [-1.4, 33.8, -41.0], [0.6, 6.0, 20.0], 50.0);
    Ok(c.finish())
}
