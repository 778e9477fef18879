#include "shared/frame.wgsl"
#include "shared/material.wgsl"
#include "shared/surface.wgsl"

// What the light that was added up is multiplied with (M section 8).
@fragment
fn texture(point: SurfacePoint) -> @location(0) vec4f {
    return vec4f(textureSample(base_color_texture, base_color_sampler, point.uv).rgb, 1.0);
}
