// Proximal weights as integers, so that their sums do not depend on the order of additions.

// Units of a weight of 1. Sums are exact up to 2^14, and one part counts at most 128: nothing overflows with
// 128 parts.
const WEIGHT_UNITS: f32 = 262144.0;
const MOST: f32 = 128.0;

fn weight_units(weight: f32) -> u32 {
    return u32(clamp(weight, 0.0, MOST) * WEIGHT_UNITS);
}
