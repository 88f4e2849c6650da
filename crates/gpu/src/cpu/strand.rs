//! Twin of `shader/strand.wgsl`, and what the kernels of strands share: `shader/shared/strand.wgsl`.

use super::elements::{Elements, MIN_RATIO, length};
use super::{divided, dot, scaled, subtracted};
use crate::assembly::{Curvature, Strand};
use crate::bound::Bound;

type V3 = [f32; 3];

impl Strand {
    pub fn is_edge(&self) -> bool {
        self.nodes[0] == self.nodes[1]
    }

    /// w, or a change of it, of the ways (or their changes) from node 0 to node 1 and from node 1 to node 2.
    pub fn jump(&self, way: impl Fn(u32, u32) -> V3) -> V3 {
        let [a, b, c] = self.nodes;
        subtracted(scaled(way(b, c), self.inverse_lengths[1]), scaled(way(a, b), self.inverse_lengths[0]))
    }

    /// The unit vector along w, of that length.
    pub fn along(&self, w: V3, size: f32) -> V3 {
        if size > 0.0 { divided(w, size) } else { [if self.is_edge() { 1.0 } else { 0.0 }, 0.0, 0.0] }
    }

    /// The weights of w by node.
    pub fn weights(&self) -> V3 {
        let [a, c] = self.inverse_lengths;
        [a, -(a + c), c]
    }
}

pub fn bound(buffers: Bound<'_>) {
    let elements = Elements {
        params: buffers.params(),
        positions: &buffers.read(1),
        start: &buffers.read(2),
        blocks: &mut buffers.write(3),
    };
    strand(&buffers.read(0), elements, &mut buffers.write(4));
}

pub fn strand(strands: &[Strand], mut elements: Elements<'_>, curvatures: &mut [Curvature]) {
    let params = elements.params;
    for (e, strand) in strands.iter().enumerate().take(params.elements as usize) {
        let w = strand.jump(|a, b| elements.way(a, b));
        let size = length(w);
        let along = strand.along(w, size);
        let (mut axial, mut across) = (1.0, 1.0);
        if strand.rest > 0.0 {
            across = 1.0 - strand.rest / size.max(MIN_RATIO * strand.rest);
        }
        if strand.damping > 0.0 && params.rate > 0.0 {
            let factor = strand.damping * params.rate;
            if strand.is_edge() {
                let turned = strand.jump(|a, b| elements.moved(a, b));
                let strain = 0.5 * factor * dot(turned, subtracted(scaled(w, 2.0), turned));
                axial += factor * size * size + strain;
                across += strain;
            } else {
                axial += factor;
                across += factor;
            }
        }
        axial = strand.stiffness * elements.filtered(axial);
        across = strand.stiffness * elements.filtered(across);
        curvatures[e] = Curvature { along, axial: axial - across, across };
        let weights = strand.weights();
        let mut block = 3 * e;
        for a in 0..3 {
            for b in a + 1..3 {
                let weight = weights[a] * weights[b];
                let shift = scaled(along, weight * (axial - across));
                let mut columns = along.map(|component| scaled(shift, component));
                (0..3).for_each(|k| columns[k][k] += weight * across);
                elements.put(block, columns);
                block += 1;
            }
        }
    }
}
