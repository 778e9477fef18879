#include "shared/frame.wgsl"
#include "shared/full_screen.wgsl"

@group(1) @binding(1) var scene_stencil: texture_2d<u32>;

// Values in false colour: neighbours lie a golden section apart on the circle of hues, so that no two near each other
// look alike; 0 is nearly black, 255 nearly white.
fn value_color(value: u32) -> vec3f {
    if value == 0u {
        return vec3f(0.065, 0.072, 0.095);
    }
    if value == 255u {
        return vec3f(0.9, 0.91, 0.94);
    }
    let hue = fract(f32(value) * 0.618034 + 0.93);
    let ramp = clamp(abs(fract(hue + vec3f(0.0, 2.0 / 3.0, 1.0 / 3.0)) * 6.0 - 3.0) - 1.0, vec3f(0.0), vec3f(1.0));
    return mix(vec3f(0.93), ramp, 0.62) * 0.86;
}

// Digits as seven strokes: top, upper right, lower right, bottom, lower left, upper left, middle.
const STROKES = array<u32, 10>(0x3fu, 0x06u, 0x5bu, 0x4fu, 0x66u, 0x6du, 0x7du, 0x07u, 0x7fu, 0x6fu);
const ENDS = array<vec4f, 7>(
    vec4f(-0.23, -0.5, 0.23, -0.5), vec4f(0.23, -0.5, 0.23, 0.0), vec4f(0.23, 0.0, 0.23, 0.5), vec4f(-0.23, 0.5, 0.23, 0.5),
    vec4f(-0.23, 0.0, -0.23, 0.5), vec4f(-0.23, -0.5, -0.23, 0.0), vec4f(-0.23, 0.0, 0.23, 0.0),
);
const HALF_STROKE: f32 = 0.075;

// From the middle of the nearest stroke of a digit of height 1 about the origin; 0 is a ring.
fn distance_to(digit: u32, at: vec2f) -> f32 {
    if digit == 0u {
        return abs(length(at * vec2f(1.9, 1.0)) - 0.49) * 0.62;
    }
    var nearest = 9.0;
    for (var stroke = 0u; stroke < 7u; stroke++) {
        if ((STROKES[digit] >> stroke) & 1u) == 1u {
            let ends = ENDS[stroke];
            let along = ends.zw - ends.xy;
            let share = clamp(dot(at - ends.xy, along) / dot(along, along), 0.0, 1.0);
            nearest = min(nearest, distance(at, ends.xy + along * share));
        }
    }
    return nearest;
}

// How much of a pixel the number about the origin covers; `height` in pixels.
fn number(value: u32, at: vec2f, height: f32) -> f32 {
    let digits = select(select(1u, 2u, value > 9u), 3u, value > 99u);
    let width = 0.72;
    var nearest = 9.0;
    var rest = value;
    for (var place = 0u; place < digits; place++) {
        let middle = (f32(digits - 1u) * 0.5 - f32(place)) * width;
        nearest = min(nearest, distance_to(rest % 10u, at / height - vec2f(middle, 0.0)));
        rest /= 10u;
    }
    return clamp((HALF_STROKE - nearest) * height + 0.5, 0.0, 1.0);
}

// The stencil's values as colours, and in a grid as numbers: each is the value of the pixel in the middle of its cell.
@fragment
fn playground(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let stored = textureLoad(scene_stencil, vec2i(pixel.xy), 0).r;
    var color = value_color(stored);
    let cell = draw.constant.x;
    if cell > 0.0 {
        let corner = floor(pixel.xy / cell) * cell;
        let inside = pixel.xy - corner;
        if min(inside.x, inside.y) < 1.0 {
            color = mix(color, vec3f(1.0), 0.07);
        }
        let last = vec2i(frame.size) - vec2i(1);
        let value = textureLoad(scene_stencil, min(vec2i(corner + cell * 0.5), last), 0).r;
        let covered = number(value, inside - cell * 0.5, cell * 0.34);
        let bright = dot(color, vec3f(0.3, 0.59, 0.11)) > 0.42;
        let ink = select(vec3f(1.0), vec3f(0.03), bright);
        color = mix(color, ink, covered * select(0.92, 0.4, value == 0u));
    }
    return vec4f(color, 1.0);
}
