//! Which nodes belong to strands.

use crate::custom::set::CustomSet;
use crate::elements::set::{AnyElementSet, ElementKind};
use bowknot_geometry::UnionFind;

/// For each of `count` nodes, whether it belongs to strands only: these are solved exactly. Custom elements
/// within one strand belong to it. Others would join many strands to a large system, for which that is no
/// good method.
pub(super) fn strand_nodes(
    element_sets: &[Box<dyn AnyElementSet>],
    custom: Option<&CustomSet>,
    count: usize,
) -> Vec<bool> {
    let is_strand = |kind| matches!(kind, ElementKind::StrandStretching | ElementKind::StrandBending);
    let mut strands = joined(element_sets, count, is_strand);
    let mut others = joined(element_sets, count, |kind| !is_strand(kind));
    if let Some(custom) = custom {
        let mut sets = UnionFind::new(count);
        for set in element_sets.iter().filter(|set| is_strand(set.kind())) {
            set.for_each_clique(&mut |clique| clique.windows(2).for_each(|pair| sets.join(pair[0], pair[1])));
        }
        custom.for_each_clique(&mut |clique| {
            let within = clique.iter().all(|&node| sets.find(node) == sets.find(clique[0]));
            clique.iter().filter(|_| !within).for_each(|&node| others[node as usize] = true);
        });
    }
    strands.iter_mut().zip(&others).for_each(|(strand, other)| *strand &= !other);
    strands
}

/// For each of `nodes` nodes, whether it belongs to an element of one of the `kinds`.
fn joined(
    element_sets: &[Box<dyn AnyElementSet>],
    nodes: usize,
    kinds: impl Fn(ElementKind) -> bool,
) -> Vec<bool> {
    let mut joined = vec![false; nodes];
    for set in element_sets.iter().filter(|set| kinds(set.kind())) {
        set.for_each_clique(&mut |clique| clique.iter().for_each(|&n| joined[n as usize] = true));
    }
    joined
}
