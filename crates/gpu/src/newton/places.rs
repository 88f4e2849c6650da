//! Time steps and targets: where the nodes are, and which of them are free.

use super::blocks::Blocks;
use super::search::Search;
use super::vectors::Vectors;
use crate::assembly::StateGrid;
use crate::engine::Engine;
use crate::error::GpuError;
use crate::kernels;
use crate::parallel::{all, collected, collected_numbers, largest};
use crate::potential::Potential;
use crate::recording::{BufferId, Recording};
use bowknot_dynamics::{ElementModel, NewtonStep, NewtonTarget, Watched};
use bowknot_geometry::Vector;
use std::collections::HashMap;

/// Side of the smallest box that a grid reaches over, as a share of the size of the model at rest, and that
/// of a model without a size [m].
const MIN_SIDE: f64 = 0.25;
const SIDE_OF_A_POINT: f64 = 1e-3;

/// Solves of a target that have places of their own; in the same ones of the next targets there are about as
/// many iterations.
const MOST_SOLVES: usize = 16;

/// Most bits by which a stage coarsens a grid.
const MOST_BITS: u32 = 20;

/// What Newton's method has on an engine.
#[derive(Debug)]
pub struct Newton {
    pub vectors: Vectors,
    pub potential: Potential,
    pub blocks: Blocks,
    pub nodes: usize,
    /// Of all positions.
    pub grid: StateGrid,
    /// Side of the smallest box that the grid reaches over [m].
    side: f64,
    /// 1 / dt [1/s].
    pub rate: f64,
    /// Sums of [`NewtonStep::gradient`] over components, and those of the forces of springs in the last solve
    /// [N].
    pub gradient_sums: Vec<Vector>,
    pub spring_sums: Vec<Vector>,
    /// What the last solve has read of R (d + p) by block, until something of it changes.
    pub momenta: Option<Vec<u32>>,
    /// Positions at the start of the time step, as the device has them.
    step_start: Vec<[i32; 4]>,
    /// What the target began with: its positions and whether nodes that are not free move.
    start: Vec<[i32; 4]>,
    start_imposes: bool,
    /// Whether nodes that are not free are not at their ends yet.
    pub imposes: bool,
    /// The watched nodes.
    pub watched: Vec<u32>,
    /// Which nodes are free.
    free: Vec<bool>,
    /// What runs before the next results are read: a submission takes the host as long as several dispatches.
    pub pending: Recording,
    /// The place of the next solve in its time step, and the iterations of the last two solves at each place.
    pub place: usize,
    pub iterations: HashMap<usize, [usize; 2]>,
    /// A search along the step of the last solve, if it was made with it.
    pub searched: Option<Search>,
    /// The trial, if it was read.
    pub trial_words: Option<Vec<u32>>,
    pub has_last: bool,
    /// Whether the step and the right-hand side are those of a solve.
    pub is_solved: bool,
    /// Numbers of the iterate and of that at the start of the target; equal numbers are equal iterates.
    pub iterate: u64,
    target: u64,
    next: u64,
    /// Of which iterates the gradient is, and the matrix with its filter.
    pub gradient_of: Option<u64>,
    pub matrix_of: Option<(u64, bool)>,
}

impl Newton {
    /// Makes the vectors of a model.
    pub fn new<E: Engine>(
        engine: &mut E,
        model: &ElementModel,
        potential: Potential,
    ) -> Result<Self, GpuError> {
        let nodes = model.rest.len();
        let blocks = Blocks::new(&model.components, nodes);
        let vectors = Vectors::new(engine, nodes, blocks.count(), 0)?;
        let mut pending = Recording::default();
        pending.write(vectors.blocks, &blocks.of_nodes);
        let low = model.rest.iter().fold(Vector::repeat(f64::INFINITY), |low, x| low.inf(x));
        let high = model.rest.iter().fold(Vector::repeat(f64::NEG_INFINITY), |high, x| high.sup(x));
        let size = (high - low).amax();
        let side = if size > 0.0 && size.is_finite() { MIN_SIDE * size } else { SIDE_OF_A_POINT };
        Ok(Self {
            vectors,
            potential,
            blocks,
            nodes,
            grid: StateGrid::around([].iter()),
            side,
            rate: 0.0,
            gradient_sums: Vec::new(),
            spring_sums: Vec::new(),
            momenta: None,
            step_start: Vec::new(),
            start: Vec::new(),
            start_imposes: false,
            imposes: false,
            watched: Vec::new(),
            free: Vec::new(),
            pending,
            place: 0,
            iterations: HashMap::new(),
            searched: None,
            trial_words: None,
            has_last: false,
            is_solved: false,
            iterate: 0,
            target: 0,
            next: 1,
            gradient_of: None,
            matrix_of: None,
        })
    }

    /// Frees the buffers.
    pub fn free<E: Engine>(self, engine: &mut E) {
        self.potential.free(engine);
        self.vectors.free(engine);
    }

    /// Says that the iterate has changed.
    pub fn change_iterate(&mut self) {
        self.iterate = self.next;
        self.next += 1;
        (self.momenta, self.searched) = (None, None);
    }

    /// Says that the trial changes.
    pub fn change_trial(&mut self) {
        (self.searched, self.trial_words) = (None, None);
    }

    /// Chooses the grid of a time step and records its positions; the potential has its terms already.
    pub fn begin_step(&mut self, step: &NewtonStep<'_>, recording: &mut Recording) {
        self.grid = StateGrid::with_room(step.start.iter().chain(step.inertial), self.side);
        self.rate = step.rate;
        self.gradient_sums = self.blocks.sums_of(step.gradient);
        self.has_last = false;
        self.is_solved = false;
        self.imposes = false;
        self.place = 0;
        self.start.clear();
        (self.gradient_of, self.matrix_of) = (None, None);
        self.step_start = self.points(step.start);
        recording.write(self.vectors.start, &self.step_start);
        recording.write(self.vectors.inertial, &self.points(step.inertial));
    }

    fn points(&self, positions: &[Vector]) -> Vec<[i32; 4]> {
        let grid = self.grid;
        collected(positions, |x| grid.place(x))
    }

    /// Records the start of a target. The buffers have room for its watched nodes.
    pub fn begin_target(&mut self, target: &NewtonTarget<'_>, recording: &mut Recording) -> Watched {
        self.place = self.place.next_multiple_of(MOST_SOLVES);
        let grid = self.grid;
        let moves = !all(target.imposed, |q| *q == Vector::zeros());
        let end = |node: usize| target.iterate[node] + target.imposed[node];
        let mut reach = largest(target.iterate, |x| grid.reach(x));
        if moves {
            let of_end = |node: usize| if target.free[node] { 0.0 } else { grid.reach(&end(node)) };
            reach = collected_numbers(self.nodes, of_end).into_iter().fold(reach, f64::max);
        }
        if reach > 1.0 && reach.is_finite() {
            self.coarsen(bits(reach), recording);
        }
        let iterate = self.points(target.iterate);
        self.start_imposes = false;
        if moves {
            let grid = self.grid;
            let imposed = collected_numbers(self.nodes, |node| {
                if target.free[node] {
                    return [0; 4];
                }
                let (from, to) = (iterate[node], grid.place(&end(node)));
                std::array::from_fn(|k| to[k] - from[k])
            });
            self.start_imposes = !all(&imposed, |way| *way == [0; 4]);
            if self.start_imposes {
                recording.write(self.vectors.imposed, &imposed);
            }
        }
        if self.start == iterate {
            self.return_to_start(recording);
        } else {
            if self.step_start == iterate {
                self.record_copy(self.vectors.start, self.vectors.target_start, recording);
            } else {
                recording.write(self.vectors.target_start, &iterate);
            }
            self.record_copy(self.vectors.target_start, self.vectors.iterate, recording);
            self.start = iterate;
            self.change_iterate();
            self.target = self.iterate;
        }
        if self.free != target.free {
            self.free = target.free.to_vec();
            recording.write(self.vectors.free, &bits_of(self.free.iter().copied()));
        }
        if self.watched != target.watched {
            self.watched = target.watched.to_vec();
        }
        recording.write(self.vectors.watched, &self.watched);
        self.record_beginning(recording)
    }

    fn return_to_start(&mut self, recording: &mut Recording) {
        if self.iterate != self.target {
            self.record_copy(self.vectors.target_start, self.vectors.iterate, recording);
            self.iterate = self.target;
        }
    }

    /// Records the trial at the iterate, with nodes that are not free at their ends. Returns the watched
    /// positions.
    fn record_beginning(&mut self, recording: &mut Recording) -> Watched {
        self.imposes = self.start_imposes;
        self.is_solved = false;
        self.momenta = None;
        self.change_trial();
        self.record_trial_positions(0.0, self.vectors.trial, recording);
        self.watched.iter().map(|&node| self.grid.position(self.start[node as usize])).collect()
    }

    /// Records that the trial becomes the iterate.
    pub fn start_from_trial(&mut self, recording: &mut Recording) {
        self.record_copy(self.vectors.trial, self.vectors.iterate, recording);
        self.imposes = false;
        self.change_iterate();
    }

    /// Records that the kept trial becomes the trial and the iterate.
    pub fn start_from_kept_trial(&mut self, recording: &mut Recording) {
        self.record_copy(self.vectors.kept, self.vectors.trial, recording);
        self.change_trial();
        self.start_from_trial(recording);
    }

    /// Records a copy of positions.
    pub fn record_copy(&self, from: BufferId, to: BufferId, recording: &mut Recording) {
        let words = 4 * self.nodes;
        recording.dispatch(
            &kernels::COPY_WORDS,
            &[from, to],
            kernels::copy_words::Params { words: words as u32 },
            words,
        );
    }

    /// Records that entries of the watched nodes go where they are read; returns from where, and how many
    /// words.
    pub fn record_watched(
        &self,
        from: BufferId,
        width: usize,
        seen: BufferId,
        recording: &mut Recording,
    ) -> (BufferId, usize) {
        let nodes = self.watched.len();
        recording.dispatch(
            &kernels::GATHER_NODES,
            &[self.vectors.watched, from, seen],
            kernels::gather_nodes::Params { nodes: nodes as u32, width: width as u32 },
            nodes,
        );
        (seen, width * nodes)
    }

    /// Records that all positions go to a grid that is coarser by so many bits: they change by half a quantum
    /// at most.
    pub fn coarsen(&mut self, bits: u32, recording: &mut Recording) {
        let mut left = bits;
        while left > 0 {
            let shift = left.min(MOST_BITS);
            let params = kernels::regrid_positions::Params { nodes: self.nodes as u32, shift };
            for positions in self.vectors.positions() {
                recording.dispatch(&kernels::REGRID_POSITIONS, &[positions], params, self.nodes);
            }
            for positions in [&mut self.start, &mut self.step_start] {
                let coarser = |x: i32| (x + (1 << (shift - 1))) >> shift;
                for [x, y, z, _] in positions.iter_mut() {
                    [*x, *y, *z] = [*x, *y, *z].map(coarser);
                }
            }
            self.grid.quantum *= f64::from(1u32 << shift);
            left -= shift;
        }
        let is_at_start = self.iterate == self.target;
        self.change_iterate();
        self.change_trial();
        if is_at_start {
            self.target = self.iterate;
        } else {
            self.target = self.next;
            self.next += 1;
        }
    }

    /// Positions of entries of four words [m].
    pub fn positions(&self, words: &[u32]) -> impl Iterator<Item = Vector> {
        words.chunks_exact(4).map(|x| self.grid.position(std::array::from_fn(|k| x[k] as i32)))
    }
}

/// Bits by which a grid must get coarser so that coordinates of that share of its reach, a finite one, are on
/// it.
pub fn bits(reach: f64) -> u32 {
    let (mut bits, mut left) = (0, if reach.is_finite() { reach } else { 0.0 });
    while left > 1.0 {
        left *= 0.5;
        bits += 1;
    }
    bits
}

/// A bit for each.
pub fn bits_of(are: impl Iterator<Item = bool>) -> Vec<u32> {
    let mut words = Vec::new();
    for (k, is) in are.enumerate() {
        if k % 32 == 0 {
            words.push(0);
        }
        words[k / 32] |= u32::from(is) << (k % 32);
    }
    words
}
