//! Twin of `shader/merge.wgsl`.

use super::contact::{contact_of, place_of};
use crate::bound::Bound;
use crate::layout::{Candidate, Control, PairState, Separation};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub mask: u32,
}

const NUMBER: u32 = 0x7fff_ffff;

pub fn bound(buffers: Bound<'_>) {
    merge(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &buffers.read(3),
        &buffers.read(4),
        &mut buffers.write(5),
        &mut buffers.write(6),
        &buffers.read::<Control>(7)[0],
    );
}

pub fn merge(
    params: Params,
    edges: &[[u32; 2]],
    triangles: &[[u32; 4]],
    candidates: &[Candidate],
    separations: &[Separation],
    table: &[u32],
    states: &mut [PairState],
    starts: &mut [u32],
    control: &Control,
) {
    let count = control.candidates.min(params.capacity) as usize;
    let contact = |c: usize| contact_of(candidates[c], &separations[c], edges, triangles);
    for c in 0..count {
        if starts[c] == 0 {
            continue;
        }
        let own = contact(c);
        if !own.is_shared {
            continue;
        }
        let other = (table[place_of(&own, params.mask)] & NUMBER) as usize;
        if other == c || separations[other].wanted < separations[c].wanted {
            continue;
        }
        if contact(other).vertices == own.vertices {
            starts[c] = 0;
            states[c].multiplier = 0.0;
            states[c].friction = [0.0; 3];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cpu::contact::Contact;
    use crate::cpu::enlist::{self, enlist};
    use crate::layout::{Kind, NONE};
    use bytemuck::Zeroable;
    use std::collections::HashMap;

    const VERTICES: u32 = 12;

    /// Candidates among the elements of a few vertices, with closest points on vertices, edges and faces.
    struct Scene {
        edges: Vec<[u32; 2]>,
        triangles: Vec<[u32; 4]>,
        candidates: Vec<Candidate>,
        separations: Vec<Separation>,
        states: Vec<PairState>,
        picked: Vec<u32>,
    }

    impl Scene {
        fn random(random: &mut fastrand::Rng) -> Self {
            let vertex = |random: &mut fastrand::Rng| random.u32(..VERTICES);
            let edges: Vec<[u32; 2]> = (0..VERTICES).map(|v| [v, (v + 1) % VERTICES]).collect();
            let triangles: Vec<[u32; 4]> =
                (0..VERTICES).map(|v| [v, (v + 1) % VERTICES, (v + 2) % VERTICES, 0]).collect();
            let count = 400;
            let (mut candidates, mut separations, mut states) = (vec![], vec![], vec![]);
            for _ in 0..count {
                let kinds = [
                    Kind::VertexVertex,
                    Kind::VertexEdge,
                    Kind::VertexTriangle,
                    Kind::EdgeEdge,
                    Kind::VertexHalfSpace,
                ];
                let kind = kinds[random.usize(..5)];
                candidates.push(Candidate::new(kind, vertex(random), vertex(random)));
                let corners =
                    [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.0, 0.5], [0.5, 0.5], [0.2, 0.3]];
                separations.push(Separation {
                    weights: corners[random.usize(..7)],
                    wanted: [1.0, 1.0, 2.0][random.usize(..3)],
                    ..Separation::zeroed()
                });
                states.push(PairState { multiplier: [0.0, 0.0, 3.0][random.usize(..3)], ..PairState::NEW });
            }
            let picked = (0..count).map(|_| u32::from(random.u8(..4) > 0)).collect();
            Self { edges, triangles, candidates, separations, states, picked }
        }

        fn contact(&self, c: usize) -> Contact {
            contact_of(self.candidates[c], &self.separations[c], &self.edges, &self.triangles)
        }

        /// The candidates that keep their rows, with a table of so many places.
        fn merged(&mut self, places: usize) -> Vec<u32> {
            let (mut starts, mut table, mask) = (self.picked.clone(), vec![NONE; places], places as u32 - 1);
            let capacity = starts.len() as u32;
            let control = Control { candidates: capacity, ..Control::default() };
            let Self { edges, triangles, candidates, separations, states, .. } = self;
            let params = enlist::Params { capacity, mask };
            enlist(params, edges, triangles, candidates, separations, states, &starts, &mut table, &control);
            let params = Params { capacity, mask };
            merge(params, edges, triangles, candidates, separations, &table, states, &mut starts, &control);
            starts
        }
    }

    #[test]
    fn what_loses_its_row_has_that_of_another_pair_with_the_same_closest_points() {
        let mut random = fastrand::Rng::with_seed(5);
        for places in [1, 8, 1 << 20] {
            let mut lost = 0;
            for _ in 0..20 {
                let mut scene = Scene::random(&mut random);
                let pressed: Vec<bool> = scene.states.iter().map(|state| state.multiplier > 0.0).collect();
                let starts = scene.merged(places);
                let mut rows: HashMap<[u32; 3], Vec<usize>> = HashMap::new();
                for c in (0..starts.len()).filter(|c| starts[*c] == 1 && scene.contact(*c).is_shared) {
                    rows.entry(scene.contact(c).vertices).or_default().push(c);
                }
                for c in (0..starts.len()).filter(|c| scene.picked[*c] == 1 && starts[*c] == 0) {
                    let own = &rows[&scene.contact(c).vertices];
                    assert!(own.iter().any(|r| scene.separations[*r].wanted >= scene.separations[c].wanted));
                    // A pair that presses gives way to one that presses.
                    assert!(!pressed[c] || own.iter().any(|r| pressed[*r]));
                    assert_eq!((scene.states[c].multiplier, scene.states[c].friction), (0.0, [0.0; 3]));
                    lost += 1;
                }
                assert!((0..starts.len()).all(|c| scene.picked[c] >= starts[c]));
                if places == 1 << 20 {
                    // Where each contact has a place of its own, what has a second row asks for more than the first.
                    for own in rows.values() {
                        let wanted = || own.iter().map(|c| scene.separations[*c].wanted);
                        let least = wanted().fold(f32::INFINITY, f32::min);
                        assert_eq!(wanted().filter(|wanted| *wanted == least).count(), 1);
                    }
                }
            }
            assert!(lost > if places == 1 << 20 { 1000 } else { 10 }, "{places} places: {lost}");
        }
    }

    #[test]
    fn contacts_are_told_apart_by_the_vertices_of_both_sides() {
        let edges = [[0, 1], [2, 3], [4, 2]];
        let triangles = [[2, 3, 4, 0]];
        let contact = |kind, a, b, weights| {
            let separation = Separation { weights, ..Separation::zeroed() };
            contact_of(Candidate::new(kind, a, b), &separation, &edges, &triangles)
        };
        let shared = |vertices: [u32; 3], contact: Contact| {
            assert!(contact.is_shared);
            assert_eq!(contact.vertices, vertices);
        };
        // Vertex 1 next to vertex 3, and next to the edge from 2 to 3, in all pairs that have these.
        shared([1, 3, NONE], contact(Kind::VertexTriangle, 1, 0, [1.0, 0.0]));
        shared([1, 3, NONE], contact(Kind::EdgeEdge, 0, 1, [1.0, 1.0]));
        shared([1, 3, NONE], contact(Kind::EdgeEdge, 1, 0, [1.0, 1.0]));
        shared([1, 3, NONE], contact(Kind::VertexEdge, 1, 1, [1.0, 0.0]));
        shared([1, 3, NONE], contact(Kind::VertexVertex, 1, 3, [0.0, 0.0]));
        shared([1, 3, NONE], contact(Kind::VertexVertex, 3, 1, [0.0, 0.0]));
        shared([1, 2, 3], contact(Kind::VertexTriangle, 1, 0, [0.4, 0.0]));
        shared([1, 2, 3], contact(Kind::EdgeEdge, 0, 1, [1.0, 0.4]));
        shared([1, 2, 3], contact(Kind::EdgeEdge, 1, 0, [0.4, 1.0]));
        shared([1, 2, 3], contact(Kind::VertexEdge, 1, 1, [0.4, 0.0]));
        // The same vertices, but the other side is the edge.
        shared([3, 0, 1], contact(Kind::EdgeEdge, 0, 1, [0.4, 1.0]));
        // No other pair has these.
        assert!(!contact(Kind::VertexTriangle, 1, 0, [0.4, 0.2]).is_shared);
        assert!(!contact(Kind::EdgeEdge, 0, 1, [0.4, 0.2]).is_shared);
        assert!(!contact(Kind::VertexHalfSpace, 1, 0, [0.0, 0.0]).is_shared);
    }
}
