//! What the kernels of the preconditioner's groups share: twin of `shader/shared/groups.wgsl`.

use super::{added, crossed, scaled, subtracted, to_f32};

pub type V3 = [f32; 3];

/// A matrix by its columns.
pub type M3 = [V3; 3];

/// The way between two places of the grid.
pub fn between(a: [i32; 3], b: [i32; 3], quantum: f32) -> V3 {
    scaled(to_f32([0, 1, 2].map(|k| b[k].wrapping_sub(a[k]))), quantum)
}

/// The place of a node.
pub fn place([x, y, z, _]: [i32; 4]) -> [i32; 3] {
    [x, y, z]
}

/// H times the map from a spin to the displacement at an arm.
pub fn times_spin(h: &M3, arm: V3) -> M3 {
    let column = |a: usize, b: usize| subtracted(scaled(h[a], arm[b]), scaled(h[b], arm[a]));
    [column(2, 1), column(0, 2), column(1, 0)]
}

/// Moments of forces, which are columns, at an arm.
pub fn moments(arm: V3, f: &M3) -> M3 {
    f.map(|force| crossed(arm, force))
}

pub fn sum(a: &M3, b: &M3) -> M3 {
    [0, 1, 2].map(|k| added(a[k], b[k]))
}

pub fn difference(a: &M3, b: &M3) -> M3 {
    [0, 1, 2].map(|k| subtracted(a[k], b[k]))
}
