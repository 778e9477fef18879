// How much of what is seen on a mirror is its reflection; the rest is the surface's own look.

const NO_MIRROR: u32 = 0u;
const EVEN: u32 = 1u;           // the same from everywhere
const FRESNEL: u32 = 2u;        // the more, the more obliquely it is seen (Schlick 1994)
override MIRROR: u32 = NO_MIRROR;

// The step's constant has the reflectance of a mirror that is looked at straight in its alpha. Neither normal nor
// way need be of unit length.
fn reflectance(normal: vec3f, to_eye: vec3f) -> f32 {
    let straight = draw.constant.a;
    if MIRROR != FRESNEL {
        return straight;
    }
    let cosine = abs(dot(normal, to_eye)) * inverseSqrt(dot(normal, normal) * dot(to_eye, to_eye));
    return straight + (1.0 - straight) * pow(saturate(1.0 - cosine), 5.0);
}
