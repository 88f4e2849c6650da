//! What the gradient by a node sums, in a fixed order: gradients of elements, and entries of K.

use super::layout::Pair;
use crate::layout::NONE;
use bowknot_dynamics::ElementModel;

/// Nodes of an element of each kind, in the order in which their gradients lie: membranes, bends, tetrahedra,
/// strands.
pub const NODES: [usize; 4] = [3, 6, 4, 3];

/// The lists of a model.
#[derive(Debug, Default)]
pub struct Lists {
    /// Of each node: its first source and their end.
    pub source_ranges: Vec<[u32; 2]>,
    /// Places of the gradients of elements by the node.
    pub sources: Vec<u32>,
}

impl Lists {
    pub fn new(model: &ElementModel) -> Self {
        let mut sums: Vec<Vec<u32>> = vec![Vec::new(); model.rest.len()];
        let mut next = 0;
        let mut add = |nodes: &[u32]| {
            for &node in nodes {
                if node != NONE {
                    sums[node as usize].push(next);
                }
                next += 1;
            }
        };
        model.membranes.iter().for_each(|element| add(&element.nodes));
        model.bends.iter().for_each(|element| add(&element.nodes));
        model.tetrahedra.iter().for_each(|element| add(&element.nodes));
        model.strands.iter().for_each(|element| add(&element.nodes));
        let mut end = 0;
        let source_ranges = sums.iter().map(|sum| {
            let first = end;
            end += sum.len() as u32;
            [first, end]
        });
        Self { source_ranges: source_ranges.collect(), sources: sums.concat() }
    }
}

/// The rows of K: of each node its first entry and their end, and the entries. Entries of the pattern that
/// are zero are left out: bending joins few of the pairs that elements join.
pub fn rows(model: &ElementModel, bending: &[f64], scalars: &[f64]) -> (Vec<[u32; 2]>, Vec<Pair>) {
    let mut pairs = Vec::new();
    let ranges = (0..model.rest.len()).map(|i| {
        let first = pairs.len() as u32;
        let parts = [
            (&model.starts, &model.columns, bending),
            (&model.scalar_starts, &model.scalar_columns, scalars),
        ];
        for (starts, columns, values) in parts {
            let row = starts[i] as usize..starts[i + 1] as usize;
            for (&node, &value) in columns[row.clone()].iter().zip(&values[row]) {
                if value != 0.0 {
                    pairs.push(Pair { node, value: value as f32 });
                }
            }
        }
        [first, pairs.len() as u32]
    });
    (ranges.collect(), pairs)
}
