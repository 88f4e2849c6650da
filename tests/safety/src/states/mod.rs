//! Seeded generators of states that are free of intersections but nearly intersecting.
//!
//! Every generator draws a hard shape, and the judge checks it. If noise makes it intersect, it is drawn
//! again with half the noise. So every state is certainly free of intersections.

mod bodies;
mod codimensional;
mod sheets;

pub use bodies::{mixed, spike_on_spike, vertex_over_edge};
pub use codimensional::{particles, strands};
pub use sheets::{crumpled_sheet, folded_sheet, slivers};

use bowknot_check::{Judge, StateOptions};
use bowknot_geometry::{HalfSpace, Point, Topology};
use bowknot_proximity::{BodyFilter, CollisionModel};

/// A scene in a state that is free of intersections.
#[derive(Clone, Debug)]
pub struct Case {
    /// Generator and seed.
    pub name: String,
    /// Elements, bodies, half-spaces.
    pub model: CollisionModel,
    /// Position of each vertex [m].
    pub positions: Vec<Point>,
}

/// A generator of cases.
pub type Generator = fn(u64) -> Case;

/// All generators.
pub const GENERATORS: [Generator; 8] =
    [folded_sheet, crumpled_sheet, slivers, vertex_over_edge, spike_on_spike, particles, strands, mixed];

/// The parts of a scene under construction.
#[derive(Default)]
pub(crate) struct Draft {
    pub(crate) positions: Vec<Point>,
    triangles: Vec<[u32; 3]>,
    strands: Vec<[u32; 2]>,
    particles: Vec<u32>,
    body: Vec<u32>,
    filters: Vec<BodyFilter>,
    pub(crate) half_spaces: Vec<HalfSpace>,
}

impl Draft {
    /// Number of the next vertex.
    fn next(&self) -> u32 {
        self.positions.len() as u32
    }

    /// Adds a body of triangles over its own vertices.
    fn add_mesh(&mut self, filter: BodyFilter, points: Vec<Point>, triangles: &[[u32; 3]]) {
        let first = self.next();
        self.triangles.extend(triangles.iter().map(|t| t.map(|v| first + v)));
        self.add_points(filter, points);
    }

    /// Adds a body of strands, each joining its points in order.
    fn add_strands(&mut self, filter: BodyFilter, strands: Vec<Vec<Point>>) {
        let mut first = self.next();
        for strand in &strands {
            let count = strand.len() as u32;
            self.strands.extend((1..count).map(|i| [first + i - 1, first + i]));
            first += count;
        }
        self.add_points(filter, strands.concat());
    }

    /// Adds a body of particles.
    fn add_particles(&mut self, filter: BodyFilter, points: Vec<Point>) {
        self.particles.extend((0..points.len() as u32).map(|i| self.positions.len() as u32 + i));
        self.add_points(filter, points);
    }

    /// Adds a body of triangles, strand edges and particles over its own vertices.
    pub(crate) fn add_elements(
        &mut self,
        filter: BodyFilter,
        points: Vec<Point>,
        triangles: &[[u32; 3]],
        strands: &[[u32; 2]],
        particles: &[u32],
    ) {
        let first = self.next();
        self.triangles.extend(triangles.iter().map(|t| t.map(|v| first + v)));
        self.strands.extend(strands.iter().map(|e| e.map(|v| first + v)));
        self.particles.extend(particles.iter().map(|v| first + v));
        self.add_points(filter, points);
    }

    fn add_points(&mut self, filter: BodyFilter, points: Vec<Point>) {
        self.body.extend(points.iter().map(|_| self.filters.len() as u32));
        self.filters.push(filter);
        self.positions.extend(points);
    }

    pub(crate) fn finish(self, name: &str, seed: u64) -> Case {
        let topology = Topology::builder(self.positions.len())
            .triangles(self.triangles)
            .strand_edges(self.strands.iter().copied())
            .particles(self.particles.iter().copied())
            .build()
            .expect("generators name their own vertices");
        let model = CollisionModel::new(topology, self.body, self.filters, self.half_spaces)
            .expect("generators give every vertex a body");
        Case { name: format!("{name} {seed}"), model, positions: self.positions }
    }
}

/// Draws with the full noise, a half of it, a quarter, and so on, and finally none, until the judge finds no
/// intersection.
fn draw_clear(name: &str, seed: u64, draw: impl Fn(f64) -> Draft) -> Case {
    let noises = (0..12).map(|k| 0.5f64.powi(k)).chain([0.0]);
    for noise in noises {
        let case = draw(noise).finish(name, seed);
        let judge = Judge::from_model(&case.model);
        let options = StateOptions { limit: 1, distance: false };
        if judge.check_state(&case.positions, &options).is_ok_and(|report| report.is_clear()) {
            return case;
        }
    }
    panic!("{name} {seed} intersects without any noise");
}

/// Triangles of a grid of `nx` x `ny` vertices, numbered along x first; `flip(i, j)` chooses the diagonal of
/// a cell.
fn grid_triangles(nx: u32, ny: u32, mut flip: impl FnMut(u32, u32) -> bool) -> Vec<[u32; 3]> {
    let mut triangles = Vec::new();
    for j in 0..ny - 1 {
        for i in 0..nx - 1 {
            let a = j * nx + i;
            let (b, c, d) = (a + 1, a + nx + 1, a + nx);
            triangles.extend(if flip(i, j) { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] });
        }
    }
    triangles
}
