//! Sums over components: what a step misses of their momentum, and forces out of balance.

use super::layout::Solve;
use super::places::{Newton, bits_of};
use super::solve::Opposed;
use crate::engine::Engine;
use crate::error::GpuError;
use crate::kernels;
use crate::linear::ConjugateGradients;
use crate::recording::{BufferId, Recording};
use bowknot_dynamics::{AssemblySprings, OutOfBalance};
use bowknot_geometry::Vector;
use std::fmt::Debug;

impl Newton {
    /// Records R (d + p) by block, with the displacement d since the start of the time step. Returns what is
    /// to be read.
    pub fn record_momenta(&self, row_sums: BufferId, recording: &mut Recording) -> (BufferId, usize) {
        let v = &self.vectors;
        recording.dispatch(
            &kernels::BLOCK_MOMENTA,
            &[v.blocks, v.iterate, v.start, row_sums, v.step, v.totals],
            kernels::block_momenta::Params { nodes: self.nodes as u32, quantum: self.grid.quantum as f32 },
            self.nodes,
        );
        (v.totals, 4 * self.blocks.count())
    }

    /// Sets `sums` to the forces on components that are not inner forces: those of springs, less c and R (d +
    /// p). That is the sum of b - R p without elements and K, where all nodes are free.
    pub fn component_residuals<E: Engine>(
        &mut self,
        engine: &mut E,
        row_sums: BufferId,
        sums: &mut Vec<Vector>,
    ) -> Result<(), GpuError> {
        let words = match self.momenta.take() {
            Some(words) => words,
            None => {
                let mut recording = std::mem::take(&mut self.pending);
                let read = self.record_momenta(row_sums, &mut recording);
                engine.run(&recording, &[read])?.swap_remove(0)
            }
        };
        sums.clear();
        let forces = self.gradient_sums.iter().zip(&self.spring_sums);
        for ([x, y, z, _], (gradient, springs)) in self.blocks.sums(&words).zip(forces) {
            sums.push(springs - gradient - Vector::new(x, y, z));
        }
        Ok(())
    }

    /// Records translations of components.
    pub fn record_translations(&mut self, translations: &[Vector], recording: &mut Recording) {
        (self.momenta, self.searched) = (None, None);
        if translations.iter().all(|way| *way == Vector::zeros()) {
            return;
        }
        let v = &self.vectors;
        recording.write(v.translations, &self.blocks.spread(translations));
        recording.dispatch(
            &kernels::TRANSLATE_BLOCKS,
            &[v.blocks, v.translations, v.free, v.step],
            kernels::translate_blocks::Params { nodes: self.nodes as u32 },
            self.nodes,
        );
    }
}

impl<E: Engine + Debug + Send> ConjugateGradients<E> {
    /// See [`bowknot_dynamics::NewtonBackend::out_of_balance`]; the matrix is that of the iterate.
    pub(super) fn balance(
        &mut self,
        springs: &AssemblySprings<'_>,
        known: &[Vector],
        counted: &[bool],
    ) -> Result<OutOfBalance, GpuError> {
        let (Some(newton), Some(assembly)) = (&mut self.newton, &self.assembly) else {
            return Ok(OutOfBalance::default());
        };
        newton.is_solved = false;
        let (iterate, quantum) = (newton.vectors.iterate, newton.grid.quantum);
        let mut recording = std::mem::take(&mut newton.pending);
        newton.record_before(&mut recording);
        let counts = assembly.free_nodes().iter().zip(counted).map(|(free, counted)| *free && *counted);
        recording.write(newton.vectors.counted, &bits_of(counts));
        let forces = if known.iter().all(|force| *force == Vector::zeros()) { 0 } else { known.len() };
        let single = |force: &Vector| [force.x as f32, force.y as f32, force.z as f32, 0.0];
        recording.write(newton.vectors.forces, &known.iter().map(single).collect::<Vec<_>>());
        self.record_preconditioner(springs, iterate, quantum, &mut recording)?;
        let (Some(newton), Some(recorder)) = (&self.newton, &self.recorder) else {
            return Ok(OutOfBalance::default());
        };
        let (v, b) = (&newton.vectors, &recorder.buffers);
        // The gradient without known forces lies where the search direction goes.
        newton.record_copy(v.gradient, b.direction, &mut recording);
        recording.dispatch(
            &kernels::SUBTRACT_KNOWN_FORCES,
            &[v.watched, v.forces, b.direction],
            kernels::subtract_known_forces::Params { count: forces as u32 },
            forces,
        );
        let opposed = Opposed { gradient: b.direction, counted: v.counted, springs: 0, imposes: false };
        newton.record_right_side(b, &opposed, &mut recording);
        newton.outside(recorder).record_residual(0, &mut recording);
        recording.dispatch(
            &kernels::RESIDUAL_NORMS,
            &[v.blocks, b.solution, b.direction, v.totals],
            kernels::residual_norms::Params { nodes: newton.nodes as u32 },
            newton.nodes,
        );
        let read =
            self.engine.run(&recording, &[(v.totals, 4 * newton.blocks.count()), (v.solve, Solve::WORDS)])?;
        let factor = f64::from(Solve::from_words(&read[1]).factor);
        let unit = 1.0 / (factor * factor);
        let mut balance = OutOfBalance::default();
        for [product, square, ..] in newton.blocks.sums(&read[0]) {
            balance.products.push(product * unit);
            balance.squared_force += square * unit;
        }
        Ok(balance)
    }
}
