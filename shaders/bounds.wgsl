// A light's bounds: their corners come in clip space.
@vertex
fn bounds_vertex(@location(0) clip: vec4f) -> @builtin(position) vec4f {
    return clip;
}

// Marking: the stencil is all that changes.
@fragment
fn bounds() {
}
