// Shadow volume vertices (M section 6): the buffer holds each vertex twice, with w = 1 where it is
// and w = 0 where the light throws it: onto the plane where the volume ends, which may be the one at
// infinity. A directional light throws all of them to one point at infinity. A piece of a clamped volume starts on a plane
// too: there its vertices with w = 1 are thrown as well.
//
// Where volumes are merged into one draw (gpu/merged.rs), w has twice its volume's number more.
//
// A cut-out's vertices with w = 0 go through its matrix instead (K 6.2.1, appendix C, "Advanced").

// `first` is the draw's instance number.
fn volume_of(vertex: vec4f, first: u32) -> u32 {
    return first + (u32(vertex.w) >> 1u);
}

fn volume_position(vertex: vec4f, volume: u32) -> vec4f {
    return clip_position(volumes[volume].object, volume_in_object(vertex, volume));
}

// The vertex in object space, homogeneous.
fn volume_in_object(vertex: vec4f, volume: u32) -> vec4f {
    let light = volumes[volume].light_in_object;
    let end = volumes[volume].end_in_object;
    let start = volumes[volume].start_in_object;
    let way = vertex.xyz * light.w - light.xyz;
    var thrown = onto(end, light, way);
    if volumes[volume].by_matrix == 1u {
        thrown = volumes[volume].thrown * vec4f(vertex.xyz, 1.0);
    }
    if volumes[volume].extrusion > 0.0 {
        // So many metres from the light, or from where it is for a directional light (B).
        let metres = length((objects[volumes[volume].object].world_from_object * vec4f(way, 0.0)).xyz);
        thrown = vec4f(select(vertex.xyz, light.xyz, light.w == 1.0) + way * (volumes[volume].extrusion / metres), 1.0);
    }
    let near = select(vec4f(vertex.xyz, 1.0), onto(start, light, way), any(start != vec4f(0.0)));
    return select(thrown, near, (u32(vertex.w) & 1u) == 1u);
}

// Along the ray from the light, light + t * way, to where the plane is; homogeneous, so that t may be infinite:
// (light * slope + way * height) / slope.
fn onto(plane: vec4f, light: vec4f, way: vec3f) -> vec4f {
    let slope = dot(plane.xyz, way);
    let height = -(dot(plane.xyz, light.xyz) + plane.w);
    return vec4f(light.xyz * slope + way * height, slope);
}

struct VolumePoint {
    @invariant @builtin(position) clip: vec4f,
}

@vertex
fn volume_vertex(@location(0) vertex: vec4f, @builtin(instance_index) first: u32) -> VolumePoint {
    return VolumePoint(volume_position(vertex, volume_of(vertex, first)));
}
