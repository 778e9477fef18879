//! Pictures made by arithmetic: marble, cobbles, planks, plaster. All repeat.

use glam::DVec2;

use super::math::{clouds, hash, noise, smoothstep};

/// sRGB, 0..1.
type Rgb = [f64; 3];

fn mix(a: Rgb, b: Rgb, t: f64) -> Rgb {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t)
}

fn scale(a: Rgb, t: f64) -> Rgb {
    a.map(|c| c * t)
}

/// A square PNG of 6 bits a channel (what the eye sees, at half the bytes), `f` given 0..1 twice.
fn png(size: u32, f: impl Fn(DVec2) -> Rgb) -> Vec<u8> {
    let mut pixels = Vec::new();
    for y in 0..size {
        for x in 0..size {
            let p = (DVec2::new(f64::from(x), f64::from(y)) + 0.5) / f64::from(size);
            pixels.extend(f(p).map(|c| ((c.clamp(0.0, 1.0) * 63.0).round() * (255.0 / 63.0)).round() as u8));
        }
    }
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size, size);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    // Writing to memory fails only on a size of zero.
    if let Ok(mut writer) = encoder.write_header() {
        let _ = writer.write_image_data(&pixels);
    }
    bytes
}

/// Veins: bright where noise bent by noise passes through its middle.
fn veins(p: DVec2, period: i64, seed: u64) -> f64 {
    let bend = DVec2::new(clouds(p, period, seed), clouds(p, period, seed + 50)) * 1.6;
    let v = (clouds(p + bend, period, seed + 90) - 0.5).abs();
    1.0 - smoothstep(0.0, 0.07, v)
}

/// Two by two slabs of pale and grey marble with dark joints.
pub fn marble() -> Vec<u8> {
    png(512, |p| {
        let cell = (p * 2.0).floor();
        let local = (p * 2.0 - cell - 0.5).abs();
        let (x, y) = (cell.x as i64, cell.y as i64);
        let dark = (x + y) % 2 == 0;
        let seed = 7 + (x * 2 + y) as u64 * 400;
        let tone = clouds(p * 4.0, 4, seed);
        let vein = veins(p * 4.0, 4, seed + 11);
        let stone = if dark {
            mix(mix([0.36, 0.37, 0.40], [0.46, 0.46, 0.48], tone), [0.66, 0.66, 0.66], vein * 0.55)
        } else {
            mix(mix([0.80, 0.77, 0.72], [0.90, 0.87, 0.82], tone), [0.58, 0.55, 0.52], vein * 0.6)
        };
        let joint = smoothstep(0.488, 0.496, local.x.max(local.y));
        mix(stone, [0.22, 0.21, 0.20], joint * 0.85)
    })
}

/// Rounded stones in a wandering pattern: the nearest of jittered points, and the gap to the next.
pub fn cobbles() -> Vec<u8> {
    const ACROSS: i64 = 9;
    png(512, |p| {
        let q = p * ACROSS as f64;
        let cell = q.floor();
        let (mut nearest, mut second, mut which) = (9.0_f64, 9.0_f64, (0, 0));
        for dy in -2..=2 {
            for dx in -2..=2 {
                let (x, y) = (cell.x as i64 + dx, cell.y as i64 + dy);
                let (wx, wy) = (x.rem_euclid(ACROSS), y.rem_euclid(ACROSS));
                let shift = if wy % 2 == 0 { 0.25 } else { -0.25 };
                let jitter = DVec2::new(hash(wx, wy, 1), hash(wx, wy, 2)) * 0.5 + 0.25;
                let d = q.distance(DVec2::new(x as f64 + shift, y as f64) + jitter);
                if d < nearest {
                    (second, nearest, which) = (nearest, d, (wx, wy));
                } else if d < second {
                    second = d;
                }
            }
        }
        let gap = smoothstep(0.05, 0.20, second - nearest);
        let tint = hash(which.0, which.1, 3);
        let stone = mix([0.50, 0.46, 0.42], [0.64, 0.60, 0.55], tint);
        let warm = mix(stone, [0.60, 0.50, 0.42], hash(which.0, which.1, 4) * 0.5);
        let grain = 0.90 + 0.2 * clouds(p * 24.0, 24, 5);
        let dome = 0.86 + 0.14 * (1.0 - smoothstep(0.1, 0.75, nearest));
        mix([0.27, 0.25, 0.23], scale(warm, grain * dome), gap)
    })
}

/// Floor boards along v, ends staggered.
pub fn planks() -> Vec<u8> {
    const BOARDS: i64 = 6;
    png(512, |p| {
        let across = p.x * BOARDS as f64;
        let board = across.floor() as i64;
        let start = hash(board, 0, 20);
        let along = p.y * 2.0 + start;
        let piece = along.floor() as i64 % 2;
        let seed = 30 + (board * 2 + piece) as u64 * 10;
        let tint = hash(board, piece, 21);
        let wood = mix([0.47, 0.36, 0.26], [0.62, 0.49, 0.36], tint);
        let grain = clouds(DVec2::new(p.x * 48.0, p.y * 4.0 + tint), 48, seed);
        let ring = noise(DVec2::new(p.x * 96.0, p.y * 6.0), 96, seed + 5);
        let shade = 0.78 + 0.3 * grain + 0.08 * ring;
        let seam = (across - across.floor() - 0.5).abs();
        let end = (along - along.floor() - 0.5).abs();
        let joint = smoothstep(0.478, 0.492, seam).max(smoothstep(0.4965, 0.4985, end));
        mix(scale(wood, shade), [0.16, 0.10, 0.06], joint * 0.9)
    })
}

/// Large pale slabs with fine joints, for floors that show shadows well.
pub fn paving() -> Vec<u8> {
    png(512, |p| {
        let row = (p.y * 3.0).floor() as i64;
        let u = p.x * 2.0 + [0.0, 0.5, 0.25][row.rem_euclid(3) as usize];
        let column = (u.floor() as i64).rem_euclid(2);
        let tint = hash(column, row, 70);
        let stone = mix([0.70, 0.66, 0.60], [0.79, 0.75, 0.68], tint);
        let tone = 0.90 + 0.14 * clouds(p * 6.0, 6, 71) + 0.05 * (noise(p * 96.0, 96, 76) - 0.5);
        let (x, y) = ((u - u.floor() - 0.5).abs(), (p.y * 3.0 - row as f64 - 0.5).abs());
        let joint = smoothstep(0.4925, 0.4965, x).max(smoothstep(0.489, 0.494, y));
        mix(scale(stone, tone), [0.36, 0.33, 0.30], joint * 0.8)
    })
}

/// Dressed stone in courses, for walls.
pub fn ashlar() -> Vec<u8> {
    const ROWS: i64 = 4;
    png(512, |p| {
        let v = p.y * ROWS as f64;
        let row = v.floor() as i64;
        let u = p.x * 2.0 + if row % 2 == 0 { 0.0 } else { 0.5 };
        let column = (u.floor() as i64).rem_euclid(2);
        let tint = hash(column, row, 60);
        let stone = mix([0.80, 0.72, 0.60], [0.88, 0.81, 0.70], tint);
        let tone = 0.86 + 0.2 * clouds(p * 8.0, 8, 61) + 0.06 * (noise(p * 128.0, 128, 63) - 0.5);
        let (x, y) = ((u - u.floor() - 0.5).abs(), (v - v.floor() - 0.5).abs());
        let joint = smoothstep(0.490, 0.496, x).max(smoothstep(0.478, 0.490, y));
        mix(scale(stone, tone), [0.56, 0.49, 0.40], joint * 0.7)
    })
}

/// Large rough blocks of sandstone, no two alike, joints fine; half the resolution of [`ashlar`].
pub fn sandstone() -> Vec<u8> {
    const ROWS: i64 = 4;
    png(256, |p| {
        let v = p.y * ROWS as f64;
        let row = v.floor() as i64;
        let u = p.x * 2.0 + [0.0, 0.55, 0.2, 0.7][row.rem_euclid(ROWS) as usize];
        let column = (u.floor() as i64).rem_euclid(2);
        let stone = mix([0.74, 0.65, 0.53], [0.86, 0.78, 0.65], hash(column, row, 100));
        let tone = 0.84 + 0.22 * clouds(p * 6.0, 6, 101) + 0.08 * (noise(p * 64.0, 64, 105) - 0.5);
        let (x, y) = ((u - u.floor() - 0.5).abs(), (v - v.floor() - 0.5).abs());
        let joint = smoothstep(0.485, 0.494, x).max(smoothstep(0.470, 0.486, y));
        mix(scale(stone, tone), [0.46, 0.39, 0.31], joint * 0.75)
    })
}

/// A floor of cut stones: porphyry discs in pale rings, tied by bands, green squares between them.
pub fn mosaic() -> Vec<u8> {
    png(512, |p| {
        let (cream, porphyry, serpentine, gold) =
            ([0.86, 0.80, 0.69], [0.46, 0.17, 0.14], [0.16, 0.29, 0.24], [0.74, 0.56, 0.30]);
        let q = (p - 0.5).abs(); // the tile is the same in all quarters; its disc is in the middle
        let r = q.length();
        let corner = (DVec2::splat(0.5) - q).length();
        let diamond = q.x + q.y;
        // Soft edges a pixel wide: 1 inside.
        let below = |x: f64, edge: f64| 1.0 - smoothstep(edge - 0.003, edge + 0.003, x);
        let chips = |t: f64, n: f64| below((t * n - (t * n).floor() - 0.5).abs(), 0.25);
        let mut color = mix(cream, scale(cream, 0.90), below((q.x - q.y).abs(), 0.10));
        color = mix(color, serpentine, below(corner, 0.20));
        color = mix(color, gold, below(corner, 0.150));
        color = mix(color, porphyry, below(corner, 0.125));
        color = mix(color, cream, below(corner, 0.045));
        color = mix(color, [0.80, 0.73, 0.61], below(diamond, 0.44));
        let ring = mix(serpentine, gold, chips((q.y.max(1e-9) / (q.x + q.y).max(1e-9)) * 0.999, 5.0));
        color = mix(color, cream, below(r, 0.335));
        color = mix(color, ring, below(r, 0.320));
        color = mix(color, cream, below(r, 0.262));
        color = mix(color, porphyry, below(r, 0.247));
        color = mix(color, scale(porphyry, 1.25), below((r - 0.12).abs(), 0.012));
        let band = below(0.5 - q.x.max(q.y), 0.014);
        color = mix(color, [0.40, 0.36, 0.31], band);
        let tone = 0.88 + 0.18 * clouds(p * 8.0, 8, 120) + 0.06 * (noise(p * 96.0, 96, 125) - 0.5);
        let vein = veins(p * 4.0, 4, 130);
        mix(scale(color, tone), [0.85, 0.80, 0.74], vein * 0.14)
    })
}

/// Worn lime plaster, a grey that a base colour tints.
pub fn plaster() -> Vec<u8> {
    png(256, |p| {
        let broad = clouds(p * 4.0, 4, 80);
        let fine = clouds(p * 32.0, 32, 84);
        let tone = 0.80 + 0.18 * smoothstep(0.25, 0.75, broad) - 0.10 * smoothstep(0.55, 0.8, fine);
        [tone, tone * 0.99, tone * 0.975]
    })
}
