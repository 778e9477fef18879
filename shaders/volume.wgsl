#include "shared/frame.wgsl"
#include "shared/volume.wgsl"

// For the failure gallery: by way of world space, in two products where `clip_position` has one. Equal in
// mathematics, it differs in the last bits, and what lies on a surface may end up behind it.
@vertex
fn volume_vertex_mismatched(@location(0) vertex: vec4f, @builtin(instance_index) first: u32) -> VolumePoint {
    let volume = volume_of(vertex, first);
    let world = objects[volumes[volume].object].world_from_object * volume_in_object(vertex, volume);
    return VolumePoint(frame.clip_from_world * world);
}

// A light cap straight to clip space. ZP+: as the light sees it through the near rectangle. Planar shadows: as the eye
// sees it on the plane that the light throws it onto.
@vertex
fn thrown_vertex(@location(0) vertex: vec4f, @builtin(instance_index) first: u32) -> VolumePoint {
    return VolumePoint(volumes[volume_of(vertex, first)].thrown * vec4f(vertex.xyz, 1.0));
}

// Counting: the stencil is all that changes.
@fragment
fn volume_count() {
}

// The same of one face only, for stencil operations that cannot tell faces apart.
@fragment
fn volume_count_fronts(@builtin(front_facing) front: bool) {
    if !front {
        discard;
    }
}

@fragment
fn volume_count_backs(@builtin(front_facing) front: bool) {
    if front {
        discard;
    }
}

// A planar shadow, where it is more than a mark in the stencil: premultiplied. And a one for each fragment, where fill is
// counted.
@fragment
fn projected() -> @location(0) vec4f {
    return vec4f(draw.constant.rgb * draw.constant.a, draw.constant.a);
}

// Volumes as coloured glass: premultiplied, one layer a face.
@fragment
fn volume_glass() -> @location(0) vec4f {
    return vec4f(draw.constant.rgb * draw.constant.a, draw.constant.a) / vec4f(vec3f(frame.exposure), 1.0);
}
