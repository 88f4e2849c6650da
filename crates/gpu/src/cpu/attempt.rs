//! Twin of `shader/attempt.wgsl`.

use super::newton::{is_free, nodes_of, xyz};
use super::sum::{THREADS, sum_of_threads};
use super::{added, difference, dot, largest, scaled};
use crate::bound::Bound;
use bytemuck::{Pod, Zeroable};

/// Largest coordinate.
const REACH: i32 = (1 << 29) - 1;

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub workgroups: u32,
    pub imposed: u32,
    pub scale: f32,
}

pub fn bound(buffers: Bound<'_>) {
    let line = Line {
        iterate: &buffers.read(0),
        imposed: &buffers.read(1),
        free: &buffers.read(2),
        step: &buffers.read(3),
        right_side: &buffers.read(4),
        target_start: &buffers.read(5),
    };
    attempt(buffers.params(), &line, &mut buffers.write(6), &mut buffers.write(7));
}

pub struct Line<'a> {
    pub iterate: &'a [[i32; 4]],
    pub imposed: &'a [[i32; 4]],
    pub free: &'a [u32],
    pub step: &'a [[f32; 4]],
    pub right_side: &'a [[f32; 4]],
    pub target_start: &'a [[i32; 4]],
}

impl Line<'_> {
    /// The trial of a free node, and its largest coordinate before it is clamped.
    fn moved(&self, scale: f32, i: usize) -> ([i32; 4], f32) {
        let x = self.iterate[i];
        if scale == 0.0 {
            return (x, 0.0);
        }
        let way = scaled(xyz(self.step[i]), scale);
        let reached = largest(added([0, 1, 2].map(|k| x[k] as f32), way));
        let limit = 2.0 * REACH as f32;
        let end = |k: usize| {
            let way = way[k].clamp(-limit, limit).round_ties_even() as i32;
            (x[k] + way).clamp(-REACH, REACH)
        };
        ([end(0), end(1), end(2), 0], reached)
    }
}

pub fn attempt(params: Params, line: &Line<'_>, trial: &mut [[i32; 4]], sums: &mut [f32]) {
    let workgroups = params.workgroups as usize;
    for group in 0..workgroups {
        let mut product = [0.0; THREADS];
        let mut found = [0.0f32; 4];
        for (t, product) in product.iter_mut().enumerate() {
            for i in nodes_of(group, t, workgroups, params.nodes as usize) {
                let (x, p) = (line.iterate[i], xyz(line.step[i]));
                *product += dot(p, xyz(line.right_side[i]));
                trial[i] = [x[0], x[1], x[2], 0];
                if is_free(line.free, i) {
                    let (y, reached) = line.moved(params.scale, i);
                    trial[i] = [y[0], y[1], y[2], 0];
                    let [way, all] = [x, line.target_start[i]].map(|from| difference(y, from));
                    let values = [largest(p), dot(way, way), dot(all, all), reached];
                    found.iter_mut().zip(values).for_each(|(found, value)| *found = found.max(value));
                } else if params.imposed == 1 {
                    (0..3).for_each(|k| trial[i][k] += line.imposed[i][k]);
                }
            }
        }
        sums[8 * group] = sum_of_threads(product);
        sums[8 * group + 1..8 * group + 5].copy_from_slice(&found);
    }
}
