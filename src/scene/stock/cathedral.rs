//! McGuire's cathedral: a nave with piers, pointed arches and vaults, a short flight of steps to
//! the choir, three figures on skeletons, three lights of different colours. A hoop with a
//! flame swings along the nave and drives the piers' shadows before it; a red and a green lamp wander in the aisles,
//! behind the piers, and stripe the pavement.

use std::f64::consts::TAU;

use glam::DVec3;

use super::compose::{CATHEDRAL, Composer, FURNITURE, PILGRIM, STRIDE, at, there_and_back};
use crate::scene::gltf::ImportError;
use crate::scene::{LightKind, Scene};

/// From pier to pier, as the models are made.
const BAY: f64 = 4.0;
/// The bays' middles go from here eastwards (towards -z).
const WEST: f64 = 10.0;
const BAYS: usize = 7;
/// The nave's wall line, and the aisles' outer walls, to both sides of the axis.
const WALL_LINE: f64 = 3.6;
const OUTER: f64 = 6.6;
/// Where the choir begins, and its floor's height.
const CHOIR: f64 = -9.0;
const CHOIR_FLOOR: f64 = 0.96;

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("cathedral", &[CATHEDRAL, FURNITURE, PILGRIM])?;
    c.environment([0.060, 0.062, 0.085], [0.050, 0.040, 0.034], [0.010, 0.014, 0.030], [0.020, 0.018, 0.020]);
    nave(&mut c);
    east(&mut c);
    pilgrims(&mut c);
    lights(&mut c);
    c.camera("nave", [0.9, 2.1, 10.9], [-0.15, 3.1, -4.0], 62.0);
    c.camera("between piers", [-5.3, 1.0, 3.3], [2.2, 1.9, -3.2], 60.0);
    c.camera("triforium", [-2.7, 8.0, 6.6], [1.0, 1.6, -3.6], 60.0);
    c.camera("choir", [1.7, 2.6, -12.2], [-0.8, 2.2, 2.0], 60.0);
    Ok(c.finish())
}

fn nave(c: &mut Composer) {
    let pavement = c.prop("pavement");
    c.put("pavement", pavement, at(0.0, 0.0, -2.0));
    let [pier, wall, aisle, pilaster] = ["pier", "nave wall", "aisle wall", "pilaster"].map(|name| c.prop(name));
    let [vault, aisle_vault] = ["nave vault", "aisle vault"].map(|name| c.prop(name));
    let [tall_frame, small_frame] = ["tall frame", "small frame"].map(|name| c.prop(name));
    let [tall, tall_2, small] = ["tall glass", "tall glass 2", "small glass"].map(|name| {
        let glass = c.prop(name);
        c.luminous(glass, 0.9)
    });
    for bay in 0..BAYS {
        let z = WEST - BAY * bay as f64;
        c.put(&format!("vault {bay}"), vault, at(0.0, 7.2, z));
        for (side, sign, facing) in [("south", 1.0, 0.0), ("north", -1.0, 180.0)] {
            let name = |part: &str| format!("{side} {part} {bay}");
            c.put(&name("wall"), wall, at(sign * WALL_LINE, 0.0, z).facing(facing));
            c.put(&name("aisle wall"), aisle, at(sign * OUTER, 0.0, z).facing(facing));
            c.put(&name("pilaster"), pilaster, at(sign * OUTER, 0.0, z).facing(facing));
            c.put(&name("aisle vault"), aisle_vault, at(sign * (OUTER + 3.9) / 2.0, 3.8, z));
            if bay + 1 < BAYS {
                c.put(&name("pier"), pier, at(sign * WALL_LINE, 0.0, z - BAY / 2.0).facing(facing));
            }
            // Windows look inwards: their front is +z.
            let inwards = -90.0 * sign;
            let glass = if (bay + usize::from(sign > 0.0)) % 2 == 0 { tall } else { tall_2 };
            c.put(&name("window"), glass, at(sign * (OUTER - 0.02), 1.3, z).facing(inwards));
            c.put(&name("window frame"), tall_frame, at(sign * OUTER, 1.3, z).facing(inwards));
            c.put(&name("clerestory"), small, at(sign * (WALL_LINE - 0.32), 9.0, z).facing(inwards));
            c.put(&name("clerestory frame"), small_frame, at(sign * (WALL_LINE - 0.3), 9.0, z).facing(inwards));
        }
    }
}

fn east(c: &mut Composer) {
    let (end, steps, choir) = (c.prop("end wall"), c.prop("choir steps"), c.prop("choir"));
    let (altar, candlestick, flame) = (c.prop("altar"), c.prop("candlestick"), c.prop("flame"));
    let wall = -16.0;
    c.put("east wall", end, at(0.0, 0.0, wall - 0.3));
    c.put("west wall", end, at(0.0, 0.0, 12.3));
    c.put("choir steps", steps, at(0.0, 0.0, CHOIR));
    c.put("choir", choir, at(0.0, 0.0, CHOIR));
    c.put("altar", altar, at(0.0, CHOIR_FLOOR, -13.4));
    for (side, x) in [("left", -0.75), ("right", 0.75)] {
        c.put(&format!("{side} candlestick"), candlestick, at(x, CHOIR_FLOOR + 1.08, -13.4).sized(0.55));
        c.put(&format!("{side} candle"), flame, at(x, CHOIR_FLOOR + 1.08 + 0.81, -13.4).sized(0.8));
    }
    let (rose, rose_frame) = (c.prop("rose glass"), c.prop("rose frame"));
    let rose = c.luminous(rose, 1.5);
    c.put("rose", rose, at(0.0, 8.3, wall + 0.02));
    c.put("rose frame", rose_frame, at(0.0, 8.3, wall));
    let (tall, frame) = (c.prop("tall glass"), c.prop("tall frame"));
    let tall = c.luminous(tall, 1.2);
    for (i, x) in [-2.0, 0.0, 2.0].into_iter().enumerate() {
        c.put(&format!("east window {i}"), tall, at(x, 2.5, wall + 0.02));
        c.put(&format!("east window frame {i}"), frame, at(x, 2.5, wall));
    }
}

fn pilgrims(c: &mut Composer) {
    // They go round one after another, each with a stride of its own.
    for (name, size, strides, dye, ahead, step) in [
        ("abbot", 1.08, 24, [0.42, 0.035, 0.03], 0.775, 0.0),
        ("monk", 1.0, 26, [0.33, 0.22, 0.12], 0.68, 0.37),
        ("novice", 0.88, 30, [0.46, 0.42, 0.36], 0.575, 0.71),
    ] {
        let figure = c.put_figure(None, PILGRIM, name, at(0.0, 0.0, 0.0).sized(size));
        c.dyed(figure, "robe", dye);
        c.out_of_step(name, step);
        let length = f64::from(strides) * STRIDE * size;
        c.walks(figure, strides, move |turns| there_and_back(DVec3::new(0.0, 0.0, 0.6), 1.25, length, turns + ahead));
    }
}

fn lights(c: &mut Composer) {
    // The corona hangs from the vault and swings along the nave.
    let hook = c.group("corona", None, at(0.0, 11.2, 2.6));
    c.swings(hook, 5.4, DVec3::X, 14.0);
    let ember = c.group("corona light", Some(hook), at(0.0, -6.0, 0.0));
    c.light(ember, LightKind::Point, [1.0, 0.72, 0.40], 120.0, 22.0);
    let (corona, flame) = (c.prop("corona"), c.prop("flame"));
    c.put_on(Some(ember), "hoop", corona, at(0.0, 0.0, 0.0));
    c.put_on(Some(ember), "flame", flame, at(0.0, 0.0, 0.0).sized(2.6));
    // Two lamps wander up and down the aisles.
    for (name, side, color, middle, seconds, start) in
        [("green lamp", 1.0, [0.16, 1.0, 0.50], 0.5, 26.0, 0.15), ("red lamp", -1.0, [1.0, 0.13, 0.12], -1.5, 31.0, 0.6)]
    {
        let lamp = c.group(name, None, at(side * 5.2, 2.2, middle));
        c.light(lamp, LightKind::Point, color, 32.0, 13.0);
        c.moves(lamp, seconds, 72, move |turns| {
            let (sin, cos) = ((turns + start) * TAU).sin_cos();
            DVec3::new(side * (5.2 + 0.3 * cos), 2.2 + 0.12 * (2.0 * (turns + start) * TAU).sin(), middle + 4.2 * sin)
        });
        let glow = c.glowing(flame, color);
        c.put_on(Some(lamp), &format!("{name}'s flame"), glow, at(0.0, 0.0, 0.0).sized(1.8));
    }
}
