//! How stiff the bodies are at each node, at rest.

use crate::elements::filter::Filter;
use crate::elements::set::{AnyElementSet, Motion, Rows};
use crate::linear::block::{BlockPattern, BlockValues};
use crate::linear::scalar::ScalarForm;
use crate::nodes::CHUNK;
use bowknot_geometry::Vector;

/// Stiffness of each node at rest in its softest direction [N/m], while its neighbors do not move: that of
/// bending for cloth and strands.
pub(super) fn softest(
    rest: &[Vector],
    element_sets: &[Box<dyn AnyElementSet>],
    pattern: &BlockPattern,
    bending: &ScalarForm,
) -> Vec<[f64; 2]> {
    let mut values = BlockValues::zeros(pattern);
    let mut gradient = vec![Vector::zeros(); rest.len()];
    let motion = Motion { x: rest, start: rest, rate: 0.0 };
    let mut blocks = values.blocks.as_mut_slice();
    let chunks = gradient.chunks_mut(CHUNK).zip(values.diagonal.chunks_mut(CHUNK));
    for (chunk, (gradient, diagonal)) in chunks.enumerate() {
        let nodes = chunk * CHUNK..chunk * CHUNK + gradient.len();
        let (first_block, end_block) =
            (pattern.starts[nodes.start] as usize, pattern.starts[nodes.end] as usize);
        let (mine, others) = blocks.split_at_mut(end_block - first_block);
        blocks = others;
        let mut rows = Rows { nodes, gradient, diagonal, blocks: mine, first_block };
        element_sets.iter().for_each(|set| {
            set.linearize(chunk, motion, Filter::Clamp, &mut rows);
        });
    }
    let of_node = |(block, bending): (&nalgebra::Matrix3<f64>, &f64)| {
        let values = block.symmetric_eigenvalues();
        [values.min().max(0.0) + bending, values.max().max(0.0) + bending]
    };
    values.diagonal.iter().zip(&bending.diagonal).map(of_node).collect()
}
