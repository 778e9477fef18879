// Surfaces: their vertices, their material, and light on them.
//
// The overrides are set for each step from the plan, so that a pixel pays only for what its material
// and its light have.

override TEXTURED: bool = true;
override GLOSSY: bool = true;
override BOTH_SIDES: bool = true;

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
    @location(3) color: vec4f,      // base colour but for the texture
    @location(4) sin_bound: f32,
}

@vertex
fn surface_vertex(vertex: SurfaceVertex, @builtin(instance_index) object: u32) -> SurfacePoint {
    var point: SurfacePoint;
    point.clip = clip_position(object, vec4f(vertex.position, 1.0));
    point.world = (objects[object].world_from_object * vec4f(vertex.position, 1.0)).xyz;
    point.normal = normalize((objects[object].normal_from_object * vec4f(vertex.normal, 0.0)).xyz);
    point.uv = vertex.uv;
    point.color = material.base_color * vertex.color;
    point.sin_bound = select(0.0, vertex.sin_bound, frame.smooth_terminator > 0.5);
    return point;
}

fn base_color(point: SurfacePoint) -> vec4f {
    if TEXTURED {
        return point.color * textureSample(base_color_texture, base_color_sampler, point.uv);
    }
    return point.color;
}

// Towards the side that is seen; not unit.
fn seen_normal(point: SurfacePoint, front: bool) -> vec3f {
    if BOTH_SIDES {
        return select(-point.normal, point.normal, front);
    }
    return point.normal;
}

// `up` is the height of the unit normal: 1 looks up, -1 down.
fn ambient_light(base: vec3f, up: f32) -> vec3f {
    let ambient = mix(frame.ambient_ground, frame.ambient_sky, up * 0.5 + 0.5);
    return (select(base * ambient, base, material.unlit > 0.5) + material.emissive) * frame.scale;
}

const PI: f32 = 3.14159265;

// What a projector's slide lets through on the way `away`, which leads from the light to the surface.
fn through_slide(light: Light, away: vec3f, from_eye: f32) -> vec3f {
    let along = max(dot(away, light.direction), 1e-6);
    let down = cross(light.direction, light.right);
    // -1 to 1 over the slide, u to the right, v downward.
    let at = vec2f(dot(away, light.right), dot(away, down)) * (light.slide_scale / along);
    // A pixel's size in texels says which level is fine enough.
    let texels = frame.pixel * from_eye * light.slide_scale / along * 0.5 * f32(textureDimensions(slides).x);
    let color = textureSampleLevel(slides, slide_sampler, at * 0.5 + 0.5, light.slide, log2(max(texels, 1.0))).rgb;
    return select(vec3f(0.0), color, all(abs(at) <= vec2f(1.0)));
}

// Radiance towards the eye from one light, before shadows. `kind` is a constant where it can be.
fn light_on_surface(light: Light, kind: u32, base: vec3f, point: SurfacePoint, normal: vec3f) -> vec3f {
    var offset = -light.direction;
    if kind != DIRECTIONAL {
        offset = light.position - point.world;
    }
    let distance_squared = max(dot(offset, offset), 1e-6);
    // One square root for both lengths: the normal's and the way to the light's.
    let cosine = dot(normal, offset) * inverseSqrt(dot(normal, normal) * distance_squared);
    // The terminator bound: zero before any neighbouring facet turns away from the light.
    let facing = max(cosine - point.sin_bound, 0.0);
    var weight = facing / (1.0 - point.sin_bound);
    if kind != DIRECTIONAL {
        // Inverse square, brought to zero at the range (as glTF's KHR_lights_punctual suggests).
        let fraction = distance_squared * light.inverse_range_squared;
        let window = saturate(1.0 - fraction * fraction);
        weight = facing * window * window / (distance_squared * (1.0 - point.sin_bound));
    }
    if kind == SPOT || kind == PROJECTOR {
        let along = -dot(offset, light.direction) * inverseSqrt(distance_squared);
        let cone = saturate((along - light.cos_outer) * light.inverse_cone_width);
        weight *= cone * cone;
    }
    var reflected = base * (1.0 / PI);
    if GLOSSY {
        // Blinn-Phong, normalised, from the glTF roughness.
        let to_eye = normalize(frame.eye - point.world);
        let halfway = normalize(to_eye + offset * inverseSqrt(distance_squared));
        let alpha = max(material.roughness * material.roughness, 0.04);
        let shininess = max(2.0 / (alpha * alpha) - 2.0, 0.0);
        let reflectance = mix(vec3f(0.04 * (1.0 - material.roughness)), base, material.metallic);
        let height = dot(normal, halfway) * inverseSqrt(dot(normal, normal));
        let lobe = (shininess + 8.0) / (8.0 * PI) * pow(max(height, 1e-4), shininess);
        reflected = reflected * (1.0 - material.metallic) + reflectance * lobe;
    }
    var intensity = light.intensity;
    if kind == PROJECTOR {
        intensity *= through_slide(light, -offset, distance(point.world, frame.eye));
    }
    return reflected * intensity * weight;
}
