//! Scenes and a slow oracle, shared by the integration tests.

pub mod folded;

use bowknot_geometry::{HalfSpace, PairKind, Point, Separation, Topology, Vector, distance, separation};
use bowknot_proximity::{BodyFilter, CollisionModel, Pair, PairList, ProximitySearch};

/// A model with a state.
pub struct Scene {
    pub model: CollisionModel,
    pub positions: Vec<Point>,
    pub radii: Vec<f64>,
}

/// Seeded random numbers.
pub struct Random(fastrand::Rng);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(fastrand::Rng::with_seed(seed))
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0.f64()
    }

    pub fn vector(&mut self, size: f64) -> Vector {
        Vector::new(self.unit() - 0.5, self.unit() - 0.5, self.unit() - 0.5) * (2.0 * size)
    }
}

/// Builds a scene from loose parts, each a body.
#[derive(Default)]
pub struct Builder {
    positions: Vec<Point>,
    radii: Vec<f64>,
    triangles: Vec<[u32; 3]>,
    strands: Vec<[u32; 2]>,
    particles: Vec<u32>,
    vertex_body: Vec<u32>,
    bodies: Vec<BodyFilter>,
    half_spaces: Vec<HalfSpace>,
}

impl Builder {
    pub fn body(&mut self, filter: BodyFilter) -> &mut Self {
        self.bodies.push(filter);
        self
    }

    fn vertex(&mut self, position: Point, radius: f64) -> u32 {
        self.positions.push(position);
        self.radii.push(radius);
        self.vertex_body.push(self.bodies.len() as u32 - 1);
        self.positions.len() as u32 - 1
    }

    pub fn mesh(&mut self, positions: &[Point], triangles: &[[u32; 3]], radius: f64) -> &mut Self {
        let first = self.positions.len() as u32;
        positions.iter().for_each(|p| {
            self.vertex(*p, radius);
        });
        self.triangles.extend(triangles.iter().map(|t| t.map(|v| v + first)));
        self
    }

    pub fn triangle(&mut self, corners: [Point; 3], radius: f64) -> &mut Self {
        self.mesh(&corners, &[[0, 1, 2]], radius)
    }

    pub fn strand(&mut self, points: &[Point], radius: f64) -> &mut Self {
        let ids: Vec<u32> = points.iter().map(|p| self.vertex(*p, radius)).collect();
        self.strands.extend(ids.windows(2).map(|w| [w[0], w[1]]));
        self
    }

    pub fn particle(&mut self, position: Point, radius: f64) -> &mut Self {
        let v = self.vertex(position, radius);
        self.particles.push(v);
        self
    }

    pub fn half_space(&mut self, half_space: HalfSpace) -> &mut Self {
        self.half_spaces.push(half_space);
        self
    }

    /// Random triangles, strands and particles of the last body in a box of half size `size`.
    pub fn soup(&mut self, random: &mut Random, counts: [usize; 3], size: f64, radius: f64) -> &mut Self {
        let at = |random: &mut Random| Point::origin() + random.vector(size);
        for _ in 0..counts[0] {
            let center = at(random);
            let corners = [0; 3].map(|_| center + random.vector(0.15 * size));
            self.triangle(corners, radius * (0.5 + random.unit()));
        }
        for _ in 0..counts[1] {
            let start = at(random);
            let points: Vec<Point> = (0..3).map(|_| start + random.vector(0.15 * size)).collect();
            self.strand(&points, radius * (0.5 + random.unit()));
        }
        for _ in 0..counts[2] {
            let position = at(random);
            self.particle(position, radius * (0.5 + random.unit()));
        }
        self
    }

    pub fn build(&self) -> Scene {
        let topology = Topology::builder(self.positions.len())
            .triangles(self.triangles.iter().copied())
            .strand_edges(self.strands.iter().copied())
            .particles(self.particles.iter().copied())
            .build()
            .expect("valid elements");
        let model = CollisionModel::new(
            topology,
            self.vertex_body.clone(),
            self.bodies.clone(),
            self.half_spaces.clone(),
        )
        .expect("consistent bodies");
        Scene { model, positions: self.positions.clone(), radii: self.radii.clone() }
    }
}

impl Scene {
    pub fn search_with(&self, search: &mut ProximitySearch) -> (PairList, Vec<Separation>) {
        let (mut pairs, mut separations) = (PairList::default(), Vec::new());
        search.search(&self.model, &self.positions, &self.radii, &mut pairs, &mut separations);
        (pairs, separations)
    }

    pub fn search(&self) -> (PairList, Vec<Separation>) {
        self.search_with(&mut ProximitySearch::new(&self.model))
    }

    pub fn points(&self, pair: &Pair) -> [Point; 4] {
        pair.vertices.map(|v| self.positions[v as usize])
    }

    /// Largest radius of each side of a pair.
    pub fn side_radii(&self, kind: PairKind, pair: &Pair) -> [f64; 2] {
        let largest = |side: &[u32]| side.iter().map(|&v| self.radii[v as usize]).fold(0.0, f64::max);
        let (a, b) = pair.vertices[..kind.vertex_count()].split_at(kind.side_a());
        // A half-space has the radius of the vertex.
        [largest(a), largest(if b.is_empty() { a } else { b })]
    }

    /// Every pair that may be formed, near or far, by kind and in order.
    pub fn all_pairs(&self) -> Vec<(PairKind, Pair)> {
        let topology = self.model.topology();
        let body = |v: u32| self.model.vertex_body()[v as usize];
        let collide = |a: u32, b: u32| self.model.may_collide(body(a), body(b));
        let mut all = Vec::new();
        let mut add = |kind: PairKind, elements: [u32; 2], a: &[u32], b: &[u32]| {
            if a.iter().all(|v| !b.contains(v)) && collide(a[0], b[0]) {
                let mut vertices = [a[0]; 4];
                a.iter().chain(b).zip(&mut vertices).for_each(|(&v, slot)| *slot = v);
                all.push((kind, Pair { elements, vertices }));
            }
        };
        for (i, &a) in topology.particles.iter().enumerate() {
            topology.particles[i + 1..].iter().for_each(|&b| add(PairKind::VertexVertex, [a, b], &[a], &[b]));
        }
        for &a in &topology.particles {
            for &e in &topology.strand_edges {
                add(PairKind::VertexEdge, [a, e], &[a], &topology.edges[e as usize]);
            }
        }
        for &a in &topology.surface_vertices {
            for (t, triangle) in (0..).zip(&topology.triangles) {
                add(PairKind::VertexTriangle, [a, t], &[a], triangle);
            }
        }
        for (e, a) in (0..).zip(&topology.edges) {
            for (f, b) in (0..).zip(&topology.edges).skip(e as usize + 1) {
                add(PairKind::EdgeEdge, [e, f], a, b);
            }
        }
        for &v in topology.surface_vertices.iter().filter(|&&v| !self.model.is_obstacle(v)) {
            for h in 0..self.model.half_spaces().len() as u32 {
                all.push((PairKind::VertexHalfSpace, Pair { elements: [v, h], vertices: [v; 4] }));
            }
        }
        all
    }

    /// Checks a list against all pairs: none nearer than its radii is missing, none is certainly farther,
    /// order and geometry are right. Returns the number of pairs.
    pub fn check(&self, pairs: &PairList, separations: &[Separation]) -> usize {
        assert_eq!(pairs.len(), separations.len());
        let mut listed = pairs.pairs().iter().enumerate().peekable();
        for (kind, pair) in self.all_pairs() {
            let [a, b] = self.side_radii(kind, &pair);
            let present = listed.peek().is_some_and(|(i, p)| pairs.kind(*i) == kind && **p == pair);
            let (distance, expected) = if kind == PairKind::VertexHalfSpace {
                let half_space = &self.model.half_spaces()[pair.elements[1] as usize];
                let point = &self.positions[pair.elements[0] as usize];
                (half_space.signed_distance(point), separation::separate_half_space(point, half_space))
            } else {
                let points = self.points(&pair);
                (distance::closest(kind, &points).distance, separation::separate(kind, &points))
            };
            if present {
                if let Some((i, _)) = listed.next() {
                    check_geometry(&separations[i], &expected, a + b);
                }
            } else {
                // The oracle's own rounding is a few units of the size of the coordinates.
                assert!(distance >= (a + b) * (1.0 - 1e-9), "{kind:?} {pair:?} at {distance} is missing");
            }
        }
        assert_eq!(listed.next(), None, "a pair is out of order, repeated or not allowed");
        pairs.len()
    }
}

fn check_geometry(listed: &Separation, expected: &Separation, radii: f64) {
    assert!(listed.width <= radii.next_up(), "{listed:?} is certainly beyond {radii}");
    assert_eq!(listed, expected);
}
