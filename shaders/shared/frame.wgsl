// What every program sees of the frame. Struct layouts are checked against Rust's by a test.

struct Frame {
    eye: vec3f,                 // world space, metres
    exposure: f32,              // times linear colour, before the tone curve
    ambient_sky: vec3f,         // linear radiance on surfaces that look up
    smooth_terminator: f32,     // 1: the terminator bound is in force
    ambient_ground: vec3f,      // linear radiance on surfaces that look down
    light_count: u32,
    background_top: vec3f,      // linear
    pixel: f32,                 // metres, one metre before the eye
    background_bottom: vec3f,   // linear
    scale: f32,                 // times all light that surfaces give; `exposure` is then less by it
    size: vec2f,                // pixels
    _pad2: vec2f,
    clip_from_world: mat4x4f,   // for mismatched arithmetic only: see volume.wgsl
    clip_plane: vec4f,          // world space: under it nothing is seen, in views by way of a mirror
    way_ahead: vec3f,           // unit: through the middle of the picture
    near: f32,                  // metres; without a far plane a depth is the near plane's distance over the surface's
    way_right: vec3f,           // from there to the right edge, one metre before the eye
    _pad3: f32,
    way_up: vec3f,              // and to the upper one
    _pad4: f32,
}

struct Object {
    clip_from_object: mat4x4f,
    world_from_object: mat4x4f,
    normal_from_object: mat4x4f, // inverse transpose: normals to world space, unnormalised
}

const POINT: u32 = 0u;
const DIRECTIONAL: u32 = 1u;
const SPOT: u32 = 2u;
const PROJECTOR: u32 = 3u;      // a spot with a slide

struct Light {
    position: vec3f,            // world space
    inverse_range_squared: f32, // 0: no end
    direction: vec3f,           // unit, world space: where it shines to
    cos_outer: f32,
    intensity: vec3f,           // linear RGB: candela, or lux
    inverse_cone_width: f32,    // 1 / (cos inner - cos outer)
    right: vec3f,               // unit, square to the direction: to the right of what it projects
    kind: u32,
    slide: u32,                 // a layer of `slides`
    slide_scale: f32,           // slide halves a metre beside the axis, one metre before the light
    hand: f32,                  // -1: reflected, with all that it projects
    _pad0: u32,
}

struct Volume {
    light_in_object: vec4f,     // w = 1: a point; w = 0: the direction to a directional light
    end_in_object: vec4f,       // the plane the volume ends on; (0, 0, 0, -1) at infinity
    start_in_object: vec4f,     // the plane it starts on; (0, 0, 0, 0): it starts at its caster
    thrown: mat4x4f,            // cut-outs: takes (x y z 1) of a far vertex to where it is thrown;
                                // ZP+: to clip space, as the light sees it through the near rectangle;
                                // planar shadows: to clip space, thrown onto their receiver
    object: u32,
    by_matrix: u32,             // 1: a cut-out, thrown by the matrix
    extrusion: f32,             // metres from the light to the far end; 0: on the plane
    _pad0: u32,
}

// One step. The light is a copy in uniform memory: every pixel reads it, and uniform reads are
// cheap where storage reads are not.
struct Draw {
    constant: vec4f,
    light: Light,
    swell: f32,                 // pixels that swollen surfaces grow by
    _pad0: f32,
    _pad1: f32,
    _pad2: f32,
}

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<storage, read> objects: array<Object>;
@group(0) @binding(2) var<storage, read> lights: array<Light>;
@group(0) @binding(3) var<storage, read> volumes: array<Volume>;
@group(0) @binding(4) var<uniform> draw: Draw;
@group(0) @binding(5) var slides: texture_2d_array<f32>;
@group(0) @binding(6) var slide_sampler: sampler;

// THE clip position: surfaces and volumes alike come through here, so that what is at the same
// place has the same depth to the last bit (DESIGN section 3).
fn clip_position(object: u32, position: vec4f) -> vec4f {
    return objects[object].clip_from_object * position;
}
