//! What the kernels of elements' energies share: twin of `shader/shared/energies.wgsl`.

use super::elements::way;
use super::parts::{Part, put_parts};
use super::terms::less;
use super::{scaled, to_f32};
use crate::bound::Bound;
use crate::potential::EnergyParams;
use bytemuck::Pod;

type V3 = [f32; 3];

/// Where the elements are.
pub struct States<'a> {
    pub params: EnergyParams,
    pub reference: &'a [[i32; 4]],
    pub trial: &'a [[i32; 4]],
    pub start: &'a [[i32; 4]],
}

impl States<'_> {
    pub fn way(&self, a: u32, b: u32) -> V3 {
        scaled(to_f32(way(self.reference, a, b)), self.params.quantum)
    }

    /// How much the way from node a to node b has changed since the start of the time step.
    pub fn moved(&self, a: u32, b: u32) -> V3 {
        let way = less(way(self.reference, a, b), way(self.start, a, b));
        scaled(to_f32(way), self.params.quantum)
    }

    /// How much it changes from the reference to the trial.
    pub fn change(&self, a: u32, b: u32) -> V3 {
        let way = less(way(self.trial, a, b), way(self.reference, a, b));
        scaled(to_f32(way), self.params.quantum)
    }
}

/// Writes the partial sums of the elements' energies.
pub fn write<T: Pod>(buffers: Bound<'_>, energy: impl Fn(&T, &States<'_>) -> Part) {
    let states = States {
        params: buffers.params(),
        reference: &buffers.read(1),
        trial: &buffers.read(2),
        start: &buffers.read(3),
    };
    let elements = buffers.read(0);
    put_parts(states.params, &mut buffers.write(4), |e| energy(&elements[e], &states));
}
