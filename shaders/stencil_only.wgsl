#include "shared/full_screen.wgsl"

// The stencil's operations are all there is to it.
@fragment
fn stencil_only() {
}
