//! K's figure 4, a room with mirrors on two opposite walls, as the shop he names for it: "barbershops put
//! mirrors on both walls to increase the overall ambient light".

use glam::{DVec3, Vec3};

use super::carpentry::{boxes, ceiling, hung_mirror, pendant, rectangle, turned, walls};
use super::compose::{Composer, FLOORS, FURNITURE, SOLIDS, STRIDE, WALKER, at, there_and_back};
use crate::scene::gltf::ImportError;
use crate::scene::{Reflective, Scene};

/// Half the room: across, and along; and its height.
const ROOM: [f32; 2] = [2.3, 3.6];
const HEIGHT: f32 = 2.9;

pub(super) fn build() -> Result<Scene, ImportError> {
    let mut c = Composer::new("barbershop", &[SOLIDS, FLOORS, FURNITURE, WALKER])?;
    c.environment([0.115, 0.110, 0.105], [0.085, 0.075, 0.068], [0.010, 0.011, 0.014], [0.016, 0.014, 0.013]);
    room(&mut c);
    mirrors(&mut c);
    chairs(&mut c);
    let barber = c.put_figure(None, WALKER, "barber", at(0.0, 0.0, 0.0));
    c.walks(barber, 9, |turns| there_and_back(DVec3::new(0.45, 0.0, -0.3), 0.42, 9.0 * STRIDE, turns + 0.12));
    let warm = [1.0, 0.80, 0.56];
    pendant(&mut c, "near lamp", [0.1, 2.25, 1.2], 0.55, warm, (13.0, 9.0));
    pendant(&mut c, "far lamp", [-0.1, 2.25, -1.7], 0.55, warm, (15.0, 9.0));
    c.camera("between the mirrors", [1.55, 1.62, 2.9], [-1.35, 1.28, -1.3], 52.0);
    c.camera("hall of mirrors", [1.7, 1.68, -0.55], [-2.3, 1.5, -0.95], 58.0);
    c.camera("chair", [-0.75, 1.32, -1.35], [-2.3, 1.45, -1.1], 64.0);
    Ok(c.finish())
}

fn room(c: &mut Composer) {
    let chequers = c.prop("chequers");
    let chequers = c.receiving(chequers);
    c.put("floor", chequers, at(0.0, 0.0, 0.0).sized(0.5));
    let panelling = walls(c, "panelling", ROOM, [0.0, 0.82], [0.09, 0.17, 0.16]);
    c.put("panelling", panelling, at(0.0, 0.0, 0.0));
    let plaster = walls(c, "plaster", ROOM, [0.82, HEIGHT], [0.60, 0.53, 0.41]);
    c.put("plaster", plaster, at(0.0, 0.0, 0.0));
    let ceiling = ceiling(c, ROOM, HEIGHT, [0.62, 0.60, 0.56]);
    c.put("ceiling", ceiling, at(0.0, 0.0, 0.0));
    // A door in the far wall, and a window's worth of shelves beside it.
    let wood = [0.16, 0.070, 0.032];
    let door = boxes(
        c,
        "door",
        &[
            ([0.0, 1.03, 0.0], [0.92, 2.1, 0.06]),
            ([-0.52, 1.06, 0.01], [0.1, 2.16, 0.12]),
            ([0.52, 1.06, 0.01], [0.1, 2.16, 0.12]),
            ([0.0, 2.16, 0.015], [1.18, 0.12, 0.13]),
        ],
        wood,
        0.5,
    );
    c.put("door", door, at(-1.1, 0.0, -3.6));
    let cupboard = boxes(
        c,
        "cupboard",
        &[
            ([0.0, 0.42, 0.0], [1.5, 0.86, 0.46]),
            ([-0.73, 1.3, 0.0], [0.04, 0.92, 0.3]),
            ([0.73, 1.3, 0.0], [0.04, 0.92, 0.3]),
            ([0.0, 1.32, 0.0], [1.45, 0.03, 0.29]),
            ([0.0, 1.75, 0.0], [1.6, 0.05, 0.34]),
        ],
        wood,
        0.5,
    );
    c.put("cupboard", cupboard, at(1.0, 0.0, -3.4));
    let bench = c.prop("bench");
    let bench = c.tinted(bench, wood, 0.5);
    c.put("bench", bench, at(0.9, -0.01, 3.2));
    let (pot, cypress) = (c.prop("pot"), c.prop("cypress"));
    c.put("pot", pot, at(-1.75, -0.01, 3.05).sized(0.8));
    c.put("cypress", cypress, at(-1.75, 0.0, 3.05).stretched(0.8, 0.62, 0.8));
}

fn mirrors(c: &mut Composer) {
    let look = Reflective { reflectivity: 1.0, tint: Vec3::new(0.93, 0.975, 0.95) };
    let brass = [0.42, 0.28, 0.10];
    let outline = rectangle(4.6, 1.36);
    hung_mirror(c, "left mirror", at(-2.3, 1.72, -0.7).facing(90.0), &outline, look, 0.07, brass);
    hung_mirror(c, "right mirror", at(2.3, 1.72, -0.7).facing(-90.0), &outline, look, 0.07, brass);
    let marble = [0.62, 0.60, 0.57];
    let bottles = bottles(c);
    for (side, x, facing) in [("left", -2.3, 90.0), ("right", 2.3, -90.0)] {
        let group = c.group(&format!("{side} counter"), None, at(x, 0.0, -0.7).facing(facing));
        let slab = boxes(c, "slab", &[([0.0, 0.86, 0.13], [4.7, 0.05, 0.34])], marble, 0.35);
        c.put_on(Some(group), "slab", slab, at(0.0, 0.0, 0.0));
        let brackets: Vec<_> = [-2.1, -0.7, 0.7, 2.1].map(|x| ([x, 0.77, 0.09], [0.06, 0.15, 0.22])).into();
        let brackets = boxes(c, "brackets", &brackets, brass, 0.5);
        c.put_on(Some(group), "brackets", brackets, at(0.0, 0.0, 0.0));
        for number in 0..10u8 {
            let along = -1.95 + 0.42 * f64::from(number) + 0.11 * f64::from(number * 7 % 5);
            let out = 0.12 + 0.045 * f64::from(number * 3 % 4);
            let bottle = bottles[usize::from((number * 5 + u8::from(x > 0.0) * 2) % 6)];
            c.put_on(Some(group), &format!("bottle {number}"), bottle, at(along, 0.883, out).facing(f64::from(number) * 31.0));
        }
    }
}

/// Bottles, jars and a bowl.
fn bottles(c: &mut Composer) -> [super::compose::Prop; 6] {
    let slender =
        [[0.0, 0.0], [0.036, 0.0], [0.038, 0.12], [0.013, 0.16], [0.013, 0.21], [0.019, 0.215], [0.019, 0.235], [0.0, 0.235]];
    let round =
        [[0.0, 0.0], [0.03, 0.0], [0.052, 0.035], [0.048, 0.08], [0.014, 0.11], [0.014, 0.15], [0.024, 0.165], [0.0, 0.18]];
    let jar = [[0.0, 0.0], [0.045, 0.0], [0.048, 0.09], [0.040, 0.10], [0.042, 0.125], [0.0, 0.135]];
    [
        ("green bottle", &slender[..], [0.05, 0.28, 0.12]),
        ("amber bottle", &round[..], [0.55, 0.22, 0.03]),
        ("blue jar", &jar[..], [0.05, 0.14, 0.48]),
        ("white jar", &jar[..], [0.72, 0.70, 0.66]),
        ("rose bottle", &slender[..], [0.60, 0.13, 0.17]),
        ("clear bottle", &round[..], [0.40, 0.52, 0.54]),
    ]
    .map(|(name, profile, color)| turned(c, name, profile, 10, color, 0.25))
}

/// Three, before the left mirror.
fn chairs(c: &mut Composer) {
    let leather = boxes(
        c,
        "leather",
        &[
            ([0.0, 0.54, 0.0], [0.54, 0.13, 0.52]),
            ([0.0, 0.90, -0.27], [0.50, 0.62, 0.10]),
            ([0.0, 1.29, -0.28], [0.26, 0.13, 0.09]),
            ([-0.31, 0.75, -0.03], [0.09, 0.05, 0.44]),
            ([0.31, 0.75, -0.03], [0.09, 0.05, 0.44]),
        ],
        [0.16, 0.018, 0.015],
        0.5,
    );
    let chrome = boxes(
        c,
        "chrome",
        &[
            ([0.0, 0.25, 0.0], [0.11, 0.48, 0.11]),
            ([-0.31, 0.63, 0.13], [0.035, 0.21, 0.035]),
            ([0.31, 0.63, 0.13], [0.035, 0.21, 0.035]),
            ([0.0, 0.20, 0.47], [0.40, 0.03, 0.17]),
            ([0.0, 0.34, 0.33], [0.05, 0.33, 0.05]),
            ([0.0, 0.45, 0.22], [0.06, 0.05, 0.26]),
            ([0.0, 1.21, -0.27], [0.05, 0.08, 0.04]),
        ],
        [0.50, 0.50, 0.52],
        0.3,
    );
    let foot =
        turned(c, "foot", &[[0.0, -0.01], [0.30, -0.01], [0.30, 0.03], [0.10, 0.06], [0.0, 0.06]], 20, [0.50, 0.50, 0.52], 0.3);
    for (number, (z, turn)) in [(0.9, 108.0), (-0.7, 90.0), (-2.3, 84.0)].into_iter().enumerate() {
        let chair = c.group(&format!("chair {number}"), None, at(-1.05, 0.0, z).facing(-turn));
        for (name, prop) in [("leather", leather), ("chrome", chrome), ("foot", foot)] {
            c.put_on(Some(chair), &format!("chair {number}'s {name}"), prop, at(0.0, 0.0, 0.0));
        }
    }
}
