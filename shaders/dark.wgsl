#include "shared/frame.wgsl"
#include "shared/full_screen.wgsl"

// One colour over everything that the stencil lets through, premultiplied.
@fragment
fn dark() -> @location(0) vec4f {
    return vec4f(draw.constant.rgb * draw.constant.a, draw.constant.a);
}
