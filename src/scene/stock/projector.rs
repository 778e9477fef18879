//! A slide projector throws a rose window past a sculpture onto a wall: shadows cut out of a coloured
//! picture, as M section 8 promises for lights with projected textures. A globe of a lamp beside it, counted
//! as eight points, throws the soft shadows of K's figure 15.

use glam::{DQuat, DVec3};

use super::compose::{Composer, FLOORS, FURNITURE, SOLIDS, at};
use crate::scene::gltf::ImportError;
use crate::scene::{BuiltInSlide, Extent, LightKind, Scene};

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("projector", &[SOLIDS, FLOORS, FURNITURE])?;
    c.environment([0.045, 0.045, 0.055], [0.035, 0.03, 0.028], [0.012, 0.012, 0.018], [0.030, 0.026, 0.026]);

    let floor = c.prop("planks");
    c.put("floor", floor, at(0.0, 0.0, 0.0));
    let cube = c.prop("cube");
    let plaster = c.tinted(cube, [0.62, 0.59, 0.54], 1.0);
    c.put("wall", plaster, at(0.0, 2.1, -2.7).stretched(16.0, 4.2, 0.3));

    let plinth = c.prop("plinth");
    c.put("plinth", plinth, at(0.15, 0.0, -0.4));
    let knot = c.prop("knot");
    let bronze = c.tinted(knot, [0.42, 0.30, 0.18], 0.4);
    let sculpture = c.put("knot", bronze, at(0.15, 1.85, -0.4).sized(0.85));
    c.turns(sculpture, 24.0, 24, |turns| DQuat::from_rotation_y(turns * std::f64::consts::TAU));
    let ball = c.prop("ball");
    let ivory = c.tinted(ball, [0.70, 0.66, 0.58], 0.5);
    c.put("ball", ivory, at(-1.55, 0.45, 0.1).sized(0.9));
    let urn = c.prop("urn");
    c.put("urn", urn, at(1.75, 0.0, -1.5).sized(0.8));

    // Behind its own light, which shines along -Z.
    let projector = c.looking("projector", [2.35, 2.15, 3.6], [-0.25, 1.75, -2.55]);
    let case = c.tinted(cube, [0.05, 0.05, 0.06], 0.6);
    c.put_on(Some(projector), "case", case, at(0.0, 0.0, 0.32).stretched(0.34, 0.3, 0.5));
    let spot = LightKind::Spot { inner: 0.40, outer: 0.42 };
    c.light(projector, spot, [1.0, 0.97, 0.90], 420.0, 16.0);
    c.projects(BuiltInSlide::StainedGlass);

    let lamp = c.group("globe lamp", None, at(-2.0, 2.65, 0.5));
    c.light(lamp, LightKind::Point, [1.0, 0.80, 0.55], 20.0, 11.0);
    c.sized_light(Extent::Round(0.22));
    let glass = c.glowing(ball, [2.4, 1.9, 1.3]);
    c.put_on(Some(lamp), "glass", glass, at(0.0, 0.0, 0.0).sized(0.42));
    c.moves(lamp, 8.0, 24, |turns| DVec3::new(-2.0 + 0.12 * (turns * std::f64::consts::TAU).sin(), 2.65, 0.5));

    c.camera("front", [-1.5, 2.0, 5.0], [0.05, 1.35, -1.2], 42.0);
    c.camera("wall", [-0.6, 1.9, 2.3], [-0.1, 1.7, -2.5], 55.0);
    c.camera("floor", [-3.6, 1.1, 2.2], [-0.6, 0.6, -0.6], 46.0);
    Ok(c.finish())
}
