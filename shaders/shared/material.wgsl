// What surfaces are made of, and how they throw light back that has no direction.

override GLOSSY: bool = true;

struct Material {
    base_color: vec4f,          // linear, with alpha
    emissive: vec3f,            // linear radiance
    roughness: f32,
    metallic: f32,
    cutoff: f32,                // masked materials: below this alpha there is no surface
    unlit: f32,                 // 1: shown in its base colour
    number: f32,                // among the scene's materials
}

// Ambient light, which comes from all around, as a surface whose normal rises by `up` throws it back:
// 1 looks up, -1 down. Unlit surfaces are bright by themselves.
fn ambient_light(made: Material, base: vec3f, up: f32) -> vec3f {
    let ambient = mix(frame.ambient_ground, frame.ambient_sky, up * 0.5 + 0.5);
    return select(base * ambient, base, made.unlit > 0.5) * frame.scale;
}

// What the material gives off by itself.
fn emitted_light(made: Material) -> vec3f {
    return made.emissive * frame.scale;
}
