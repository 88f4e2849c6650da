//! Twin of `shader/facing.wgsl`.

use super::pair::{Pair, pair_of};
use super::{difference, divided, dot, negated, scaled, subtracted};
use crate::bound::Bound;
use crate::layout::{Candidate, Control, Kind, PairState, Separation};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub edges_first: u32,
    pub triangles_first: u32,
}

const ON_BORDER: f32 = 1e-6;
const CONE_TOLERANCE: f32 = 0.02;
const FLAT_TOLERANCE: f32 = 2e-3;
const CLOSE: f32 = 1.001;
const SHARE: f32 = 0.9;
const LEAST_SHARE: f32 = 0.5;

#[derive(Clone, Copy, PartialEq, Eq)]
enum Feature {
    Vertex(u32),
    Edge(u32),
    Face,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    Outside,
    Inside,
    Flat,
}

pub fn bound(buffers: Bound<'_>) {
    let (positions, edges, triangles) = (buffers.read(0), buffers.read(1), buffers.read(2));
    let (adjacency, candidates, states) = (buffers.read(3), buffers.read(4), buffers.read(5));
    let mesh = Mesh {
        params: buffers.params(),
        positions: &positions,
        edges: &edges,
        triangles: &triangles,
        adjacency: &adjacency,
    };
    facing(&mesh, &candidates, &states, &mut buffers.write(6), &buffers.read::<Control>(7)[0]);
}

pub struct Mesh<'a> {
    params: Params,
    positions: &'a [[i32; 4]],
    edges: &'a [[u32; 2]],
    triangles: &'a [[u32; 4]],
    adjacency: &'a [u32],
}

pub fn facing(
    mesh: &Mesh<'_>,
    candidates: &[Candidate],
    states: &[PairState],
    separations: &mut [Separation],
    control: &Control,
) {
    for c in 0..control.candidates.min(mesh.params.capacity) as usize {
        let (separation, state) = (separations[c], states[c]);
        let pair = pair_of(candidates[c], mesh.edges, mesh.triangles);
        if separation.distance > state.range || mesh.is_contact(&pair, candidates[c], &separation) {
            continue;
        }
        let is_close = separation.distance < CLOSE * state.desired || state.multiplier > 0.0;
        let guarded = (SHARE * separation.distance).max(LEAST_SHARE * state.desired).min(state.desired);
        separations[c].wanted = if is_close { guarded } else { 0.0 };
    }
}

fn on_edge(edge: u32, vertices: [u32; 2], last: f32) -> Feature {
    if 1.0 - last <= ON_BORDER {
        Feature::Vertex(vertices[1])
    } else if last <= ON_BORDER {
        Feature::Vertex(vertices[0])
    } else {
        Feature::Edge(edge)
    }
}

impl Mesh<'_> {
    fn on_triangle(&self, triangle: u32, vertices: [u32; 3], weights: [f32; 3]) -> Feature {
        let edge = |place: u32| {
            Feature::Edge(self.adjacency[(self.params.triangles_first + 3 * triangle + place) as usize])
        };
        match weights.map(|weight| weight > ON_BORDER) {
            [true, true, true] => Feature::Face,
            [true, true, false] => edge(0),
            [false, true, true] => edge(1),
            [true, false, true] => edge(2),
            [true, false, false] => Feature::Vertex(vertices[0]),
            [false, true, false] => Feature::Vertex(vertices[1]),
            [false, false, _] => Feature::Vertex(vertices[2]),
        }
    }

    fn place(&self, feature: Feature, outward: [f32; 3]) -> Place {
        let (entry, from, along) = match feature {
            Feature::Face => return Place::Inside,
            Feature::Vertex(v) => (v, self.positions[v as usize], [0.0; 3]),
            Feature::Edge(e) => {
                let [a, b] = self.edges[e as usize].map(|v| self.positions[v as usize]);
                let whole = difference(b, a);
                (self.params.edges_first + e, a, divided(whole, dot(whole, whole).sqrt().max(1.0)))
            }
        };
        let list = self.adjacency[entry as usize] as usize..self.adjacency[entry as usize + 1] as usize;
        let mut flat = matches!(feature, Feature::Edge(_)) && list.len() > 1;
        for &neighbor in &self.adjacency[list] {
            let mut to = difference(self.positions[neighbor as usize], from);
            to = subtracted(to, scaled(along, dot(along, to)));
            let (size, rise) = (dot(to, to).sqrt(), dot(outward, to));
            if rise > CONE_TOLERANCE * size {
                return Place::Outside;
            }
            flat &= rise >= -FLAT_TOLERANCE * size;
        }
        if flat { Place::Flat } else { Place::Inside }
    }

    fn is_contact(&self, pair: &Pair, candidate: Candidate, separation: &Separation) -> bool {
        let (v, [s, t]) = (pair.vertices, separation.weights);
        let [mut a, mut b] = [Feature::Vertex(v[0]), Feature::Vertex(v[1])];
        if pair.kind == Kind::VertexEdge as u32 {
            b = on_edge(candidate.b, [v[1], v[2]], s);
        } else if pair.kind == Kind::VertexTriangle as u32 {
            b = self.on_triangle(candidate.b, [v[1], v[2], v[3]], [1.0 - s - t, s, t]);
        } else if pair.kind == Kind::EdgeEdge as u32 {
            a = on_edge(candidate.a(), [v[0], v[1]], s);
            b = on_edge(candidate.b, [v[2], v[3]], t);
        } else if pair.kind == Kind::VertexHalfSpace as u32 {
            b = Feature::Face;
        }
        if matches!((a, b), (Feature::Vertex(_), Feature::Face)) {
            return true;
        }
        let first = self.place(a, negated(separation.normal));
        if first == Place::Outside {
            return false;
        }
        match self.place(b, separation.normal) {
            Place::Outside => false,
            Place::Inside => true,
            Place::Flat => !matches!((first, a, b), (Place::Flat, Feature::Edge(_), Feature::Edge(_))),
        }
    }
}
