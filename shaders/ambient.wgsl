#include "shared/frame.wgsl"
#include "shared/surface.wgsl"
#include "shared/tone.wgsl"

// Worked out at the vertices, as in lit.wgsl.
struct AmbientPoint {
    @invariant @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
    @location(1) ambient: vec4f,        // light thrown back, but for the texture: of the front; alpha
    @location(2) ambient_behind: vec3f, // and of the back
    @location(3) @interpolate(flat) emitted: vec3f,
    @location(4) @interpolate(flat) cutoff: f32,
}

@vertex
fn ambient_vertex(vertex: SurfaceVertex, @builtin(instance_index) object: u32) -> AmbientPoint {
    let surface = surface_point(vertex, object);
    let base = surface.color.rgb;
    var point: AmbientPoint;
    point.clip = surface.clip;
    point.uv = surface.uv;
    point.ambient = vec4f(ambient_light(base, surface.normal.y) * exposure(), surface.color.a);
    point.ambient_behind = ambient_light(base, -surface.normal.y) * exposure();
    point.emitted = emitted_light() * exposure();
    point.cutoff = material.cutoff;
    return point;
}

@fragment
fn ambient(point: AmbientPoint, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return ambient_color(point, base_color_texel(point.uv).rgb, front);
}

@fragment
fn ambient_masked(point: AmbientPoint, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let texel = base_color_texel(point.uv);
    if texel.a * point.ambient.a < point.cutoff {
        discard;
    }
    return ambient_color(point, texel.rgb, front);
}

fn ambient_color(point: AmbientPoint, texel: vec3f, front: bool) -> vec4f {
    let light = texel * select(point.ambient_behind, point.ambient.rgb, front || !BOTH_SIDES) + point.emitted;
    if FINISHED {
        return shown(light);
    }
    return vec4f(light, 1.0);
}
