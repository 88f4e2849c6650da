//! Steps toward a target that nothing passes through: search, contact geometry and forward step on an engine.
//!
//! Positions, targets, trust regions and pairs stay on the device. A step is the list of dispatches that
//! [`Collision::record_step`] writes; the host reads [`Control`] alone, and grows buffers that were too small. A step
//! with a buffer that is too small moves nothing and is made again.

use crate::cpu;
use crate::edges::Edges;
use crate::engine::Engine;
use crate::error::GpuError;
use crate::grid::{Grid, GridError, GridPoint};
use crate::layout::{Ball, Candidate, Control, EdgeLimit, Kind, OldRow, PairState, Separation, Slot, Vertex};
use crate::model::{self, Constraints, Lengths};
use crate::recording::{BufferId, Recording};
use crate::stages;
use crate::tree::Tree;
use bowknot_geometry::{CollisionModel, Point, Topology};
use bytemuck::Pod;

/// Longest travel of a vertex in a step, and smallest radius of a trust region, in local edge lengths.
const LONGEST_TRAVEL: f32 = 0.35;
const SMALLEST_RADIUS: f32 = 0.1;

/// Partners of an element for which there is room at first, and candidates per vertex.
const FIRST_PARTNERS: usize = 24;
const FIRST_CANDIDATES: usize = 16;

/// Sweeps of a backward step, and the part of the curvature of edges that damps it.
const SWEEPS: usize = 8;
const EDGE_PROXIMAL: f32 = 0.1;

/// Words of a row before its partners: their number, and the element.
const ROW_HEADER: usize = 2;

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
    #[error("vertex {vertex} has left the grid of the device: use --backend cpu")]
    OutsideGrid {
        /// The vertex.
        vertex: usize,
    },
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
    /// Largest remaining distance of a prescribed vertex that no pair holds back [m].
    pub unhindered_lag: f64,
    /// Longest move of a vertex [m].
    pub largest_move: f64,
}

/// The collision stage of a scene on an engine.
#[derive(Debug)]
pub struct Collision<E> {
    engine: E,
    grid: Grid,
    lengths: StepLengths,
    counts: Counts,
    buffers: Buffers,
    trees: Trees,
    edges: Edges,
    /// Partners of an element that fit into a row, and candidates that fit into their list.
    most_partners: usize,
    capacity: usize,
    /// Candidates of the time before a search for which there is room.
    old_capacity: usize,
    /// Whether all trust regions are new.
    all_new: bool,
    /// Whether the step is made again, because a buffer was too small.
    again: bool,
}

/// Lengths in quanta that all steps share.
#[derive(Clone, Copy, Debug)]
struct StepLengths {
    min_separation: f32,
    /// By how much the rows of a call ask a small gap to grow.
    growth: f32,
    damping: f32,
}

#[derive(Clone, Copy, Debug)]
struct Counts {
    vertices: usize,
    groups: usize,
    planes: usize,
}

/// Buffers that all stages share.
#[derive(Clone, Copy, Debug)]
struct Buffers {
    positions: BufferId,
    targets: BufferId,
    vertices: BufferId,
    edges: BufferId,
    triangles: BufferId,
    planes: BufferId,
    paths: BufferId,
    alphas: BufferId,
    group_caps: BufferId,
    group_alphas: BufferId,
    balls: BufferId,
    control: BufferId,
    partners: BufferId,
    starts: BufferId,
    blocks: BufferId,
    candidates: BufferId,
    separations: BufferId,
    states: BufferId,
    rest: BufferId,
    old_rows: BufferId,
    old_elements: BufferId,
    old_states: BufferId,
    limits: BufferId,
    proximal: BufferId,
    displacements: BufferId,
    /// Where the vertices go in this step: those of the backward step or, if there is none, the targets.
    aims: BufferId,
}

/// Trees by the primitives that they hold, and the queries into them.
#[derive(Debug)]
struct Trees {
    surface: DeviceTree,
    edges: DeviceTree,
    triangles: DeviceTree,
    particles: DeviceTree,
    strands: DeviceTree,
}

/// A tree with its buffers. One without elements has buffers too, which no stage reads.
#[derive(Debug)]
struct DeviceTree {
    tree: Tree,
    slots: BufferId,
    boxes: BufferId,
}

impl<E: Engine> Collision<E> {
    /// Prepares the scene of `model` at `positions` [m], where no two elements intersect; `rest` are the rest positions
    /// [m]. `damping` is the share of a gap that a step may use up.
    ///
    /// # Errors
    /// No grid has room for the scene; the device has no memory; wrong lengths.
    pub fn new(
        mut engine: E,
        model: &CollisionModel,
        positions: &[Point],
        rest: &[Point],
        lengths: &Lengths<'_>,
        constraints: &Constraints<'_>,
        damping: f64,
    ) -> Result<Self, CollisionError> {
        let count = model.topology().vertex_count;
        for (what, given) in [
            ("positions", positions.len()),
            ("rest positions", rest.len()),
            ("edges", lengths.edges.len()),
            ("margins", lengths.margins.len()),
            ("deltas", lengths.deltas.len()),
        ] {
            check_length(what, given, count)?;
        }
        let room = extent(positions).max(extent(rest));
        let grid = Grid::around(positions, room, lengths.min_separation)?;
        let on_grid = snapped(&grid, positions)?;
        let rest_grid = grid.around_others(rest).ok_or(CollisionError::OutsideGrid { vertex: 0 })?;
        let rest_on_grid = snapped(&rest_grid, rest)?;
        let vertices = model::vertices(model, lengths, constraints, &grid);
        let planes = model::planes(model, &grid);
        let groups = vertices.iter().filter(|v| v.group != crate::layout::NONE).map(|v| v.group as usize + 1);
        let counts = Counts { vertices: count, groups: groups.max().unwrap_or(0), planes: planes.len() };
        let trees = Trees::new(&mut engine, model.topology(), &on_grid)?;
        let (most_partners, capacity) = (FIRST_PARTNERS, (FIRST_CANDIDATES * count).max(64));
        let rows = trees.rows(&counts);
        let topology = model.topology();
        let triangles: Vec<[u32; 4]> = topology.triangles.iter().map(|&[a, b, c]| [a, b, c, 0]).collect();
        let targets = engine.buffer("targets", 4 * count)?;
        let mut buffers = Buffers {
            positions: engine.buffer("positions", 4 * count)?,
            targets,
            vertices: engine.buffer("vertices", words::<Vertex>(count))?,
            edges: engine.buffer("edges", 2 * topology.edges.len())?,
            triangles: engine.buffer("triangles", 4 * triangles.len())?,
            planes: engine.buffer("planes", words::<crate::layout::Plane>(planes.len().max(1)))?,
            paths: engine.buffer("paths", 4 * count)?,
            alphas: engine.buffer("step sizes", count)?,
            group_caps: engine.buffer("group caps", counts.groups)?,
            group_alphas: engine.buffer("group step sizes", counts.groups)?,
            balls: engine.buffer("trust regions", words::<Ball>(count))?,
            control: engine.buffer("control", words::<Control>(1))?,
            partners: engine.buffer("partners", rows * (ROW_HEADER + most_partners))?,
            starts: engine.buffer("starts", rows)?,
            blocks: engine.buffer("blocks", rows.div_ceil(cpu::count::BLOCK))?,
            candidates: engine.buffer("candidates", words::<Candidate>(capacity))?,
            separations: engine.buffer("separations", words::<Separation>(capacity))?,
            states: engine.buffer("states of pairs", words::<PairState>(capacity))?,
            rest: engine.buffer("rest positions", 4 * count)?,
            old_rows: engine.buffer("old rows", words::<OldRow>(rows))?,
            old_elements: engine.buffer("old partners", capacity)?,
            old_states: engine.buffer("old states of pairs", words::<PairState>(capacity))?,
            limits: targets,
            proximal: targets,
            displacements: targets,
            aims: targets,
        };
        let moves = |v: u32| vertices[v as usize].flags & Vertex::PRESCRIBED == 0;
        let edges = Edges::new(&topology.edges, lengths.edge_limits, moves);
        if edges.len() > 0 {
            buffers.limits = engine.buffer("edge limits", words::<EdgeLimit>(edges.len()))?;
            buffers.proximal = engine.buffer("proximal weights", count)?;
            buffers.displacements = engine.buffer("displacements", 4 * count)?;
            buffers.aims = engine.buffer("aims", 4 * count)?;
        }
        let mut setup = Recording::default();
        setup.write(buffers.positions, &padded(&on_grid));
        setup.write(buffers.rest, &padded(&rest_on_grid));
        setup.write(buffers.vertices, &vertices);
        setup.write(buffers.edges, &topology.edges);
        setup.write(buffers.triangles, &triangles);
        setup.write(buffers.planes, &planes);
        trees.all().iter().for_each(|tree| tree.upload(&mut setup));
        engine.run(&setup, &[])?;
        let lengths = StepLengths {
            min_separation: grid.length(lengths.min_separation).next_up(),
            growth: f32::MAX,
            damping: damping as f32,
        };
        Ok(Self {
            engine,
            grid,
            lengths,
            counts,
            buffers,
            trees,
            edges,
            most_partners,
            capacity,
            old_capacity: capacity,
            all_new: true,
            again: false,
        })
    }

    /// The grid on which all positions lie.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Begins a call: sets where the vertices want to go [m]; targets outside of the grid are moved to its border. Pairs
    /// that are closer than they should be ask to open by at most `growth` [m] in the call.
    ///
    /// # Errors
    /// A wrong length; the device failed.
    pub fn begin(&mut self, target: &[Point], growth: f64) -> Result<(), CollisionError> {
        check_length("target", target.len(), self.counts.vertices)?;
        let inside: Vec<GridPoint> = target.iter().map(|y| self.grid.nearest_inside(y)).collect();
        let mut recording = Recording::default();
        recording.write(self.buffers.targets, &padded(&inside));
        if self.edges.len() > 0 {
            let start = self.positions()?;
            recording.write(self.buffers.limits, &self.edges.limits(&start, &self.grid));
        }
        // Without candidates nothing is inherited from the call before.
        recording.write(self.buffers.control, &[Control::default()]);
        self.engine.run(&recording, &[])?;
        self.lengths.growth = self.grid.length(growth).min(f32::MAX);
        self.all_new = true;
        Ok(())
    }

    /// Moves the vertices toward their target as far as all candidate pairs allow.
    ///
    /// # Errors
    /// The device failed, or has no memory for all candidates.
    pub fn step(&mut self) -> Result<StepReport, CollisionError> {
        self.make_room_for_old()?;
        loop {
            let mut recording = Recording::default();
            self.record_step(&mut recording);
            let read = [(self.buffers.control, words::<Control>(1))];
            let words = self.engine.run(&recording, &read)?.swap_remove(0);
            let control: Control = bytemuck::cast_slice(&words)[0];
            if control.overflow == 0 {
                (self.all_new, self.again) = (false, false);
                return Ok(self.report(&control));
            }
            self.grow(&control)?;
        }
    }

    /// The positions [m], exactly as they are on the device.
    ///
    /// # Errors
    /// The device failed.
    pub fn positions(&mut self) -> Result<Vec<Point>, CollisionError> {
        let read = [(self.buffers.positions, 4 * self.counts.vertices)];
        let words = self.engine.run(&Recording::default(), &read)?.swap_remove(0);
        let positions: &[[i32; 4]] = bytemuck::cast_slice(&words);
        Ok(positions.iter().map(|&[x, y, z, _]| self.grid.position([x, y, z])).collect())
    }

    /// The candidates of the last step, sorted.
    ///
    /// # Errors
    /// The device failed.
    pub fn candidates(&mut self) -> Result<Vec<Candidate>, CollisionError> {
        let read = [
            (self.buffers.control, words::<Control>(1)),
            (self.buffers.candidates, words::<Candidate>(self.capacity)),
        ];
        let all = self.engine.run(&Recording::default(), &read)?;
        let control: Control = bytemuck::cast_slice(&all[0])[0];
        let candidates: &[Candidate] = bytemuck::cast_slice(&all[1]);
        let mut candidates = candidates[..control.candidates as usize].to_vec();
        candidates.sort_unstable();
        Ok(candidates)
    }

    /// Makes room to keep all present candidates.
    fn make_room_for_old(&mut self) -> Result<(), GpuError> {
        if self.old_capacity < self.capacity {
            let Self { engine, buffers, capacity, .. } = self;
            engine.free(buffers.old_elements);
            engine.free(buffers.old_states);
            buffers.old_elements = engine.buffer("old partners", *capacity)?;
            buffers.old_states = engine.buffer("old states of pairs", words::<PairState>(*capacity))?;
            self.old_capacity = self.capacity;
        }
        Ok(())
    }

    /// The dispatches of a step, in order.
    fn record_step(&self, recording: &mut Recording) {
        self.record_start(recording);
        // If the step is made again, the aims are known.
        if !self.again {
            self.record_backward(recording);
        }
        self.record_paths(recording);
        self.record_search(recording);
        self.record_forward(recording);
    }

    /// Resets what the stages of a step add to.
    fn record_start(&self, recording: &mut Recording) {
        let buffers = &self.buffers;
        let ones = vec![1.0f32; self.counts.groups];
        recording.write(buffers.group_caps, &ones);
        recording.write(buffers.group_alphas, &ones);
        recording.write(buffers.control, &[0u32; Control::RESET_WORDS]);
    }

    /// Where the vertices should go so that no edge is too long.
    fn record_backward(&self, recording: &mut Recording) {
        if self.edges.len() == 0 {
            return;
        }
        let (b, vertices) = (&self.buffers, self.counts.vertices as u32);
        recording.dispatch(
            &stages::CURVE_EDGES,
            &[b.positions, b.limits, b.proximal],
            cpu::curve_edges::Params { edges: self.edges.len() as u32, strength: EDGE_PROXIMAL },
            self.edges.len(),
        );
        recording.dispatch(
            &stages::RELEASE,
            &[b.positions, b.targets, b.vertices, b.proximal, b.displacements],
            cpu::release::Params { vertices },
            self.counts.vertices,
        );
        // First the multipliers of the last step are applied.
        for sweep in 0..=SWEEPS {
            for color in self.edges.colors() {
                recording.dispatch(
                    &stages::SWEEP_EDGES,
                    &[b.positions, b.limits, b.displacements],
                    cpu::sweep_edges::Params {
                        first: color.start as u32,
                        end: color.end as u32,
                        only_apply: u32::from(sweep == 0),
                    },
                    color.len(),
                );
            }
        }
        recording.dispatch(
            &stages::AIM,
            &[b.positions, b.targets, b.displacements, b.aims],
            cpu::aim::Params { vertices },
            self.counts.vertices,
        );
    }

    /// How far each vertex wants to go, and which trust regions do not cover it.
    fn record_paths(&self, recording: &mut Recording) {
        let (b, vertices) = (&self.buffers, self.counts.vertices as u32);
        recording.dispatch(
            &stages::PLAN,
            &[b.positions, b.aims, b.vertices, b.paths, b.group_caps],
            cpu::plan::Params { vertices, longest: LONGEST_TRAVEL },
            self.counts.vertices,
        );
        recording.dispatch(
            &stages::JOIN,
            &[b.vertices, b.group_caps, b.paths, b.alphas],
            cpu::join::Params { vertices },
            self.counts.vertices,
        );
        recording.dispatch(
            &stages::COVER,
            &[b.positions, b.paths, b.vertices, b.balls, b.control],
            cpu::cover::Params { vertices, all: u32::from(self.all_new), smallest: SMALLEST_RADIUS },
            self.counts.vertices,
        );
    }

    /// The candidates, if trust regions have changed.
    fn record_search(&self, recording: &mut Recording) {
        let b = &self.buffers;
        self.record_keep(recording);
        for tree in self.trees.targets() {
            tree.record_fit(b, recording);
        }
        let mut row = 0;
        for (kind, queries, targets) in self.trees.searches() {
            self.record_traverse(kind, queries, targets, row, recording);
            row += queries.tree.slots.len();
        }
        if self.counts.planes > 0 {
            let queries = &self.trees.surface;
            let params = cpu::near_planes::Params {
                queries: queries.tree.slots.len() as u32,
                planes: self.counts.planes as u32,
                first_row: row as u32,
                stride: self.stride(),
                most: self.most_partners as u32,
            };
            let buffers = [queries.slots, b.planes, b.balls, b.vertices, b.partners, b.control];
            recording.dispatch(&stages::NEAR_PLANES, &buffers, params, queries.tree.slots.len());
            row += queries.tree.slots.len();
        }
        let (rows, most, capacity) = (row as u32, self.most_partners as u32, self.capacity as u32);
        let stride = self.stride();
        recording.dispatch(
            &stages::COUNT,
            &[b.partners, b.starts, b.blocks, b.control],
            cpu::count::Params { rows, stride, most },
            row,
        );
        recording.dispatch(
            &stages::TOTAL,
            &[b.blocks, b.control],
            cpu::total::Params { blocks: rows.div_ceil(cpu::count::BLOCK as u32), capacity },
            1,
        );
        recording.dispatch(
            &stages::GATHER,
            &[b.partners, b.starts, b.blocks, b.candidates, b.control],
            cpu::gather::Params { rows, stride, most, capacity },
            row,
        );
        recording.dispatch(
            &stages::INHERIT,
            &[b.partners, b.starts, b.blocks, b.old_rows, b.old_elements, b.old_states, b.states, b.control],
            cpu::inherit::Params { rows, stride, most, capacity },
            row,
        );
    }

    /// Keeps the present candidates with their states. If the step is made again they have been kept already, and the
    /// present ones are not whole.
    fn record_keep(&self, recording: &mut Recording) {
        if self.again {
            return;
        }
        let (b, rows) = (&self.buffers, self.trees.rows(&self.counts));
        recording.dispatch(
            &stages::KEEP,
            &[b.partners, b.starts, b.blocks, b.states, b.old_rows, b.old_elements, b.old_states, b.control],
            cpu::keep::Params {
                rows: rows as u32,
                stride: self.stride(),
                most: self.most_partners as u32,
                capacity: self.capacity as u32,
            },
            rows,
        );
    }

    fn record_traverse(
        &self,
        kind: Kind,
        queries: &DeviceTree,
        targets: &DeviceTree,
        row: usize,
        recording: &mut Recording,
    ) {
        let b = &self.buffers;
        let mut level_first = [[0; 4]; 3];
        for (k, level) in targets.tree.levels.iter().enumerate() {
            level_first[k / 4][k % 4] = level.first as u32;
        }
        let params = cpu::traverse::Params {
            queries: queries.tree.slots.len() as u32,
            count: queries.tree.vertex_count as u32,
            kind: kind as u32,
            symmetric: u32::from(queries.slots == targets.slots),
            first_row: row as u32,
            stride: self.stride(),
            most: self.most_partners as u32,
            levels: targets.tree.levels.len() as u32,
            level_first,
        };
        let buffers =
            [queries.slots, targets.slots, targets.boxes, b.balls, b.vertices, b.partners, b.control];
        recording.dispatch(&stages::TRAVERSE, &buffers, params, queries.tree.slots.len());
    }

    /// Contact geometry, step sizes and the move.
    fn record_forward(&self, recording: &mut Recording) {
        let (b, vertices, capacity) = (&self.buffers, self.counts.vertices as u32, self.capacity as u32);
        recording.dispatch(
            &stages::SEPARATE,
            &[b.positions, b.edges, b.triangles, b.planes, b.candidates, b.separations, b.control],
            cpu::separate::Params { capacity },
            self.capacity,
        );
        recording.dispatch(
            &stages::SPACE,
            &[b.rest, b.edges, b.triangles, b.vertices, b.candidates, b.separations, b.states, b.control],
            cpu::space::Params {
                capacity,
                min_separation: self.lengths.min_separation,
                growth: self.lengths.growth,
            },
            self.capacity,
        );
        recording.dispatch(
            &stages::LIMIT,
            &[b.edges, b.triangles, b.vertices, b.candidates, b.separations, b.paths, b.alphas, b.control],
            cpu::limit::Params { capacity, damping: self.lengths.damping },
            self.capacity,
        );
        recording.dispatch(
            &stages::LIMIT_GROUPS,
            &[b.vertices, b.alphas, b.group_alphas],
            cpu::limit_groups::Params { vertices },
            self.counts.vertices,
        );
        recording.dispatch(
            &stages::ADVANCE,
            &[b.aims, b.vertices, b.paths, b.alphas, b.group_alphas, b.positions, b.control],
            cpu::advance::Params { vertices },
            self.counts.vertices,
        );
    }

    /// Words of a row of partners.
    fn stride(&self) -> u32 {
        (ROW_HEADER + self.most_partners) as u32
    }

    /// Makes room for what did not fit. What is read afterwards is written anew, as all trust regions are new.
    fn grow(&mut self, control: &Control) -> Result<(), CollisionError> {
        let Self { engine, buffers, .. } = self;
        let (partners, candidates) = (control.most_partners as usize, control.candidates as usize);
        if partners > self.most_partners {
            self.most_partners = partners + partners / 4;
            engine.free(buffers.partners);
            let rows = self.trees.rows(&self.counts);
            buffers.partners = engine.buffer("partners", rows * (ROW_HEADER + self.most_partners))?;
        }
        if candidates > self.capacity {
            self.capacity = candidates + candidates / 4;
            engine.free(buffers.candidates);
            engine.free(buffers.separations);
            buffers.candidates = engine.buffer("candidates", words::<Candidate>(self.capacity))?;
            buffers.separations = engine.buffer("separations", words::<Separation>(self.capacity))?;
            engine.free(buffers.states);
            buffers.states = engine.buffer("states of pairs", words::<PairState>(self.capacity))?;
        }
        tracing::debug!(partners, candidates, "buffers grew");
        (self.all_new, self.again) = (true, true);
        Ok(())
    }

    fn report(&self, control: &Control) -> StepReport {
        let length = |bits: u32| f64::from(f32::from_bits(bits)) * self.grid.quantum();
        StepReport {
            candidates: control.candidates as usize,
            searched: control.changed != 0,
            frozen: control.frozen as usize,
            remaining: length(control.remaining),
            unhindered_lag: length(control.unhindered_lag),
            largest_move: length(control.largest_move),
        }
    }
}

impl Trees {
    fn new(engine: &mut impl Engine, topology: &Topology, positions: &[GridPoint]) -> Result<Self, GpuError> {
        let points = |list: &[u32]| -> Vec<(u32, [u32; 1])> { list.iter().map(|&v| (v, [v])).collect() };
        let edge = |e: u32| (e, topology.edges[e as usize]);
        let edges: Vec<(u32, [u32; 2])> = (0..topology.edges.len() as u32).map(edge).collect();
        let triangles: Vec<(u32, [u32; 3])> = (0..).zip(topology.triangles.iter().copied()).collect();
        let strands: Vec<(u32, [u32; 2])> = topology.strand_edges.iter().map(|&e| edge(e)).collect();
        let mut device = |tree: Tree| DeviceTree::new(engine, tree);
        Ok(Self {
            surface: device(Tree::new(&points(&topology.surface_vertices), positions))?,
            edges: device(Tree::new(&edges, positions))?,
            triangles: device(Tree::new(&triangles, positions))?,
            particles: device(Tree::new(&points(&topology.particles), positions))?,
            strands: device(Tree::new(&strands, positions))?,
        })
    }

    fn all(&self) -> [&DeviceTree; 5] {
        [&self.surface, &self.edges, &self.triangles, &self.particles, &self.strands]
    }

    /// Those that are searched in.
    fn targets(&self) -> impl Iterator<Item = &DeviceTree> {
        let mut targets: Vec<&DeviceTree> = Vec::new();
        for (_, _, target) in self.searches() {
            if targets.iter().all(|known| known.slots != target.slots) {
                targets.push(target);
            }
        }
        targets.into_iter()
    }

    /// Kinds of pairs with the tree of the queries and the one that they search in. What the scene does not have takes
    /// no part.
    fn searches(&self) -> impl Iterator<Item = (Kind, &DeviceTree, &DeviceTree)> {
        [
            (Kind::VertexVertex, &self.particles, &self.particles),
            (Kind::VertexEdge, &self.particles, &self.strands),
            (Kind::VertexTriangle, &self.surface, &self.triangles),
            (Kind::EdgeEdge, &self.edges, &self.edges),
        ]
        .into_iter()
        .filter(|(_, queries, targets)| !queries.tree.is_empty() && !targets.tree.is_empty())
    }

    /// Rows of partners of all queries.
    fn rows(&self, counts: &Counts) -> usize {
        let slots = |tree: &DeviceTree| tree.tree.slots.len();
        let searched: usize = self.searches().map(|(_, queries, _)| slots(queries)).sum();
        let near_planes = if counts.planes > 0 { slots(&self.surface) } else { 0 };
        searched + near_planes
    }
}

impl DeviceTree {
    fn new(engine: &mut impl Engine, tree: Tree) -> Result<Self, GpuError> {
        let slots = engine.buffer("elements", words::<Slot>(tree.slots.len()))?;
        let boxes = engine.buffer("boxes", words::<crate::layout::NodeBox>(tree.box_count))?;
        Ok(Self { tree, slots, boxes })
    }

    fn upload(&self, recording: &mut Recording) {
        if !self.tree.is_empty() {
            recording.write(self.slots, &self.tree.slots);
            recording.write(self.boxes, &self.tree.blank_boxes());
        }
    }

    /// Fits the boxes, level by level.
    fn record_fit(&self, b: &Buffers, recording: &mut Recording) {
        let slots = self.tree.slots.len();
        recording.dispatch(
            &stages::BOXES,
            &[self.slots, b.balls, b.vertices, self.boxes, b.control],
            cpu::boxes::Params { slots: slots as u32, count: self.tree.vertex_count as u32 },
            slots,
        );
        for levels in self.tree.levels.windows(2) {
            let [below, level] = [levels[0], levels[1]];
            recording.dispatch(
                &stages::REFIT,
                &[self.boxes, b.control],
                cpu::refit::Params {
                    first: level.first as u32,
                    nodes: level.nodes as u32,
                    first_child: below.first as u32,
                    children: below.nodes as u32,
                },
                level.nodes,
            );
        }
    }
}

/// Words of 32 bits of so many entries.
fn words<T: Pod>(count: usize) -> usize {
    count * size_of::<T>() / 4
}

/// With a fourth coordinate, as the device stores positions.
fn padded(points: &[GridPoint]) -> Vec<[i32; 4]> {
    points.iter().map(|&[x, y, z]| [x, y, z, 0]).collect()
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

fn snapped(grid: &Grid, positions: &[Point]) -> Result<Vec<GridPoint>, CollisionError> {
    let snap = |(vertex, x): (usize, &Point)| grid.nearest(x).ok_or(CollisionError::OutsideGrid { vertex });
    positions.iter().enumerate().map(snap).collect()
}

#[cfg(test)]
mod tests;
