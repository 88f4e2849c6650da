//! Which of the close pairs are contacts.
//!
//! Where two surfaces touch, many pairs of primitives are close to each other, but the distance of the
//! surfaces has a minimum at few of them. The others have tilted normals, and a constraint along such a
//! normal blocks bodies that slide past: these are the ghost collisions at internal edges of meshes. A pair
//! is a contact if its normal lies in the normal cones of the features of both sides, that is, if no
//! neighboring feature is closer to the other side. Offset geometric contact (Chen et al. 2025) sorts
//! contacts by the same blocks: those above faces, edges and vertices.

use bowknot_geometry::{EdgeTriangles, PairKind, Point, Separation, Topology, Vector};
use bowknot_proximity::Pair;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// A closest point is on the boundary of its primitive if one of its weights is at most this.
const ON_BOUNDARY: f64 = 1e-9;

/// Largest sine of the angle between the faces of an edge that count as one flat surface.
const FLAT: f64 = 2e-3;

/// Sine of the angle between normal and cone up to which a pair is a contact in full, and from which on it is
/// none.
const NARROWEST: f64 = 0.01;
const WIDEST: f64 = 0.1;

/// Sines of the angle between the faces of an edge from which on it begins to count as bent, and does in
/// full. Larger: what slides on slightly bent surfaces is lifted and let down, and loses speed.
const NEARLY_FLAT: f64 = 5e-4;
const BENT: f64 = 0.01;

/// Largest number of passes over the neighbors of a pair's features that turn its normal into their cones.
const MAX_TURNS: usize = 4;

/// Sine of the angle between the directions to two neighbors from which on they span a plane, and the largest
/// one between a plane and the directions in it: above rounding.
const MIN_CROSSING: f64 = 0.1;
const PLANE: f64 = 1e-9;

/// Cosine of the angle between normal and plane up to which the plane counts. Farther off a pair is no
/// contact.
const NEAR_PLANE: f64 = 0.98;

/// Smallest length of a turned normal that has a direction.
const MIN_TURNED_LENGTH: f64 = 0.1;

/// Tells contacts from pairs that are only close. Made once per topology.
#[derive(Clone, Debug, Default)]
pub struct Facing {
    triangles: EdgeTriangles,
    /// Vertices next to each vertex of a surface: `neighbors[starts[v]..starts[v + 1]]`.
    starts: Vec<u32>,
    neighbors: Vec<u32>,
}

/// The feature of a primitive that a closest point lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
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

/// Position of a direction relative to the normal cone of a feature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Outside,
    /// Inside of the cone, which has more than one direction and its opposite.
    Inside,
    /// Along the normal of a flat surface: the cone is this direction and its opposite.
    Flat,
}

impl Facing {
    /// Collects the neighbors of all vertices and edges, in linear time.
    pub fn new(topology: &Topology) -> Self {
        let triangles = topology.edge_triangles();
        let of_surfaces = || (0..topology.edges.len()).filter(|&e| triangles.count(e as u32) > 0);
        let mut starts = vec![0u32; topology.vertex_count + 1];
        for v in of_surfaces().flat_map(|e| topology.edges[e]) {
            starts[v as usize + 1] += 1;
        }
        (1..starts.len()).for_each(|v| starts[v] += starts[v - 1]);
        let mut next = starts.clone();
        let mut neighbors = vec![0; next.last().map_or(0, |count| *count as usize)];
        for [a, b] in of_surfaces().map(|e| topology.edges[e]) {
            for (from, to) in [(a, b), (b, a)] {
                neighbors[next[from as usize] as usize] = to;
                next[from as usize] += 1;
            }
        }
        Self { triangles, starts, neighbors }
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
                // The edges of a triangle are in the order 0-1, 1-2, 2-0 of its vertices.
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

    /// Whether a pair is a contact: its normal lies in the normal cones of both `features` at `positions`, or
    /// leaves them by an angle with a sine of at most `tolerance`, which is at least 0. The tolerance is
    /// needed because cones above flat surfaces are single directions. The cones of strands have all
    /// directions. Two edges within flat surfaces are no contact: vertices and faces represent it completely.
    /// A vertex above the interior of a face always is a contact.
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

    /// How much of a contact a pair is [1]: 1 if its normal lies in the normal cones of both `features`, less
    /// the farther it leaves them, 0 from an angle with a sine of a tenth on. Continuous in positions and
    /// normal, where [`Self::is_contact`] jumps. Two edges within flat surfaces are no contact, those of bent
    /// ones the more the more they are bent.
    pub fn contact_share(
        &self,
        topology: &Topology,
        features: [Feature; 2],
        normal: &Vector,
        positions: &[Point],
    ) -> f64 {
        if above_a_face(&features) {
            return 1.0;
        }
        let (mut share, mut bend) = (1.0, 0.0f64);
        for (feature, outward) in [(features[0], -normal), (features[1], *normal)] {
            let (mut rise, mut fall, mut count) = (0.0f64, 0.0f64, 0);
            if matches!(feature, Feature::Triangle(_) | Feature::HalfSpace(_)) {
                continue;
            }
            self.all_neighbors(topology, feature, positions, |to| {
                let sine = outward.dot(&to) / to.norm().max(f64::MIN_POSITIVE);
                (rise, fall, count) = (rise.max(sine), fall.max(-sine), count + 1);
                rise < WIDEST
            });
            share *= ((WIDEST - rise) / (WIDEST - NARROWEST)).clamp(0.0, 1.0);
            let bent = ((fall - NEARLY_FLAT) / (BENT - NEARLY_FLAT)).clamp(0.0, 1.0);
            bend = bend.max(if count > 1 { bent } else { 1.0 });
            if share == 0.0 {
                return 0.0;
            }
        }
        if matches!(features, [Feature::Edge(_), Feature::Edge(_)]) { share * bend } else { share }
    }

    /// The direction in the normal cones of both `features` at `positions` that is closest to `normal`,
    /// approximately. A contact is pushed along it if its normal has left the cones a little. If the surface
    /// of a `rigid` side is flat there, its normal counts alone: a plane without friction pushes to no side,
    /// whatever lies on it. Unit vectors.
    pub fn turned(
        &self,
        topology: &Topology,
        features: [Feature; 2],
        normal: &Vector,
        positions: &[Point],
        rigid: Option<usize>,
    ) -> Vector {
        if let Some(plane) = rigid.and_then(|side| self.plane(topology, features[side], positions)) {
            // At the border of the surface directions beside it are contacts as well.
            let rise = plane.dot(normal);
            if rise.abs() >= NEAR_PLANE {
                return plane * rise.signum();
            }
        }
        if above_a_face(&features) {
            return *normal;
        }
        let mut turned = *normal;
        for _ in 0..MAX_TURNS {
            let before = turned;
            for (feature, sign) in [(features[0], -1.0), (features[1], 1.0)] {
                self.all_neighbors(topology, feature, positions, |to| {
                    let (rise, squared) = (sign * turned.dot(&to), to.norm_squared());
                    if rise > 0.0 && squared > 0.0 {
                        turned -= to * (sign * rise / squared);
                    }
                    true
                });
            }
            if turned == before {
                break;
            }
        }
        turned.try_normalize(MIN_TURNED_LENGTH).unwrap_or(*normal)
    }

    /// The normal of the surface, of either sign, if it is a plane around an edge or a vertex.
    fn plane(&self, topology: &Topology, feature: Feature, positions: &[Point]) -> Option<Vector> {
        let edge = |e: u32| {
            let [a, b] = topology.edges[e as usize].map(|v| positions[v as usize]);
            (b - a).normalize()
        };
        let mut first = if let Feature::Edge(e) = feature { Some(edge(e)) } else { None };
        let mut normal: Option<Vector> = None;
        let is_plane = self.all_neighbors(topology, feature, positions, |to| {
            let along = to.normalize();
            match (first, normal) {
                (None, _) => first = Some(along),
                (Some(first), None) => {
                    let across = first.cross(&along);
                    normal = (across.norm() > MIN_CROSSING).then(|| across.normalize());
                }
                (Some(_), Some(normal)) => return normal.dot(&along).abs() <= PLANE,
            }
            true
        });
        normal.filter(|_| is_plane)
    }

    /// Whether all directions in which the surface continues from a feature pass a test; they have any
    /// length. It ends with the first that does not.
    #[inline]
    fn all_neighbors(
        &self,
        topology: &Topology,
        feature: Feature,
        positions: &[Point],
        mut test: impl FnMut(Vector) -> bool,
    ) -> bool {
        match feature {
            Feature::Triangle(_) | Feature::HalfSpace(_) => true,
            Feature::Vertex(v) => {
                let range = self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize;
                let from = positions[v as usize];
                self.neighbors[range].iter().all(|&u| test(positions[u as usize] - from))
            }
            Feature::Edge(e) => {
                let [a, b] = topology.edges[e as usize].map(|v| positions[v as usize]);
                let edge = b - a;
                let squared = edge.norm_squared().max(f64::MIN_POSITIVE);
                self.triangles.of(e).all(|(_, w)| {
                    let to = positions[w as usize] - a;
                    test(to - edge * (edge.dot(&to) / squared))
                })
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
        let (mut flat, mut count) = (matches!(feature, Feature::Edge(_)), 0);
        // Lengths, each a square root, are computed where a sign does not decide.
        let within = self.all_neighbors(topology, feature, positions, |to| {
            let rise = outward.dot(&to);
            flat = flat && (rise >= 0.0 || rise >= -FLAT * to.norm());
            count += 1;
            rise <= 0.0 || rise <= tolerance * to.norm()
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
mod tests;
