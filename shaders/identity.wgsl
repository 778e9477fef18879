#include "shared/frame.wgsl"
#include "shared/material.wgsl"
#include "shared/surface.wgsl"

struct IdentityPoint {
    @invariant @builtin(position) clip: vec4f,
    @location(0) world: vec3f,
    @location(1) uv: vec2f,
    @location(2) alpha: f32,
    @location(3) @interpolate(flat) color: vec3f,
}

// Odd, so that no two numbers below 2^24 have one colour.
const SPREAD: u32 = 0x9e3779b1u;

@vertex
fn identity_vertex(vertex: SurfaceVertex, @builtin(instance_index) object: u32) -> IdentityPoint {
    let surface = surface_point(vertex, object);
    let number = (object + 1u) * SPREAD;
    let color = vec3f(vec3u(number & 0xffu, (number >> 8u) & 0xffu, (number >> 16u) & 0xffu)) / 255.0;
    return IdentityPoint(surface.clip, surface.world, surface.uv, surface.color.a, color);
}

@fragment
fn identity(point: IdentityPoint) -> @location(0) vec4f {
    leave_out_behind_mirror(point.world);
    if point.alpha * base_color_texel(point.uv).a < material.cutoff {
        discard;
    }
    return vec4f(point.color, 1.0);
}
