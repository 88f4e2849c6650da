//! Which trust regions cover the paths that vertices want to take, and new ones where they do not.
//!
//! A path of a step is the straight line from x toward the target, at most `trust_region_max` local edge
//! lengths long. A new trust region is a ball about the middle of the path, so that it is half as large as
//! one about x. As long as the paths of a vertex lie in its ball no search is needed, and none of its pairs
//! are searched.
//!
//! No step depends on the trust regions: they cover every path, and pairs that are farther apart limit none.
//! So a list of pairs may be kept from call to call, and a run that resumes without it has the same bits.

use crate::scene::CollisionScene;
use crate::state::ResolveState;
use bowknot_geometry::{Point, Vector};
use bowknot_stepper::TrustRegions;
use rayon::prelude::*;

/// Vertices that one task covers.
const CHUNK: usize = 4096;

/// What a trust region is larger than half of the path, in local edge lengths. A vertex can then change its
/// direction a little before it needs another search.
const SLACK: f64 = 0.05;

/// Share of a ball within which paths must stay. [`TrustRegions::limit`] allows slightly more.
const COVERED: f64 = 1.0 - 2e-3;

/// The trust regions of all vertices, and which of them have changed since the last search.
#[derive(Debug, Default)]
pub(super) struct Regions {
    pub balls: TrustRegions,
    /// Radius of each search: that of the ball and the margin of the vertex's body [m].
    pub radii: Vec<f64>,
    /// Which balls are new.
    pub changed: Vec<bool>,
    /// Smallest radius of balls that are not at rest [m].
    smallest: Option<f64>,
}

impl Regions {
    /// Gives a new ball to each vertex whose path from x along `wanted(vertex)` [m] leaves its own; `all`: to
    /// each vertex. Returns how many balls are new.
    pub fn cover(
        &mut self,
        scene: &CollisionScene,
        state: &ResolveState,
        all: bool,
        wanted: impl Fn(usize) -> Vector + Sync,
    ) -> usize {
        let count = state.x.len();
        let all = all || self.balls.radii.len() != count;
        self.balls.centers.resize(count, Point::origin());
        self.balls.radii.resize(count, 0.0);
        self.radii.resize(count, 0.0);
        self.changed.resize(count, true);
        let smallest = scene.params().solver.forward.trust_region_min;
        let parts = (&mut self.balls.centers, &mut self.balls.radii, &mut self.radii, &mut self.changed);
        let (centers, balls) = (parts.0.par_chunks_mut(CHUNK), parts.1.par_chunks_mut(CHUNK));
        let (radii, changed) = (parts.2.par_chunks_mut(CHUNK), parts.3.par_chunks_mut(CHUNK));
        centers
            .zip(balls)
            .zip(radii.zip(changed))
            .enumerate()
            .map(|(chunk, ((centers, balls), (radii, changed)))| {
                let mut renewed = 0;
                for k in 0..centers.len() {
                    let v = chunk * CHUNK + k;
                    let path = path(scene, v, &wanted(v));
                    let x = &state.x[v];
                    changed[k] = all || !(holds(&centers[k], balls[k], x, &path));
                    if changed[k] {
                        // A prescribed vertex that is at its target, such as one of an obstacle at rest, does
                        // not move.
                        let rests = path == Vector::zeros() && state.call.is_prescribed(v);
                        let h = scene.local_edge(v);
                        let ball = (0.5 * path.norm() / (COVERED * COVERED) + SLACK * h).max(smallest * h);
                        centers[k] = x + path * 0.5;
                        balls[k] = if rests { 0.0 } else { ball };
                        radii[k] = balls[k] + scene.spacing().margin(scene.model().vertex_body()[v]);
                        renewed += 1;
                    }
                }
                renewed
            })
            .sum()
    }

    /// Smallest radius of balls that are not at rest [m].
    pub fn smallest_radius(&mut self, scene: &CollisionScene) -> f64 {
        *self.smallest.get_or_insert_with(|| {
            let edges = (0..scene.vertex_count()).map(|v| scene.local_edge(v));
            scene.params().solver.forward.trust_region_min * edges.fold(f64::INFINITY, f64::min)
        })
    }

    /// Gives all vertices balls of one `radius` [m] about x, which are searched without a margin.
    pub fn set_uniform(&mut self, state: &ResolveState, radius: f64) {
        self.balls.centers.clone_from(&state.x);
        self.balls.radii.clear();
        self.balls.radii.resize(state.x.len(), radius);
        self.radii.clone_from(&self.balls.radii);
    }
}

/// The largest travel of a vertex in a step [m].
#[inline]
pub(crate) fn longest_path(scene: &CollisionScene, vertex: usize) -> f64 {
    scene.params().solver.forward.trust_region_max * scene.local_edge(vertex)
}

/// The path of a vertex that wants to move by `wanted` [m]. The zero vector if that is not finite.
#[inline]
fn path(scene: &CollisionScene, vertex: usize, wanted: &Vector) -> Vector {
    let (length, longest) = (wanted.norm(), longest_path(scene, vertex));
    if length <= longest {
        *wanted
    } else if length < f64::INFINITY {
        wanted * (longest / length)
    } else {
        Vector::zeros()
    }
}

/// Whether a ball holds the path from x. A ball without a radius holds a vertex at its center that rests.
#[inline]
fn holds(center: &Point, radius: f64, x: &Point, path: &Vector) -> bool {
    let (start, limit) = (x - center, COVERED * radius);
    start.norm_squared() <= limit * limit && (start + path).norm_squared() <= limit * limit
}
