#include "shared/frame.wgsl"
#include "shared/full_screen.wgsl"
#include "shared/tone.wgsl"

@group(1) @binding(0) var scene_color: texture_2d<f32>;
@group(1) @binding(1) var scene_stencil: texture_2d<u32>;
@group(1) @binding(2) var mean_before: texture_2d<f32>;

// The scene joins the mean of the frames before it, by the weight it has there.
@fragment
fn gather(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let scene = textureLoad(scene_color, vec2i(pixel.xy), 0);
    let before = textureLoad(mean_before, vec2i(pixel.xy), 0);
    // The first frame's weight is 1, and what is there before it is nobody's.
    return select(before + (scene - before) * draw.constant.x, scene, draw.constant.x == 1.0);
}

struct Backdrop {
    @builtin(position) clip: vec4f,
    @location(0) color: vec3f,      // the gradient behind everything
}

@vertex
fn backdrop_vertex(@builtin(vertex_index) index: u32) -> Backdrop {
    let clip = full_screen_corner(index);
    return Backdrop(clip, mix(frame.background_top, frame.background_bottom, 0.5 - clip.y * 0.5));
}

@fragment
fn tone_map(behind: Backdrop) -> @location(0) vec4f {
    let scene = textureLoad(scene_color, vec2i(behind.clip.xy), 0);
    // Where no surface is, or only blended ones, the gradient shows.
    return shown(scene.rgb * frame.exposure + behind.color * (1.0 - scene.a));
}

// The gradient as light, so that it comes out the same after exposure and tone curve: what lies behind all that a
// mirror reflects. At infinity.
@fragment
fn backdrop(behind: Backdrop) -> @location(0) vec4f {
    return vec4f(behind.color / frame.exposure, 1.0);
}

override BANDS: u32 = 1u;

// Of two triangles: right and down, 0 or 1.
const CORNERS = array<vec2f, 6>(
    vec2f(0.0, 0.0), vec2f(0.0, 1.0), vec2f(1.0, 0.0), vec2f(1.0, 0.0), vec2f(0.0, 1.0), vec2f(1.0, 1.0),
);

// The gradient in bands across the picture, finished at their corners: between them the tone curve and
// the encoding are as good as straight.
@vertex
fn band_vertex(@builtin(vertex_index) index: u32) -> Backdrop {
    let corner = CORNERS[index % 6u];
    let y = (f32(index / 6u) + corner.y) / f32(BANDS);
    let color = shown(mix(frame.background_top, frame.background_bottom, y)).rgb;
    return Backdrop(vec4f(corner.x * 2.0 - 1.0, 1.0 - y * 2.0, 0.0, 1.0), color);
}

@fragment
fn background(behind: Backdrop) -> @location(0) vec4f {
    return vec4f(behind.color, 1.0);
}

// Display values, 0 to 1 as the picture stores them, go through unchanged.
@fragment
fn copy(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    return vec4f(textureLoad(scene_color, vec2i(pixel.xy), 0).rgb, 1.0);
}

// 1 to 8, each told from its neighbours at a glance.
const COUNT_COLORS = array<vec3f, 8>(
    vec3f(0.20, 0.26, 0.75), vec3f(0.13, 0.60, 0.95), vec3f(0.06, 0.70, 0.58), vec3f(0.33, 0.76, 0.27),
    vec3f(0.74, 0.84, 0.20), vec3f(0.98, 0.80, 0.20), vec3f(0.96, 0.55, 0.20), vec3f(0.93, 0.42, 0.72),
);

// Counts in false colour: 0 is dark, 1 to 8 run from blue over green to orange and pink, 9 and more
// are white, and counts that wrapped below zero (128 to 255) are red, -1 the brightest.
fn count_color(count: u32) -> vec3f {
    if count == 0u {
        return vec3f(0.07, 0.08, 0.11);
    }
    if count >= 128u {
        return mix(vec3f(0.30, 0.0, 0.12), vec3f(1.0, 0.20, 0.18), pow(f32(max(count, 248u) - 248u) / 7.0, 3.0));
    }
    if count >= 9u {
        return vec3f(0.97, 0.97, 0.95);
    }
    return COUNT_COLORS[count - 1u];
}

// 3 x 5 glyphs, rows from the top, three bits a row: 0 to 9, plus, minus.
const GLYPHS = array<u32, 12>(
    0x7b6fu, 0x2c97u, 0x73e7u, 0x73cfu, 0x5bc9u, 0x79cfu, 0x79efu, 0x7249u, 0x7befu, 0x7bcfu, 0x05d0u, 0x01c0u,
);
const PLUS: u32 = 10u;
const MINUS: u32 = 11u;

fn glyph(which: u32, at: vec2i) -> bool {
    if any(at < vec2i(0)) || at.x > 2 || at.y > 4 {
        return false;
    }
    return ((GLYPHS[which] >> u32(14 - (at.y * 3 + at.x))) & 1u) == 1u;
}

const SWATCHES: i32 = 12; // 0 to 8, 9+, -2, -1

@fragment
fn stencil_colors(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    // The legend: a column of swatches at the bottom left, each with its count beside it.
    let unit = max(i32(frame.size.y) / 240, 1);
    let cell = 9 * unit;
    let origin = vec2i(6 * unit, i32(frame.size.y) - 6 * unit - SWATCHES * cell);
    let at = vec2i(pixel.xy) - origin;
    if all(at >= vec2i(-3 * unit)) && at.x < 30 * unit && at.y < SWATCHES * cell + 3 * unit {
        var color = vec3f(0.02, 0.022, 0.03);
        let row = at.y / cell;
        if at.y >= 0 && row < SWATCHES && at.x >= 0 {
            let inside = vec2i(at.x, at.y % cell);
            var count = u32(row);
            if row >= 10 {
                count = u32(254 + row - 10);
            }
            if inside.x < 12 * unit && inside.y < 7 * unit {
                color = count_color(count);
            } else {
                let text = (inside - vec2i(15 * unit, unit)) / unit;
                let first = select(count, MINUS, row >= 10);
                let second = select(PLUS, 256u - count, row >= 10);
                let has_second = row >= 9;
                let drawn = inside.y >= unit && inside.x >= 15 * unit
                    && (glyph(first, text) || (has_second && glyph(second, text - vec2i(4, 0))));
                if drawn {
                    color = vec3f(0.85);
                }
            }
        }
        return vec4f(color, 1.0);
    }
    // Where no surface is there is nothing to count.
    let scene = textureLoad(scene_color, vec2i(pixel.xy), 0);
    if scene.a == 0.0 {
        return vec4f(0.02, 0.022, 0.03, 1.0);
    }
    let stored = textureLoad(scene_stencil, vec2i(pixel.xy), 0).r;
    let dimmed = dot(scene.rgb * frame.exposure, vec3f(0.25, 0.5, 0.25)) * 0.5;
    // Beyond the light's depth bounds nothing is counted: hatched, where the plan has a bit for it.
    let beyond = u32(draw.constant.r);
    if (stored & beyond) != 0u {
        let stripe = ((i32(pixel.x) + i32(pixel.y)) / max(i32(frame.size.y) / 180, 1)) % 4 == 0;
        return vec4f(encoded(vec3f(dimmed) + select(vec3f(0.0), vec3f(0.05, 0.06, 0.09), stripe)), 1.0);
    }
    // Points of a light have a bit each: how many are set.
    let points = u32(draw.constant.g);
    let mirrors = u32(draw.constant.b);
    let count = select(stored & ~(beyond | mirrors), countOneBits(stored & points), points != 0u);
    if count > 0u {
        return vec4f(count_color(count), 1.0);
    }
    // Where the count is zero the scene shows through, dimly, so that one sees what is counted.
    return vec4f(encoded(decoded(count_color(0u)) + dimmed), 1.0);
}
