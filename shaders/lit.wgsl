#include "shared/frame.wgsl"
#include "shared/surface.wgsl"

@fragment
fn lit(point: SurfacePoint, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let base = base_color(point).rgb;
    let added = light_on_surface(lights[draw.light], base, point, seen_normal(point, front));
    return vec4f(select(added, vec3f(0.0), material.unlit > 0.5), 0.0);
}
