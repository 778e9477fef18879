#include "shared/frame.wgsl"

struct LineVertex {
    @location(0) at: vec2f,         // pixels from the upper left
    @location(1) color: vec4f,      // as the picture stores it, premultiplied
}

struct LinePoint {
    @builtin(position) clip: vec4f,
    @location(0) color: vec4f,
}

@vertex
fn line_vertex(vertex: LineVertex) -> LinePoint {
    let at = vertex.at / frame.size * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0);
    return LinePoint(vec4f(at, 0.0, 1.0), vertex.color);
}

@fragment
fn line(point: LinePoint) -> @location(0) vec4f {
    return point.color;
}
