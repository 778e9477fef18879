#include "shared/frame.wgsl"
#include "shared/surface.wgsl"

@fragment
fn ambient(point: SurfacePoint, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return vec4f(ambient_light(base_color(point).rgb, seen_normal(point, front).y), 1.0);
}

@fragment
fn ambient_masked(point: SurfacePoint, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let base = base_color(point);
    if base.a < material.cutoff {
        discard;
    }
    return vec4f(ambient_light(base.rgb, seen_normal(point, front).y), 1.0);
}
