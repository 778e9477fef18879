//! Small scenes to be cut open ([`crate::techniques::diagram`]): lamp, casters and what they shadow stand in one
//! upright plane, as in the papers' diagrams. Their near planes lie far before the eye, so that a viewport is there to be
//! seen.

use super::carpentry::boxes;
use super::compose::{Composer, FLOORS, FURNITURE, SOLIDS, at};
use crate::scene::gltf::ImportError;
use crate::scene::{LightKind, Scene};

/// Metres from the eye to its viewport.
const VIEWPORT: f64 = 0.55;

fn stage(name: &str, lamp_at: [f64; 3]) -> Result<Composer, ImportError> {
    let mut c = Composer::new(name, &[SOLIDS, FLOORS, FURNITURE])?;
    c.environment([0.085, 0.090, 0.110], [0.055, 0.050, 0.046], [0.022, 0.028, 0.046], [0.070, 0.074, 0.092]);
    let floor = c.prop("paving");
    let floor = c.laid(floor, [14.0, 6.0], 2.4);
    c.put("floor", floor, at(0.0, 0.0, 0.0));
    let [x, y, z] = lamp_at;
    let lamp = c.group("lamp", None, at(x, y, z));
    c.light(lamp, LightKind::Point, [1.0, 0.90, 0.74], 95.0, 24.0);
    let flame = c.prop("flame");
    let glow = c.glowing(flame, [1.0, 0.90, 0.74]);
    let glow = Composer::shadeless(glow);
    c.put_on(Some(lamp), "flame", glow, at(0.0, 0.0, 0.0).sized(1.4));
    Ok(c)
}

fn finished(c: Composer) -> Scene {
    let mut scene = c.finish();
    for camera in &mut scene.cameras {
        camera.near = VIEWPORT;
    }
    scene
}

/// A slab hangs before a lamp, a ball lies partly in its shadow.
pub(super) fn slice() -> Result<Scene, ImportError> {
    let mut c = stage("slice", [-1.5, 4.3, 0.0])?;
    let slab = boxes(&mut c, "slab", &[([0.0, 0.0, 0.0], [1.5, 0.14, 1.5])], [0.55, 0.30, 0.10], 0.6);
    c.put("slab", slab, at(0.15, 2.75, 0.0).turned(glam::DVec3::Z, 12.0));
    let ball = c.prop("ball");
    let ivory = Composer::shadeless(c.tinted(ball, [0.70, 0.64, 0.54], 0.35));
    c.put("ball", ivory, at(0.75, 0.8, 0.0).sized(1.6));
    c.camera("eye", [-4.3, 1.75, 0.0], [1.2, 1.35, 0.0], 42.0);
    c.camera("low", [-3.9, 0.75, 0.0], [0.6, 1.45, 0.0], 46.0);
    c.camera("away", [2.3, 1.3, 0.0], [5.0, 1.0, 0.0], 42.0);
    c.camera("towards the light", [3.1, 0.95, 0.0], [-0.3, 3.0, 0.0], 42.0);
    c.camera("from above", [-2.6, 4.6, 4.2], [0.15, 2.35, 0.0], 40.0);
    Ok(finished(c))
}

/// Three slabs, whose volumes overlap.
pub(super) fn slabs() -> Result<Scene, ImportError> {
    let mut c = stage("slabs", [-0.4, 5.0, 0.0])?;
    let list = [
        ("upper slab", [-0.4, 3.5], 1.0, [0.50, 0.14, 0.08]),
        ("middle slab", [0.75, 2.75], 1.4, [0.55, 0.36, 0.08]),
        ("lower slab", [0.85, 1.75], 0.8, [0.10, 0.30, 0.36]),
    ];
    for (name, [x, y], width, color) in list {
        let slab = boxes(&mut c, name, &[([0.0, 0.0, 0.0], [width, 0.12, 1.4])], color, 0.6);
        c.put(name, slab, at(x, y, 0.0));
    }
    let ball = c.prop("ball");
    let ivory = Composer::shadeless(c.tinted(ball, [0.70, 0.64, 0.54], 0.35));
    c.put("ball", ivory, at(2.9, 0.55, 0.0).sized(1.1));
    c.camera("eye", [-4.4, 1.7, 0.0], [1.2, 0.9, 0.0], 40.0);
    Ok(finished(c))
}
