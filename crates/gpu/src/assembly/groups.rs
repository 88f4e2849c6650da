//! The buffers of the preconditioner's groups, and the dispatches that make their matrices.

use super::hierarchy::{Hierarchy, Touching};
use super::layout::Frame;
use crate::engine::Engine;
use crate::error::GpuError;
use crate::kernels;
use crate::linear::{Buffers, CHILDREN, DOMAIN_WORDS, PATCH_SLOTS};
use crate::recording::{BufferId, Recording};
use bowknot_dynamics::LinearSpring;

/// The groups of a set of free nodes on an engine.
#[derive(Debug)]
pub struct GroupBuffers {
    pub hierarchy: Hierarchy,
    places: BufferId,
    pairs: BufferId,
    sums: BufferId,
    parts: BufferId,
    tables: BufferId,
    frames: BufferId,
    couplings: BufferId,
    touching: BufferId,
    pressed: BufferId,
    /// Where the chunks of springs begin, and their number.
    chunks: (usize, usize),
}

impl GroupBuffers {
    /// Makes the buffers and writes which groups there are.
    pub fn new<E: Engine>(engine: &mut E, hierarchy: Hierarchy) -> Result<Self, GpuError> {
        let mut make = |label, words: usize| engine.buffer(label, words);
        let h = &hierarchy;
        let buffers = Self {
            places: make("places of nodes", h.places.len())?,
            pairs: make("pairs of groups", 2 * h.pairs.len())?,
            sums: make("sums of pairs", 4 * h.sums.len())?,
            parts: make("parts of pairs", 4 * h.parts.len())?,
            tables: make("pairs of domains", h.tables.len())?,
            frames: make("frames of groups", size_of::<Frame>() / 4 * h.frames)?,
            couplings: make("blocks of pairs of groups", 36 * h.sums.len())?,
            touching: make("springs of domains", h.domains() + 1)?,
            pressed: make("sums of springs of domains", 0)?,
            chunks: (0, 0),
            hierarchy,
        };
        let (h, mut recording) = (&buffers.hierarchy, Recording::default());
        recording.write(buffers.places, &h.places);
        recording.write(buffers.pairs, &h.pairs);
        recording.write(buffers.sums, &h.sums);
        recording.write(buffers.parts, &h.parts);
        recording.write(buffers.tables, &h.tables);
        engine.run(&recording, &[])?;
        Ok(buffers)
    }

    /// Frees the buffers.
    pub fn free<E: Engine>(self, engine: &mut E) {
        let buffers = [self.places, self.pairs, self.sums, self.parts, self.tables, self.frames];
        let others = [self.couplings, self.touching, self.pressed];
        buffers.into_iter().chain(others).for_each(|buffer| engine.free(buffer));
    }

    /// Writes which springs touch each domain.
    pub fn write_springs<E: Engine>(
        &mut self,
        engine: &mut E,
        springs: &[LinearSpring],
        recording: &mut Recording,
    ) -> Result<(), GpuError> {
        if springs.is_empty() || self.hierarchy.levels.is_empty() {
            return Ok(());
        }
        let Touching { words, first, chunks } = self.hierarchy.touching(springs);
        let mut grow = |buffer: &mut BufferId, label, words: usize| {
            if engine.words(*buffer) < words {
                engine.free(*buffer);
                *buffer = engine.buffer(label, words + words / 2)?;
            }
            Ok::<(), GpuError>(())
        };
        grow(&mut self.touching, "springs of domains", words.len())?;
        grow(&mut self.pressed, "sums of springs of domains", DOMAIN_WORDS * chunks)?;
        recording.write(self.touching, &words);
        self.chunks = (first, chunks);
        Ok(())
    }

    /// Records what makes the domains of a matrix.
    pub fn record(
        &self,
        linear: &Buffers,
        positions: BufferId,
        springs: bool,
        quantum: f32,
        recording: &mut Recording,
    ) {
        let levels = &self.hierarchy.levels;
        // The place of a domain among those of coarse levels.
        let coarse =
            |domain: usize| domain.saturating_sub(levels.get(1).map_or(0, |level| level.first_domain));
        for index in 0..levels.len() + usize::from(!levels.is_empty()) {
            // The last frame is that of the last domain.
            let parts = index.checked_sub(1).map(|before| levels[before]);
            let level = levels.get(index);
            let (count, first) = level.map_or((1, self.hierarchy.frames - 1), |l| (l.groups, l.first_frame));
            let width = if index < 2 { [CHILDREN, PATCH_SLOTS][index] } else { 0 };
            recording.dispatch(
                &kernels::GROUP_FRAMES,
                &[positions, linear.slots, self.frames, linear.links],
                kernels::group_frames::Params {
                    count: count as u32,
                    first: first as u32,
                    first_part: parts.map_or(0, |level| level.first_frame as u32),
                    parts: parts.map_or(0, |level| level.groups as u32),
                    width: width as u32,
                    first_domain: parts.map_or(0, |level| coarse(level.first_domain)) as u32,
                    quantum,
                },
                count,
            );
        }
        for (index, level) in levels.iter().enumerate() {
            let (pairs, first) = (level.pairs as u32, level.first_pair as u32);
            if index < 2 {
                recording.dispatch(
                    &kernels::GALERKIN_BLOCKS,
                    &[
                        self.pairs,
                        linear.slices,
                        linear.words,
                        linear.slots,
                        self.places,
                        positions,
                        self.frames,
                        self.couplings,
                    ],
                    kernels::galerkin_blocks::Params {
                        pairs,
                        first,
                        width: level.width as u32,
                        first_frame: level.first_frame as u32,
                        quantum,
                    },
                    level.width * level.pairs,
                );
            } else {
                recording.dispatch(
                    &kernels::COARSEN_BLOCKS,
                    &[self.sums, self.parts, self.frames, self.couplings],
                    kernels::coarsen_blocks::Params { pairs, first, quantum },
                    kernels::COARSEN_BLOCKS.workgroup * level.pairs,
                );
            }
        }
        let (first, chunks) = self.chunks;
        if springs && chunks > 0 {
            recording.dispatch(
                &kernels::DOMAIN_SPRINGS,
                &[linear.springs, self.touching, self.places, positions, self.frames, self.pressed],
                kernels::domain_springs::Params { chunks: chunks as u32, first: first as u32, quantum },
                kernels::DOMAIN_SPRINGS.workgroup * chunks,
            );
        }
        for (index, level) in levels.iter().enumerate() {
            let (inverses, first_inverse) =
                if index == 0 { (linear.domains, 0) } else { (linear.coarse, coarse(level.first_domain)) };
            recording.dispatch(
                &kernels::INVERT_DOMAINS,
                &[self.tables, self.couplings, self.touching, self.pressed, self.frames, inverses],
                kernels::invert_domains::Params {
                    domains: level.domains as u32,
                    first: level.first_domain as u32,
                    first_inverse: first_inverse as u32,
                    first_part: level.first_frame as u32,
                    parts: level.groups as u32,
                    springs: u32::from(springs && chunks > 0),
                },
                kernels::INVERT_DOMAINS.workgroup * level.domains,
            );
        }
    }
}
