#include "shared/frame.wgsl"
#include "shared/surface.wgsl"
#include "shared/tone.wgsl"

override FINISHED: bool = false;

@fragment
fn ambient(point: SurfacePoint, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return shown(ambient_light(base_color(point).rgb, seen_normal(point, front).y));
}

@fragment
fn ambient_masked(point: SurfacePoint, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let base = base_color(point);
    if base.a < material.cutoff {
        discard;
    }
    return shown(ambient_light(base.rgb, seen_normal(point, front).y));
}

fn shown(color: vec3f) -> vec4f {
    if FINISHED {
        return vec4f(tone_curve(color * frame.exposure), 1.0);
    }
    return vec4f(color, 1.0);
}
