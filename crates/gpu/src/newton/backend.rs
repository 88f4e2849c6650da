//! The interface of the dynamics.

use super::places::Newton;
use crate::assembly::AssemblyPlace;
use crate::engine::Engine;
use crate::error::GpuError;
use crate::linear::ConjugateGradients;
use crate::potential::{Places, Potential};
use crate::recording::Recording;
use bowknot_dynamics::{
    AssemblySprings, DeviceWork, ElementModel, Matrix3, NewtonBackend, NewtonBackendError, NewtonSolve,
    NewtonStep, NewtonTarget, OutOfBalance, SolveLimits, Trial, Watched,
};
use bowknot_geometry::Vector;
use std::fmt::Debug;
use std::mem::take;

/// A call before [`NewtonBackend::set_model`].
#[derive(Debug, thiserror::Error)]
#[error("there is no model on the device")]
struct NoModel;

impl<E: Engine + Debug + Send> ConjugateGradients<E> {
    fn newton(&mut self) -> Result<(&mut Newton, &mut E), NewtonBackendError> {
        match &mut self.newton {
            Some(newton) => Ok((newton, &mut self.engine)),
            None => Err(NoModel.into()),
        }
    }

    /// Records what runs before the next results are read.
    fn record(&mut self, of: impl FnOnce(&mut Newton, &mut Recording)) -> Result<(), NewtonBackendError> {
        let (newton, _) = self.newton()?;
        let mut recording = take(&mut newton.pending);
        of(newton, &mut recording);
        newton.pending = recording;
        Ok(())
    }

    /// Takes over a model for Newton's method.
    fn take_newton_model(&mut self, model: &ElementModel) -> Result<(), GpuError> {
        self.take_model(model)?;
        if let Some(assembly) = &self.assembly {
            let potential = Potential::new(&mut self.engine, model, assembly.buffers.elements())?;
            self.newton = Some(Newton::new(&mut self.engine, model, potential)?);
        }
        Ok(())
    }

    fn begin_newton_step(&mut self, step: &NewtonStep<'_>) -> Result<(), GpuError> {
        let (Some(newton), Some(assembly)) = (&mut self.newton, &mut self.assembly) else { return Ok(()) };
        let mut recording = take(&mut newton.pending);
        newton.potential.write_step(&mut self.engine, &assembly.model, step, &mut recording)?;
        newton.begin_step(step, &mut recording);
        assembly.buffers.write_row_sums(step.row_sums, &mut recording);
        assembly.buffers.set_bending(step.bending, step.scalars);
        newton.pending = recording;
        Ok(())
    }

    fn begin_newton_target(&mut self, target: &NewtonTarget<'_>) -> Result<Watched, GpuError> {
        self.set_free(target.free)?;
        let Some(newton) = &mut self.newton else { return Ok(Watched::new()) };
        if !newton.vectors.can_watch(&self.engine, target.watched.len()) {
            self.engine.run(&take(&mut newton.pending), &[])?;
            newton.vectors.watch(&mut self.engine, target.watched.len())?;
        }
        let mut recording = take(&mut newton.pending);
        let watched = newton.begin_target(target, &mut recording);
        newton.pending = recording;
        Ok(watched)
    }

    /// Makes gradient and matrix of the iterate, unless they are there.
    fn linearize_newton(&mut self, absolute: bool) -> Result<(), GpuError> {
        let Some(buffers) = self.make_room()? else { return Ok(()) };
        let (Some(newton), Some(assembly)) = (&mut self.newton, &mut self.assembly) else { return Ok(()) };
        // Buffers of the matrix have the same sizes from now on, so the next call that makes room frees none
        // of them.
        let mut recording = take(&mut newton.pending);
        let (v, quantum) = (&newton.vectors, newton.grid.quantum);
        let wanted = Some((newton.iterate, absolute));
        if newton.matrix_of != wanted {
            let place =
                AssemblyPlace { positions: v.iterate, start: v.start, quantum, rate: newton.rate, absolute };
            assembly.buffers.record_matrix(&place, &buffers, &mut recording);
        }
        if newton.gradient_of != Some(newton.iterate) {
            let places = Places { positions: v.iterate, start: v.start, quantum: quantum as f32 };
            newton.potential.record_gradient(places, v.gradient, &mut recording);
        }
        newton.pending = recording;
        (newton.matrix_of, newton.gradient_of) = (wanted, Some(newton.iterate));
        Ok(())
    }

    fn read_watched_diagonal(&mut self, blocks: &mut Vec<Matrix3<f64>>) -> Result<(), GpuError> {
        let (Some(newton), Some(assembly)) = (&mut self.newton, &self.assembly) else { return Ok(()) };
        let mut recording = take(&mut newton.pending);
        let watched =
            newton.record_watched(assembly.buffers.diagonal, 6, newton.vectors.seen, &mut recording);
        let read = self.engine.run(&recording, &[watched])?;
        blocks.clear();
        blocks.extend(crate::linear::symmetric_blocks(&read[0]));
        Ok(())
    }
}

impl<E: Engine + Debug + Send> NewtonBackend for ConjugateGradients<E> {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn work(&self) -> DeviceWork {
        self.engine.work()
    }

    fn set_model(&mut self, model: &ElementModel) -> Result<(), NewtonBackendError> {
        Ok(self.take_newton_model(model)?)
    }

    fn begin_step(&mut self, step: &NewtonStep<'_>) -> Result<(), NewtonBackendError> {
        self.newton()?;
        Ok(self.begin_newton_step(step)?)
    }

    fn begin_target(&mut self, target: &NewtonTarget<'_>) -> Result<Watched, NewtonBackendError> {
        self.newton()?;
        Ok(self.begin_newton_target(target)?)
    }

    fn linearize(&mut self, absolute: bool) -> Result<(), NewtonBackendError> {
        self.newton()?;
        Ok(self.linearize_newton(absolute)?)
    }

    fn diagonal(&mut self, blocks: &mut Vec<Matrix3<f64>>) -> Result<(), NewtonBackendError> {
        self.newton()?;
        Ok(self.read_watched_diagonal(blocks)?)
    }

    fn solve(
        &mut self,
        springs: &AssemblySprings<'_>,
        limits: &SolveLimits,
    ) -> Result<NewtonSolve, NewtonBackendError> {
        self.newton()?;
        Ok(self.solve_newton(springs, limits)?)
    }

    fn component_residuals(&mut self, sums: &mut Vec<Vector>) -> Result<(), NewtonBackendError> {
        let row_sums = self.assembly.as_ref().map(|assembly| assembly.buffers.row_sums());
        let (newton, engine) = self.newton()?;
        let row_sums = row_sums.ok_or(NoModel)?;
        Ok(newton.component_residuals(engine, row_sums, sums)?)
    }

    fn translate(&mut self, translations: &[Vector]) -> Result<(), NewtonBackendError> {
        self.record(|newton, recording| newton.record_translations(translations, recording))
    }

    fn place(&mut self, length: f64) -> Result<Trial, NewtonBackendError> {
        let (newton, engine) = self.newton()?;
        Ok(newton.make_trial(engine, length)?)
    }

    fn begin_search(&mut self) -> Result<(Watched, Trial), NewtonBackendError> {
        let (newton, engine) = self.newton()?;
        Ok(newton.begin_search(engine)?)
    }

    fn start_from_trial(&mut self) -> Result<(), NewtonBackendError> {
        self.record(Newton::start_from_trial)
    }

    fn keep_trial(&mut self) -> Result<(), NewtonBackendError> {
        self.record(|newton, recording| {
            newton.record_copy(newton.vectors.trial, newton.vectors.kept, recording);
        })
    }

    fn start_from_kept_trial(&mut self) -> Result<(), NewtonBackendError> {
        self.record(Newton::start_from_kept_trial)
    }

    fn target(&mut self, y: &mut [Vector]) -> Result<(), NewtonBackendError> {
        self.record(|newton, recording| {
            newton.record_copy(newton.vectors.trial, newton.vectors.last, recording);
            newton.has_last = true;
        })?;
        let (newton, engine) = self.newton()?;
        let words = match newton.trial_words.take() {
            Some(words) => words,
            None => {
                let read = [(newton.vectors.trial, 4 * newton.nodes)];
                engine.run(&take(&mut newton.pending), &read)?.swap_remove(0)
            }
        };
        y.iter_mut().zip(newton.positions(&words)).for_each(|(y, x)| *y = x);
        Ok(())
    }

    fn out_of_balance(
        &mut self,
        springs: &AssemblySprings<'_>,
        known: &[Vector],
        counted: &[bool],
        absolute: bool,
    ) -> Result<OutOfBalance, NewtonBackendError> {
        self.newton()?;
        self.linearize_newton(absolute)?;
        Ok(self.balance(springs, known, counted)?)
    }
}
