//! Contacts that several pairs have: one of them keeps the row, by the twins of `hash_contacts` and
//! `merge_rows`.
#![allow(clippy::unwrap_used)] // helpers of tests are outside the functions that the lint knows as tests

use super::buffers::words;
use crate::engine::{Engine, TwinEngine};
use crate::kernels;
use crate::layout::{Candidate, Control, Kind, NONE, PairState, Separation};
use crate::recording::Recording;
use bytemuck::{Zeroable, cast_slice};

const VERTICES: u32 = 12;

/// Candidates among the elements of a few vertices, with closest points on vertices, edges and faces.
struct Scene {
    edges: Vec<[u32; 2]>,
    triangles: Vec<[u32; 4]>,
    candidates: Vec<Candidate>,
    separations: Vec<Separation>,
    states: Vec<PairState>,
    selected: Vec<u32>,
}

impl Scene {
    fn random(random: &mut fastrand::Rng) -> Self {
        let vertex = |random: &mut fastrand::Rng| random.u32(..VERTICES);
        let edges: Vec<[u32; 2]> = (0..VERTICES).map(|v| [v, (v + 1) % VERTICES]).collect();
        let triangles: Vec<[u32; 4]> =
            (0..VERTICES).map(|v| [v, (v + 1) % VERTICES, (v + 2) % VERTICES, 0]).collect();
        let (mut candidates, mut separations, mut states) = (vec![], vec![], vec![]);
        for _ in 0..400 {
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
        let selected = (0..400).map(|_| u32::from(random.u8(..4) > 0)).collect();
        Self { edges, triangles, candidates, separations, states, selected }
    }

    /// Which candidates keep their rows, with a table of so many places, and what their states are then.
    fn merged(&self, places: usize) -> (Vec<u32>, Vec<PairState>) {
        let mut engine = TwinEngine::new();
        let mut recording = Recording::default();
        let count = self.candidates.len();
        let mut filled = |words: &[u32]| {
            let buffer = engine.buffer("input", words.len()).unwrap();
            recording.write(buffer, words);
            buffer
        };
        let edges = filled(cast_slice(&self.edges));
        let triangles = filled(cast_slice(&self.triangles));
        let candidates = filled(cast_slice(&self.candidates));
        let separations = filled(cast_slice(&self.separations));
        let states = filled(cast_slice(&self.states));
        let starts = filled(&self.selected);
        let table = filled(&vec![NONE; places]);
        let control = Control { candidates: count as u32, ..Control::default() };
        let control = filled(cast_slice(&[control]));
        let (capacity, mask) = (count as u32, places as u32 - 1);
        recording.dispatch(
            &kernels::HASH_CONTACTS,
            &[edges, triangles, candidates, separations, states, starts, table, control],
            kernels::hash_contacts::Params { capacity, mask },
            count,
        );
        recording.dispatch(
            &kernels::MERGE_ROWS,
            &[edges, triangles, candidates, separations, table, states, starts, control],
            kernels::merge_rows::Params { capacity, mask },
            count,
        );
        let read = [(starts, count), (states, words::<PairState>(count))];
        let [starts, states] = <[Vec<u32>; 2]>::try_from(engine.run(&recording, &read).unwrap()).unwrap();
        (starts, cast_slice(&states).to_vec())
    }

    /// Whether two candidates have the same contact: merged by themselves, one keeps the row.
    fn same(&self, a: usize, b: usize) -> bool {
        let pick = |c: usize| (self.candidates[c], self.separations[c], PairState::NEW);
        let [a, b] = [a, b].map(pick);
        let pair = Self {
            edges: self.edges.clone(),
            triangles: self.triangles.clone(),
            candidates: vec![a.0, b.0],
            separations: [a.1, b.1].map(|separation| Separation { wanted: 1.0, ..separation }).to_vec(),
            states: vec![PairState::NEW; 2],
            selected: vec![1; 2],
        };
        pair.merged(1).0.contains(&0)
    }
}

#[test]
fn what_loses_its_row_has_that_of_another_pair_with_the_same_closest_points() {
    let mut random = fastrand::Rng::with_seed(5);
    for places in [1, 8, 1 << 20] {
        let mut lost = 0;
        for _ in 0..4 {
            let scene = Scene::random(&mut random);
            let pressed = |c: usize| scene.states[c].multiplier > 0.0;
            let (starts, states) = scene.merged(places);
            let kept: Vec<usize> = (0..starts.len()).filter(|c| starts[*c] == 1).collect();
            for c in (0..starts.len()).filter(|c| scene.selected[*c] == 1 && starts[*c] == 0) {
                let own: Vec<usize> = kept.iter().copied().filter(|r| scene.same(c, *r)).collect();
                assert!(own.iter().any(|r| scene.separations[*r].wanted >= scene.separations[c].wanted));
                // A pair that presses gives way to one that presses.
                assert!(!pressed(c) || own.iter().any(|r| pressed(*r)));
                assert_eq!((states[c].multiplier, states[c].friction), (0.0, [0.0; 3]));
                if places == 1 << 20 {
                    // Where each contact has a place of its own, what has a second row asks for more than the
                    // first.
                    let wanted = || own.iter().map(|c| scene.separations[*c].wanted);
                    let least = wanted().fold(f32::INFINITY, f32::min);
                    assert_eq!(wanted().filter(|wanted| *wanted == least).count(), 1);
                }
                lost += 1;
            }
            assert!((0..starts.len()).all(|c| scene.selected[c] >= starts[c]));
        }
        assert!(lost > if places == 1 << 20 { 200 } else { 2 }, "{places} places: {lost}");
    }
}

#[test]
fn contacts_are_told_apart_by_the_vertices_of_both_sides() {
    let pair = |kind, a, b, weights| {
        (Candidate::new(kind, a, b), Separation { weights, wanted: 1.0, ..Separation::zeroed() })
    };
    // Groups of pairs that have one contact.
    let groups = [
        // Vertex 1 next to vertex 3.
        vec![
            pair(Kind::VertexTriangle, 1, 0, [1.0, 0.0]),
            pair(Kind::EdgeEdge, 0, 1, [1.0, 1.0]),
            pair(Kind::EdgeEdge, 1, 0, [1.0, 1.0]),
            pair(Kind::VertexEdge, 1, 1, [1.0, 0.0]),
            pair(Kind::VertexVertex, 1, 3, [0.0, 0.0]),
            pair(Kind::VertexVertex, 3, 1, [0.0, 0.0]),
        ],
        // Vertex 1 next to the edge from 2 to 3.
        vec![
            pair(Kind::VertexTriangle, 1, 0, [0.4, 0.0]),
            pair(Kind::EdgeEdge, 0, 1, [1.0, 0.4]),
            pair(Kind::EdgeEdge, 1, 0, [0.4, 1.0]),
            pair(Kind::VertexEdge, 1, 1, [0.4, 0.0]),
        ],
        // The same vertices, but the other side is the edge.
        vec![pair(Kind::EdgeEdge, 0, 1, [0.4, 1.0])],
        // No other pair has these.
        vec![pair(Kind::VertexTriangle, 1, 0, [0.4, 0.2])],
        vec![pair(Kind::EdgeEdge, 0, 1, [0.4, 0.2])],
        vec![pair(Kind::VertexHalfSpace, 1, 0, [0.0, 0.0])],
    ];
    let all: Vec<(usize, (Candidate, Separation))> =
        groups.iter().enumerate().flat_map(|(g, group)| group.iter().map(move |pair| (g, *pair))).collect();
    let scene = Scene {
        edges: vec![[0, 1], [2, 3], [4, 2]],
        triangles: vec![[2, 3, 4, 0]],
        candidates: all.iter().map(|(_, pair)| pair.0).collect(),
        separations: all.iter().map(|(_, pair)| pair.1).collect(),
        states: vec![PairState::NEW; all.len()],
        selected: vec![1; all.len()],
    };
    for a in 0..all.len() {
        for b in (0..all.len()).filter(|b| *b != a) {
            assert_eq!(scene.same(a, b), all[a].0 == all[b].0, "pairs {a} and {b}");
        }
    }
}
