//! The vectors of Newton's method on an engine.

use super::layout::{FIRST_SUM, SUMS, Solve};
use crate::engine::Engine;
use crate::error::GpuError;
use crate::linear::MOST_WORKGROUPS;
use crate::linear::Progress;
use crate::recording::BufferId;

/// The buffers. Positions are four integers per node, the fourth of them 0; other vectors are four numbers.
#[derive(Clone, Copy, Debug)]
pub struct Vectors {
    /// Positions: at the start of the time step, where inertia leads, the iterate, the iterate that the
    /// target began with, the trial and the one that is kept, what changes of energy count from, the last
    /// target.
    pub start: BufferId,
    pub inertial: BufferId,
    pub iterate: BufferId,
    pub target_start: BufferId,
    pub trial: BufferId,
    pub kept: BufferId,
    pub reference: BufferId,
    pub last: BufferId,
    /// Displacements of nodes that are not free to their ends, as positions.
    pub imposed: BufferId,
    /// The step p [m], the right-hand side b with 1 at free nodes, the gradient [N].
    pub step: BufferId,
    pub right_side: BufferId,
    pub gradient: BufferId,
    /// The second guess and its image; the first one lies where the search direction does.
    pub second: BufferId,
    pub second_image: BufferId,
    /// A bit per node: whether it is free, and whether it counts.
    pub free: BufferId,
    pub counted: BufferId,
    /// The block of each node, and four numbers per block.
    pub blocks: BufferId,
    pub totals: BufferId,
    pub translations: BufferId,
    /// Numbers by workgroup, and what becomes of those of a trial.
    pub sums: BufferId,
    pub summary: BufferId,
    pub solve: BufferId,
    /// A [`Progress`] that moves outside of the iterations of a round.
    pub ended: BufferId,
    /// The watched nodes, what is read of them, and forces on them.
    pub watched: BufferId,
    pub seen: BufferId,
    pub seen_at_reference: BufferId,
    pub forces: BufferId,
}

impl Vectors {
    /// Makes them for so many nodes, blocks of nodes and watched nodes.
    pub fn new<E: Engine>(
        engine: &mut E,
        nodes: usize,
        blocks: usize,
        watched: usize,
    ) -> Result<Self, GpuError> {
        let mut make = |label, words| engine.buffer(label, words);
        Ok(Self {
            start: make("start of the time step", 4 * nodes)?,
            inertial: make("positions by inertia", 4 * nodes)?,
            iterate: make("iterate", 4 * nodes)?,
            target_start: make("start of the target", 4 * nodes)?,
            trial: make("trial", 4 * nodes)?,
            kept: make("kept trial", 4 * nodes)?,
            reference: make("reference", 4 * nodes)?,
            last: make("last target", 4 * nodes)?,
            imposed: make("imposed displacements", 4 * nodes)?,
            step: make("Newton step", 4 * nodes)?,
            right_side: make("right-hand side", 4 * nodes)?,
            gradient: make("gradient", 4 * nodes)?,
            second: make("second guess", 4 * nodes)?,
            second_image: make("image of the second guess", 4 * nodes)?,
            free: make("free nodes", nodes.div_ceil(32))?,
            counted: make("counted nodes", nodes.div_ceil(32))?,
            blocks: make("blocks of nodes", nodes)?,
            totals: make("sums of blocks", 4 * blocks)?,
            translations: make("translations", 4 * blocks)?,
            sums: make("sums by workgroup", FIRST_SUM + SUMS * MOST_WORKGROUPS)?,
            summary: make("summary of a trial", SUMS)?,
            solve: make("state of a solve", Solve::WORDS)?,
            ended: make("end of a round", size_of::<Progress>() / 4)?,
            watched: make("watched nodes", watched)?,
            seen: make("seen of watched nodes", 6 * watched)?,
            seen_at_reference: make("watched nodes at the reference", 4 * watched)?,
            forces: make("known forces", 4 * watched)?,
        })
    }

    /// Whether there is room for so many watched nodes.
    pub fn can_watch<E: Engine>(&self, engine: &E, watched: usize) -> bool {
        engine.words(self.seen) >= 6 * watched
    }

    /// Makes room for so many watched nodes.
    pub fn watch<E: Engine>(&mut self, engine: &mut E, watched: usize) -> Result<(), GpuError> {
        let before = [self.watched, self.seen, self.seen_at_reference, self.forces];
        before.into_iter().for_each(|buffer| engine.free(buffer));
        let room = watched + watched / 2;
        self.watched = engine.buffer("watched nodes", room)?;
        self.seen = engine.buffer("seen of watched nodes", 6 * room)?;
        self.seen_at_reference = engine.buffer("watched nodes at the reference", 4 * room)?;
        self.forces = engine.buffer("known forces", 4 * room)?;
        Ok(())
    }

    /// Positions that lie on the grid.
    pub fn positions(&self) -> [BufferId; 9] {
        [
            self.start,
            self.inertial,
            self.iterate,
            self.target_start,
            self.trial,
            self.kept,
            self.reference,
            self.last,
            self.imposed,
        ]
    }

    /// Frees the buffers.
    pub fn free<E: Engine>(self, engine: &mut E) {
        let vectors = [self.step, self.right_side, self.gradient, self.second, self.second_image];
        let sums = [self.blocks, self.totals, self.translations, self.sums, self.summary, self.solve];
        let bits = [self.free, self.counted, self.ended];
        let watched = [self.watched, self.seen, self.seen_at_reference, self.forces];
        let all = self.positions().into_iter().chain(vectors).chain(sums).chain(bits).chain(watched);
        all.for_each(|buffer| engine.free(buffer));
    }
}
