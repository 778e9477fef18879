#include "shared/frame.wgsl"
#include "shared/surface.wgsl"

override LIGHT_KIND: u32 = 0u;

@fragment
fn lit(point: SurfacePoint, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let base = base_color(point).rgb;
    let added = light_on_surface(draw.light, LIGHT_KIND, base, point, seen_normal(point, front));
    return vec4f(select(added, vec3f(0.0), material.unlit > 0.5), 0.0);
}
