//! Matrices and preconditioners that the device makes from positions.

use super::assembly::Assembly;
use super::buffers::{Buffers, Sizes};
use super::layout::{PATCH_SLOTS, PatchSlot};
use super::patches::Patches;
use super::record::Recorder;
use super::solver::ConjugateGradients;
use crate::assembly::{AssemblyBuffers, Plan};
use crate::engine::Engine;
use crate::error::GpuError;
use crate::kernels;
use crate::recording::{BufferId, Recording};
use bowknot_dynamics::{AssemblySprings, ElementModel};
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use std::fmt::Debug;

/// A power of two that makes the largest entry nearly 1; 1 if that is not possible.
fn unit_factor(values: &[Vector]) -> f64 {
    let largest = values.iter().map(Vector::amax).fold(0.0, f64::max);
    let factor = 1.0 / f64::from_bits(largest.to_bits() & 0x7ff0_0000_0000_0000);
    if factor.is_normal() { factor } else { 1.0 }
}

fn singles(values: &[Vector], factor: f64) -> Vec<[f32; 4]> {
    values
        .iter()
        .map(|v| [(v.x * factor) as f32, (v.y * factor) as f32, (v.z * factor) as f32, 0.0])
        .collect()
}

/// Symmetric matrices from six numbers each.
pub fn symmetric_blocks(words: &[u32]) -> impl Iterator<Item = Matrix3<f64>> {
    words.chunks_exact(6).map(|words| {
        let [xx, xy, xz, yy, yz, zz] = [0, 1, 2, 3, 4, 5].map(|k| f64::from(f32::from_bits(words[k])));
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    })
}

impl<E: Engine + Debug + Send> ConjugateGradients<E> {
    pub(crate) fn take_model(&mut self, model: &ElementModel) -> Result<(), GpuError> {
        if let Some(newton) = self.newton.take() {
            newton.free(&mut self.engine);
        }
        if let Some(assembly) = self.assembly.take() {
            assembly.free(&mut self.engine);
        }
        self.assembly = Some(Assembly {
            buffers: AssemblyBuffers::new(&mut self.engine, Plan::new(model))?,
            model: model.clone(),
            set: None,
            previous: None,
            slots: None,
        });
        Ok(())
    }

    /// Divides the free nodes into patches, unless these were free a moment ago.
    pub(crate) fn set_free(&mut self, free: &[bool]) -> Result<(), GpuError> {
        match &mut self.assembly {
            Some(assembly) => assembly.set_free(&mut self.engine, free),
            None => Ok(()),
        }
    }

    /// Makes room for the matrix of the model and its preconditioner.
    pub(crate) fn make_room(&mut self) -> Result<Option<Buffers>, GpuError> {
        let Some(assembly) = &self.assembly else { return Ok(None) };
        let structure = &assembly.buffers.plan.structure;
        let without = Patches::default();
        let patches = assembly.set.as_ref().map_or(&without, |set| &set.patches);
        let sizes = Sizes::new(assembly.model.rest.len(), structure, patches);
        let buffers = self.pool.make(&mut self.engine, &sizes, structure, assembly.domains())?;
        let strands = assembly.buffers.strands();
        self.recorder = Some(Recorder { buffers, sizes, strands });
        Ok(Some(buffers))
    }

    /// Makes room for springs and records what adds them to the matrix and makes the preconditioner, with
    /// nodes at `positions` on a grid. Nothing that is recorded before may bind buffers of the system.
    pub(crate) fn record_preconditioner(
        &mut self,
        springs: &AssemblySprings<'_>,
        positions: BufferId,
        quantum: f64,
        recording: &mut Recording,
    ) -> Result<(), GpuError> {
        if let Some(assembly) = &mut self.assembly {
            let structure = &mut assembly.buffers.plan.structure;
            structure.set_springs(springs.springs, springs.starts, springs.entries);
        }
        self.make_room()?;
        let (Some(assembly), Some(Recorder { buffers, sizes, .. })) = (&mut self.assembly, &self.recorder)
        else {
            return Ok(());
        };
        let Some(set) = &mut assembly.set else { return Ok(()) };
        let structure = &assembly.buffers.plan.structure;
        recording.write(buffers.springs, &structure.springs);
        recording.write(buffers.spring_words, &structure.spring_words);
        if assembly.slots != Some(buffers.slots) {
            let slot = |node: &Option<u32>| PatchSlot { node: node.unwrap_or(u32::MAX), ..PatchSlot::EMPTY };
            recording.write(buffers.slots, &set.patches.slots.iter().map(slot).collect::<Vec<_>>());
            // Nodes that are not free keep this: no patch has them.
            recording.write(buffers.solution, &vec![0u32; 8 * sizes.nodes]);
            assembly.slots = Some(buffers.slots);
        }
        let slots = PATCH_SLOTS * sizes.patches;
        set.groups.write_springs(&mut self.engine, springs.springs, recording)?;
        recording.dispatch(
            &kernels::FACTOR_DIAGONAL,
            &[assembly.buffers.diagonal, buffers.springs, buffers.spring_words, buffers.slots],
            kernels::factor_diagonal::Params { slots: slots as u32, springs: sizes.springs as u32 },
            slots,
        );
        set.groups.record(buffers, positions, sizes.springs > 0, quantum as f32, recording);
        Ok(())
    }

    /// H x with the matrix that was prepared last, springs included; only rows of free nodes count. For
    /// tests: solves do without.
    ///
    /// # Errors
    /// The device failed.
    pub fn multiply(&mut self, x: &[Vector]) -> Result<Vec<Vector>, GpuError> {
        let Some(recorder) = &self.recorder else { return Ok(Vec::new()) };
        let factor = unit_factor(x);
        let mut recording = Recording::default();
        recorder.record_product(&singles(x, factor), &mut recording);
        let read = self.engine.run(&recording, &[(recorder.buffers.image, 4 * x.len())])?;
        let double = |four: &[u32]| Vector::from_fn(|k, _| f64::from(f32::from_bits(four[k])) / factor);
        Ok(read[0].chunks_exact(4).map(double).collect())
    }
}
