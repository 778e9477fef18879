// Linear light to the picture. Khronos' PBR Neutral curve (2024): what is below 0.8 keeps its hue
// and nearly its value, what is above is brought down to 1 and gently bleached.
fn tone_curve(linear: vec3f) -> vec3f {
    let start = 0.8 - 0.04;
    let desaturation = 0.15;
    let least = min(linear.r, min(linear.g, linear.b));
    let offset = select(0.04, least - 6.25 * least * least, least < 0.08);
    let color = linear - offset;
    let peak = max(color.r, max(color.g, color.b));
    if peak < start {
        return color;
    }
    let room = 1.0 - start;
    let sum = peak + room - start;
    let scale = (sum - room * room) / (peak * sum);
    let new_peak = peak * scale;
    let bleach = 1.0 - 1.0 / (desaturation * (peak - new_peak) + 1.0);
    return mix(color * scale, vec3f(new_peak), bleach);
}
