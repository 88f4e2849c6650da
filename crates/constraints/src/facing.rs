//! Which of the pairs that are near are contacts.
//!
//! Around a place where two surfaces touch, many pairs of primitives are near each other, but the distance of the
//! surfaces has a minimum at few of them. The others have tilted normals, and a constraint along such a normal is a wall in
//! the way of whatever slides past: the ghost collisions at internal edges of meshes. A pair is a contact if its normal lies
//! in the normal cone of the feature of either side, that is, if no neighbouring feature is nearer to the other side. Offset
//! geometric contact (Chen et al. 2025) sorts contacts by the same blocks: those above faces, edges and vertices.

use bowknot_geometry::{EdgeTriangles, PairKind, Point, Separation, Topology, Vector};
use bowknot_proximity::Pair;

/// A closest point is on the boundary of its primitive where a weight is below this.
const ON_BOUNDARY: f64 = 1e-9;

/// Sine of the angle between the faces of an edge within which they are one flat surface.
const FLAT: f64 = 2e-3;

/// Passes over the neighbours of a pair's features at most, in turning its normal into their cones.
const TURNS: usize = 4;

/// Length below which what is left of a normal has no direction.
const LEAST_SHARE: f64 = 0.1;

/// Tells contacts from pairs that are merely near; made once for a topology.
#[derive(Clone, Debug, Default)]
pub struct Facing {
    triangles: EdgeTriangles,
    /// Vertices next to each vertex of a surface: `neighbours[starts[v]..starts[v + 1]]`.
    starts: Vec<u32>,
    neighbours: Vec<u32>,
}

/// The feature of a primitive that a closest point lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Feature {
    /// A vertex.
    Vertex(u32),
    /// An edge of the topology, by index.
    Edge(u32),
    /// A triangle of the topology, by index.
    Triangle(u32),
    /// A half-space, by index.
    HalfSpace(u32),
}

/// How a direction lies to the normal cone of a feature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Outside,
    /// Within it; the cone is not just one direction and its opposite.
    Inside,
    /// Across a surface that is flat there: the cone is one direction and its opposite.
    Flat,
}

impl Facing {
    /// Prepares the neighbourhoods. O(n).
    pub fn new(topology: &Topology) -> Self {
        let triangles = topology.edge_triangles();
        let of_surfaces = || (0..topology.edges.len()).filter(|&e| triangles.count(e as u32) > 0);
        let mut starts = vec![0u32; topology.vertex_count + 1];
        for v in of_surfaces().flat_map(|e| topology.edges[e]) {
            starts[v as usize + 1] += 1;
        }
        (1..starts.len()).for_each(|v| starts[v] += starts[v - 1]);
        let mut next = starts.clone();
        let mut neighbours = vec![0; next.last().map_or(0, |count| *count as usize)];
        for [a, b] in of_surfaces().map(|e| topology.edges[e]) {
            for (from, to) in [(a, b), (b, a)] {
                neighbours[next[from as usize] as usize] = to;
                next[from as usize] += 1;
            }
        }
        Self { triangles, starts, neighbours }
    }

    /// The features that the closest points of a pair lie on, of side a and side b.
    pub fn features(
        topology: &Topology,
        kind: PairKind,
        pair: &Pair,
        separation: &Separation,
    ) -> [Feature; 2] {
        let (w, v, [a, b]) = (&separation.weights, &pair.vertices, pair.elements);
        let on_edge = |edge: u32, first: usize| match [w[first] <= ON_BOUNDARY, w[first + 1] <= ON_BOUNDARY] {
            [false, false] => Feature::Edge(edge),
            [true, _] => Feature::Vertex(v[first + 1]),
            [false, true] => Feature::Vertex(v[first]),
        };
        match kind {
            PairKind::VertexVertex => [Feature::Vertex(v[0]), Feature::Vertex(v[1])],
            PairKind::VertexEdge => [Feature::Vertex(v[0]), on_edge(b, 1)],
            PairKind::EdgeEdge => [on_edge(a, 0), on_edge(b, 2)],
            PairKind::VertexHalfSpace => [Feature::Vertex(v[0]), Feature::HalfSpace(b)],
            PairKind::VertexTriangle => {
                let edge = |place: usize| Feature::Edge(topology.triangle_edges[b as usize][place]);
                // Edges of a triangle stand in the order 0-1, 1-2, 2-0 of its vertices.
                let second = match [1, 2, 3].map(|k| w[k] > ON_BOUNDARY) {
                    [true, true, false] => edge(0),
                    [false, true, true] => edge(1),
                    [true, false, true] => edge(2),
                    [true, false, false] => Feature::Vertex(v[1]),
                    [false, true, false] => Feature::Vertex(v[2]),
                    [false, false, true] => Feature::Vertex(v[3]),
                    _ => Feature::Triangle(b),
                };
                [Feature::Vertex(v[0]), second]
            }
        }
    }

    /// Whether a pair is a contact: its normal lies in the normal cones of both `features` at `positions`, or leaves them by an
    /// angle whose sine is at most the `tolerance`: cones above flat surfaces are single directions. Strands, which have no
    /// inside to slide past, have all directions. Two edges within
    /// flat surfaces are none: their vertices and faces tell all about such a contact. A vertex above a face always is one, as
    /// the face is where it is.
    pub fn is_contact(
        &self,
        topology: &Topology,
        features: [Feature; 2],
        normal: &Vector,
        positions: &[Point],
        tolerance: f64,
    ) -> bool {
        if above_a_face(&features) {
            return true;
        }
        let first = self.place(topology, features[0], &-normal, positions, tolerance);
        if first == Place::Outside {
            return false;
        }
        match self.place(topology, features[1], normal, positions, tolerance) {
            Place::Outside => false,
            Place::Inside => true,
            Place::Flat => !matches!((first, features), (Place::Flat, [Feature::Edge(_), Feature::Edge(_)])),
        }
    }

    /// The direction nearest to `normal`, about, that lies in the normal cones of both `features` at `positions`: what a contact is
    /// pushed along whose normal has left its cones a little. Unit vectors.
    pub fn turned(
        &self,
        topology: &Topology,
        features: [Feature; 2],
        normal: &Vector,
        positions: &[Point],
    ) -> Vector {
        if above_a_face(&features) {
            return *normal;
        }
        let mut turned = *normal;
        for _ in 0..TURNS {
            let before = turned;
            for (feature, sign) in [(features[0], -1.0), (features[1], 1.0)] {
                self.for_each_neighbour(topology, feature, positions, |to| {
                    let (rise, squared) = (sign * turned.dot(&to), to.norm_squared());
                    if rise > 0.0 && squared > 0.0 {
                        turned -= to * (sign * rise / squared);
                    }
                });
            }
            if turned == before {
                break;
            }
        }
        turned.try_normalize(LEAST_SHARE).unwrap_or(*normal)
    }

    /// Directions in which the surface goes on from a feature, of any length.
    fn for_each_neighbour(
        &self,
        topology: &Topology,
        feature: Feature,
        positions: &[Point],
        mut visit: impl FnMut(Vector),
    ) {
        match feature {
            Feature::Triangle(_) | Feature::HalfSpace(_) => {}
            Feature::Vertex(v) => {
                let range = self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize;
                self.neighbours[range]
                    .iter()
                    .for_each(|&u| visit(positions[u as usize] - positions[v as usize]));
            }
            Feature::Edge(e) => {
                let [a, b] = topology.edges[e as usize].map(|v| positions[v as usize]);
                let edge = b - a;
                let squared = edge.norm_squared().max(f64::MIN_POSITIVE);
                for (_, w) in self.triangles.of(e) {
                    let to = positions[w as usize] - a;
                    visit(to - edge * (edge.dot(&to) / squared));
                }
            }
        }
    }

    fn place(
        &self,
        topology: &Topology,
        feature: Feature,
        outward: &Vector,
        positions: &[Point],
        tolerance: f64,
    ) -> Place {
        if matches!(feature, Feature::Triangle(_) | Feature::HalfSpace(_)) {
            return Place::Inside;
        }
        let (mut within, mut flat, mut count) = (true, matches!(feature, Feature::Edge(_)), 0);
        self.for_each_neighbour(topology, feature, positions, |to| {
            let (rise, slack) = (outward.dot(&to), tolerance * to.norm());
            within &= rise <= slack;
            flat &= rise >= -FLAT * to.norm();
            count += 1;
        });
        match (within, flat && count > 1) {
            (false, _) => Place::Outside,
            (true, true) => Place::Flat,
            (true, false) => Place::Inside,
        }
    }
}

fn above_a_face(features: &[Feature; 2]) -> bool {
    matches!(features, [Feature::Vertex(_), Feature::Triangle(_) | Feature::HalfSpace(_)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use bowknot_geometry::separation;

    /// Two triangles that share the edge 0-1 along y, at x = +-1, `height` below it; and free vertices.
    fn roof(height: f64, others: &[[f64; 3]]) -> (Topology, Vec<Point>) {
        let mut x: Vec<Point> = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.5, -height], [-1.0, 0.5, -height]]
            .map(Point::from)
            .to_vec();
        x.extend(others.iter().map(|p| Point::from(*p)));
        let mut triangles = vec![[0, 2, 1], [0, 1, 3]];
        if others.len() == 4 {
            triangles.extend([[4, 6, 5], [4, 5, 7]]);
        }
        let particles: Vec<u32> = if others.len() == 4 { vec![] } else { (4..x.len() as u32).collect() };
        (
            Topology::builder(x.len())
                .triangles(triangles)
                .particles(particles.iter().copied())
                .build()
                .expect("valid"),
            x,
        )
    }

    fn above(height: f64, point: [f64; 3]) -> Vec<bool> {
        let (topology, x) = roof(height, &[point]);
        let facing = Facing::new(&topology);
        (0..2u32)
            .map(|t| {
                let [a, b, c] = topology.triangles[t as usize];
                let pair = Pair { elements: [4, t], vertices: [4, a, b, c] };
                let kind = PairKind::VertexTriangle;
                let s = separation::separate(kind, &pair.vertices.map(|v| x[v as usize]));
                let features = Facing::features(&topology, kind, &pair, &s);
                facing.is_contact(&topology, features, &s.normal, &x, 0.01)
            })
            .collect()
    }

    #[test]
    fn above_a_flat_surface_only_the_face_below_is_a_contact() {
        assert_eq!(above(0.0, [0.1, 0.5, 0.1]), [true, false]);
        assert_eq!(above(0.0, [-0.1, 0.5, 0.1]), [false, true]);
        // Exactly above the edge either will do.
        assert_eq!(above(0.0, [0.0, 0.5, 0.1]), [true, true]);
    }

    #[test]
    fn a_tilted_normal_turns_into_the_cone_and_one_within_stays() {
        let (topology, x) = roof(0.0, &[[0.1, 0.5, 0.1]]);
        let facing = Facing::new(&topology);
        let edge = topology.edges.iter().position(|e| *e == [0, 1]).expect("an edge") as u32;
        let turned = |x: &[Point], n: Vector| {
            facing.turned(&topology, [Feature::Vertex(4), Feature::Edge(edge)], &n.normalize(), x)
        };
        assert!((turned(&x, Vector::new(0.1, 0.0, 1.0)) - Vector::z()).norm() < 1e-12);
        let (_, ridge) = roof(0.5, &[[0.1, 0.5, 0.1]]);
        let within = Vector::new(0.1, 0.0, 1.0).normalize();
        assert_eq!(turned(&ridge, within), within);
        let leaned = turned(&ridge, Vector::new(1.0, 0.0, 1.0));
        assert!((leaned - Vector::new(0.5, 0.0, 1.0).normalize()).norm() < 1e-12, "{leaned}");
    }

    #[test]
    fn above_a_ridge_the_edge_is_a_contact_and_in_a_valley_both_faces_are() {
        assert_eq!(above(0.5, [0.01, 0.5, 0.1]), [true, true]);
        assert_eq!(above(-0.5, [0.01, 0.5, 0.1]), [true, true]);
        assert_eq!(above(0.5, [0.1, 0.5, 0.02]), [true, false]);
    }

    #[test]
    fn edges_that_cross_are_contacts_where_one_of_them_is_a_ridge() {
        let crossing = |lower: f64, upper: f64| {
            let h = 0.05;
            // A second roof turned by 90 degrees about the vertical, upside down.
            let over = [[-0.5, 0.5, h], [0.5, 0.5, h], [0.0, 1.5, h + upper], [0.0, -0.5, h + upper]];
            let (topology, x) = roof(lower, &over);
            let facing = Facing::new(&topology);
            let edge = |v: [u32; 2]| topology.edges.iter().position(|e| *e == v).expect("an edge") as u32;
            let (a, b) = (edge([0, 1]), edge([4, 5]));
            let pair = Pair { elements: [a, b], vertices: [0, 1, 4, 5] };
            let s = separation::separate(PairKind::EdgeEdge, &pair.vertices.map(|v| x[v as usize]));
            let features = Facing::features(&topology, PairKind::EdgeEdge, &pair, &s);
            assert_eq!(features, [Feature::Edge(a), Feature::Edge(b)]);
            facing.is_contact(&topology, features, &s.normal, &x, 0.01)
        };
        assert!(crossing(0.5, 0.5) && crossing(0.5, 0.0) && crossing(0.0, 0.5));
        assert!(!crossing(0.0, 0.0), "within flat surfaces vertices and faces tell all");
        assert!(!crossing(-0.5, 0.5), "a valley is no contact");
    }
}
