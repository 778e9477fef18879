#include "shared/frame.wgsl"

@group(1) @binding(0) var glyphs: texture_2d<f32>;

struct LabelVertex {
    @location(0) at: vec2f,         // pixels from the upper left
    @location(1) uv: vec2f,         // in the atlas
    @location(2) color: vec4f,      // as the picture stores it, premultiplied
}

struct LabelPoint {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
    @location(1) color: vec4f,
}

@vertex
fn label_vertex(vertex: LabelVertex) -> LabelPoint {
    let at = vertex.at / frame.size * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0);
    return LabelPoint(vec4f(at, 0.0, 1.0), vertex.uv, vertex.color);
}

// Glyphs stand on whole pixels: one texel a pixel, nothing to filter.
@fragment
fn label(point: LabelPoint) -> @location(0) vec4f {
    let texel = vec2i(point.uv * vec2f(textureDimensions(glyphs)));
    return point.color * textureLoad(glyphs, texel, 0).r;
}
