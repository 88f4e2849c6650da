//! Twin of `shader/node_energy.wgsl`.

use super::parts::{Part, part, put_parts};
use super::terms::{between, less};
use super::{added, dot, scaled, to_f32};
use crate::bound::Bound;
use crate::potential::{EnergyParams, Pair, Terms};

type V3 = [f32; 3];

pub fn bound(buffers: Bound<'_>) {
    let nodes = Nodes {
        params: buffers.params(),
        ranges: &buffers.read(0),
        pairs: &buffers.read(1),
        terms: &buffers.read(2),
        reference: &buffers.read(3),
        trial: &buffers.read(4),
        start: &buffers.read(5),
    };
    put_parts(nodes.params, &mut buffers.write(6), |i| nodes.energy(i));
}

pub struct Nodes<'a> {
    pub params: EnergyParams,
    pub ranges: &'a [[u32; 4]],
    pub pairs: &'a [Pair],
    pub terms: &'a [Terms],
    pub reference: &'a [[i32; 4]],
    pub trial: &'a [[i32; 4]],
    pub start: &'a [[i32; 4]],
}

fn absolute(v: V3) -> V3 {
    v.map(f32::abs)
}

impl Nodes<'_> {
    fn energy(&self, i: usize) -> Part {
        let [_, _, first, end] = self.ranges[i].map(|place| place as usize);
        let quantum = self.params.quantum;
        let own = between(self.start[i], self.reference[i]);
        let own_step = between(self.reference[i], self.trial[i]);
        let (d, u) = (scaled(to_f32(own), quantum), scaled(to_f32(own_step), quantum));
        let (mut before, mut middle_sum, mut size) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        for pair in &self.pairs[first..end] {
            let k = pair.node as usize;
            let factor = quantum * pair.value;
            let x = scaled(to_f32(less(between(self.start[k], self.reference[k]), own)), factor);
            let y = scaled(to_f32(less(between(self.reference[k], self.trial[k]), own_step)), factor);
            before = added(before, x);
            middle_sum = added(middle_sum, added(x, scaled(y, 0.5)));
            size = added(size, added(absolute(x), absolute(y)));
        }
        let terms = &self.terms[i];
        let sizes = Terms { row_sum: terms.row_sum.map(f32::abs), linear: absolute(terms.linear) };
        let middle = added(d, scaled(u, 0.5));
        let whole = added(absolute(d), absolute(u));
        part([
            dot(d, added(scaled(added(terms.row_sum_times(d), before), 0.5), terms.linear)),
            dot(u, added(added(terms.row_sum_times(middle), middle_sum), terms.linear)),
            dot(absolute(u), added(added(sizes.row_sum_times(whole), size), sizes.linear)),
        ])
    }
}
