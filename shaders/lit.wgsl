#include "shared/frame.wgsl"
#include "shared/material.wgsl"
#include "shared/surface.wgsl"
#include "shared/light.wgsl"
#include "shared/tone.wgsl"
#include "shared/mirror.wgsl"

// What is the same all over a surface, or changes in proportion over a triangle, is worked out at the
// vertices: a software GPU pays for every instruction of every pixel, and one number read from a uniform
// buffer costs it two dozen.

override LIGHT_KIND: u32 = 0u;

struct LitPoint {
    @invariant @builtin(position) clip: vec4f,
    @location(0) normal: vec3f,
    @location(1) to_light: vec3f,
    @location(2) to_eye: vec3f,
    @location(3) sin_bound: f32,
    @location(4) uv: vec2f,
    @location(5) ambient: vec3f,        // light thrown back, but for the texture: of the front
    @location(6) ambient_behind: vec3f, // and of the back
    @location(7) tint: vec3f,           // the light's colour times the base colour, but for the texture
    @location(8) along: f32,            // see Reach
    @location(9) @interpolate(flat) emitted: vec3f,
    @location(10) @interpolate(flat) clear: vec3f,  // see Finish; in the light's colour
    @location(11) @interpolate(flat) finish: vec3f, // diffuse, metal, sharpness
    @location(12) @interpolate(flat) reach: vec2f,  // inverse range squared, rim
}

@vertex
fn lit_vertex(vertex: SurfaceVertex, @builtin(instance_index) object: u32) -> LitPoint {
    let surface = surface_point(vertex, object);
    let base = surface.color.rgb;
    // Unlit surfaces have their colour already.
    let intensity = draw.light.intensity * exposure() * (1.0 - material.unlit);
    let finish = finish_of(material);
    var point: LitPoint;
    point.clip = surface.clip;
    point.normal = surface.normal;
    point.to_light = way_to_light(draw.light, LIGHT_KIND, surface.world);
    point.to_eye = frame.eye - surface.world;
    point.sin_bound = surface.sin_bound;
    point.uv = surface.uv;
    point.ambient = ambient_light(material, base, surface.normal.y) * exposure();
    point.ambient_behind = ambient_light(material, base, -surface.normal.y) * exposure();
    point.tint = base * intensity;
    let reach = light_reach(draw.light, point.to_light);
    point.along = reach.along;
    point.emitted = emitted_light(material) * exposure();
    point.clear = intensity * finish.clear;
    point.finish = vec3f(finish.diffuse, finish.metal, finish.sharpness);
    point.reach = vec2f(reach.inverse_range_squared, reach.rim);
    return point;
}

@fragment
fn lit(point: LitPoint, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let texel = base_color_texel(point.uv).rgb;
    let normal = select(-point.normal, point.normal, front || !BOTH_SIDES);
    let reach = Reach(point.reach.x, point.along, point.reach.y);
    var share = vec3f(arriving(LIGHT_KIND, reach, point.sin_bound, normal, point.to_light));
    if LIGHT_KIND == PROJECTOR {
        share *= through_slide(draw.light, point.to_light, length(point.to_eye));
    }
    if MIRROR != NO_MIRROR {
        share *= 1.0 - reflectance(normal, point.to_eye);
    }
    let base = texel * point.tint;
    var light = base * point.finish.x;
    if GLOSSY {
        let lobe = highlight(point.finish.z, normal, point.to_light, point.to_eye);
        light = base * (point.finish.x + point.finish.y * lobe) + point.clear * lobe;
    }
    if FINISHED {
        let ambient = select(point.ambient_behind, point.ambient, front || !BOTH_SIDES);
        return shown(light * share + texel * ambient + point.emitted);
    }
    return vec4f(light * share, 0.0);
}
