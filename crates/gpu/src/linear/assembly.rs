//! What a linear solver keeps of a model whose matrices it assembles.

use super::patches::Patches;
use crate::assembly::{AssemblyBuffers, GroupBuffers};
use crate::recording::BufferId;
use bowknot_dynamics::ElementModel;

/// The elements of a model on the engine.
#[derive(Debug)]
pub struct Assembly {
    pub buffers: AssemblyBuffers,
    pub model: ElementModel,
    /// Which nodes are free, and their patches.
    pub free: Vec<bool>,
    pub patches: Patches,
    pub groups: Option<GroupBuffers>,
    /// The buffer to which the slots of these patches were written.
    pub slots: Option<BufferId>,
}

impl Assembly {
    /// Number of domains of the preconditioner.
    pub fn domains(&self) -> usize {
        self.groups.as_ref().map_or(0, |groups| groups.hierarchy.domains())
    }
}
