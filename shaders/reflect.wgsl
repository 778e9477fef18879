#include "shared/frame.wgsl"
#include "shared/material.wgsl"
#include "shared/surface.wgsl"
#include "shared/mirror.wgsl"

// What the picture behind a mirror is multiplied with: how much of it the mirror reflects, in its own colour.
@fragment
fn reflected(point: SurfacePoint) -> @location(0) vec4f {
    return vec4f(draw.constant.rgb * reflectance(point.normal, frame.eye - point.world), 1.0);
}
