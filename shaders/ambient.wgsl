#include "shared/frame.wgsl"
#include "shared/material.wgsl"
#include "shared/surface.wgsl"
#include "shared/tone.wgsl"
#include "shared/mirror.wgsl"

// Worked out at the vertices, as in lit.wgsl.
struct AmbientPoint {
    @invariant @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
    @location(1) ambient: vec4f,        // light thrown back, but for the texture: of the front; alpha
    @location(2) ambient_behind: vec3f, // and of the back
    @location(3) @interpolate(flat) emitted: vec3f,
    @location(4) @interpolate(flat) cutoff: f32,
    @location(5) world: vec3f,
    @location(6) normal: vec3f,
}

@vertex
fn ambient_vertex(vertex: SurfaceVertex, @builtin(instance_index) object: u32) -> AmbientPoint {
    let surface = surface_point(vertex, object);
    let base = surface.color.rgb;
    var point: AmbientPoint;
    point.clip = surface.clip;
    point.uv = surface.uv;
    point.ambient = vec4f(ambient_light(material, base, surface.normal.y) * exposure(), surface.color.a);
    point.ambient_behind = ambient_light(material, base, -surface.normal.y) * exposure();
    point.emitted = emitted_light(material) * exposure();
    point.cutoff = material.cutoff;
    point.world = surface.world;
    point.normal = surface.normal;
    return point;
}

@fragment
fn ambient(point: AmbientPoint, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    leave_out_behind_mirror(point.world);
    return ambient_color(point, base_color_texel(point.uv).rgb, front);
}

@fragment
fn ambient_masked(point: AmbientPoint, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    leave_out_behind_mirror(point.world);
    let texel = base_color_texel(point.uv);
    if texel.a * point.ambient.a < point.cutoff {
        discard;
    }
    return ambient_color(point, texel.rgb, front);
}

// Added to what the mirror reflects.
@fragment
fn own(point: AmbientPoint, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return vec4f(ambient_color(point, base_color_texel(point.uv).rgb, front).rgb, 0.0);
}

fn ambient_color(point: AmbientPoint, texel: vec3f, front: bool) -> vec4f {
    var light = texel * select(point.ambient_behind, point.ambient.rgb, front || !BOTH_SIDES) + point.emitted;
    if MIRROR != NO_MIRROR {
        let share = reflectance(point.normal, frame.eye - point.world);
        light = mix(light, draw.constant.rgb * (frame.scale * exposure()), share);
    }
    if FINISHED {
        return shown(light);
    }
    return vec4f(light, 1.0);
}
