#include "shared/frame.wgsl"
#include "shared/material.wgsl"
#include "shared/light.wgsl"
#include "shared/full_screen.wgsl"
#include "shared/tone.wgsl"

// Up to four lights on the surfaces that geometry.wgsl kept: pixel by pixel, without a triangle.

@group(1) @binding(0) var kept_depth: texture_depth_2d;
@group(1) @binding(1) var kept_surface: texture_2d<u32>;
@group(1) @binding(2) var kept_dark: texture_2d<f32>;    // a bit for each light, where a volume holds the surface
@group(1) @binding(3) var<storage, read> materials: array<Material>;

// The kinds of the lights; the constant has their numbers.
const NO_LIGHT: u32 = 4u;
override LIGHT_0: u32 = NO_LIGHT;
override LIGHT_1: u32 = NO_LIGHT;
override LIGHT_2: u32 = NO_LIGHT;
override LIGHT_3: u32 = NO_LIGHT;
// The lights' bits are asked; else the stencil has spoken.
override EACH: bool = false;
// Some material has more than its base colour.
override MATERIALS: bool = false;

// What is the same everywhere is worked out at the three corners: see lit.wgsl.
struct Screen {
    @builtin(position) clip: vec4f,
    @location(0) way: vec3f,                            // from the eye, times the depth
    @location(1) @interpolate(flat) sky: vec3f,
    @location(2) @interpolate(flat) ground: vec3f,
    @location(3) @interpolate(flat) place_0: vec4f,     // from the eye, or towards it for a directional light; inverse range squared
    @location(4) @interpolate(flat) color_0: vec4f,     // times exposure; rim
    @location(5) @interpolate(flat) axis_0: vec3f,      // over the width of the cone's soft rim
    @location(6) @interpolate(flat) place_1: vec4f,
    @location(7) @interpolate(flat) color_1: vec4f,
    @location(8) @interpolate(flat) axis_1: vec3f,
    @location(9) @interpolate(flat) place_2: vec4f,
    @location(10) @interpolate(flat) color_2: vec4f,
    @location(11) @interpolate(flat) axis_2: vec3f,
    @location(12) @interpolate(flat) place_3: vec4f,
    @location(13) @interpolate(flat) color_3: vec4f,
    @location(14) @interpolate(flat) axis_3: vec3f,
}

struct Lamp {
    place: vec4f,
    color: vec4f,
    axis: vec3f,
}

fn lamp(number: f32, kind: u32) -> Lamp {
    if kind == NO_LIGHT {
        return Lamp();
    }
    let light = lights[u32(number)];
    let width = light.inverse_cone_width;
    let place = select(light.position - frame.eye, -light.direction, kind == DIRECTIONAL);
    return Lamp(
        vec4f(place, light.inverse_range_squared),
        vec4f(light.intensity * exposure(), light.cos_outer * width),
        light.direction * width,
    );
}

@vertex
fn shade_vertex(@builtin(vertex_index) index: u32) -> Screen {
    let clip = full_screen_corner(index);
    let a = lamp(draw.constant.x, LIGHT_0);
    let b = lamp(draw.constant.y, LIGHT_1);
    let c = lamp(draw.constant.z, LIGHT_2);
    let d = lamp(draw.constant.w, LIGHT_3);
    let bright = frame.scale * exposure();
    return Screen(
        clip,
        (frame.way_ahead + frame.way_right * clip.x + frame.way_up * clip.y) * frame.near,
        frame.ambient_sky * bright, frame.ambient_ground * bright,
        a.place, a.color, a.axis,
        b.place, b.color, b.axis,
        c.place, c.color, c.axis,
        d.place, d.color, d.axis,
    );
}

// What the pixel shows.
struct Ground {
    from_eye: vec3f,
    normal: vec3f,
    sin_bound: f32,
    base: vec3f,
    finish: Finish,
    dark: u32,          // a bit for each light
}

@fragment
fn shade(screen: Screen) -> @location(0) vec4f {
    let at = vec2i(screen.clip.xy);
    let kept = textureLoad(kept_surface, at, 0);
    let normal = vec4f(unpack2x16float(kept.x), unpack2x16float(kept.y));
    let rest = unpack2x16float(kept.w);
    var ground: Ground;
    ground.from_eye = screen.way / textureLoad(kept_depth, at, 0);
    ground.normal = normal.xyz;
    ground.sin_bound = 1.0 - normal.w;
    ground.base = vec3f(unpack2x16float(kept.z), rest.x);
    ground.finish = Finish(1.0 / PI, 0.0, 0.0, 0.0);
    var lights_there = 1.0;
    var color = ground.base * mix(screen.ground, screen.sky, normal.y * 0.5 + 0.5);
    if MATERIALS {
        let made = materials[u32(rest.y)];
        ground.finish = finish_of(made);
        lights_there = 1.0 - made.unlit;
        color = (select(color, ground.base * (frame.scale * exposure()), made.unlit > 0.5)) + emitted_light(made) * exposure();
    }
    if EACH {
        ground.dark = u32(textureLoad(kept_dark, at, 0).r * 255.0 + 0.5);
    }
    var light = lit_by(ground, 0u, LIGHT_0, draw.constant.x, screen.place_0, screen.color_0, screen.axis_0);
    light += lit_by(ground, 1u, LIGHT_1, draw.constant.y, screen.place_1, screen.color_1, screen.axis_1);
    light += lit_by(ground, 2u, LIGHT_2, draw.constant.z, screen.place_2, screen.color_2, screen.axis_2);
    light += lit_by(ground, 3u, LIGHT_3, draw.constant.w, screen.place_3, screen.color_3, screen.axis_3);
    return shown(color + light * lights_there);
}

fn lit_by(ground: Ground, place: u32, kind: u32, number: f32, at: vec4f, color: vec4f, axis: vec3f) -> vec3f {
    if kind == NO_LIGHT {
        return vec3f(0.0);
    }
    let to_light = select(at.xyz - ground.from_eye, at.xyz, kind == DIRECTIONAL);
    let reach = Reach(at.w, -dot(to_light, axis), color.w);
    var share = vec3f(arriving(kind, reach, ground.sin_bound, ground.normal, to_light));
    if EACH {
        share *= f32(~(ground.dark >> place) & 1u);
    }
    if kind == PROJECTOR {
        share *= through_slide(lights[u32(number)], to_light, length(ground.from_eye));
    }
    var thrown = ground.base * ground.finish.diffuse;
    if GLOSSY {
        let lobe = highlight(ground.finish.sharpness, ground.normal, to_light, -ground.from_eye);
        thrown = ground.base * (ground.finish.diffuse + ground.finish.metal * lobe) + ground.finish.clear * lobe;
    }
    return color.rgb * thrown * share;
}

// A light's bit, where the stencil says that its shadow is.
@fragment
fn mark_dark() -> @location(0) vec4f {
    return vec4f(draw.constant.r);
}
