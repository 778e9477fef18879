// One light on a surface, before shadows.

const PI: f32 = 3.14159265;

// At least this rough, and without metal, there is no highlight: techniques/surfaces/groups.rs has the same number.
const MATT: f32 = 0.9;

// How a material throws light back: the same all over it.
struct Finish {
    diffuse: f32,       // times the base colour
    metal: f32,         // times the base colour and the lobe: a metal's highlight
    clear: f32,         // times the lobe alone: any other's highlight, in the light's own colour
    sharpness: f32,     // of the lobe
}

// From the glTF roughness: Blinn-Phong, normalised, its lobe the Gaussian it nearly is.
fn finish_of(material: Material) -> Finish {
    if !GLOSSY {
        return Finish(1.0 / PI, 0.0, 0.0, 0.0);
    }
    // Not a branch: one that uniforms alone decide makes lavapipe copy the shader at every draw, and keep the copies.
    let shines = select(1.0, 0.0, (material.roughness >= MATT) & (material.metallic <= 0.0));
    let alpha = max(material.roughness * material.roughness, 0.04);
    let shininess = max(2.0 / (alpha * alpha) - 2.0, 0.0);
    let strength = shines * (shininess + 8.0) / (8.0 * PI);
    let clear = 0.04 * (1.0 - material.roughness) * (1.0 - material.metallic);
    return Finish((1.0 - material.metallic) / PI, material.metallic * strength, clear * strength, shininess * log2(exp(1.0)));
}

// Where a light ends.
struct Reach {
    inverse_range_squared: f32,
    along: f32,         // how far along the cone's axis the surface lies, in units of the cone's soft rim
    rim: f32,           // the cosine of the cone's outer half angle, likewise
}

// The way to the light; for a directional one of unit length.
fn way_to_light(light: Light, kind: u32, world: vec3f) -> vec3f {
    return select(light.position - world, -light.direction, kind == DIRECTIONAL);
}

fn light_reach(light: Light, to_light: vec3f) -> Reach {
    let width = light.inverse_cone_width;
    return Reach(light.inverse_range_squared, -dot(to_light, light.direction) * width, light.cos_outer * width);
}

// What arrives of each unit of a light's intensity. Neither normal nor way need be of unit length.
fn arriving(kind: u32, reach: Reach, sin_bound: f32, normal: vec3f, to_light: vec3f) -> f32 {
    let distance_squared = max(dot(to_light, to_light), 1e-6);
    let nearness = inverseSqrt(distance_squared);
    let cosine = dot(normal, to_light) * (inverseSqrt(dot(normal, normal)) * nearness);
    // The terminator bound: zero before any neighbouring facet turns away from the light.
    var share = max(cosine - sin_bound, 0.0) / (1.0 - sin_bound);
    if kind != DIRECTIONAL {
        // Inverse square, brought to zero at the range (as glTF's KHR_lights_punctual suggests).
        let fraction = distance_squared * reach.inverse_range_squared;
        let window = saturate(1.0 - fraction * fraction) * nearness;
        share *= window * window;
    }
    if kind == SPOT || kind == PROJECTOR {
        let cone = saturate(reach.along * nearness - reach.rim);
        share *= cone * cone;
    }
    return share;
}

// How much of what arrives a highlight shows: 1 in its middle.
fn highlight(sharpness: f32, normal: vec3f, to_light: vec3f, to_eye: vec3f) -> f32 {
    let light = to_light * inverseSqrt(max(dot(to_light, to_light), 1e-6));
    let halfway = light + to_eye * inverseSqrt(dot(to_eye, to_eye));
    let across = max(dot(normal, normal) * dot(halfway, halfway), 1e-12);
    return exp2(sharpness * (dot(normal, halfway) * inverseSqrt(across) - 1.0));
}

// What a projector's slide lets through on the way from the surface `to_light`.
fn through_slide(light: Light, to_light: vec3f, from_eye: f32) -> vec3f {
    let along = max(-dot(to_light, light.direction), 1e-6);
    let down = cross(light.direction, light.right) * light.hand;
    // -1 to 1 over the slide, u to the right, v downward.
    let at = -vec2f(dot(to_light, light.right), dot(to_light, down)) * (light.slide_scale / along);
    // A pixel's size in texels says which level is fine enough.
    let texels = frame.pixel * from_eye * light.slide_scale / along * 0.5 * f32(textureDimensions(slides).x);
    let color = textureSampleLevel(slides, slide_sampler, at * 0.5 + 0.5, light.slide, log2(max(texels, 1.0))).rgb;
    return select(vec3f(0.0), color, all(abs(at) <= vec2f(1.0)));
}
