//! Operations on vectors with one entry per node. Sums do not depend on the number of threads.
//!
//! Partial sums run over fixed chunks and are added in order.

use crate::nodes::CHUNK;
use bowknot_geometry::Vector;
use rayon::prelude::*;

/// sum a_i . b_i.
pub(crate) fn dot(a: &[Vector], b: &[Vector]) -> f64 {
    let partial: Vec<f64> =
        a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK)).map(|(a, b)| chunk_dot(a, b)).collect();
    partial.iter().sum()
}

/// sum a_i . b_i over one chunk, serially.
#[inline]
pub(crate) fn chunk_dot(a: &[Vector], b: &[Vector]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}

/// y += s x.
pub(crate) fn add_scaled(y: &mut [Vector], s: f64, x: &[Vector]) {
    y.par_chunks_mut(CHUNK).zip(x.par_chunks(CHUNK)).for_each(|(y, x)| {
        y.iter_mut().zip(x).for_each(|(y, x)| *y += x * s);
    });
}
