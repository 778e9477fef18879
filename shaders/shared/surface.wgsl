// Surfaces: their vertices, their material, and light on them.

struct Material {
    base_color: vec4f,          // linear, with alpha
    emissive: vec3f,            // linear radiance
    roughness: f32,
    metallic: f32,
    cutoff: f32,                // masked materials: below this alpha there is no surface
    unlit: f32,                 // 1: shown in its base colour
    _pad0: f32,
}

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
    @location(3) color: vec4f,
    @location(4) sin_bound: f32,
}

@vertex
fn surface_vertex(vertex: SurfaceVertex, @builtin(instance_index) object: u32) -> SurfacePoint {
    var point: SurfacePoint;
    point.clip = clip_position(object, vec4f(vertex.position, 1.0));
    point.world = (objects[object].world_from_object * vec4f(vertex.position, 1.0)).xyz;
    point.normal = (objects[object].normal_from_object * vec4f(vertex.normal, 0.0)).xyz;
    point.uv = vertex.uv;
    point.color = vertex.color;
    point.sin_bound = vertex.sin_bound;
    return point;
}

fn base_color(point: SurfacePoint) -> vec4f {
    return material.base_color * point.color * textureSample(base_color_texture, base_color_sampler, point.uv);
}

// The side that is seen.
fn seen_normal(point: SurfacePoint, front: bool) -> vec3f {
    return normalize(select(-point.normal, point.normal, front));
}

fn ambient_light(base: vec3f, normal: vec3f) -> vec3f {
    let ambient = mix(frame.ambient_ground, frame.ambient_sky, normal.y * 0.5 + 0.5);
    return select(base * ambient, base, material.unlit > 0.5) + material.emissive;
}

const PI: f32 = 3.14159265;

// Radiance towards the eye from one light, before shadows.
fn light_on_surface(light: Light, base: vec3f, point: SurfacePoint, normal: vec3f) -> vec3f {
    var to_light = -light.direction;
    var falloff = 1.0;
    if light.kind != DIRECTIONAL {
        let offset = light.position - point.world;
        let distance_squared = max(dot(offset, offset), 1e-6);
        to_light = offset * inverseSqrt(distance_squared);
        // Inverse square, brought to zero at the range (as glTF's KHR_lights_punctual suggests).
        let fraction = distance_squared * light.inverse_range_squared;
        let window = saturate(1.0 - fraction * fraction);
        falloff = window * window / distance_squared;
        if light.kind == SPOT {
            let cone = saturate((dot(-to_light, light.direction) - light.cos_outer) * light.inverse_cone_width);
            falloff *= cone * cone;
        }
    }
    // The terminator bound: zero before any neighbouring facet turns away from the light.
    let bound = select(0.0, point.sin_bound, frame.smooth_terminator > 0.5);
    let facing = max((dot(normal, to_light) - bound) / (1.0 - bound), 0.0);

    // Blinn-Phong, normalised, from the glTF roughness.
    let to_eye = normalize(frame.eye - point.world);
    let halfway = normalize(to_eye + to_light);
    let alpha = max(material.roughness * material.roughness, 0.04);
    let shininess = max(2.0 / (alpha * alpha) - 2.0, 0.0);
    let reflectance = mix(vec3f(0.04 * (1.0 - material.roughness)), base, material.metallic);
    let lobe = (shininess + 8.0) / (8.0 * PI) * pow(max(dot(normal, halfway), 1e-4), shininess);
    let diffuse = base * ((1.0 - material.metallic) / PI);
    return (diffuse + reflectance * lobe) * light.intensity * (falloff * facing);
}
