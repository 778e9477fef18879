#include "shared/frame.wgsl"
#include "shared/material.wgsl"
#include "shared/surface.wgsl"

struct DepthPoint {
    @invariant @builtin(position) clip: vec4f,
}

@vertex
fn depth_vertex(@location(0) position: vec3f, @builtin(instance_index) object: u32) -> DepthPoint {
    return DepthPoint(clip_position(object, vec4f(position, 1.0)));
}

// Depth is all that is written.
@fragment
fn depth() {
}

@fragment
fn depth_masked(point: SurfacePoint) {
    leave_out_behind_mirror(point.world);
    if base_color(point).a < material.cutoff {
        discard;
    }
}
