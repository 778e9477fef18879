#include "shared/frame.wgsl"
#include "shared/volume.wgsl"
#include "shared/full_screen.wgsl"

// Counting by addition, in a target of one float a sample. Only fragments behind the surface arrive
// (the depth test has seen to it): z-fail.
@fragment
fn volume_numbers(@builtin(front_facing) front: bool) -> @location(0) vec4f {
    return vec4f(select(draw.constant.r, -draw.constant.r, front), 0.0, 0.0, 0.0);
}

@group(1) @binding(0) var counts: texture_2d<f32>;
@group(1) @binding(0) var counts_each: texture_multisampled_2d<f32>;

// The stencil is written where the fragment stays.
@fragment
fn wide_verdict(@builtin(position) pixel: vec4f) {
    if textureLoad(counts, vec2i(pixel.xy), 0).r == 0.0 {
        discard;
    }
}

@fragment
fn wide_verdict_each(@builtin(position) pixel: vec4f, @builtin(sample_index) sample: u32) {
    if textureLoad(counts_each, vec2i(pixel.xy), i32(sample)).r == 0.0 {
        discard;
    }
}

// One bit of the count, which is not shown beyond the constant's green.
@fragment
fn wide_bit(@builtin(position) pixel: vec4f) {
    let count = clamp(textureLoad(counts, vec2i(pixel.xy), 0).r, 0.0, draw.constant.g);
    if ((u32(count) >> u32(draw.constant.r)) & 1u) == 0u {
        discard;
    }
}

// What a field of as many values as the constant's red would make of the count: blue, lighter with
// the count, where it holds it; amber where it wraps and still is not zero; red where it wraps to
// zero, and shadow is taken for light. Where nothing is counted the picture is only dimmed.
@fragment
fn wide_overflow(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let count = textureLoad(counts, vec2i(pixel.xy), 0).r;
    let field = draw.constant.r;
    if count == 0.0 {
        return vec4f(0.0, 0.0, 0.0, 0.5);
    }
    if count < field {
        return vec4f(mix(vec3f(0.10, 0.16, 0.36), vec3f(0.42, 0.62, 0.90), count / field), 1.0);
    }
    let wrapped = count - field * floor(count / field);
    return select(vec4f(1.0, 0.0, 0.0, 1.0), vec4f(0.85, 0.60, 0.10, 1.0), wrapped != 0.0);
}
