#include "shared/frame.wgsl"
#include "shared/material.wgsl"
#include "shared/surface.wgsl"
#include "shared/light.wgsl"

@fragment
fn transparent(point: SurfacePoint, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    leave_out_behind_mirror(point.world);
    let base = base_color(point);
    let normal = seen_normal(point, front);
    var color = ambient_light(material, base.rgb, normal.y) + emitted_light(material);
    // What is not seen needs none. (Not a branch on uniforms alone: shared/light.wgsl.)
    let light_count = select(0u, frame.light_count, (base.a > 0.0) & (material.unlit < 0.5));
    for (var i = 0u; i < light_count; i++) {
        color += light_on_surface(lights[i], base.rgb, point, normal);
    }
    return vec4f(color * base.a, base.a);
}

// Radiance towards the eye from one light.
fn light_on_surface(light: Light, base: vec3f, point: SurfacePoint, normal: vec3f) -> vec3f {
    let to_light = way_to_light(light, light.kind, point.world);
    let to_eye = frame.eye - point.world;
    let reach = light_reach(light, to_light);
    var share = light.intensity * arriving(light.kind, reach, point.sin_bound, normal, to_light);
    if light.kind == PROJECTOR {
        share *= through_slide(light, to_light, length(to_eye));
    }
    let finish = finish_of(material);
    let lobe = highlight(finish.sharpness, normal, to_light, to_eye);
    return share * (base * (finish.diffuse + finish.metal * lobe) + finish.clear * lobe);
}
