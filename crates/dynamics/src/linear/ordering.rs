//! Numbering of nodes along the mesh, so that ranges of numbers are compact patches.
//!
//! Nodes are sorted by connected component, then by recursive bisection of the rest positions at the median
//! of the longest side. Neighbors are then close in memory, and the leaves serve as aggregates.

use bowknot_geometry::{UnionFind, Vector};
use std::ops::Range;

/// A numbering and its leaves.
pub(crate) struct Ordering {
    /// Old index of each new index.
    pub order: Vec<u32>,
    /// Consecutive ranges of new indices, each at most `leaf` long and within one component.
    pub leaves: Vec<Range<u32>>,
    /// Consecutive ranges of new indices, one per connected component.
    pub components: Vec<Range<u32>>,
}

/// Orders the nodes at `positions`; `for_each_link` calls its argument with each pair of nodes that are
/// joined.
pub(crate) fn order_nodes(
    positions: &[Vector],
    leaf: usize,
    for_each_link: impl FnOnce(&mut dyn FnMut(u32, u32)),
) -> Ordering {
    let count = positions.len();
    let mut sets = UnionFind::new(count);
    // The smallest node represents a component, so that components are in the order of their first node.
    for_each_link(&mut |a, b| sets.join(a, b));
    let mut order: Vec<u32> = (0..count as u32).collect();
    let component: Vec<u32> = (0..count as u32).map(|n| sets.find(n)).collect();
    order.sort_by_key(|&n| component[n as usize]);

    let (mut leaves, mut components) = (Vec::new(), Vec::new());
    let mut begin = 0;
    while begin < count {
        let this = component[order[begin] as usize];
        let length = order[begin..].iter().take_while(|&&n| component[n as usize] == this).count();
        bisect(&mut order[begin..begin + length], begin as u32, positions, leaf, &mut leaves);
        components.push(begin as u32..(begin + length) as u32);
        begin += length;
    }
    Ordering { order, leaves, components }
}

fn bisect(nodes: &mut [u32], first: u32, positions: &[Vector], leaf: usize, leaves: &mut Vec<Range<u32>>) {
    if nodes.len() <= leaf {
        nodes.sort_unstable();
        leaves.push(first..first + nodes.len() as u32);
        return;
    }
    let (mut low, mut high) = (Vector::repeat(f64::INFINITY), Vector::repeat(f64::NEG_INFINITY));
    for &n in nodes.iter() {
        low = low.inf(&positions[n as usize]);
        high = high.sup(&positions[n as usize]);
    }
    let axis = (high - low).imax();
    let middle = nodes.len() / 2;
    // Ties are broken by index, so that both halves are the same sets whatever order the selection leaves.
    nodes.select_nth_unstable_by(middle, |&a, &b| {
        positions[a as usize][axis].total_cmp(&positions[b as usize][axis]).then(a.cmp(&b))
    });
    let (left, right) = nodes.split_at_mut(middle);
    let split = first + left.len() as u32;
    bisect(left, first, positions, leaf, leaves);
    bisect(right, split, positions, leaf, leaves);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leaves_partition_the_nodes_and_stay_within_components() {
        // Two interleaved chains: even and odd nodes.
        let positions: Vec<Vector> = (0..200).map(|i| Vector::new(i as f64, 0.0, 0.0)).collect();
        let ordering = order_nodes(&positions, 16, |link| (0..198).for_each(|i| link(i, i + 2)));
        let mut seen = ordering.order.clone();
        seen.sort_unstable();
        assert!(seen.iter().enumerate().all(|(i, &n)| i as u32 == n), "a permutation");
        let mut end = 0;
        for leaf in &ordering.leaves {
            assert_eq!(leaf.start, end);
            end = leaf.end;
            assert!(leaf.len() <= 16);
            let nodes = &ordering.order[leaf.start as usize..leaf.end as usize];
            assert!(nodes.iter().all(|n| n % 2 == nodes[0] % 2), "{nodes:?} mixes components");
        }
        assert_eq!(end, 200);
        assert_eq!(ordering.components, [0..100, 100..200]);
    }
}
