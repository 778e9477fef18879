// Surfaces: their vertices, their material, and light on them.
//
// The overrides are set for each step from the plan, so that a pixel pays only for what its material
// and its light have.

override TEXTURED: bool = true;
override BOTH_SIDES: bool = true;
// Reaches under the plane of the mirror it is seen in: what lies there is no reflection.
override CLIPPED: bool = false;

@group(1) @binding(0) var<uniform> material: Material;
@group(1) @binding(1) var base_color_texture: texture_2d<f32>;
@group(1) @binding(2) var base_color_sampler: sampler;

struct SurfaceVertex {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) uv: vec2f,
    @location(3) color: vec4f,
    @location(4) sin_bound: f32,    // sine of the terminator bound
}

struct SurfacePoint {
    @invariant @builtin(position) clip: vec4f,
    @location(0) world: vec3f,
    @location(1) normal: vec3f,
    @location(2) uv: vec2f,
    @location(3) color: vec4f,      // base colour but for the texture
    @location(4) sin_bound: f32,
}

@vertex
fn surface_vertex(vertex: SurfaceVertex, @builtin(instance_index) object: u32) -> SurfacePoint {
    return surface_point(vertex, object);
}

fn surface_point(vertex: SurfaceVertex, object: u32) -> SurfacePoint {
    var point: SurfacePoint;
    point.clip = clip_position(object, vec4f(vertex.position, 1.0));
    point.world = (objects[object].world_from_object * vec4f(vertex.position, 1.0)).xyz;
    point.normal = normalize((objects[object].normal_from_object * vec4f(vertex.normal, 0.0)).xyz);
    point.uv = vertex.uv;
    point.color = material.base_color * vertex.color;
    point.sin_bound = select(0.0, vertex.sin_bound, frame.smooth_terminator > 0.5);
    return point;
}

// Left out in the fragment, not by clipping the triangle: a triangle that was cut has other depths in its last
// bits, and its light cap, which is never cut, would lie before it.
fn leave_out_behind_mirror(world: vec3f) {
    if CLIPPED && dot(frame.clip_plane, vec4f(world, 1.0)) < 0.0 {
        discard;
    }
}

// White where there is no texture.
fn base_color_texel(uv: vec2f) -> vec4f {
    if TEXTURED {
        return textureSample(base_color_texture, base_color_sampler, uv);
    }
    return vec4f(1.0);
}

fn base_color(point: SurfacePoint) -> vec4f {
    return point.color * base_color_texel(point.uv);
}

// Towards the side that is seen; not unit.
fn seen_normal(point: SurfacePoint, front: bool) -> vec3f {
    if BOTH_SIDES {
        return select(-point.normal, point.normal, front);
    }
    return point.normal;
}
