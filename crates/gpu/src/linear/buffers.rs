//! The buffers of a linear system on an engine.

use super::layout::{CHILDREN, DOMAIN_WORDS, MOST_LEVELS, PATCH_SLOTS, PatchSlot, Progress};
use super::matrix::PackedMatrix;
use super::patches::Patches;
use crate::engine::Engine;
use crate::error::GpuError;
use crate::linear::{MOST_WORKGROUPS, THREADS};
use crate::recording::BufferId;
use bytemuck::Pod;

/// Most workgroups of coarse levels, which have few domains.
pub const MOST_COARSE_WORKGROUPS: usize = 256;

/// Patches that a workgroup steps at once, a thread per slot.
const STEPPED: usize = THREADS / PATCH_SLOTS;

/// Most partial sums of a squared norm.
pub const MOST_NORMS: usize = MOST_WORKGROUPS + MOST_LEVELS * MOST_COARSE_WORKGROUPS;

/// What the stages bind.
#[derive(Clone, Copy, Debug)]
pub struct Buffers {
    pub slices: BufferId,
    pub words: BufferId,
    pub springs: BufferId,
    pub spring_words: BufferId,
    pub slots: BufferId,
    /// Inverses of the domains of patches, and of those of coarse levels with the links of their children.
    pub domains: BufferId,
    pub coarse: BufferId,
    pub links: BufferId,
    /// Search direction p; the residual before the start.
    pub direction: BufferId,
    /// q = H p, then z.
    pub image: BufferId,
    /// x of all nodes, then r of all nodes.
    pub solution: BufferId,
    /// Forces on the motions of patches and of the groups above them, and these motions.
    pub forces: BufferId,
    pub motions: BufferId,
    /// Partial sums: of p . q, then twice those of r . z.
    pub sums: BufferId,
    pub progress: BufferId,
}

/// Numbers of what the buffers hold.
#[derive(Clone, Debug)]
pub struct Sizes {
    pub nodes: usize,
    pub springs: usize,
    pub patches: usize,
    pub grouped: usize,
    /// Groups of each coarse level.
    pub levels: Vec<usize>,
}

impl Sizes {
    pub fn new(nodes: usize, matrix: &PackedMatrix, patches: &Patches) -> Self {
        let levels = patches.levels.clone();
        let (patches, grouped) = (patches.count(), patches.grouped);
        Self { nodes, springs: matrix.springs.len(), patches, grouped, levels }
    }

    /// Workgroups that multiply, and that step.
    pub fn multiplying(&self) -> usize {
        self.nodes.div_ceil(THREADS).min(MOST_WORKGROUPS)
    }

    pub fn stepping(&self) -> usize {
        self.patches.div_ceil(STEPPED).min(MOST_WORKGROUPS)
    }

    /// Place of the first group of each coarse level, then of the group of all.
    pub fn first_groups(&self) -> [u32; MOST_LEVELS + 4] {
        let mut firsts = [0; MOST_LEVELS + 4];
        for (level, groups) in self.levels.iter().enumerate() {
            firsts[level + 1] = firsts[level] + *groups as u32;
        }
        firsts
    }
}

/// Finds or makes the buffers of a system: those of the one before if they are large enough.
#[derive(Debug, Default)]
pub struct Pool {
    buffers: Option<Buffers>,
}

impl Pool {
    /// Makes room for a matrix, and for a preconditioner of so many domains.
    pub fn make<E: Engine>(
        &mut self,
        engine: &mut E,
        sizes: &Sizes,
        matrix: &PackedMatrix,
        domains: usize,
    ) -> Result<Buffers, GpuError> {
        let before = self.buffers.take();
        let mut room = |label, of: fn(&Buffers) -> BufferId, words: usize| {
            if let Some(buffer) = before.as_ref().map(of) {
                if engine.words(buffer) >= words {
                    return Ok(buffer);
                }
                engine.free(buffer);
            }
            engine.buffer(label, words)
        };
        let coarse = domains.saturating_sub(sizes.grouped);
        let groups = sizes.levels.iter().sum::<usize>().max(sizes.grouped) + 1;
        let buffers = Buffers {
            slices: room("slices of the matrix", |b| b.slices, 4 * matrix.slices.len())?,
            words: room("the matrix", |b| b.words, matrix.words.len())?,
            springs: room("springs", |b| b.springs, words(&matrix.springs))?,
            spring_words: room("springs of nodes", |b| b.spring_words, matrix.spring_words.len())?,
            slots: room(
                "slots of patches",
                |b| b.slots,
                sizes.patches * PATCH_SLOTS * size_of::<PatchSlot>() / 4,
            )?,
            domains: room("domains of patches", |b| b.domains, DOMAIN_WORDS * sizes.grouped)?,
            coarse: room("coarse domains", |b| b.coarse, DOMAIN_WORDS * coarse)?,
            links: room("links of coarse domains", |b| b.links, 4 * CHILDREN * coarse)?,
            direction: room("search direction", |b| b.direction, 4 * sizes.nodes)?,
            image: room("image", |b| b.image, 4 * sizes.nodes)?,
            solution: room("solution", |b| b.solution, 8 * sizes.nodes)?,
            forces: room("forces on groups", |b| b.forces, 6 * groups)?,
            motions: room("motions of groups", |b| b.motions, 6 * groups)?,
            sums: room("partial sums", |b| b.sums, MOST_WORKGROUPS + 2 * MOST_NORMS)?,
            progress: room("progress", |b| b.progress, size_of::<Progress>() / 4)?,
        };
        self.buffers = Some(buffers);
        Ok(buffers)
    }
}

fn words<T: Pod>(entries: &[T]) -> usize {
    size_of_val(entries) / 4
}
