//! Prescribed vertices that make no progress because pairs hold them back.
//!
//! The rows of the backward step take prescribed vertices to be at their targets. Where one cannot get there, rows of
//! contacts and of edges contradict each other: cloth is to follow its pins into an obstacle. No target then satisfies
//! all rows, and multipliers grow from step to step. So after some steps without progress the rows take such a vertex to
//! be where it is. The forward step still moves it toward its target; as soon as it makes progress, rows use its target
//! again.

use crate::index_set::IndexSet;
use crate::scene::CollisionScene;
use crate::state::ResolveState;
use bowknot_geometry::Point;

/// Number of steps without progress after which a vertex is blocked: fewer than the 24 steps of a call that
/// another Newton iteration follows.
const MAX_STEPS_WITHOUT_PROGRESS: usize = 6;

/// Smallest decrease of the distance to the target that counts as progress, in mean edge lengths.
pub const MIN_PROGRESS: f64 = 1e-3;

/// A prescribed vertex that has not arrived.
#[derive(Clone, Copy, Debug)]
struct Late {
    vertex: u32,
    /// Smallest distance to its target so far [m].
    smallest: f64,
    steps_without_progress: usize,
}

/// The blocked vertices of a call.
#[derive(Debug, Default)]
pub(crate) struct Blocked {
    late: Vec<Late>,
    vertices: IndexSet,
    /// Those of the step before.
    before: Vec<u32>,
}

impl Blocked {
    /// Starts a call.
    pub fn begin(&mut self, vertices: usize) {
        self.late.clear();
        self.vertices.reset(vertices);
        self.before.clear();
    }

    /// Updates the list before a step; returns whether it has changed.
    pub fn update(&mut self, scene: &CollisionScene, state: &ResolveState) -> bool {
        let distance = |v: u32| (state.target[v as usize] - state.x[v as usize]).norm();
        if state.step == 0 {
            return false;
        }
        if state.step == 1 {
            let prescribed = (0..state.x.len()).filter(|&v| state.call.is_prescribed(v)).map(|v| v as u32);
            let late = prescribed.map(|vertex| Late {
                vertex,
                smallest: distance(vertex),
                steps_without_progress: 0,
            });
            self.late.extend(late.filter(|late| late.smallest > 0.0));
            return false;
        }
        let least = MIN_PROGRESS * scene.lengths().edge;
        self.late.retain_mut(|late| {
            let now = distance(late.vertex);
            if now < late.smallest - least {
                (late.smallest, late.steps_without_progress) = (now, 0);
            } else {
                late.steps_without_progress += 1;
            }
            now > 0.0
        });
        self.before.clear();
        self.before.extend_from_slice(self.vertices.members());
        self.vertices.clear();
        for late in self.late.iter().filter(|late| late.steps_without_progress >= MAX_STEPS_WITHOUT_PROGRESS)
        {
            self.vertices.insert(late.vertex);
        }
        self.vertices.members() != self.before
    }

    /// The blocked vertices, in ascending order.
    pub fn vertices(&self) -> &[u32] {
        self.vertices.members()
    }

    /// Those of the step before.
    pub fn before(&self) -> &[u32] {
        &self.before
    }

    /// Where the rows take a prescribed vertex to go [m].
    pub fn aim(&self, state: &ResolveState, vertex: u32) -> Point {
        let from = if self.vertices.contains(vertex) { &state.x } else { &state.target };
        from[vertex as usize]
    }
}
