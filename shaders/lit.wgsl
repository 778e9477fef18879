#include "shared/frame.wgsl"
#include "shared/surface.wgsl"
#include "shared/tone.wgsl"

override LIGHT_KIND: u32 = 0u;
override FINISHED: bool = false;

@fragment
fn lit(point: SurfacePoint, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let base = base_color(point).rgb;
    let normal = seen_normal(point, front);
    let light = light_on_surface(draw.light, LIGHT_KIND, base, point, normal);
    let added = select(light, vec3f(0.0), material.unlit > 0.5);
    if FINISHED {
        return vec4f(tone_curve((ambient_light(base, normal.y) + added) * frame.exposure), 1.0);
    }
    return vec4f(added, 0.0);
}
