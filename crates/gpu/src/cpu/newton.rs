//! What the stages of Newton's method share: twin of `shader/shared/newton.wgsl`, `free.wgsl`, `segments.wgsl`.

use super::sum::THREADS;

/// Nodes of a window, whose segments are summed by a workgroup.
pub const WINDOW: usize = 256;

pub fn is_positive(number: f32) -> bool {
    number > 0.0 && number.is_finite()
}

/// Whether node `i` is free: a bit each.
pub fn is_free(free: &[u32], i: usize) -> bool {
    free[i / 32] >> (i % 32) & 1 == 1
}

/// The nodes of a thread of a workgroup, of so many workgroups.
pub fn nodes_of(group: usize, thread: usize, workgroups: usize, nodes: usize) -> impl Iterator<Item = usize> {
    (THREADS * group + thread..nodes).step_by(THREADS * workgroups)
}

/// Sets `totals` to the sums over the segments of all windows: `blocks` has the segment of each node.
pub fn sum_segments(blocks: &[u32], value: impl Fn(usize) -> [f32; 4], totals: &mut [[f32; 4]]) {
    for first in (0..blocks.len()).step_by(WINDOW) {
        let segments = &blocks[first..(first + WINDOW).min(blocks.len())];
        let mut values: Vec<[f32; 4]> = (0..segments.len()).map(|t| value(first + t)).collect();
        let mut reach = 1;
        while reach < WINDOW {
            // Each adds what stood there before this round.
            for t in 0..segments.len() {
                if t + reach < segments.len() && segments[t + reach] == segments[t] {
                    let other = values[t + reach];
                    values[t].iter_mut().zip(other).for_each(|(value, other)| *value += other);
                }
            }
            reach *= 2;
        }
        for t in 0..segments.len() {
            if t == 0 || segments[t - 1] != segments[t] {
                totals[segments[t] as usize] = values[t];
            }
        }
    }
}

/// The first three numbers.
pub fn xyz([x, y, z, _]: [f32; 4]) -> [f32; 3] {
    [x, y, z]
}

/// With a fourth number of zero.
pub fn padded([x, y, z]: [f32; 3]) -> [f32; 4] {
    [x, y, z, 0.0]
}
