//! The buffers of a model on an engine, and the dispatches that assemble a matrix.

use super::layout::{Curvature, ElementParams};
use super::plan::Plan;
use crate::engine::Engine;
use crate::error::GpuError;
use crate::kernels;
use crate::linear::{Buffers, StrandHessian};
use crate::parallel::collected;
use crate::recording::{BufferId, Recording};
use crate::stages::Stage;
use bytemuck::Pod;
use nalgebra::Matrix3;

/// The buffers, with copies of what was written last: what has not changed is not written again.
#[derive(Debug)]
pub struct AssemblyBuffers {
    pub plan: Plan,
    membranes: BufferId,
    bends: BufferId,
    tetrahedra: BufferId,
    strands: BufferId,
    curvatures: BufferId,
    strand_rows: BufferId,
    sources: BufferId,
    blocks: BufferId,
    entries: Written,
    row_sums: Written,
    /// Diagonal blocks without springs, six numbers per node.
    pub diagonal: BufferId,
    /// Numbers of flat bending, of the pairs that elements join and of the others.
    bending: (Vec<f64>, Vec<f64>),
    /// The buffer that the structure of the matrix was written to, with them.
    written_to: Option<BufferId>,
}

/// Where nodes are for an assembly, and what else it depends on.
#[derive(Clone, Copy, Debug)]
pub struct AssemblyPlace {
    /// Positions and those at the start of the time step, on a grid.
    pub positions: BufferId,
    pub start: BufferId,
    /// [m].
    pub quantum: f64,
    /// 1 / dt [1/s].
    pub rate: f64,
    /// Whether negative curvatures change their sign.
    pub absolute: bool,
}

/// A buffer and what it holds.
#[derive(Debug)]
pub struct Written {
    pub buffer: BufferId,
    words: Vec<u32>,
}

/// The elements of a model on an engine.
#[derive(Clone, Copy, Debug)]
pub struct ElementBuffers {
    pub membranes: BufferId,
    pub bends: BufferId,
    pub tetrahedra: BufferId,
    pub strands: BufferId,
}

impl Written {
    /// A buffer to which nothing was written.
    pub fn new(buffer: BufferId) -> Self {
        Self { buffer, words: Vec::new() }
    }

    /// Writes the entries unless they stand there already; returns whether they were new.
    pub fn write<T: Pod>(&mut self, entries: &[T], recording: &mut Recording) -> bool {
        let words: &[u32] = bytemuck::cast_slice(entries);
        if self.words == words {
            return false;
        }
        self.words.clear();
        self.words.extend_from_slice(words);
        recording.write(self.buffer, words);
        true
    }
}

impl AssemblyBuffers {
    /// Makes the buffers of a model and writes its elements.
    pub fn new<E: Engine>(engine: &mut E, plan: Plan) -> Result<Self, GpuError> {
        let mut recording = Recording::default();
        let nodes = plan.nodes;
        let mut make = |label, words: usize| engine.buffer(label, words);
        let written = Written::new;
        let buffers = Self {
            membranes: make("triangles", size_of_val(plan.membranes.as_slice()) / 4)?,
            bends: make("bends", (size_of_val(plan.bends.as_slice()) / 4).max(48))?,
            tetrahedra: make("tetrahedra", size_of_val(plan.tetrahedra.as_slice()) / 4)?,
            strands: make("strands", size_of_val(plan.strands.as_slice()) / 4)?,
            curvatures: make("curvatures of strands", size_of::<Curvature>() / 4 * plan.strands.len())?,
            strand_rows: make("strands of nodes", plan.strand_rows.len())?,
            sources: make("sources of blocks", plan.sources.len())?,
            blocks: make("blocks of elements", 9 * plan.blocks)?,
            entries: written(make("entries of the matrix", 4 * plan.entries.len())?),
            row_sums: written(make("sums of rows", 6 * nodes)?),
            diagonal: make("diagonal of the matrix", 6 * nodes)?,
            bending: (Vec::new(), Vec::new()),
            written_to: None,
            plan,
        };
        recording.write(buffers.membranes, &buffers.plan.membranes);
        recording.write(buffers.bends, &buffers.plan.bends);
        recording.write(buffers.tetrahedra, &buffers.plan.tetrahedra);
        recording.write(buffers.strands, &buffers.plan.strands);
        recording.write(buffers.strand_rows, &buffers.plan.strand_rows);
        recording.write(buffers.sources, &buffers.plan.sources);
        engine.run(&recording, &[])?;
        Ok(buffers)
    }

    /// The elements.
    pub fn elements(&self) -> ElementBuffers {
        let Self { membranes, bends, tetrahedra, strands, .. } = *self;
        ElementBuffers { membranes, bends, tetrahedra, strands }
    }

    /// The Hessian of strands that the last matrix was made with; None if there are no strands.
    pub fn strands(&self) -> Option<StrandHessian> {
        let rows = self.plan.strand_nodes;
        (rows > 0).then_some(StrandHessian {
            strands: self.strands,
            curvatures: self.curvatures,
            rows: self.strand_rows,
            count: rows,
        })
    }

    /// Frees the buffers.
    pub fn free<E: Engine>(self, engine: &mut E) {
        let written = [self.entries, self.row_sums].map(|written| written.buffer);
        let others = [self.membranes, self.bends, self.tetrahedra, self.sources, self.blocks, self.diagonal];
        let strands = [self.strands, self.curvatures, self.strand_rows];
        written.into_iter().chain(others).chain(strands).for_each(|buffer| engine.free(buffer));
    }

    /// The sums of rows, six numbers per node.
    pub fn row_sums(&self) -> BufferId {
        self.row_sums.buffer
    }

    /// Writes the sums of rows.
    pub fn write_row_sums(&mut self, sums: &[Matrix3<f64>], recording: &mut Recording) {
        let sums = collected(sums, |sum| {
            let half = |i: usize, j: usize| (0.5 * (sum[(i, j)] + sum[(j, i)])) as f32;
            [half(0, 0), half(0, 1), half(0, 2), half(1, 1), half(1, 2), half(2, 2)]
        });
        self.row_sums.write(&sums, recording);
    }

    /// Sets flat bending, by the pairs of [`bowknot_dynamics::ElementModel`].
    pub fn set_bending(&mut self, bending: &[f64], scalars: &[f64]) {
        if self.bending.0 != bending || self.bending.1 != scalars {
            self.bending = (bending.to_vec(), scalars.to_vec());
            self.written_to = None;
        }
    }

    /// Records what makes the matrix in `linear`, with the sums of rows and the bending that were set last.
    pub fn record_matrix(&mut self, place: &AssemblyPlace, linear: &Buffers, recording: &mut Recording) {
        if self.written_to != Some(linear.words) {
            let (entries, words) = self.plan.with_bending(&self.bending.0, &self.bending.1);
            self.entries.write(&entries, recording);
            recording.write(linear.slices, &self.plan.structure.slices);
            recording.write(linear.words, &words);
            self.written_to = Some(linear.words);
        }
        self.record_elements(place, recording);
        let (nodes, entries) = (self.plan.nodes, self.plan.entries.len());
        recording.dispatch(
            &kernels::ASSEMBLE_BLOCKS,
            &[
                self.entries.buffer,
                self.sources,
                self.blocks,
                linear.slices,
                self.row_sums.buffer,
                linear.words,
            ],
            kernels::assemble_blocks::Params { entries: entries as u32, nodes: nodes as u32 },
            entries + nodes,
        );
        recording.dispatch(
            &kernels::DIAGONAL_BLOCKS,
            &[linear.slices, linear.words, self.diagonal],
            kernels::diagonal_blocks::Params { nodes: nodes as u32 },
            nodes,
        );
    }

    fn record_elements(&self, place: &AssemblyPlace, recording: &mut Recording) {
        let plan = &self.plan;
        let (bends, tetrahedra) =
            (3 * plan.membranes.len(), 3 * plan.membranes.len() + 15 * plan.bends.len());
        let damped = if plan.has_damped_tetrahedra() { plan.tetrahedra.len() } else { 0 };
        let strands = tetrahedra + 6 * plan.tetrahedra.len();
        let kinds: [(&'static Stage, BufferId, usize, usize); 5] = [
            (&kernels::MEMBRANE_HESSIAN, self.membranes, plan.membranes.len(), 0),
            (&kernels::BEND_HESSIAN, self.bends, plan.bends.len(), bends),
            (&kernels::TETRAHEDRON_HESSIAN, self.tetrahedra, plan.tetrahedra.len(), tetrahedra),
            (&kernels::DAMPED_TETRAHEDRON_HESSIAN, self.tetrahedra, damped, tetrahedra),
            (&kernels::STRAND_HESSIAN, self.strands, plan.strands.len(), strands),
        ];
        for (stage, buffer, elements, first_block) in kinds {
            let bound = [buffer, place.positions, place.start, self.blocks, self.curvatures];
            recording.dispatch(
                stage,
                &bound[..stage.bindings.len()],
                ElementParams {
                    elements: elements as u32,
                    first_block: first_block as u32,
                    absolute: u32::from(place.absolute),
                    rate: place.rate as f32,
                    quantum: place.quantum as f32,
                },
                elements,
            );
        }
    }
}
