//! Where z-pass fails: the eye stands in the shadow of a great disc and looks towards the light.
//! The near plane cuts the disc's volume open, every count seen through that hole is one short, and
//! what is lit turns dark while the shadow turns bright. z-fail and exact z-pass do not mind.

use glam::DVec3;

use super::compose::{ARCHITECTURE, CUTOUT, Composer, FLOORS, FURNITURE, SOLIDS, STRIDE, WALKER, at, circle};
use crate::scene::gltf::ImportError;
use crate::scene::{LightKind, Scene};

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("eye-in-shadow", &[FLOORS, ARCHITECTURE, CUTOUT, FURNITURE, SOLIDS, WALKER])?;
    c.environment([0.080, 0.092, 0.135], [0.060, 0.058, 0.066], [0.020, 0.034, 0.085], [0.13, 0.105, 0.12]);

    let floor = c.prop("paving");
    let floor = c.receiving(floor);
    c.put("floor", floor, at(0.0, 0.0, 0.0));

    // The disc rests on its socle; the light stands behind it, the eye before it.
    let sun = c.prop("sun");
    let bronze = c.tinted(sun, [0.30, 0.19, 0.09], 0.4);
    c.put("disc", bronze, at(0.0, 2.86, -3.0).sized(3.0));
    let block = c.prop("bevelled cube");
    let socle = c.tinted(block, [0.42, 0.38, 0.33], 0.8);
    c.put("socle", socle, at(0.0, 0.18, -3.0).stretched(2.4, 0.36, 0.9));

    let column = c.prop("column");
    for (i, z) in [-6.4, -3.2, 0.0, 3.2].into_iter().enumerate() {
        for (side, x) in [("left", -4.3), ("right", 4.3)] {
            c.put(&format!("{side} column {i}"), column, at(x, 0.0, z));
        }
    }
    let arcade = c.prop("arcade 6");
    c.put("arcade", arcade, at(0.0, 0.0, -12.2));
    let wall = c.prop("wall 6");
    c.put("wall", wall, at(0.0, -2.2, -13.6));
    for k in -3..=3 {
        c.put(&format!("pillar {k}"), column, at(f64::from(k) * 2.4, 0.0, -12.2));
    }
    let (pot, cypress, urn) = (c.prop("pot"), c.prop("cypress"), c.prop("urn"));
    for (side, x) in [("left", -2.9), ("right", 2.9)] {
        c.put(&format!("{side} pot"), pot, at(x, 0.0, -4.6).sized(1.1));
        c.put(&format!("{side} cypress"), cypress, at(x, 0.0, -4.6).facing(x * 40.0).sized(1.1));
    }
    c.put("urn", urn, at(1.75, 0.0, 0.9).facing(30.0).sized(0.8));

    let radius = 14.0 * STRIDE / std::f64::consts::TAU;
    let walker = c.put_figure(None, WALKER, "walker", at(0.0, 0.0, 0.0));
    c.walks(walker, 14, |turns| circle(DVec3::new(0.0, 0.0, -2.2), radius, turns + 0.60));

    let lamp = c.group("lamp", None, at(0.0, 3.7, -8.2));
    c.light(lamp, LightKind::Point, [1.0, 0.76, 0.46], 210.0, 26.0);
    c.moves(lamp, 12.0, 32, |turns| circle(DVec3::new(0.0, 3.7, -8.2), 0.25, turns + 0.25));
    let flame = c.prop("flame");
    let glow = c.glowing(flame, [1.0, 0.80, 0.52]);
    c.put_on(Some(lamp), "bulb", glow, at(0.0, 0.0, 0.0).sized(1.7));
    c.point_light("evening sky", [-5.0, 6.5, 9.5], [0.42, 0.55, 1.0], 80.0, 28.0);

    c.camera("in shadow", [0.0, 1.55, 6.2], [0.0, 2.25, -3.0], 52.0);
    c.camera("beside", [8.6, 3.6, 5.2], [0.0, 1.6, -3.4], 46.0);
    c.camera("towards the eye", [-5.6, 3.1, -10.2], [0.4, 1.9, -1.0], 52.0);
    Ok(c.finish())
}
