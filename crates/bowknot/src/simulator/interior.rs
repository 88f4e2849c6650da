//! Moves the vertices inside of solids with their surfaces.
//!
//! The dynamics gives all vertices of a solid a target y. The collision stage knows those of the surface
//! only, and may stop them on the way, at x. A vertex inside that moved to its target could then end on the
//! wrong side of the surface. So, where surface and target differ:
//!
//! 1. vertices inside get their target plus a correction, the average of those of their neighbors (a few
//!    sweeps of Gauss-Seidel on the graph Laplacian, the corrections of the surface held fixed);
//! 2. with [`InteriorFollows::Elastic`], the dynamics then solves for them with the surface held there: a
//!    Newton iteration of the time step's own energy, repeated while a tetrahedron is inverted, a few times
//!    at most.
//!
//! The frame points of rods follow their edges without a turn.
//!
//! `docs/design-notes.md` has the figures by which the default was chosen.

use bowknot_dynamics::{Dynamics, StepError};
use bowknot_geometry::{Point, Vector, carried_frame_point};
use bowknot_scene::InteriorFollows;
use bowknot_scene::world::World;

/// Sweeps of the average. Corrections reach about the square root of this number of layers of vertices deep.
const SWEEPS: usize = 24;
/// Largest number of Newton iterations of the elastic solve.
const MOST_SOLVES: usize = 4;

/// The tetrahedra of a world and the vertices inside of solids.
#[derive(Debug, Default)]
pub(super) struct Interior {
    method: InteriorFollows,
    /// Number of vertices that collide; those inside follow.
    first: usize,
    /// Tetrahedra with a vertex inside.
    tets: Vec<[u32; 4]>,
    /// Edges of rods with their frame points.
    rods: Vec<[u32; 3]>,
    /// Where the neighbors of each vertex inside begin, and the end.
    starts: Vec<u32>,
    neighbors: Vec<u32>,
    prescribed: Vec<bool>,
    keyframes: Vec<Point>,
}

impl Interior {
    pub fn new(world: &World, method: InteriorFollows) -> Self {
        let first = world.collision_vertices();
        let inside = |v: &u32| *v as usize >= first;
        let tets = world.bodies.iter().flat_map(|body| &body.tets).filter(|t| t.iter().any(inside));
        let tets: Vec<[u32; 4]> = tets.copied().collect();
        let mut pairs: Vec<[u32; 2]> = Vec::new();
        for tet in &tets {
            for &v in tet.iter().filter(|v| inside(v)) {
                pairs.extend(tet.iter().filter(|w| **w != v).map(|&w| [v, w]));
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        let starts = (first..=world.positions.len())
            .map(|v| pairs.partition_point(|pair| (pair[0] as usize) < v) as u32)
            .collect();
        let neighbors = pairs.iter().map(|pair| pair[1]).collect();
        let rods = world.bodies.iter().flat_map(|body| &body.rods).copied().collect();
        Self { method, first, tets, rods, starts, neighbors, ..Self::default() }
    }

    /// Moves the vertices inside and frame points, which are at their target `y`, to follow the surface and the edges at
    /// `x` [m].
    /// Returns the number of elastic solves.
    pub fn follow(
        &mut self,
        dynamics: &mut Dynamics,
        prescribed: &[bool],
        y: &[Point],
        x: &mut [Point],
    ) -> Result<usize, StepError> {
        let first = self.first;
        carry_frame_points(&self.rods, |v| prescribed[v], y, x);
        let moved = |v: &u32| (*v as usize) < first && x[*v as usize] != y[*v as usize];
        if !self.tets.iter().flatten().any(moved) {
            return Ok(0);
        }
        self.average(prescribed, y, x);
        if self.method == InteriorFollows::Average {
            return Ok(0);
        }
        // Only vertices inside are free: surfaces and all other bodies are held.
        self.prescribed.clear();
        self.prescribed.resize(first, true);
        self.prescribed.extend_from_slice(&prescribed[first..]);
        let mut solves = 0;
        while solves < MOST_SOLVES {
            self.keyframes.clear();
            self.keyframes.extend_from_slice(x);
            let mut target = x.to_vec();
            dynamics.newton_target(x, &self.prescribed, &self.keyframes, &mut target)?;
            x[first..].copy_from_slice(&target[first..]);
            solves += 1;
            if count_inverted(&self.tets, x) == 0 {
                break;
            }
        }
        Ok(solves)
    }

    fn average(&self, prescribed: &[bool], y: &[Point], x: &mut [Point]) {
        let mut correction: Vec<Vector> = x.iter().zip(y).map(|(x, y)| x - y).collect();
        for _ in 0..SWEEPS {
            for (k, range) in self.starts.windows(2).enumerate() {
                let v = self.first + k;
                let near = &self.neighbors[range[0] as usize..range[1] as usize];
                if near.is_empty() || prescribed[v] {
                    continue;
                }
                let sum: Vector = near.iter().map(|&w| correction[w as usize]).sum();
                correction[v] = sum / near.len() as f64;
            }
        }
        for v in self.first..x.len() {
            x[v] = y[v] + correction[v];
        }
    }
}

/// Moves the frame points of `rods` but those that are `held` along with their edges, which were at `from` and are at
/// `x` [m].
pub(super) fn carry_frame_points(
    rods: &[[u32; 3]],
    held: impl Fn(usize) -> bool,
    from: &[Point],
    x: &mut [Point],
) {
    for [a, b, p] in rods.iter().map(|rod| rod.map(|v| v as usize)) {
        if !held(p) && (x[a] != from[a] || x[b] != from[b]) {
            x[p] = carried_frame_point([&from[a], &from[b]], [&x[a], &x[b]], &from[p]);
        }
    }
}

/// Number of tetrahedra of the world without a positive volume.
pub(super) fn inverted(world: &World, x: &[Point]) -> usize {
    world.bodies.iter().map(|body| count_inverted(&body.tets, x)).sum()
}

fn count_inverted(tets: &[[u32; 4]], x: &[Point]) -> usize {
    let volume = |tet: &[u32; 4]| {
        let [a, b, c, d] = tet.map(|v| x[v as usize]);
        (b - a).cross(&(c - a)).dot(&(d - a))
    };
    // A volume that is not a number counts as inverted.
    let sound = |tet: &&[u32; 4]| volume(tet) > 0.0;
    tets.len() - tets.iter().filter(sound).count()
}
