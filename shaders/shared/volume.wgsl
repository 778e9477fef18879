// Shadow volume vertices (M section 6): the buffer holds each vertex twice, with w = 1 where it is
// and w = 0 where the light throws it, to infinity. A directional light throws all of them to one point.

fn volume_position(vertex: vec4f, volume: u32) -> vec4f {
    let light = volumes[volume].light_in_object;
    let thrown = vec4f(vertex.xyz * light.w - light.xyz, 0.0);
    return clip_position(volumes[volume].object, select(thrown, vec4f(vertex.xyz, 1.0), vertex.w == 1.0));
}
