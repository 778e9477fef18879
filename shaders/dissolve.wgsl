#include "shared/frame.wgsl"
#include "shared/full_screen.wgsl"

// Two pictures mixed pixel by pixel: a pattern marks the stencil, and one picture is laid where it did not.

const BAYER: f32 = 0.0;
const BLUE_NOISE: f32 = 1.0;
const CHECKER: f32 = 2.0;

// In which order pixels turn, of 256 times four each, 32 by 32, row by row, four to a word, the first lowest: void and
// cluster (Ulichney 1993), sigma 1.5, torus, from 102 random points. Any first part of them is spread evenly.
const RANKS = array<u32, 256>(
    0x4b195839u, 0xa18009e3u, 0x1ed60567u, 0x59b581f7u, 0xea8506cau, 0x470a773fu, 0xb9017d9bu, 0x054561f1u,
    0x8ebdd4acu, 0xf242c126u, 0xa776c42bu, 0x1940942fu, 0xc32eabfau, 0xe2bb8e1cu, 0x6c32ff22u, 0x7bc8258au,
    0xf37c2969u, 0x56d9975fu, 0xe44c8bb2u, 0x7aeace5fu, 0x60734799u, 0x7034ef9fu, 0xd595c759u, 0xf599e14fu,
    0x0143e211u, 0x7d0d36aau, 0x1438f918u, 0x2a6a02b7u, 0xd1e50fc5u, 0x88cd4e04u, 0x1745b10du, 0x533509acu,
    0x71b98ba1u, 0xa66ceed0u, 0xc99d63ccu, 0xe0af4f85u, 0x38ad8b5du, 0xa21fb580u, 0xe9772bf3u, 0xdabf8662u,
    0x53fe3364u, 0xe14b8d1du, 0x6de9223du, 0x1d9efe31u, 0x5716f03bu, 0x43de66fdu, 0xc28fd763u, 0x2374f73bu,
    0x8314a8d1u, 0x11b92cc4u, 0x9051be82u, 0x7e46d31au, 0xd5a06cc0u, 0x7a119524u, 0x215203bcu, 0x49b50ea4u,
    0x3ddb6f06u, 0xfb9565edu, 0xdd0aa368u, 0x940771aau, 0x85472cd8u, 0xefb03cbfu, 0x6efca02fu, 0xec9558deu,
    0xb25790beu, 0x5439049fu, 0x41f630d3u, 0x54f4c55bu, 0x02f7b313u, 0x8c5ae871u, 0x3583cc4bu, 0x30801cc9u,
    0x2818e741u, 0xa6c6e473u, 0xb8788c13u, 0xa8398625u, 0xca5c78e6u, 0xda0b2ea6u, 0xb710641eu, 0x67f5a148u,
    0xfac97cabu, 0x6a218643u, 0x00ca4cedu, 0x6718e59fu, 0x9238208eu, 0xa369d44au, 0xe796f2bcu, 0x21d50076u,
    0x9a5e084fu, 0xb1dc52bbu, 0xf0629a29u, 0xbcd34e70u, 0xeaadcf45u, 0x42fa8716u, 0x23543278u, 0xc58d5badu,
    0x32df89f1u, 0x7915920du, 0x3a16e044u, 0x06982bb4u, 0x740dff7fu, 0x9b23c059u, 0xdd8ad004u, 0x722ffb3eu,
    0x6dae1b3cu, 0xfd60c8f1u, 0xd6ab87beu, 0xde5df979u, 0x2c9d6431u, 0x60b13acdu, 0x0b6cb6ebu, 0xb5109cc1u,
    0x44cfa0dcu, 0x37a42781u, 0x52266805u, 0xa5208f0cu, 0xe0b850c4u, 0x8512f07bu, 0x4ea42d48u, 0x56e96582u,
    0x015a2a78u, 0xd54fe7b4u, 0x83c4ec98u, 0x7646bbe4u, 0x018a1be9u, 0xbd6b974au, 0xdff91bd4u, 0x9320ce33u,
    0xe08dff0eu, 0x748b1767u, 0xa8425a1eu, 0x08cd6534u, 0x66f54193u, 0x36dc27acu, 0x935e7a99u, 0xbf4aa915u,
    0x33c26a3eu, 0xf83fc79au, 0xfb09cea3u, 0x2ef09b1au, 0x38d16eb2u, 0x520afdc7u, 0x42c30fedu, 0xd787f674u,
    0x1f4e9eb2u, 0xb70758f2u, 0x778f6629u, 0x4d8258dau, 0x129c21dfu, 0xb68c5b81u, 0xd929a969u, 0x246102b8u,
    0x84d108ebu, 0x83dd73aeu, 0x49bded51u, 0xc30cb326u, 0xbaee5787u, 0xd81ca744u, 0x50f38840u, 0x7de1329cu,
    0xe3347256u, 0x1c983a10u, 0x9f1036d2u, 0x39f76dcbu, 0x2d7506a5u, 0x2fe86dd0u, 0x196207c9u, 0x9746c571u,
    0x50a2f81du, 0xa8f463c2u, 0xe47eb16eu, 0x6316913bu, 0x5096e3cbu, 0x4c9103f8u, 0x8edfa079u, 0xcc0cfcafu,
    0x257cba3du, 0x4d2dd88cu, 0x1d60fd03u, 0x7bafeb55u, 0x15b43f23u, 0xb05fc27eu, 0x3cc128f5u, 0xa7885a1fu,
    0xea005eddu, 0xcb7f14adu, 0xc1d64092u, 0x4bd42d89u, 0xd75d89feu, 0xdb203b9eu, 0xec556f0fu, 0x6b2adb7eu,
    0x6ed29017u, 0xe6b65b44u, 0x0f982875u, 0x9e0a6fabu, 0x27e817bdu, 0x84a5f16au, 0x039dba46u, 0xeeb748cau,
    0x2abf4d35u, 0x0c339bfau, 0x65eeb055u, 0x5fefc645u, 0x47a97237u, 0xc7560bccu, 0x3789fe2eu, 0x9c0b76a9u,
    0x7aa6f682u, 0xc069cf18u, 0x317f1af4u, 0x942484e2u, 0x91c005dbu, 0x96e63481u, 0x68d01361u, 0xce5df322u,
    0x3e07591fu, 0x8649e190u, 0xd6be3e9du, 0x41b95700u, 0x1e53f47du, 0x1b70aafbu, 0x4dae79dcu, 0xb33d93d9u,
    0xe8b8da72u, 0x0426ac5eu, 0xa16f5ccbu, 0xcf19fc8au, 0xc8682ba5u, 0x4cbc0243u, 0x08eb3ca3u, 0xe71180bbu,
    0x84499631u, 0xff77c313u, 0x2812de30u, 0x6175ae4au, 0x7c99e50eu, 0x7fd25ce2u, 0x5c8f24f6u, 0xa451f930u,
    0x2ccd0e64u, 0x51943af2u, 0xecb67baau, 0xef9a37c8u, 0x1435ba48u, 0x369225a2u, 0xa770c612u, 0xc62275d3u,
    0x73a2fc88u, 0x1ad262b0u, 0x55913fe6u, 0x27d9096bu, 0x54d76b8du, 0xd866f8b3u, 0x40e353afu, 0xe5b49715u,
);

// From 0 to 1: a pixel turns when the amount is past it.
fn threshold(pattern: f32, at: vec2u) -> f32 {
    if pattern == BAYER {
        // Bayer's 8 by 8 matrix (1973): the bits of x ^ y and of y, interleaved, the lowest first.
        let y = at.y & 7u;
        let mixed = (at.x & 7u) ^ y;
        var order = 0u;
        for (var bit = 0u; bit < 3u; bit++) {
            order |= (((mixed >> bit) & 1u) << (5u - 2u * bit)) | (((y >> bit) & 1u) << (4u - 2u * bit));
        }
        return (f32(order) + 0.5) / 64.0;
    }
    if pattern == BLUE_NOISE {
        let place = (at.y & 31u) * 32u + (at.x & 31u);
        var ranks = RANKS;
        let rank = (ranks[place >> 2u] >> (8u * (place & 3u))) & 255u;
        return (f32(rank) + 0.5) / 256.0;
    }
    if pattern == CHECKER {
        return select(0.25, 0.75, ((at.x + at.y) & 1u) == 1u);
    }
    // From the left to the right.
    return (f32(at.x) + 0.5) / frame.size.x;
}

struct Turning {
    @builtin(position) at: vec4f,
    @location(0) @interpolate(flat) pattern: f32,       // no uniform: shared/light.wgsl says why
}

@vertex
fn pattern_vertex(@builtin(vertex_index) index: u32) -> Turning {
    return Turning(full_screen_corner(index), draw.constant.x);
}

// The stencil is all that changes: the constant has the pattern and the amount.
@fragment
fn pattern(pixel: Turning) {
    if threshold(pixel.pattern, vec2u(pixel.at.xy)) >= draw.constant.y {
        discard;
    }
}

@group(1) @binding(0) var kept: texture_2d<f32>;
@group(1) @binding(1) var kept_sampler: sampler;

// The picture that was kept, where the stencil lets it through: as light that will be exposed as the second picture is.
@fragment
fn lay_kept(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return textureSampleLevel(kept, kept_sampler, at.xy / frame.size, 0.0) * vec4f(vec3f(draw.constant.x), 1.0);
}
