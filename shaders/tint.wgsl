#include "shared/frame.wgsl"
#include "shared/material.wgsl"
#include "shared/surface.wgsl"

// Towards a lamp that stands nowhere in the scene: faces of one colour are told apart by their slope.
const KEY = vec3f(0.31, 0.86, 0.405);

// The step's display colour, premultiplied.
fn shaded(point: SurfacePoint, front: bool) -> vec4f {
    let slope = dot(normalize(seen_normal(point, front)), KEY);
    return vec4f(draw.constant.rgb * (0.74 + 0.26 * slope) * draw.constant.a, draw.constant.a);
}

@fragment
fn tint(point: SurfacePoint, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    leave_out_behind_mirror(point.world);
    return shaded(point, front);
}

@fragment
fn tint_masked(point: SurfacePoint, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    leave_out_behind_mirror(point.world);
    if base_color(point).a < material.cutoff {
        discard;
    }
    return shaded(point, front);
}
