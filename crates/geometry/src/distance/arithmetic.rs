//! Small operations that the pair kinds share.

use super::rescale::{MAX_SCALE, MIN_SCALE, norm_of_tiny};
use crate::point::Vector;
use std::hint::select_unpredictable;

/// Clamps to [0, 1]; not-a-number (0/0 of a zero-length edge) becomes 0. It compiles to two instructions;
/// `f64::max` needs more, because it treats not-a-number in both operands.
#[inline(always)]
pub(super) fn clamp_unit(t: f64) -> f64 {
    let t = if t > 0.0 { t } else { 0.0 };
    if t < 1.0 { t } else { 1.0 }
}

/// One of two vectors, without a branch, because a branch could not be predicted.
#[inline(always)]
pub(super) fn select(condition: bool, yes: Vector, no: Vector) -> Vector {
    yes.zip_map(&no, |y, n| select_unpredictable(condition, y, n))
}

/// Length of a vector whose squares may underflow.
#[inline(always)]
pub(crate) fn norm(v: &Vector, norm_squared: f64) -> f64 {
    // Below this the smallest square may have lost bits to underflow.
    const SAFE: f64 = 1e-280;
    if norm_squared > SAFE { norm_squared.sqrt() } else { norm_of_tiny(v) }
}

/// Whether squares and fourth powers of a pair's differences neither overflow nor underflow. `squares` is a
/// sum of squares that bounds all of them within a small factor.
#[inline(always)]
pub(super) fn in_range(squares: f64) -> bool {
    squares > MIN_SCALE * MIN_SCALE && squares < MAX_SCALE * MAX_SCALE
}
