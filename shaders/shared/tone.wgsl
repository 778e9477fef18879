// Linear light to the picture.

// Surfaces are drawn in the picture's own colours: whole, exposed, through the tone curve.
override FINISHED: bool = false;

// What surfaces' light is multiplied with at the vertices.
fn exposure() -> f32 {
    return select(1.0, frame.exposure, FINISHED);
}

// A pixel of the picture, of exposed light.
fn shown(light: vec3f) -> vec4f {
    return vec4f(encoded(tone_curve(light)), 1.0);
}

// Khronos' PBR Neutral curve (2024): what is below 0.8 keeps its hue and nearly its value, what is above
// is brought down to 1 and gently bleached.
fn tone_curve(linear: vec3f) -> vec3f {
    let start = 0.8 - 0.04;
    let room = 1.0 - start;
    let desaturation = 0.15;
    let least = min(linear.r, min(linear.g, linear.b));
    let most = max(linear.r, max(linear.g, linear.b));
    let offset = select(0.04, least - 6.25 * least * least, least < 0.08);
    let color = linear - offset;
    let peak = most - offset;
    let sum = peak + (room - start);
    // The curve brings the peak to 1 - room^2 / sum, then mixes in white by how far it fell. Written so that there is one
    // division: on a software GPU that makes half a millisecond.
    let above = desaturation * (peak * sum - sum + room * room);
    let share = (sum - room * room) / ((above + sum) * (peak * sum));
    let high = peak >= start;
    let scale = select(1.0, sum * share, high);
    let white = select(0.0, above * peak * share, high);
    return color * scale + white;
}

// sRGB's encoding, which the picture is stored in. The power of 1 / 2.4 is a polynomial in the square
// root, never 0.2 of 255 from it: the picture's format could encode too, but on a software GPU that costs
// several times as much, and in steps that write no colour as well.
fn encoded(linear: vec3f) -> vec3f {
    let x = sqrt(linear);
    let curve = (((-0.30942455 * x + 0.84246057) * x - 0.94461204) * x + 1.44782844) * x - 0.03699875;
    return select(curve, linear * 12.92, linear < vec3f(0.0031308));
}

// And back.
fn decoded(value: vec3f) -> vec3f {
    return select(pow((value + 0.055) / 1.055, vec3f(2.4)), value / 12.92, value <= vec3f(0.04045));
}
