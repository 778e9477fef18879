#include "shared/frame.wgsl"
#include "shared/surface.wgsl"

@fragment
fn transparent(point: SurfacePoint, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let base = base_color(point);
    let normal = seen_normal(point, front);
    var color = ambient_light(base.rgb, normal.y);
    if material.unlit < 0.5 {
        for (var i = 0u; i < frame.light_count; i++) {
            color += light_on_surface(lights[i], lights[i].kind, base.rgb, point, normal);
        }
    }
    return vec4f(color * base.a, base.a);
}
