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
    c.environment([0.115, 0.120, 0.215], [0.045, 0.034, 0.045], [0.012, 0.022, 0.085], [0.34, 0.165, 0.12]);
    c.put_figure(None, STAIRS, "building", at(0.0, 0.0, 0.0));
    let (paving, ground) = (c.prop("paving"), c.prop("ground"));
    for (i, (x, z)) in [(-12.0, 32.0), (12.0, 32.0), (-12.0, 8.0), (12.0, 8.0)].into_iter().enumerate() {
        c.put(&format!("court {i}"), paving, at(x, 0.0, z));
    }
    // The land about the court, and the lower one before it.
    let land = c.tinted(ground, [0.016, 0.015, 0.018], 1.0);
    c.put("land", land, at(0.0, -0.03, 44.0 - 180.0).stretched(30.0, 1.0, 15.0));
    c.put("low land", land, at(0.0, -1.1, 44.0 + 36.0).stretched(30.0, 1.0, 3.0));

    let beacon = c.group("beacon", None, at(BEACON.x, BEACON.y, BEACON.z));
    c.light(beacon, LightKind::Point, [1.0, 0.70, 0.36], 36_000.0, 170.0);
    c.moves(beacon, 8.0, 32, |turns| circle(BEACON, 0.12, turns));
    let flame = c.prop("flame");
    let glow = c.glowing(flame, [6.0, 4.0, 2.0]);
    c.put_on(Some(beacon), "fire", glow, at(0.0, 0.0, 0.0).sized(16.0));
    // As steep on the treads as on the risers.
    c.point_light("moon", [20.0, 46.0, 52.0], [0.50, 0.62, 1.0], 1500.0, 85.0);

    let (obelisk, cypress, pot) = (c.prop("obelisk"), c.prop("cypress"), c.prop("pot"));
    for (i, (x, z)) in [(-9.5, 24.0), (9.5, 24.0), (-9.5, 31.0), (9.5, 31.0), (-9.5, 38.0), (9.5, 38.0)].into_iter().enumerate() {
        c.put(&format!("obelisk {i}"), obelisk, at(x, 0.0, z).sized(1.3));
    }
    for (i, (x, z)) in [(-15.0, 27.5), (15.0, 27.5), (-15.0, 37.0), (15.0, 37.0)].into_iter().enumerate() {
        c.put(&format!("pot {i}"), pot, at(x, 0.0, z).sized(1.6));
        c.put(&format!("cypress {i}"), cypress, at(x, 0.0, z).facing(50.0 * i as f64).sized(1.6));
    }

    let radius = 20.0 * STRIDE / std::f64::consts::TAU;
    let walker = c.put_figure(None, WALKER, "walker", at(0.0, 0.0, 0.0));
    c.walks(walker, 20, |turns| circle(DVec3::new(2.5, 0.0, 31.5), radius, turns + 0.6));

    c.camera("court", [6.5, 14.0, 57.0], [-0.9, 6.6, 12.0], 52.0);
    c.camera("terrace", [-14.0, 9.0, 41.0], [1.0, 5.0, 18.0], 48.0);
    c.camera("top", [-2.3, 35.6, -41.0], [0.5, 2.0, 26.0], 46.0);
    Ok(c.finish())
}
