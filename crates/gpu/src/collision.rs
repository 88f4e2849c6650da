//! Steps toward a target that nothing passes through: search, backward step and forward step on an engine.
//!
//! Positions, targets, trust regions and pairs stay on the device. A step is the list of dispatches that
//! [`Collision::record_step`] writes; the host submits several of them at once, reads [`Control`] and a
//! report per step alone, and grows buffers that were too small. A step with a buffer that is too small moves
//! nothing, those after it are not made, and it is made again.
//!
//! A device binds so many candidates and no more. Where a search finds more, the rest of the call goes on
//! with trust regions of half the size and paths of half the length, as often as it takes. Safety does not
//! depend on their size: a path stays within the trust region of its vertex, and all pairs whose trust
//! regions, enlarged by their contact ranges, overlap are candidates. Smaller ones leave fewer pairs and are
//! left sooner, so there are more steps and searches. Pairs within contact range are candidates in any case.
//! If these alone are too many, the call ends with an error.

mod buffers;
mod carried;
mod end;
mod near_list;
mod record;
mod record_rows;
mod record_search;
mod steps;
mod stop;
mod trees;

use crate::adjacency::Adjacency;
use crate::bricks::Bricks;
use crate::edges::Edges;
use crate::engine::{Engine, PhaseSeconds};
use crate::error::GpuError;
use crate::grid::{Grid, GridError, GridPoint};
use crate::kernels;
use crate::layout::{Candidate, Control, NONE, Vertex};
use crate::model::{self, Constraints, Lengths};
use crate::parallel::collected;
use crate::recording::{BufferId, Recording};
use bowknot_geometry::{CollisionModel, Point, Vector};
use buffers::{Buffers, Sizes, words};
pub use carried::Carried;
use carried::CarriedList;
use near_list::NearList;
use std::mem::take;
pub use stop::Stop;
use trees::Trees;

/// Largest growth of the multipliers in a call by coarse corrections.
const MOST_GROWTH: f32 = 1e3;

/// Why collisions cannot be computed on the device.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CollisionError {
    /// There is no grid for the scene.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// The device failed.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// An array has another length than the model has vertices.
    #[error("{what} has {given} entries for {vertices} vertices")]
    Length {
        /// The array.
        what: &'static str,
        /// Its length.
        given: usize,
        /// Vertices of the model.
        vertices: usize,
    },
    /// A position lies outside of the grid.
    #[error("vertex {vertex} has left the grid of the device: use the CPU")]
    OutsideGrid {
        /// The vertex.
        vertex: usize,
    },
}

/// How steps are made.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Gauss-Seidel sweeps of a backward step.
    pub sweeps: usize,
    /// How often a sweep goes over each cluster of edges before the next one.
    pub cluster_sweeps: usize,
    /// How often a sweep goes over each bucket of contact rows before the next one.
    pub bucket_sweeps: usize,
    /// Vertices that move by bucket of contact rows, about. A workgroup sweeps a bucket; scenes of fewer than
    /// eight buckets have one.
    pub bucket_vertices: usize,
    /// Most sweeps while the last step left less than `polish_distance` and stretched an edge beyond
    /// `polish_stretch`. The first such step of a call makes `sweeps`, each of the next ones twice as many.
    pub polish_sweeps: usize,
    /// Remaining distance of a vertex [m].
    pub polish_distance: f64,
    /// Ratio of an edge's length to its limit [1].
    pub polish_stretch: f64,
    /// Strength of the proximal term of edges: the part of their curvature that counts.
    pub edge_proximal: f64,
    /// Strength of the proximal term of contacts: the part of their curvature that counts.
    pub contact_proximal: f64,
    /// Largest factor on the proximal term of a vertex, which grows while its displacements reverse.
    pub proximal_growth: f64,
    /// Distance within which a pair can have a row, in its desired distance without regard to rest positions.
    pub range: f64,
    /// Predicted gap below which a pair gets a row, in the distance that the row asks for.
    pub active: f64,
    /// Whether only contacts get rows, and pairs that are merely close guard a part of their gap.
    pub contacts_only: bool,
    /// Distance in the desired one below which the target knows a contact of the vertices that a [`Call`]
    /// says.
    pub known: f64,
    /// Share of its gap that the row of such a contact guards.
    pub guarded: f64,
    /// Smallest distance that such a row asks for, in the way from the minimum separation to the desired
    /// distance.
    pub guarded_floor: f64,
    /// Factor on the stretch limits of edges that the target knows.
    pub guarded_stretch: f64,
    /// Whether all multipliers are scaled by one factor before each sweep.
    pub coarse_correction: bool,
    /// Share of a gap that a step may use up.
    pub damping: f64,
    /// Longest travel of a vertex in a step, in local edge lengths; at most 1.
    pub longest_travel: f64,
    /// Smallest radius of a trust region, likewise.
    pub smallest_radius: f64,
    /// Smallest decrease of a prescribed vertex's distance to its target that counts as progress [m].
    pub progress: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            sweeps: 8,
            cluster_sweeps: 2,
            bucket_sweeps: 2,
            bucket_vertices: 128,
            polish_sweeps: 8,
            polish_distance: 0.0,
            polish_stretch: 1.01,
            edge_proximal: 0.1,
            contact_proximal: 0.1,
            proximal_growth: 32.0,
            range: 2.0,
            active: 1.1,
            contacts_only: true,
            known: 1.3,
            guarded: 0.7,
            guarded_floor: 0.35,
            guarded_stretch: 1.0125,
            coarse_correction: true,
            damping: 0.9,
            longest_travel: 0.35,
            smallest_radius: 0.1,
            progress: 0.0,
        }
    }
}

/// What a call starts from.
#[derive(Clone, Copy, Debug)]
pub struct Call<'a> {
    /// Where the vertices want to go [m].
    pub target: &'a [Point],
    /// By how much pairs that are closer than they should be open at most in the call [m].
    pub growth: f64,
    /// Where the vertices were at the start of the time step, from where slip counts [m]. Empty: the present
    /// positions.
    pub slip_start: &'a [Point],
    /// Vertices whose contacts the target knows: pairs with one of them that are near when they become
    /// candidates guard only a part of their gap. Empty: none.
    pub known: &'a [bool],
    /// What pairs carry at the start, in any order: the first step sweeps on from it. Pairs without an entry
    /// carry nothing; entries of pairs that do not press, or that the first search does not find, are left
    /// out.
    pub carried: &'a [Carried],
    /// Edges that may be longer than their limits, and how long [m]. Entries below the limit, and of edges
    /// without one, change nothing.
    pub yielding: &'a [([u32; 2], f64)],
    /// When the call ends.
    pub stop: Stop,
}

impl<'a> Call<'a> {
    /// Toward a target that knows no contacts, with pairs that carry nothing. Pairs may open at once, slip
    /// counts from here, and the host alone ends the call.
    pub fn toward(target: &'a [Point]) -> Self {
        Self {
            target,
            growth: f64::INFINITY,
            slip_start: &[],
            known: &[],
            carried: &[],
            yielding: &[],
            stop: Stop::NEVER,
        }
    }
}

impl From<&ContactRow> for Carried {
    /// What a call carried at its end.
    fn from(row: &ContactRow) -> Self {
        Self { candidate: row.candidate, multiplier: row.multiplier, friction: row.friction }
    }
}

/// What a step did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Candidate pairs.
    pub candidates: usize,
    /// Whether they were searched for.
    pub searched: bool,
    /// Pairs that nothing certifies.
    pub frozen: usize,
    /// Largest remaining distance of a vertex [m].
    pub remaining: f64,
    /// Largest remaining distance of a vertex that is not prescribed [m].
    pub free_remaining: f64,
    /// Largest remaining distance of a prescribed vertex [m].
    pub lag: f64,
    /// Largest remaining distance of a vertex that no pair holds back [m].
    pub unhindered: f64,
    /// Largest remaining distance of a prescribed vertex that no pair holds back [m].
    pub unhindered_lag: f64,
    /// Longest move of a vertex [m].
    pub largest_move: f64,
    /// Longest move of a vertex that is not prescribed [m].
    pub free_move: f64,
    /// Contact rows.
    pub contact_rows: usize,
    /// Those of them that press.
    pub pressing: usize,
    /// Largest net residual of a body [m]: how far it is as a whole from where the forces on it balance.
    pub net_residual: f64,
    /// Largest mean residual of the vertices of a body [m].
    pub mean_residual: f64,
    /// Largest ratio of an edge's length to its limit [1]; 0 without limits.
    pub stretch_to_limit: f64,
}

/// What a contact row of a step came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactRow {
    /// The pair.
    pub candidate: Candidate,
    /// Multiplier [m, in units of the mean mass].
    pub multiplier: f64,
    /// Multiplier of friction on side *a*, across the normal, in the same units.
    pub friction: Vector,
    /// How far the contact had slipped since the start of the time step, before the step [m].
    pub slip: Vector,
    /// Coefficient of friction [1].
    pub coefficient: f64,
}

/// How a call ends.
#[derive(Clone, Debug, PartialEq)]
pub struct End {
    /// The positions [m], exactly as they are on the device.
    pub positions: Vec<Point>,
    /// Where the last step wanted to go [m].
    pub aims: Vec<Point>,
    /// The contact rows of the last step.
    pub rows: Vec<ContactRow>,
    /// Pairs among which are all that are within their contact range, the sum of their margins, at the
    /// positions; sorted. None if no step and no search of the call has looked for them.
    pub near: Option<Vec<Candidate>>,
}

/// The collision stage of a scene on an engine.
#[derive(Debug)]
pub struct Collision<E> {
    engine: E,
    grid: Grid,
    settings: Settings,
    lengths: StepLengths,
    sizes: Sizes,
    buffers: Buffers,
    /// As they are on the device.
    vertices: Vec<Vertex>,
    near: NearList,
    carried: CarriedList,
    trees: Trees,
    edges: Edges,
    bricks: Bricks,
    /// Where the edges and the triangles begin in the adjacency.
    adjacency_starts: [u32; 2],
    /// Whether any contact may have friction, and whether vertices of bodies that are no obstacles are
    /// prescribed.
    frictional: bool,
    has_pins: bool,
    /// Whether edges of the last call yielded.
    yields: bool,
    /// The rule of the call, and the contact rows of its last step.
    stop: Stop,
    row_count: usize,
    /// What the end of the call reads, if the last submission of steps has read it.
    ended: Option<Vec<Vec<u32>>>,
    /// [`Control`] at the end of a call.
    end_control: BufferId,
    /// Submissions of steps in the call, and in the one before, with its contact rows.
    submissions: usize,
    before: [usize; 2],
    /// Whether the next step polishes.
    polishes: bool,
    /// Steps of the call that polished.
    polished: usize,
    /// Number of steps that a submission is likely to make, of those that do not polish and of those that do.
    expected_steps: [usize; 2],
    /// Dispatches of a step that can be left out, of one that does not polish and of one that does; None
    /// before they are counted.
    step_dispatches: [Option<usize>; 2],
    /// Steps since the call began or the device last halted a submission.
    steps_in_a_row: usize,
    /// Factor on the longest travel of a step and on the sizes of trust regions, which halves where the
    /// device does not bind all candidates. Each call begins with 1, so that it depends on its start alone.
    travel: f32,
    /// Whether the factor has changed, and trust regions have not: all of them are new.
    shrunk: bool,
    /// Whether a call has begun whose candidates were not yet searched for: all trust regions are new.
    fresh: bool,
    /// Whether the step is made again, because a buffer was too small.
    again: bool,
    /// What runs before the next steps, or before the next results are read.
    pending: Recording,
    /// Whether the candidates are those of the present positions: all pairs that could meet within the trust
    /// regions, in which the vertices are.
    listed: bool,
}

/// Lengths in quanta that all steps share.
#[derive(Clone, Copy, Debug)]
struct StepLengths {
    min_separation: f32,
    /// By how much the rows of a call ask a small gap to grow.
    growth: f32,
    damping: f32,
    progress: f32,
}

impl<E: Engine> Collision<E> {
    /// Prepares the scene of `model` at `positions` [m], where no two elements intersect; `rest` are the rest
    /// positions [m].
    ///
    /// # Errors
    /// No grid has room for the scene; the device has no memory; wrong lengths.
    pub fn new(
        engine: E,
        model: &CollisionModel,
        positions: &[Point],
        rest: &[Point],
        lengths: &Lengths<'_>,
        constraints: &Constraints<'_>,
        settings: &Settings,
    ) -> Result<Self, CollisionError> {
        let grid = Self::grid_around(positions, rest, lengths)?;
        let mut collision =
            Self::on_grid(engine, &grid, model, positions, rest, lengths, constraints, settings)?;
        collision.place(positions)?;
        Ok(collision)
    }

    /// A grid for a scene that begins at `positions` [m].
    ///
    /// # Errors
    /// There is none with room for the scene.
    pub fn grid_around(
        positions: &[Point],
        rest: &[Point],
        lengths: &Lengths<'_>,
    ) -> Result<Grid, CollisionError> {
        // Trust regions and boxes must fit as well: no radius is above an edge length, none of a box above
        // two margins more.
        let lengths_of_vertices = lengths.edges.iter().chain(lengths.margins);
        let largest = lengths_of_vertices.fold(0.0, |largest: f64, length| largest.max(*length));
        let room = extent(positions).max(extent(rest)).max(4.0 * largest);
        Ok(Grid::around(positions, room, lengths.min_separation)?)
    }

    /// Prepares the scene on a grid, without [positions](Self::place). The
    /// elements are ordered in space by `order`, any positions that are typical of the scene [m].
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn on_grid(
        mut engine: E,
        grid: &Grid,
        model: &CollisionModel,
        order: &[Point],
        rest: &[Point],
        lengths: &Lengths<'_>,
        constraints: &Constraints<'_>,
        settings: &Settings,
    ) -> Result<Self, CollisionError> {
        let count = model.topology().vertex_count;
        for (what, given) in [
            ("positions", order.len()),
            ("rest positions", rest.len()),
            ("edges", lengths.edges.len()),
            ("margins", lengths.margins.len()),
            ("deltas", lengths.deltas.len()),
        ] {
            check_length(what, given, count)?;
        }
        let order = snapped_elsewhere(grid, order)?;
        let rest_grid = grid.around_others(rest).ok_or(CollisionError::OutsideGrid { vertex: 0 })?;
        let rest_on_grid = snapped(&rest_grid, rest)?;
        let vertices = model::vertices(model, lengths, constraints, grid);
        let planes = model::planes(model, grid);
        let pair_frictions = model::pair_frictions(constraints);
        let groups = vertices.iter().filter(|v| v.group != NONE).map(|v| v.group as usize + 1);
        let topology = model.topology();
        let triangles: Vec<[u32; 4]> = topology.triangles.iter().map(|&[a, b, c]| [a, b, c, 0]).collect();
        let moves = |v: u32| vertices[v as usize].flags & Vertex::PRESCRIBED == 0;
        let edges = Edges::new(&topology.edges, lengths.edge_limits, rest, moves);
        let trees = Trees::new(&mut engine, topology, &order)?;
        let adjacency = Adjacency::new(topology);
        let blocks = model::blocks(model);
        let bricks = Bricks::new(&vertices[..count], settings.bucket_vertices);
        let sizes = Sizes {
            vertices: count,
            groups: groups.max().unwrap_or(0),
            edges: topology.edges.len(),
            triangles: triangles.len(),
            planes: planes.len(),
            pair_frictions: pair_frictions.len(),
            limits: edges.len(),
            clusters: [edges.clusters.len(), edges.vertices.len(), edges.color_ends.len()],
            adjacency: adjacency.words.len(),
            blocks: blocks.len(),
            rows: trees.rows(planes.len()),
            buckets: bricks.count(),
        };
        let frictional = constraints.frictions.iter().any(|friction| *friction > 0.0)
            || pair_frictions.iter().any(|pair| pair.coefficient > 0.0);
        let has_pins =
            vertices.iter().any(|v| v.flags & (Vertex::PRESCRIBED | Vertex::OBSTACLE) == Vertex::PRESCRIBED);
        let buffers = Buffers::new(&mut engine, &sizes)?;
        let near = NearList::new(&mut engine)?;
        let end_control = engine.buffer("control at the end", words::<Control>(1))?;
        let carried = CarriedList::new(&mut engine)?;
        let mut setup = Recording::default();
        let of_vertices = rest_on_grid.iter().zip(model.vertex_component());
        let rest: Vec<[i32; 4]> = of_vertices.map(|(&[x, y, z], &c)| [x, y, z, c as i32]).collect();
        setup.write(buffers.rest, &rest);
        setup.write(buffers.vertices, &vertices);
        setup.write(buffers.edges, &topology.edges);
        setup.write(buffers.triangles, &triangles);
        setup.write(buffers.planes, &planes);
        setup.write(buffers.pair_frictions, &pair_frictions);
        setup.write(buffers.adjacency, &adjacency.words);
        setup.write(buffers.vertex_blocks, &blocks);
        setup.write(buffers.limits, &edges.limits(grid, &[]));
        setup.write(buffers.clusters, &edges.clusters);
        setup.write(buffers.cluster_vertices, &edges.vertices);
        setup.write(buffers.cluster_colors, &edges.color_ends);
        trees.all().iter().for_each(|tree| tree.upload(&mut setup));
        engine.run(&setup, &[])?;
        let lengths = StepLengths {
            min_separation: grid.length(lengths.min_separation).next_up(),
            growth: f32::MAX,
            damping: settings.damping as f32,
            progress: (settings.progress / grid.quantum()) as f32,
        };
        Ok(Self {
            engine,
            grid: *grid,
            settings: settings.clone(),
            lengths,
            sizes,
            buffers,
            vertices,
            near,
            carried,
            trees,
            edges,
            bricks,
            adjacency_starts: [adjacency.edges_first, adjacency.triangles_first],
            frictional,
            has_pins,
            yields: false,
            stop: Stop::NEVER,
            row_count: 0,
            ended: None,
            end_control,
            submissions: 0,
            before: [0; 2],
            polishes: false,
            polished: 0,
            expected_steps: [1; 2],
            step_dispatches: [None; 2],
            steps_in_a_row: 0,
            travel: 1.0,
            shrunk: false,
            fresh: false,
            again: false,
            pending: Recording::default(),
            listed: false,
        })
    }

    /// Puts the vertices at other positions [m], where no two elements intersect. Each goes to the nearest
    /// point of the grid; returns these points [m]. They may be far from where the scene was prepared, but
    /// steps then take longer: trees keep the order of the elements ([`Self::reorder`]).
    ///
    /// # Errors
    /// A wrong length; a position outside of the grid; the device failed.
    pub fn place(&mut self, positions: &[Point]) -> Result<Vec<Point>, CollisionError> {
        check_length("positions", positions.len(), self.sizes.vertices)?;
        let on_grid = snapped(&self.grid, positions)?;
        self.pending.write(self.buffers.positions, &padded(&on_grid));
        (self.ended, self.listed) = (None, false);
        let grid = self.grid;
        Ok(collected(&on_grid, |&x| grid.position(x)))
    }

    /// Orders the elements in space anew, by any positions that are typical of the scene from now on [m]. To be
    /// called between two calls: candidates have another order afterwards. Bodies that mix cost time otherwise.
    ///
    /// # Errors
    /// A wrong length; positions that no grid holds; the device failed.
    pub fn reorder(&mut self, order: &[Point]) -> Result<(), CollisionError> {
        check_length("positions", order.len(), self.sizes.vertices)?;
        let order = snapped_elsewhere(&self.grid, order)?;
        self.trees.reorder(&order, &mut self.pending);
        Ok(())
    }

    /// Frees the buffers and gives the engine back.
    pub fn into_engine(mut self) -> E {
        self.engine.clear();
        self.engine
    }

    /// The grid on which all positions lie.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Begins a call. Targets outside of the grid are moved to its border.
    ///
    /// # Errors
    /// A wrong length; the device failed.
    pub fn begin(&mut self, call: &Call<'_>) -> Result<(), CollisionError> {
        check_length("target", call.target.len(), self.sizes.vertices)?;
        if !call.slip_start.is_empty() {
            check_length("slip_start", call.slip_start.len(), self.sizes.vertices)?;
        }
        let grid = self.grid;
        let inside = |points: &[Point]| -> Vec<GridPoint> { collected(points, |y| grid.nearest_inside(y)) };
        let (target, slip_start) = (inside(call.target), inside(call.slip_start));
        let slips_from_here = slip_start.is_empty();
        let changes = self.set_known(call.known)?;
        let carried = carried::sorted(&grid, call.carried);
        self.carried.set(&mut self.engine, &carried, &mut self.pending)?;
        let mut recording = take(&mut self.pending);
        let b = &self.buffers;
        if changes {
            recording.write(b.vertices, &self.vertices);
        }
        // Those of the last call stay on the device.
        if self.yields || !call.yielding.is_empty() {
            recording.write(b.limits, &self.edges.limits(&grid, call.yielding));
            self.yields = !call.yielding.is_empty();
        }
        recording.write(b.targets, &padded(&target));
        if !slips_from_here {
            recording.write(b.slip_start, &padded(&slip_start));
        }
        recording.write(b.coarse_factor, &[1.0, MOST_GROWTH]);
        recording.write(b.control, &[Control::of_new_call()]);
        recording.dispatch(
            &kernels::BEGIN_CALL,
            &[b.positions, b.targets, b.limits, b.aims, b.slip_start, b.swings, b.late, b.vertices],
            kernels::begin_call::Params {
                vertices: self.sizes.vertices as u32,
                limits: self.edges.len() as u32,
                slips_from_here: u32::from(slips_from_here),
                guarded_stretch: self.settings.guarded_stretch as f32,
            },
            self.sizes.vertices.max(self.edges.len()),
        );
        self.pending = recording;
        if self.submissions > 0 {
            self.before = [self.submissions, self.row_count];
        }
        (self.ended, self.submissions) = (None, 0);
        (self.stop, self.row_count, self.polishes, self.polished) = (call.stop, 0, false, 0);
        self.lengths.growth = self.grid.length(call.growth).min(f32::MAX);
        (self.fresh, self.again, self.listed, self.steps_in_a_row) = (true, false, false, 0);
        (self.travel, self.shrunk) = (1.0, false);
        Ok(())
    }

    /// Notes the vertices whose contacts the target knows; whether they are others than before.
    fn set_known(&mut self, known: &[bool]) -> Result<bool, CollisionError> {
        if !known.is_empty() {
            check_length("known", known.len(), self.sizes.vertices)?;
        }
        let mut changes = false;
        for (v, vertex) in self.vertices.iter_mut().enumerate() {
            let is_known = known.get(v).copied().unwrap_or(false);
            let flags = if is_known { vertex.flags | Vertex::KNOWN } else { vertex.flags & !Vertex::KNOWN };
            changes |= flags != vertex.flags;
            vertex.flags = flags;
        }
        Ok(changes)
    }

    /// Seconds of the phases of the steps since the last call, between time stamps of the device; None if it
    /// has none.
    pub fn take_phase_seconds(&mut self) -> Option<PhaseSeconds> {
        self.engine.take_phase_seconds()
    }

    /// What runs the stages.
    pub fn engine(&self) -> &E {
        &self.engine
    }

    /// The positions [m], exactly as they are on the device.
    ///
    /// # Errors
    /// The device failed.
    pub fn positions(&mut self) -> Result<Vec<Point>, CollisionError> {
        let [positions] = self.points([self.buffers.positions])?;
        Ok(positions)
    }

    /// The points of some buffers [m].
    fn points<const N: usize>(&mut self, buffers: [BufferId; N]) -> Result<[Vec<Point>; N], CollisionError> {
        let read = buffers.map(|buffer| (buffer, 4 * self.sizes.vertices));
        let words = self.engine.run(&take(&mut self.pending), &read)?;
        Ok(std::array::from_fn(|k| self.points_of(&words[k])))
    }

    fn points_of(&self, words: &[u32]) -> Vec<Point> {
        let grid = self.grid;
        collected(bytemuck::cast_slice(words), |&[x, y, z, _]: &[i32; 4]| grid.position([x, y, z]))
    }

    /// The positions, and where the last step wanted to go [m].
    ///
    /// # Errors
    /// The device failed.
    pub fn positions_and_aims(&mut self) -> Result<(Vec<Point>, Vec<Point>), CollisionError> {
        let [positions, aims] = self.points([self.buffers.positions, self.buffers.aims])?;
        Ok((positions, aims))
    }

    /// The candidates of the last step or of [`Self::search`], sorted.
    ///
    /// # Errors
    /// The device failed.
    pub fn candidates(&mut self) -> Result<Vec<Candidate>, CollisionError> {
        let read = [
            (self.buffers.control, words::<Control>(1)),
            (self.buffers.candidates, words::<Candidate>(self.buffers.capacity)),
        ];
        let all = self.engine.run(&take(&mut self.pending), &read)?;
        let control: Control = bytemuck::cast_slice(&all[0])[0];
        let candidates: &[Candidate] = bytemuck::cast_slice(&all[1]);
        let mut candidates = candidates[..control.candidates as usize].to_vec();
        candidates.sort_unstable();
        Ok(candidates)
    }
}

/// With a fourth coordinate, as the device stores positions.
fn padded(points: &[GridPoint]) -> Vec<[i32; 4]> {
    collected(points, |&[x, y, z]| [x, y, z, 0])
}

fn check_length(what: &'static str, given: usize, vertices: usize) -> Result<(), CollisionError> {
    if given == vertices { Ok(()) } else { Err(CollisionError::Length { what, given, vertices }) }
}

/// Largest side of the box around the positions [m].
fn extent(positions: &[Point]) -> f64 {
    let side = |k: usize| {
        let coordinates = || positions.iter().map(|x| x[k]);
        coordinates().fold(f64::NEG_INFINITY, f64::max) - coordinates().fold(f64::INFINITY, f64::min)
    };
    (0..3).map(side).fold(0.0, f64::max)
}

/// Positions on a grid with the quantum of this one where they are.
fn snapped_elsewhere(grid: &Grid, positions: &[Point]) -> Result<Vec<GridPoint>, CollisionError> {
    let grid = grid.around_others(positions).ok_or(CollisionError::OutsideGrid { vertex: 0 })?;
    snapped(&grid, positions)
}

fn snapped(grid: &Grid, positions: &[Point]) -> Result<Vec<GridPoint>, CollisionError> {
    let snapped = collected(positions, |x| grid.nearest(x));
    match snapped.iter().position(Option::is_none) {
        Some(vertex) => Err(CollisionError::OutsideGrid { vertex }),
        None => Ok(snapped.into_iter().flatten().collect()),
    }
}

#[cfg(test)]
mod edge_tests;
#[cfg(test)]
mod list_tests;
#[cfg(test)]
mod merge_tests;
#[cfg(test)]
mod row_tests;
#[cfg(test)]
mod slab_tests;
#[cfg(test)]
mod tests;
