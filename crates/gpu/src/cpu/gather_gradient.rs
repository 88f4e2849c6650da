//! Twin of `shader/gather_gradient.wgsl`.

use super::terms::{between, less};
use super::{added, scaled, to_f32};
use crate::bound::Bound;
use crate::potential::{NodeParams, Pair, Terms};

pub fn bound(buffers: Bound<'_>) {
    let nodes = Nodes {
        ranges: &buffers.read(0),
        sources: &buffers.read(1),
        gradients: &buffers.read(2),
        pairs: &buffers.read(3),
        terms: &buffers.read(4),
        positions: &buffers.read(5),
        start: &buffers.read(6),
    };
    gather_gradient(buffers.params(), &nodes, &mut buffers.write(7));
}

pub struct Nodes<'a> {
    pub ranges: &'a [[u32; 4]],
    pub sources: &'a [u32],
    pub gradients: &'a [[f32; 3]],
    pub pairs: &'a [Pair],
    pub terms: &'a [Terms],
    pub positions: &'a [[i32; 4]],
    pub start: &'a [[i32; 4]],
}

pub fn gather_gradient(params: NodeParams, nodes: &Nodes<'_>, gradient: &mut [[f32; 4]]) {
    let moved = |i: usize| between(nodes.start[i], nodes.positions[i]);
    for (i, gradient) in gradient.iter_mut().enumerate().take(params.nodes as usize) {
        let range = nodes.ranges[i].map(|place| place as usize);
        let own = moved(i);
        let terms = &nodes.terms[i];
        let mut sum = added(terms.row_sum_times(scaled(to_f32(own), params.quantum)), terms.linear);
        for pair in &nodes.pairs[range[2]..range[3]] {
            let other = moved(pair.node as usize);
            sum = added(sum, scaled(to_f32(less(other, own)), params.quantum * pair.value));
        }
        for source in &nodes.sources[range[0]..range[1]] {
            sum = added(sum, nodes.gradients[*source as usize]);
        }
        *gradient = [sum[0], sum[1], sum[2], 0.0];
    }
}
