//! What a linear solver keeps of a model whose matrices it assembles.

use super::patches::Patches;
use crate::assembly::{AssemblyBuffers, GroupBuffers, Hierarchy};
use crate::engine::Engine;
use crate::error::GpuError;
use crate::recording::BufferId;
use bowknot_dynamics::ElementModel;

/// The elements of a model on the engine.
#[derive(Debug)]
pub struct Assembly {
    pub buffers: AssemblyBuffers,
    pub model: ElementModel,
    /// The free nodes, and those before them: solves for what is inside of solids take turns with those of
    /// the whole.
    pub set: Option<FreeSet>,
    pub previous: Option<FreeSet>,
    /// The buffer to which the slots of the patches of `set` were written.
    pub slots: Option<BufferId>,
}

/// Which nodes are free, their patches, and the groups of the preconditioner.
#[derive(Debug)]
pub struct FreeSet {
    pub free: Vec<bool>,
    pub patches: Patches,
    pub groups: GroupBuffers,
}

impl FreeSet {
    pub fn new<E: Engine>(engine: &mut E, model: &ElementModel, free: &[bool]) -> Result<Self, GpuError> {
        // Patches of the rest shape: nodes that lie together then, do so later on.
        let patches = Patches::new(free, &model.rest, &model.patches);
        let groups = GroupBuffers::new(engine, Hierarchy::new(model, &patches))?;
        Ok(Self { free: free.to_vec(), patches, groups })
    }
}

impl Assembly {
    /// Number of domains of the preconditioner.
    pub fn domains(&self) -> usize {
        self.set.as_ref().map_or(0, |set| set.groups.hierarchy.domains())
    }

    /// Which nodes are free; none before a target begins.
    pub fn free_nodes(&self) -> &[bool] {
        self.set.as_ref().map_or(&[], |set| &set.free)
    }

    /// Makes these the free nodes, and keeps those before.
    pub fn set_free<E: Engine>(&mut self, engine: &mut E, free: &[bool]) -> Result<(), GpuError> {
        let are_these = |set: &Option<FreeSet>| set.as_ref().is_some_and(|set| set.free == free);
        if are_these(&self.set) {
            return Ok(());
        }
        self.slots = None;
        std::mem::swap(&mut self.set, &mut self.previous);
        if are_these(&self.set) {
            return Ok(());
        }
        if let Some(oldest) = self.set.take() {
            oldest.groups.free(engine);
        }
        self.set = Some(FreeSet::new(engine, &self.model, free)?);
        Ok(())
    }

    /// Frees all buffers.
    pub fn free<E: Engine>(self, engine: &mut E) {
        self.buffers.free(engine);
        for set in [self.set, self.previous].into_iter().flatten() {
            set.groups.free(engine);
        }
    }
}
