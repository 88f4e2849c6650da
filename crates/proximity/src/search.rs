//! The proximity search.

use crate::assemble::PartnerTable;
use crate::candidates::CandidateList;
use crate::collision_matrix::CollisionMatrix;
use crate::frame::{self, LocalVertex};
use crate::half_spaces::near_half_spaces;
use crate::layer::Layer;
use crate::narrow::{BLANK, separate_all};
use crate::obstacles::{Changes, ObstacleTracker};
use crate::pair_test::{EdgeEdge, PairTest, VertexEdge, VertexTriangle, VertexVertex};
use crate::pairs::{Pair, PairList};
use crate::statistics::SearchStatistics;
use crate::traverse::{Query, Scene, Scratch, TASK_LEAVES, TaskResult, overlapping_leaves, search_leaves};
use crate::tree::Tree;
use bowknot_geometry::{CollisionModel, Identity, PairKind, Point, Separation, Vector};
use rayon::prelude::*;
use std::sync::Mutex;

/// Vertices that one task brings to the local frame.
const LOCAL_CHUNK: usize = 4096;

/// The layers: the primitives of a layer are rebuilt and refitted together.
const DEFORMABLE: u8 = 0;
const MOVING: u8 = 1;
const RESTING: u8 = 2;

/// Finds pairs. It keeps its trees and buffers between calls.
///
/// Each call compares the model with that of the last one, in constant time. For another model, or one whose
/// filters have changed, it begins anew: no pair is lost, the trees are built again.
#[derive(Debug, Default)]
pub struct ProximitySearch {
    /// Of the model that everything below belongs to.
    model: Identity,
    /// Deformable surface vertices, ascending.
    deformable: Vec<u32>,
    /// Layer of each vertex.
    layer_of_vertex: Vec<u8>,
    obstacles: ObstacleTracker,
    collisions: CollisionMatrix,

    origin: Option<Point>,
    /// Whether the trees are those of the last [`Self::update`].
    updated: bool,
    /// Of the list of the last update, which may be updated where vertices have changed.
    listed: Option<Identity>,
    local: Vec<LocalVertex>,
    end: Vec<LocalVertex>,
    layers: [Layer; 3],

    leaves: Leaves,
    /// One for each thread.
    scratch: Vec<Mutex<Scratch>>,
    tasks: [Vec<TaskResult>; 4],
    tables: [PartnerTable; 4],
    half_space_pairs: Vec<Vec<Pair>>,
    statistics: SearchStatistics,
}

/// The leaves that query other trees: all leaves of deformable primitives, and for each layer of obstacles
/// the leaves that overlap the box of the deformable primitives.
#[derive(Debug, Default)]
struct Leaves {
    all: Vec<u32>,
    vertices: [Vec<u32>; 2],
    edges: [Vec<u32>; 2],
    particles: [Vec<u32>; 2],
    particles_near_strands: [Vec<u32>; 2],
}

impl ProximitySearch {
    /// A search over the primitives of `model`.
    pub fn new(model: &CollisionModel) -> Self {
        let topology = model.topology();
        let deformable: Vec<u32> =
            topology.surface_vertices.iter().copied().filter(|&v| !model.is_obstacle(v)).collect();
        let layer_of_vertex = (0..topology.vertex_count as u32)
            .map(|v| if model.is_obstacle(v) { RESTING } else { DEFORMABLE })
            .collect();
        Self {
            deformable,
            layer_of_vertex,
            obstacles: ObstacleTracker::new(model),
            collisions: CollisionMatrix::new(model),
            model: model.identity(),
            local: vec![[0.0; 4]; topology.vertex_count],
            ..Self::default()
        }
    }

    /// Lists every pair that may collide whose certified lower bound of the distance is at most max over side
    /// a of `radii` + max over side b of `radii`. A half-space has no radius; for its pairs twice the radius
    /// of the vertex counts.
    ///
    /// There is one radius [m] per vertex, finite and >= 0. `separations` gets the contact geometry of each
    /// listed pair at `positions`, in the order of `pairs`. The result depends on the input alone, not on the
    /// number of threads or on earlier searches.
    ///
    /// A vertex whose position or radius is not finite or beyond 1e15 m is in no pair, and neither are the
    /// elements that it belongs to. All other pairs are listed as usual.
    ///
    /// # Panics
    /// If a slice has another length than the model has vertices.
    pub fn search(
        &mut self,
        model: &CollisionModel,
        positions: &[Point],
        radii: &[f64],
        pairs: &mut PairList,
        separations: &mut Vec<Separation>,
    ) {
        self.run::<false>(model, positions, None, radii, pairs, separations);
    }

    /// As [`Self::search`], for vertices that move linearly from x to x + u over the path time [0, 1]: lists
    /// every pair whose boxes, moving linearly and inflated by their radii, overlap at some time. Contact
    /// geometry is that of the start, `positions`.
    ///
    /// The boxes contain the elements at any time, so the distance of a pair that is not listed always
    /// exceeds the sum of its radii. The test of distances is not applied, because the distance at the start
    /// says nothing about later times.
    ///
    /// # Panics
    /// If a slice has another length than the model has vertices.
    pub fn search_swept(
        &mut self,
        model: &CollisionModel,
        positions: &[Point],
        displacements: &[Vector],
        radii: &[f64],
        pairs: &mut PairList,
        separations: &mut Vec<Separation>,
    ) {
        assert_eq!(displacements.len(), positions.len(), "one displacement per vertex");
        self.run::<true>(model, positions, Some(displacements), radii, pairs, separations);
    }

    /// Lists the same pairs as [`Self::search`], in compact form: with a lower bound of their distance in
    /// place of their contact geometry, and without those of half-spaces.
    ///
    /// With `changed`, only the vertices that it marks (one entry per vertex) have other positions or radii
    /// than in the last call. Only pairs with such a vertex are then searched for; all others stay. That pays
    /// where few vertices have changed. A call searches everything if it is the first, if `list` is not as
    /// the last call left it, if the model is another one, or if an obstacle begins or ends to move.
    ///
    /// Which pairs are listed whose distance equals the sum of their radii up to rounding in `f32` may depend
    /// on earlier calls; no pair is lost.
    ///
    /// # Panics
    /// If a slice has another length than the model has vertices.
    pub fn update(
        &mut self,
        model: &CollisionModel,
        positions: &[Point],
        radii: &[f64],
        changed: Option<&[bool]>,
        list: &mut CandidateList,
    ) {
        self.begin(model, positions, radii);
        let obstacles = self.obstacles.update(model, positions, None, radii);
        // An obstacle that begins or ends to move changes its trees.
        let is_kept = self.listed.is_some_and(|listed| listed == list.identity);
        let changed = changed.filter(|_| is_kept && !obstacles.layers);
        match changed {
            Some(changed) if self.updated => self.update_changed_trees(positions, radii, changed),
            Some(changed) => {
                self.update_trees(model, positions, None, radii, obstacles);
                self.layers.iter_mut().for_each(|layer| layer.mark_changed(changed));
            }
            None => self.update_trees(model, positions, None, radii, obstacles),
        }
        let filtered = self.collisions.some_forbidden;
        let scene = Scene { model, positions, radii, filtered, changed_only: changed.is_some() };
        self.search_kinds::<false>(&scene);
        self.fill_tables(model);
        list.take(model.topology(), &self.tables, &self.tasks, changed);
        self.count(list.len());
        (self.updated, self.listed) = (true, Some(list.identity));
    }

    /// Notes that vertices have moved although the next [`Self::update`] will not mark them as changed, such
    /// as those of a body that has moved as a whole: boxes are then refitted, but the pairs of these vertices
    /// stay. It is for the caller to know that none of the pairs left out has come nearer.
    pub fn note_moved(&mut self) {
        self.updated = false;
    }

    /// As [`Self::search_swept`], in compact form: without contact geometry and the pairs of half-spaces. The
    /// lower bounds of the distances are 0.
    ///
    /// # Panics
    /// If a slice has another length than the model has vertices.
    pub fn list_swept(
        &mut self,
        model: &CollisionModel,
        positions: &[Point],
        displacements: &[Vector],
        radii: &[f64],
        list: &mut CandidateList,
    ) {
        assert_eq!(displacements.len(), positions.len(), "one displacement per vertex");
        self.find::<true>(model, positions, Some(displacements), radii);
        self.fill_tables(model);
        list.take(model.topology(), &self.tables, &self.tasks, None);
        self.count(list.len());
        self.updated = false;
    }

    /// Counts of the last search.
    pub fn statistics(&self) -> SearchStatistics {
        self.statistics
    }

    fn run<const SWEPT: bool>(
        &mut self,
        model: &CollisionModel,
        positions: &[Point],
        displacements: Option<&[Vector]>,
        radii: &[f64],
        pairs: &mut PairList,
        separations: &mut Vec<Separation>,
    ) {
        self.find::<SWEPT>(model, positions, displacements, radii);
        near_half_spaces(model, positions, displacements, |v| radii[v], &mut self.half_space_pairs);
        self.write(model, positions, pairs, separations);
        self.count(pairs.len());
        self.updated = false;
    }

    /// Finds the pairs of all kinds but those of half-spaces.
    fn find<const SWEPT: bool>(
        &mut self,
        model: &CollisionModel,
        positions: &[Point],
        displacements: Option<&[Vector]>,
        radii: &[f64],
    ) {
        self.begin(model, positions, radii);
        let obstacles = self.obstacles.update(model, positions, displacements, radii);
        self.update_trees(model, positions, displacements, radii, obstacles);
        let filtered = self.collisions.some_forbidden;
        self.search_kinds::<SWEPT>(&Scene { model, positions, radii, filtered, changed_only: false });
    }

    /// Begins a search.
    fn begin(&mut self, model: &CollisionModel, positions: &[Point], radii: &[f64]) {
        if self.model != model.identity() {
            *self = Self::new(model);
        }
        let count = model.topology().vertex_count;
        assert_eq!(positions.len(), count, "one position per vertex");
        assert_eq!(radii.len(), count, "one radius per vertex");
        self.statistics = SearchStatistics::default();
    }

    /// Counts what a search has done that has listed so many pairs.
    fn count(&mut self, pairs: usize) {
        for found in self.tasks.iter().flatten() {
            self.statistics.candidates += found.candidates;
            self.statistics.undecided += found.undecided;
        }
        self.statistics.pairs = pairs as u64;
    }

    /// Updates local positions and trees where vertices have changed.
    fn update_changed_trees(&mut self, positions: &[Point], radii: &[f64], changed: &[bool]) {
        assert_eq!(changed.len(), positions.len(), "one flag per vertex");
        let (still, origin) = (Vector::new(0.0, 0.0, 0.0), self.origin.unwrap_or(Point::origin()));
        self.local.par_chunks_mut(LOCAL_CHUNK).enumerate().for_each(|(chunk, local)| {
            for (local, v) in local.iter_mut().zip(chunk * LOCAL_CHUNK..) {
                if changed[v] {
                    *local = frame::localize(&positions[v], &still, radii[v], &origin);
                }
            }
        });
        for layer in &mut self.layers {
            layer.mark_changed(changed);
            layer.refit_changed(&self.local);
        }
    }

    /// Updates local positions and trees to the given state.
    fn update_trees(
        &mut self,
        model: &CollisionModel,
        positions: &[Point],
        displacements: Option<&[Vector]>,
        radii: &[f64],
        changes: Changes,
    ) {
        let first = self.origin.is_none();
        let origin = frame::origin(positions, &self.deformable);
        let origin_moved = self.origin.replace(origin) != Some(origin);
        if changes.layers {
            for (v, layer) in self.layer_of_vertex.iter_mut().enumerate() {
                let body = model.vertex_body()[v] as usize;
                if model.bodies()[body].obstacle {
                    *layer = if self.obstacles.moving[body] { MOVING } else { RESTING };
                }
            }
        }
        let refit = [true, origin_moved || changes.moved || changes.layers, origin_moved || changes.layers];

        let layer_of_vertex = &self.layer_of_vertex;
        let localize = |local: &mut [LocalVertex], displacements: Option<&[Vector]>| {
            local.par_chunks_mut(LOCAL_CHUNK).enumerate().for_each(|(chunk, local)| {
                let begin = chunk * LOCAL_CHUNK;
                for (local, v) in local.iter_mut().zip(begin..) {
                    if refit[layer_of_vertex[v] as usize] {
                        let displacement = displacements.map_or(Vector::new(0.0, 0.0, 0.0), |u| u[v]);
                        *local = frame::localize(&positions[v], &displacement, radii[v], &origin);
                    }
                }
            });
        };
        localize(&mut self.local, None);
        let end = displacements.map(|_| {
            self.end.resize(self.local.len(), [0.0; 4]);
            localize(&mut self.end, displacements);
            self.end.as_slice()
        });

        for (layer, index) in self.layers.iter_mut().zip(0_u8..) {
            let build = if index == DEFORMABLE { first } else { changes.layers };
            if build {
                self.statistics.rebuilds +=
                    layer.build(model, &self.local, |v| layer_of_vertex[v as usize] == index);
            }
            if refit[index as usize] {
                // Obstacles at rest have no motion: their boxes hold for the whole path.
                let end = if index == RESTING { None } else { end };
                self.statistics.refits += layer.refit(&self.local, end);
                self.statistics.rebuilds += layer.rebuild_stale(&self.local, end);
            }
        }
    }

    fn search_kinds<const SWEPT: bool>(&mut self, scene: &Scene<'_>) {
        self.scratch.resize_with(rayon::current_num_threads(), Mutex::default);
        let Self { layers: [deformable, moving, resting], leaves, scratch, tasks, .. } = self;
        let obstacles = [&*moving, &*resting];
        let all_leaves = deformable.edges.leaves.len().max(deformable.vertices.leaves.len());
        let all_leaves = all_leaves.max(deformable.particles.leaves.len());
        leaves.all.clear();
        leaves.all.extend(0..all_leaves as u32);
        for (k, obstacle) in obstacles.iter().enumerate() {
            overlapping_leaves(&obstacle.vertices, &deformable.triangles.bounds(), &mut leaves.vertices[k]);
            overlapping_leaves(&obstacle.edges, &deformable.edges.bounds(), &mut leaves.edges[k]);
            overlapping_leaves(&obstacle.particles, &deformable.particles.bounds(), &mut leaves.particles[k]);
            overlapping_leaves(
                &obstacle.particles,
                &deformable.strands.bounds(),
                &mut leaves.particles_near_strands[k],
            );
        }
        let collisions = self.collisions;
        let [vertex_vertex, vertex_edge, vertex_triangle, edge_edge] = tasks;
        search_kind::<VertexVertex, 1, 1, SWEPT>(
            scene,
            collisions,
            (&deformable.particles, &deformable.particles),
            obstacles.map(|o| (&o.particles, &o.particles)),
            (&leaves.all, &leaves.particles),
            scratch,
            vertex_vertex,
        );
        search_kind::<VertexEdge, 1, 2, SWEPT>(
            scene,
            collisions,
            (&deformable.particles, &deformable.strands),
            obstacles.map(|o| (&o.particles, &o.strands)),
            (&leaves.all, &leaves.particles_near_strands),
            scratch,
            vertex_edge,
        );
        search_kind::<VertexTriangle, 1, 3, SWEPT>(
            scene,
            collisions,
            (&deformable.vertices, &deformable.triangles),
            obstacles.map(|o| (&o.vertices, &o.triangles)),
            (&leaves.all, &leaves.vertices),
            scratch,
            vertex_triangle,
        );
        search_kind::<EdgeEdge, 2, 2, SWEPT>(
            scene,
            collisions,
            (&deformable.edges, &deformable.edges),
            obstacles.map(|o| (&o.edges, &o.edges)),
            (&leaves.all, &leaves.edges),
            scratch,
            edge_edge,
        );
    }

    /// Sorts the results of the tasks by element; returns the number of pairs of each kind.
    fn fill_tables(&mut self, model: &CollisionModel) -> [usize; 4] {
        let topology = model.topology();
        let elements =
            [topology.vertex_count, topology.vertex_count, topology.vertex_count, topology.edges.len()];
        std::array::from_fn(|k| self.tables[k].fill(elements[k], &self.tasks[k]))
    }

    /// Writes the results of the tasks into the caller's lists.
    fn write(
        &mut self,
        model: &CollisionModel,
        positions: &[Point],
        pairs: &mut PairList,
        separations: &mut Vec<Separation>,
    ) {
        let [vv, ve, vt, ee] = self.fill_tables(model);
        let mut counts = [vv, ve, vt, ee, 0];
        counts[4] = self.half_space_pairs.iter().map(Vec::len).sum();
        let total: usize = counts.iter().sum();
        let mut pairs = pairs.resize_kinds(counts);
        separations.resize(total, BLANK);
        let mut separations = separations.as_mut_slice();
        for k in 0..4 {
            let (head, tail) = pairs.split_at_mut(counts[k]);
            pairs = tail;
            let (geometry, tail) = separations.split_at_mut(counts[k]);
            separations = tail;
            self.tables[k].write(PairKind::ALL[k], &self.tasks[k], model, positions, head, geometry);
        }
        let found = self.half_space_pairs.iter().flatten();
        pairs.iter_mut().zip(found).for_each(|(pair, found)| *pair = *found);
        separate_all(model, PairKind::VertexHalfSpace, pairs, positions, separations);
    }
}

/// Searches for one kind of pair: deformable elements of side *a* against all elements of side *b*, and
/// elements of obstacles of side *a* against deformable ones. Trees are given as (side a, side b); leaves are
/// numbers, as many as the largest deformable tree has leaves, and those of the obstacles that are searched
/// for.
fn search_kind<K: PairTest<A, B>, const A: usize, const B: usize, const SWEPT: bool>(
    scene: &Scene<'_>,
    collisions: CollisionMatrix,
    deformable: (&Tree<A>, &Tree<B>),
    obstacles: [(&Tree<A>, &Tree<B>); 2],
    (all_leaves, obstacle_leaves): (&[u32], &[Vec<u32>; 2]),
    scratch: &[Mutex<Scratch>],
    tasks: &mut Vec<TaskResult>,
) {
    let mut targets = [deformable.1; 3];
    let mut target_count = 0;
    let searched = [(collisions.deformable, deformable.1)].into_iter();
    let searched = searched.chain(obstacles.map(|obstacle| (collisions.obstacle, obstacle.1)));
    for (_, tree) in searched.filter(|(searched, tree)| *searched && !tree.is_empty()) {
        targets[target_count] = tree;
        target_count += 1;
    }
    let targets = &targets[..target_count];
    let near = &[deformable.1];
    let own_leaves = if targets.is_empty() { 0 } else { deformable.0.leaves.len() };
    let meets_obstacles = collisions.obstacle && !deformable.1.is_empty();
    let queries = [
        Query { tree: deformable.0, leaves: &all_leaves[..own_leaves], targets },
        Query { tree: obstacles[0].0, leaves: &obstacle_leaves[0][..], targets: near },
        Query { tree: obstacles[1].0, leaves: &obstacle_leaves[1][..], targets: near },
    ];
    let used = if meets_obstacles { &queries[..] } else { &queries[..1] };

    let task_count = |query: &Query<'_, A, B>| query.leaves.len().div_ceil(TASK_LEAVES);
    let total: usize = used.iter().map(task_count).sum();
    if total == 0 {
        return tasks.clear();
    }
    // Tasks beyond the total keep their buffers for a later search.
    tasks.resize_with(total.max(tasks.len()), TaskResult::default);
    tasks[total..].iter_mut().for_each(TaskResult::clear);
    tasks[..total].par_iter_mut().enumerate().for_each(|(mut index, found)| {
        found.clear();
        for query in used {
            let count = task_count(query);
            if index < count {
                let leaves = &query.leaves[index * TASK_LEAVES..];
                let leaves = &leaves[..leaves.len().min(TASK_LEAVES)];
                let scratch = &scratch[rayon::current_thread_index().unwrap_or(0) % scratch.len()];
                // A search starts no other task, so that a thread never waits for itself here. After a panic
                // the content may be anything.
                let mut scratch = scratch.lock().unwrap_or_else(|poisoned| {
                    let mut scratch = poisoned.into_inner();
                    *scratch = Scratch::default();
                    scratch
                });
                return search_leaves::<K, A, B, SWEPT>(
                    scene,
                    &Query { leaves, ..*query },
                    &mut scratch,
                    found,
                );
            }
            index -= count;
        }
    });
}
