//! A logarithm that is accurate near 1: twin of `shader/shared/logarithm.wgsl`.

/// log(1 + x) for x > -1 to a few ulp of its own.
pub fn log_1p(x: f32) -> f32 {
    let bits = (1.0 + x).max(1e-30).to_bits();
    let mut exponent = (bits >> 23) as i32 - 127;
    let mut mantissa = f32::from_bits((bits & 0x007f_ffff) | 0x3f80_0000);
    if mantissa > std::f32::consts::SQRT_2 {
        mantissa *= 0.5;
        exponent += 1;
    }
    let z = if exponent == 0 { x / (2.0 + x) } else { (mantissa - 1.0) / (mantissa + 1.0) };
    let s = z * z;
    let series = 1.0 + s * (0.333_333_33 + s * (0.2 + s * (0.142_857_14 + s * 0.111_111_11)));
    exponent as f32 * std::f32::consts::LN_2 + 2.0 * z * series
}

#[cfg(test)]
mod tests {
    use super::log_1p;

    #[test]
    fn the_logarithm_has_a_small_relative_error_everywhere() {
        let worst = (1..2_000_000).map(|k| {
            let size = (f64::from(k) / 1e5 - 12.0).exp();
            [size, -size].map(|x| x as f32).into_iter().filter(|x| *x > -0.999).fold(0.0, |worst: f64, x| {
                let expected = f64::from(x).ln_1p();
                worst.max((f64::from(log_1p(x)) / expected - 1.0).abs())
            })
        });
        let worst = worst.fold(0.0, f64::max);
        // 1 + x is rounded below the root of 1/2, where the logarithm has a size of at least 0.34.
        assert!(worst < 6e-7, "{worst:e}");
        assert!(log_1p(0.0) == 0.0 && log_1p(1e-20) == 1e-20);
    }
}
