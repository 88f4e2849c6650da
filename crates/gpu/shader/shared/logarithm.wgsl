// log(1 + x) for x > -1 to a few ulp of its own, also near 0: the functions of the language have an absolute
// error there.
fn log_1p(x: f32) -> f32 {
    let bits = bitcast<u32>(max(1.0 + x, 1e-30));
    var exponent = i32(bits >> 23u) - 127;
    var mantissa = bitcast<f32>((bits & 0x7fffffu) | 0x3f800000u);
    if mantissa > 1.41421356 {
        mantissa *= 0.5;
        exponent += 1;
    }
    // 1 + x = mantissa 2^exponent, and log(mantissa) = 2 artanh(z).
    var z = x / (2.0 + x);
    if exponent != 0 {
        z = (mantissa - 1.0) / (mantissa + 1.0);
    }
    let s = z * z;
    let series = 1.0 + s * (0.33333333 + s * (0.2 + s * (0.14285714 + s * 0.11111111)));
    return f32(exponent) * 0.6931472 + 2.0 * z * series;
}
