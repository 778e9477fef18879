#include "shared/frame.wgsl"
#include "shared/full_screen.wgsl"

// A layer of a solid into the scene's depth, where it lies on the side of the other operand that the step's
// constant says: 1 inside, 0 outside.
@group(1) @binding(0) var layer_depth: texture_depth_2d;
@group(1) @binding(1) var layer_stencil: texture_2d<u32>;
@group(1) @binding(0) var layer_depth_each: texture_depth_multisampled_2d;
@group(1) @binding(1) var layer_stencil_each: texture_multisampled_2d<u32>;

fn kept(depth: f32, stencil: u32) -> f32 {
    // Nothing was drawn where depth is at infinity.
    if depth == 0.0 || (stencil >> 7u) != u32(draw.constant.r) {
        discard;
    }
    return depth;
}

@fragment
fn solid_merge(@builtin(position) pixel: vec4f) -> @builtin(frag_depth) f32 {
    let at = vec2i(pixel.xy);
    return kept(textureLoad(layer_depth, at, 0), textureLoad(layer_stencil, at, 0).r);
}

@fragment
fn solid_merge_each(@builtin(position) pixel: vec4f, @builtin(sample_index) sample: u32) -> @builtin(frag_depth) f32 {
    let at = vec2i(pixel.xy);
    let each = i32(sample);
    return kept(textureLoad(layer_depth_each, at, each), textureLoad(layer_stencil_each, at, each).r);
}
