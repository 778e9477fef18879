//! Small scenes for single failures of the gallery ([`crate::failures`]): their casters are made here,
//! triangle by triangle, because it is the triangles that matter.

use glam::Vec3;

use super::carpentry::cuboid;
use super::compose::{ARCHITECTURE, Composer, FLOORS, FURNITURE, SOLIDS, WALKER, at};
use crate::scene::gltf::ImportError;
use crate::scene::{LightKind, Scene};

/// A lamp in a hut with an open door: to the light there are walls all round.
pub(super) fn hut() -> Result<Scene, ImportError> {
    let mut c = Composer::new("hut", &[FLOORS, ARCHITECTURE, FURNITURE, SOLIDS, WALKER])?;
    c.environment([0.055, 0.066, 0.105], [0.040, 0.040, 0.048], [0.014, 0.022, 0.055], [0.060, 0.062, 0.090]);
    let floor = c.prop("paving");
    c.put("floor", floor, at(0.0, 0.0, 0.0));

    // The door looks along +Z. Boxes of one mesh overlap at the corners, so that no light finds a joint.
    let (half, wall, height, door, lintel) = (1.8f32, 0.18, 2.5, 0.55, 1.95);
    let inner = half - wall;
    let boxes = [
        ([-half, 0.0, -half], [half, height, -inner]),
        ([-half, 0.0, -half + 0.01], [-inner, height - 0.01, half - 0.01]),
        ([inner, 0.0, -half + 0.01], [half, height - 0.01, half - 0.01]),
        ([-half + 0.01, 0.0, inner], [-door, height - 0.02, half]),
        ([door, 0.0, inner], [half - 0.01, height - 0.02, half]),
        ([-half + 0.02, lintel, inner + 0.01], [half - 0.02, height - 0.03, half - 0.01]),
        ([-half - 0.02, -0.1, -half - 0.02], [half + 0.02, 0.04, half + 0.02]),
        ([-half - 0.25, height - 0.05, -half - 0.25], [half + 0.25, height + 0.12, half + 0.25]),
    ];
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for (least, most) in boxes {
        cuboid(least.into(), most.into(), &mut positions, &mut triangles);
    }
    let hut = c.made("hut", &positions, &triangles, [0.46, 0.36, 0.27], 0.85);
    c.put("hut", hut, at(0.0, 0.0, 0.0));

    let block = c.prop("bevelled cube");
    let stone = c.tinted(block, [0.42, 0.38, 0.33], 0.8);
    c.put("pedestal", stone, at(0.0, 0.3, -0.3).stretched(0.5, 0.6, 0.5));
    c.put("left stone", stone, at(-1.0, 0.22, 3.5).facing(25.0).sized(0.44));
    let ball = c.prop("ball");
    let red = c.tinted(ball, [0.55, 0.10, 0.06], 0.4);
    c.put("ball", red, at(1.15, 0.3, 3.9).sized(0.6));
    let (pot, cypress, column) = (c.prop("pot"), c.prop("cypress"), c.prop("column"));
    for (side, x) in [("left", -2.9), ("right", 2.9)] {
        c.put(&format!("{side} pot"), pot, at(x, 0.0, 2.3));
        c.put(&format!("{side} cypress"), cypress, at(x, 0.0, 2.3).facing(x * 40.0));
        c.put(&format!("{side} column"), column, at(x * 1.5, 0.0, -1.0));
    }
    c.put_figure(None, WALKER, "walker", at(0.25, 0.0, 4.6));

    let lamp = c.group("lamp", None, at(0.0, 1.15, -0.3));
    c.light(lamp, LightKind::Point, [1.0, 0.74, 0.42], 60.0, 16.0);
    let flame = c.prop("flame");
    let glow = c.glowing(flame, [1.0, 0.78, 0.48]);
    c.put_on(Some(lamp), "flame", glow, at(0.0, 0.0, 0.0).sized(1.4));
    c.camera("before the door", [3.4, 3.5, 9.2], [0.0, 0.9, 1.2], 42.0);
    c.camera("inside", [-1.2, 1.6, -1.3], [0.3, 0.9, 2.5], 70.0);
    Ok(c.finish())
}

/// An awning of strips, every other one of one long panel, the rest of nine short ones: the short ones'
/// corners lie on the long one's edge, as nearly as an editor's grid allows. The long panels' triangles
/// meet those corners, so that the mesh has no T-junction; until somebody forgets them.
pub(super) fn awning() -> Result<Scene, ImportError> {
    const STRIPS: u32 = 8;
    const PANELS: u32 = 9;
    /// Metres from one place to the next in the editor.
    const GRID: f32 = 0.008;
    let mut c = Composer::new("awning", &[FLOORS, ARCHITECTURE, FURNITURE, SOLIDS])?;
    c.environment([0.090, 0.100, 0.130], [0.060, 0.055, 0.050], [0.020, 0.034, 0.085], [0.13, 0.105, 0.12]);
    let floor = c.prop("paving");
    c.put("floor", floor, at(0.0, 0.0, 0.0));

    // A barrel vault along X; each seam is straight, but leans, so that its vertices miss the grid.
    let corner = |seam: u32, panel: u32| {
        let (across, along) = (seam as f32 / STRIPS as f32, panel as f32 / PANELS as f32);
        let turn = (across - 0.5) * 2.2;
        let end = Vec3::new(2.3, 2.0 + 0.9 * turn.cos(), 1.7 * turn.sin());
        let lean = Vec3::new(0.0, 0.17, 0.11 * (1.0 + across));
        let place = end * Vec3::new(2.0 * along - 1.0, 1.0, 1.0) + lean * along;
        let inside = (1..PANELS).contains(&panel) && (1..STRIPS).contains(&seam);
        if inside { (place / GRID).round() * GRID } else { place }
    };
    let positions: Vec<Vec3> =
        (0..=STRIPS).flat_map(|seam| (0..=PANELS).map(move |panel| (seam, panel))).map(|(s, p)| corner(s, p)).collect();
    let number = |seam: u32, panel: u32| seam * (PANELS + 1) + panel;
    let mut triangles = Vec::new();
    for strip in 0..STRIPS {
        let (near, far) = (strip, strip + 1);
        for panel in 0..PANELS {
            let [a, b] = [panel, panel + 1].map(|panel| number(near, panel));
            let [d, e] = [panel, panel + 1].map(|panel| number(far, panel));
            if strip % 2 == 0 {
                triangles.extend([[a, d, e], [a, e, b]]);
            } else {
                // Two fans, one about each end of a diagonal.
                triangles.extend([[a, number(far, 0), b], [d, e, number(near, PANELS)]]);
            }
        }
    }
    let cloth = c.made("awning", &positions, &triangles, [0.62, 0.20, 0.10], 0.95);
    let cloth = c.sheet(cloth);
    c.put("awning", cloth, at(0.0, 0.0, 0.0));

    let post = c.prop("post");
    for (x, z, height) in [(-2.2, -1.4, 2.3), (2.2, -1.35, 2.4), (-2.2, 1.4, 2.3), (2.2, 1.5, 2.4)] {
        c.put("post", post, at(x, height / 2.0, z).stretched(0.4, height / 2.2, 0.4));
    }
    let block = c.prop("bevelled cube");
    let stone = c.tinted(block, [0.42, 0.38, 0.33], 0.8);
    c.put("stone", stone, at(-0.8, 0.3, 0.2).facing(25.0).sized(0.6));
    let ball = c.prop("ball");
    let blue = c.tinted(ball, [0.08, 0.18, 0.45], 0.4);
    c.put("ball", blue, at(0.7, 0.45, -0.2).sized(0.9));

    c.point_light("lamp", [0.4, 4.6, 0.7], [1.0, 0.92, 0.78], 120.0, 16.0);
    c.point_light("sky", [-5.0, 6.5, 7.5], [0.42, 0.55, 1.0], 40.0, 24.0);
    c.camera("under the awning", [0.45, 1.8, 2.7], [0.0, 0.2, -0.1], 46.0);
    c.camera("above", [-2.6, 5.2, 5.6], [0.0, 1.6, 0.0], 44.0);
    Ok(c.finish())
}
