//! The map from numbers to colors, which is perceptually uniform.

/// Coefficients of t^0 .. t^6 for red, green and blue of viridis: a fit by Matt Zucker (2019, CC0,
/// <https://www.shadertoy.com/view/WlfXRN>) to the map of Stéfan van der Walt and Nathaniel Smith (2015,
/// CC0). Its error is at most 0.013 of full intensity.
const VIRIDIS: [[f64; 3]; 7] = [
    [0.277_727_327_223_417_7, 0.005_407_344_544_966_578, 0.334_099_805_335_306_1],
    [0.105_093_043_108_577_4, 1.404_613_529_898_575, 1.384_590_162_594_685],
    [-0.330_861_828_725_556_3, 0.214_847_559_468_213, 0.095_095_163_028_236_59],
    [-4.634_230_498_983_486, -5.799_100_973_351_585, -19.332_440_956_279_87],
    [6.228_269_936_347_081, 14.179_933_366_805_09, 56.690_552_600_681_05],
    [4.776_384_997_670_288, -13.745_145_377_746_01, -65.353_032_633_372_34],
    [-5.435_455_855_934_631, 4.645_852_612_178_535, 26.312_435_249_583_2],
];

/// The color of `t` in [0, 1], from dark violet to yellow, as sRGB in [0, 1]. Values outside have the
/// colors of the ends.
pub fn viridis(t: f64) -> [f64; 3] {
    let t = t.clamp(0.0, 1.0);
    let channel = |c: usize| VIRIDIS.iter().rev().fold(0.0, |sum, row| sum * t + row[c]).clamp(0.0, 1.0);
    [channel(0), channel(1), channel(2)]
}

/// sRGB in [0, 1] to linear light (IEC 61966-2-1).
pub fn to_linear(srgb: f64) -> f64 {
    if srgb <= 0.040_45 { srgb / 12.92 } else { ((srgb + 0.055) / 1.055).powf(2.4) }
}

/// Linear light in [0, 1] to sRGB.
pub fn to_srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests;
