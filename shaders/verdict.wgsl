#include "shared/frame.wgsl"
#include "shared/material.wgsl"
#include "shared/surface.wgsl"

// One light's verdict: the step's constant, within the light's range. The stencil test has decided
// already whether this step is the white or the black one.
@fragment
fn verdict(point: SurfacePoint) -> @location(0) vec4f {
    let offset = draw.light.position - point.world;
    // Not a branch on uniforms alone: shared/light.wgsl.
    if (draw.light.kind != DIRECTIONAL) & (dot(offset, offset) * draw.light.inverse_range_squared > 1.0) {
        discard;
    }
    return draw.constant;
}
