// Double and single precision by whole numbers: the CPU's arithmetic to the last bit, whatever this device makes of
// floats (it may fuse a product and a sum, round otherwise, or take the smallest numbers for zero). Round to nearest,
// ties to even. There is no infinity: who calls keeps his numbers far from it.

// mantissa * 2^exponent; the mantissa (low word, high word) has 53 bits, or is zero.
struct Double {
    mantissa: vec2u,
    exponent: i32,
    negative: bool,
}

const ZERO: Double = Double(vec2u(0u, 0u), 0, false);

fn is_zero(a: Double) -> bool {
    return a.mantissa.x == 0u && a.mantissa.y == 0u;
}

fn wide_left(x: vec2u, by: u32) -> vec2u {
    if by == 0u {
        return x;
    }
    if by >= 32u {
        return vec2u(0u, x.x << (by - 32u));
    }
    return vec2u(x.x << by, (x.y << by) | (x.x >> (32u - by)));
}

// What is shifted out leaves its mark in the lowest bit.
fn wide_right(x: vec2u, by: u32) -> vec2u {
    if by == 0u {
        return x;
    }
    var lost = x.x | x.y;
    var shifted = vec2u(0u, 0u);
    if by < 32u {
        lost = x.x << (32u - by);
        shifted = vec2u((x.x >> by) | (x.y << (32u - by)), x.y >> by);
    } else if by == 32u {
        lost = x.x;
        shifted = vec2u(x.y, 0u);
    } else if by < 64u {
        lost = x.x | (x.y << (64u - by));
        shifted = vec2u(x.y >> (by - 32u), 0u);
    }
    return vec2u(shifted.x | select(0u, 1u, lost != 0u), shifted.y);
}

fn wide_sum(a: vec2u, b: vec2u) -> vec2u {
    let low = a.x + b.x;
    return vec2u(low, a.y + b.y + select(0u, 1u, low < a.x));
}

fn wide_difference(a: vec2u, b: vec2u) -> vec2u {
    return vec2u(a.x - b.x, a.y - b.y - select(0u, 1u, a.x < b.x));
}

fn wide_less(a: vec2u, b: vec2u) -> bool {
    return a.y < b.y || (a.y == b.y && a.x < b.x);
}

fn wide_product(a: u32, b: u32) -> vec2u {
    let low = (a & 0xffffu) * (b & 0xffffu);
    let middle = (a >> 16u) * (b & 0xffffu);
    let other = (a & 0xffffu) * (b >> 16u);
    let high = (a >> 16u) * (b >> 16u);
    let sum = wide_sum(vec2u(low, high), vec2u(middle << 16u, middle >> 16u));
    return wide_sum(sum, vec2u(other << 16u, other >> 16u));
}

// The place of the highest bit that is set; of what is not zero.
fn wide_place(x: vec2u) -> u32 {
    if x.y != 0u {
        return 32u + firstLeadingBit(x.y);
    }
    return firstLeadingBit(x.x);
}

// x * 2^exponent, rounded to 53 bits. The lowest bit of x may stand for what was shifted out.
fn rounded(negative: bool, exponent: i32, x: vec2u) -> Double {
    if x.x == 0u && x.y == 0u {
        return ZERO;
    }
    let place = wide_place(x);
    var y = x;
    var e = exponent;
    if place == 63u {
        y = wide_right(x, 1u);
        e += 1;
    } else {
        y = wide_left(x, 62u - place);
        e -= i32(62u - place);
    }
    var mantissa = vec2u((y.x >> 10u) | (y.y << 22u), y.y >> 10u);
    let rest = y.x & 1023u;
    if rest > 512u || (rest == 512u && (mantissa.x & 1u) == 1u) {
        mantissa = wide_sum(mantissa, vec2u(1u, 0u));
        if mantissa.y == 0x200000u {
            mantissa = vec2u(0u, 0x100000u);
            e += 1;
        }
    }
    return Double(mantissa, e + 10, negative);
}

fn plus(a: Double, b: Double) -> Double {
    if is_zero(a) {
        return b;
    }
    if is_zero(b) {
        return a;
    }
    var large = a;
    var small = b;
    if b.exponent > a.exponent || (b.exponent == a.exponent && wide_less(a.mantissa, b.mantissa)) {
        large = b;
        small = a;
    }
    let apart = u32(min(large.exponent - small.exponent, 64));
    let x = wide_left(large.mantissa, 10u);
    let y = wide_right(wide_left(small.mantissa, 10u), apart);
    if large.negative == small.negative {
        return rounded(large.negative, large.exponent - 10, wide_sum(x, y));
    }
    return rounded(large.negative, large.exponent - 10, wide_difference(x, y));
}

fn times(a: Double, b: Double) -> Double {
    if is_zero(a) || is_zero(b) {
        return ZERO;
    }
    let low = wide_product(a.mantissa.x, b.mantissa.x);
    let one = wide_product(a.mantissa.x, b.mantissa.y);
    let other = wide_product(a.mantissa.y, b.mantissa.x);
    let high = wide_product(a.mantissa.y, b.mantissa.y);
    let second = wide_sum(wide_sum(vec2u(low.y, 0u), vec2u(one.x, 0u)), vec2u(other.x, 0u));
    let upper = wide_sum(wide_sum(high, vec2u(second.y, 0u)), wide_sum(vec2u(one.y, 0u), vec2u(other.y, 0u)));
    // 106 bits, of which the lowest 42 leave their mark.
    let lost = low.x != 0u || (second.x & 1023u) != 0u;
    let x = vec2u((second.x >> 10u) | (upper.x << 22u), (upper.x >> 10u) | (upper.y << 22u));
    return rounded(a.negative != b.negative, a.exponent + b.exponent + 42, vec2u(x.x | select(0u, 1u, lost), x.y));
}

fn opposite(a: Double) -> Double {
    return Double(a.mantissa, a.exponent, !a.negative);
}

fn absolute(a: Double) -> Double {
    return Double(a.mantissa, a.exponent, false);
}

fn less(a: Double, b: Double) -> bool {
    let difference = plus(a, opposite(b));
    return difference.negative && !is_zero(difference);
}

fn scaled(negative: bool, whole: u32, exponent: i32) -> Double {
    if whole == 0u {
        return ZERO;
    }
    let by = 52u - firstLeadingBit(whole);
    return Double(wide_left(vec2u(whole, 0u), by), exponent - i32(by), negative);
}

// Of a single's bits.
fn double_of(bits: u32) -> Double {
    let exponent = i32((bits >> 23u) & 255u);
    let fraction = bits & 0x7fffffu;
    let negative = (bits >> 31u) == 1u;
    if exponent == 0 {
        return scaled(negative, fraction, -149);
    }
    return scaled(negative, fraction | 0x800000u, exponent - 150);
}

// As single precision holds it.
fn single(a: Double) -> Double {
    if is_zero(a) {
        return a;
    }
    // So many bits too many; more of them where the number is so small that single precision runs out of exponents.
    let over = max(29, -149 - a.exponent);
    if over > 54 {
        return ZERO;
    }
    let x = wide_right(a.mantissa, u32(over) - 2u);
    var whole = (x.x >> 2u) | (x.y << 30u);
    let rest = x.x & 3u;
    if rest == 3u || (rest == 2u && (whole & 1u) == 1u) {
        whole += 1u;
    }
    return scaled(a.negative, whole, a.exponent + over);
}
