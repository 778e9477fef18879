#include "shared/frame.wgsl"
#include "shared/material.wgsl"
#include "shared/surface.wgsl"
#include "shared/mirror.wgsl"

@group(2) @binding(0) var reflection: texture_2d<f32>;
@group(2) @binding(1) var reflection_sampler: sampler;

// The texture holds the whole picture as the reflected eye sees it: a pixel of the mirror finds its own there.
@fragment
fn mirrored(point: SurfacePoint) -> @location(0) vec4f {
    leave_out_behind_mirror(point.world);
    let seen = textureSample(reflection, reflection_sampler, point.clip.xy / frame.size).rgb;
    return vec4f(seen * draw.constant.rgb * reflectance(point.normal, frame.eye - point.world), 1.0);
}
