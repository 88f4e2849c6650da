//! The buffers of the potential of a model on an engine, and its dispatches.

use super::layout::{EnergyParams, GradientParams, NodeParams, Terms};
use super::layout::{MOST_WORKGROUPS, THREADS};
use super::lists::{Lists, NODES, rows};
use crate::assembly::{ElementBuffers, Written};
use crate::engine::Engine;
use crate::error::GpuError;
use crate::kernels;
use crate::recording::{BufferId, Recording};
use crate::stages::Stage;
use bowknot_dynamics::{ElementModel, NewtonStep};

/// The error of a change is at most so many units of 2^-24, the rounding of a number, of the sum of the sizes
/// of what it is made of. The kernels take these sizes before anything cancels: the stress of a strain counts
/// with all of the deformation, and not with the strain alone. Of single elements and nodes in random states
/// the error is at most half of this (a test measures it). Errors of many elements have either sign: they add
/// up like the root of the sum of squares. The additions of up to 16 terms by a thread, and those of twelve
/// levels of sums, have errors of some units of what the sums come to.
pub const ROUNDING_UNITS: f64 = 8.0;

/// Where the nodes are.
#[derive(Clone, Copy, Debug)]
pub struct Places {
    /// Positions, and those at the start of the time step: `vec4<i32>` per node, coordinates below 2^29 [N].
    pub positions: BufferId,
    /// See [`Self::positions`].
    pub start: BufferId,
    /// Their unit [m].
    pub quantum: f32,
}

/// A change of the potential.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PotentialChange {
    /// Potential at the reference, relative to the quadratic terms at the start of the time step [J].
    pub reference: f64,
    /// Change from the reference to the trial [J].
    pub change: f64,
    /// Error that rounding is likely to stay below in the change [J].
    pub rounding: f64,
}

/// The potential of the bodies of a model.
#[derive(Debug)]
pub struct Potential {
    nodes: usize,
    elements: ElementBuffers,
    /// Numbers of membranes, bends, tetrahedra and strands.
    counts: [usize; 4],
    /// Of each node: its first source and their end.
    source_ranges: Vec<[u32; 2]>,
    /// Numbers of K that were written last.
    stiffness: Option<(Vec<f64>, Vec<f64>)>,
    ranges: BufferId,
    sources: BufferId,
    pairs: BufferId,
    terms: Written,
    gradients: BufferId,
    pub(super) parts: BufferId,
    sums: BufferId,
    /// Workgroups that sum the parts.
    sum_count: usize,
    /// 1 / dt [1/s].
    rate: f32,
}

impl Potential {
    /// Makes the buffers of a model, whose elements stand in `elements`.
    ///
    /// # Errors
    /// A buffer is too large.
    pub fn new<E: Engine>(
        engine: &mut E,
        model: &ElementModel,
        elements: ElementBuffers,
    ) -> Result<Self, GpuError> {
        let nodes = model.rest.len();
        let counts = [model.membranes.len(), model.bends.len(), model.tetrahedra.len(), model.strands.len()];
        let lists = Lists::new(model);
        let gradients: usize = counts.iter().zip(NODES).map(|(count, nodes)| count * nodes).sum();
        let parts = part_count(counts, nodes);
        let potential = Self {
            nodes,
            elements,
            counts,
            stiffness: None,
            ranges: engine.buffer("ranges of nodes", 4 * nodes)?,
            sources: engine.buffer("sources of gradients", lists.sources.len())?,
            pairs: engine.buffer("entries of bending", 0)?,
            terms: Written::new(engine.buffer("quadratic terms", nodes * size_of::<Terms>() / 4)?),
            gradients: engine.buffer("gradients of elements", 3 * gradients)?,
            parts: engine.buffer("parts of energies", 4 * parts)?,
            sums: engine.buffer("sums of energies", 4 * parts.div_ceil(THREADS))?,
            sum_count: parts.div_ceil(THREADS),
            source_ranges: lists.source_ranges,
            rate: 0.0,
        };
        let mut recording = Recording::default();
        recording.write(potential.sources, &lists.sources);
        engine.run(&recording, &[])?;
        Ok(potential)
    }

    /// Frees the buffers.
    pub fn free<E: Engine>(self, engine: &mut E) {
        let own =
            [self.ranges, self.sources, self.pairs, self.terms.buffer, self.gradients, self.parts, self.sums];
        own.into_iter().for_each(|buffer| engine.free(buffer));
    }

    /// Records the writes of what is fixed in a time step, as far as it has changed.
    ///
    /// # Errors
    /// A buffer is too large.
    pub fn write_step<E: Engine>(
        &mut self,
        engine: &mut E,
        model: &ElementModel,
        step: &NewtonStep<'_>,
        recording: &mut Recording,
    ) -> Result<(), GpuError> {
        self.rate = step.rate as f32;
        let terms = step.row_sums.iter().zip(step.gradient).map(|(sum, linear)| {
            let half = |i: usize, j: usize| (0.5 * (sum[(i, j)] + sum[(j, i)])) as f32;
            Terms {
                row_sum: [half(0, 0), half(0, 1), half(0, 2), half(1, 1), half(1, 2), half(2, 2)],
                linear: [0, 1, 2].map(|k| linear[k] as f32),
            }
        });
        self.terms.write(&terms.collect::<Vec<_>>(), recording);
        let is_written = self
            .stiffness
            .as_ref()
            .is_some_and(|(bending, scalars)| bending == step.bending && scalars == step.scalars);
        if !is_written {
            let (ranges, pairs) = rows(model, step.bending, step.scalars);
            if engine.words(self.pairs) < 2 * pairs.len() {
                engine.free(self.pairs);
                self.pairs = engine.buffer("entries of bending", 2 * pairs.len())?;
            }
            let both = self.source_ranges.iter().zip(&ranges);
            let ranges: Vec<[u32; 4]> = both.map(|([a, b], [c, d])| [*a, *b, *c, *d]).collect();
            recording.write(self.ranges, &ranges);
            recording.write(self.pairs, &pairs);
            self.stiffness = Some((step.bending.to_vec(), step.scalars.to_vec()));
        }
        Ok(())
    }

    /// Records the gradient (R + K) d + c + sum of e' at some positions: `vec4<f32>` per node [N, N].
    pub fn record_gradient(&self, at: Places, gradient: BufferId, recording: &mut Recording) {
        let ElementBuffers { membranes, bends, tetrahedra, strands } = self.elements;
        let kinds: [(&'static Stage, BufferId); 4] = [
            (&kernels::MEMBRANE_GRADIENT, membranes),
            (&kernels::BEND_GRADIENT, bends),
            (&kernels::TETRAHEDRON_GRADIENT, tetrahedra),
            (&kernels::STRAND_GRADIENT, strands),
        ];
        let mut first = 0;
        for (((stage, buffer), elements), nodes) in kinds.into_iter().zip(self.counts).zip(NODES) {
            recording.dispatch(
                stage,
                &[buffer, at.positions, at.start, self.gradients],
                GradientParams {
                    elements: elements as u32,
                    first: first as u32,
                    rate: self.rate,
                    quantum: at.quantum,
                },
                elements,
            );
            first += elements * nodes;
        }
        recording.dispatch(
            &kernels::GATHER_GRADIENT,
            &[
                self.ranges,
                self.sources,
                self.gradients,
                self.pairs,
                self.terms.buffer,
                at.positions,
                at.start,
                gradient,
            ],
            NodeParams { nodes: self.nodes as u32, quantum: at.quantum },
            self.nodes,
        );
    }

    /// Records the sums that [`Self::energies`] reads. Positions are those of [`Places`].
    pub fn record_energies(
        &self,
        reference: BufferId,
        trial: BufferId,
        start: BufferId,
        quantum: f32,
        recording: &mut Recording,
    ) {
        let ElementBuffers { membranes, bends, tetrahedra, strands } = self.elements;
        let states = [reference, trial, start, self.parts];
        let with = |first: &[BufferId]| [first, &states].concat();
        let kinds: [(&'static Stage, Vec<BufferId>); 5] = [
            (&kernels::MEMBRANE_ENERGY, with(&[membranes])),
            (&kernels::BEND_ENERGY, with(&[bends])),
            (&kernels::TETRAHEDRON_ENERGY, with(&[tetrahedra])),
            (&kernels::STRAND_ENERGY, with(&[strands])),
            (&kernels::NODE_ENERGY, with(&[self.ranges, self.pairs, self.terms.buffer])),
        ];
        let mut first = 0;
        for ((stage, buffers), count) in kinds.into_iter().zip(self.counts.into_iter().chain([self.nodes])) {
            let workgroups = workgroups(count);
            let params = EnergyParams {
                count: count as u32,
                first: first as u32,
                workgroups: workgroups as u32,
                rate: self.rate,
                quantum,
            };
            recording.dispatch(stage, &buffers, params, THREADS * workgroups);
            first += workgroups;
        }
        let params = EnergyParams {
            count: first as u32,
            first: 0,
            workgroups: self.sum_count as u32,
            rate: self.rate,
            quantum,
        };
        recording.dispatch(&kernels::SUM_ENERGY, &[self.parts, self.sums], params, THREADS * self.sum_count);
    }

    /// What [`Self::energies`] needs after [`Self::record_energies`]: the first words of a buffer, at most
    /// 256.
    pub fn energy_words(&self) -> (BufferId, usize) {
        (self.sums, 4 * self.sum_count)
    }

    /// The change of the potential from its words.
    pub fn energies(&self, words: &[u32]) -> PotentialChange {
        let (mut reference, mut change, mut sizes, mut squares) = (0.0, 0.0, 0.0, 0.0);
        for part in words.chunks_exact(4) {
            let number = |k: usize| f64::from(f32::from_bits(part[k]));
            reference += number(0);
            change += number(1);
            // Of sums the rounding is relative to what they have come to.
            sizes += number(1).abs();
            squares += number(3);
        }
        let unit = f64::from(f32::EPSILON) / 2.0;
        PotentialChange { reference, change, rounding: ROUNDING_UNITS * unit * (sizes + squares.sqrt()) }
    }
}

#[cfg(test)]
impl Potential {
    /// Parts of the energies: those of elements, then those of nodes.
    pub fn part_count(&self) -> usize {
        part_count(self.counts, self.nodes)
    }
}

/// Parts of the energies of elements by kind and of nodes.
fn part_count(counts: [usize; 4], nodes: usize) -> usize {
    counts.map(workgroups).iter().sum::<usize>() + workgroups(nodes)
}

/// Workgroups that sum the energies of so many elements or nodes.
fn workgroups(count: usize) -> usize {
    count.div_ceil(THREADS).min(MOST_WORKGROUPS)
}
