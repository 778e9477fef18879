#include "shared/frame.wgsl"
#include "shared/full_screen.wgsl"

@fragment
fn background(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    return vec4f(mix(frame.background_top, frame.background_bottom, pixel.y / frame.size.y), 1.0);
}
