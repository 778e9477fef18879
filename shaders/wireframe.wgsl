#include "shared/frame.wgsl"

struct LinePoint {
    @builtin(position) clip: vec4f,
}

// Pulled a hair towards the eye: reverse-Z depth grows, and what is on screen stays where it is.
@vertex
fn wireframe_vertex(@location(0) position: vec3f, @builtin(instance_index) object: u32) -> LinePoint {
    var clip = clip_position(object, vec4f(position, 1.0));
    clip.z *= 1.0005;
    return LinePoint(clip);
}

@fragment
fn wireframe() -> @location(0) vec4f {
    return vec4f(draw.constant.rgb * draw.constant.a, draw.constant.a) / vec4f(vec3f(frame.exposure), 1.0);
}
