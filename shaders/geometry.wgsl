#include "shared/frame.wgsl"
#include "shared/material.wgsl"
#include "shared/surface.wgsl"

// What light needs to know of the surface that a pixel shows (Saito and Takahashi 1990): kept, so that lights come
// without the triangles. As few numbers a vertex as may be: where triangles are many, each costs.

struct GeometryPoint {
    @invariant @builtin(position) clip: vec4f,
    @location(0) normal: vec4f,     // and the sine of the terminator bound
    @location(1) base: vec4f,       // base colour but for the texture, with alpha
    @location(2) uv: vec2f,
}

@vertex
fn geometry_vertex(vertex: SurfaceVertex, @builtin(instance_index) object: u32) -> GeometryPoint {
    let surface = surface_point(vertex, object);
    return GeometryPoint(surface.clip, vec4f(surface.normal, surface.sin_bound), surface.color, surface.uv);
}

@fragment
fn geometry(point: GeometryPoint, @builtin(front_facing) front: bool) -> @location(0) vec4u {
    return kept(point, base_color_texel(point.uv).rgb, front);
}

@fragment
fn geometry_masked(point: GeometryPoint, @builtin(front_facing) front: bool) -> @location(0) vec4u {
    let texel = base_color_texel(point.uv);
    if texel.a * point.base.a < material.cutoff {
        discard;
    }
    return kept(point, texel.rgb, front);
}

fn kept(point: GeometryPoint, texel: vec3f, front: bool) -> vec4u {
    let normal = point.normal.xyz * select(-1.0, 1.0, front || !BOTH_SIDES);
    let base = texel * point.base.rgb;
    // A bound near 1 is what light is divided by: half floats tell small numbers apart.
    return vec4u(
        pack2x16float(normal.xy), pack2x16float(vec2f(normal.z, 1.0 - point.normal.w)),
        pack2x16float(base.rg), pack2x16float(vec2f(base.b, material.number)),
    );
}
