#include "shared/frame.wgsl"
#include "shared/material.wgsl"
#include "shared/surface.wgsl"

// How much nearer a halo is drawn than it is, in its own widths.
const NEARER: f32 = 3.0;

struct HaloPoint {
    @builtin(position) clip: vec4f,
    @location(0) world: vec3f,
}

// Every vertex moved outwards on screen by `draw.swell` pixels.
@vertex
fn halo_vertex(
    @location(0) position: vec3f,
    @location(1) outward: vec3f,
    @builtin(instance_index) object: u32,
) -> HaloPoint {
    let at = vec4f(position, 1.0);
    var clip = clip_position(object, at);
    let way = (objects[object].normal_from_object * vec4f(outward, 0.0)).xyz;
    let ahead = frame.clip_from_world * vec4f(way / max(length(way), 1e-12), 0.0);
    // Pixels a metre, times the distance squared.
    let across = (ahead.xy * clip.w - clip.xy * ahead.w) * frame.size * 0.5;
    let speed = length(across);
    // 1 where the way out lies in the picture's plane, 0 where it leads towards the eye: there it says little.
    let aside = speed * frame.pixel / max(clip.w, 1e-12);
    if clip.w > 0.0 && speed > 0.0 {
        let pixels = across / speed * draw.swell * min(1.0, 3.0 * aside);
        clip = vec4f(clip.xy + pixels / frame.size * 2.0 * clip.w, clip.zw);
        let forward = min(NEARER * draw.swell * frame.pixel, 0.5);
        clip.z = min(clip.z / (1.0 - forward), clip.w);
    }
    return HaloPoint(clip, (objects[object].world_from_object * at).xyz);
}

@fragment
fn halo(point: HaloPoint) -> @location(0) vec4f {
    leave_out_behind_mirror(point.world);
    return draw.constant;
}
