//! Minimum and maximum in one instruction.

/// The smaller of two numbers; `b` where one is not a number. `f32::min` and `f64::min` take several
/// instructions.
#[inline(always)]
pub fn smaller<T: PartialOrd>(a: T, b: T) -> T {
    if a < b { a } else { b }
}

/// The larger of two numbers; `b` where one is not a number.
#[inline(always)]
pub fn larger<T: PartialOrd>(a: T, b: T) -> T {
    if a > b { a } else { b }
}
