#![allow(clippy::unwrap_used)] // helpers of tests are outside the functions that the lint knows as tests

use super::*;
use crate::TwinEngine;
use bowknot_geometry::{BodyFilter, PairKind, Vector, distance};
use std::collections::HashMap;

const EDGE: f64 = 0.02;
const DELTA: f64 = 4e-3;
const MIN_SEPARATION: f64 = 1e-4;

/// Two sheets above each other, of two bodies; the lower one has a fine mesh.
fn sheets() -> (CollisionModel, Vec<Point>) {
    let (mut x, mut triangles, mut bodies) = (Vec::new(), Vec::new(), Vec::new());
    for (body, (edge, height)) in [(EDGE, 3e-3), (0.25 * DELTA, 0.0)].into_iter().enumerate() {
        let (first, n) = (x.len() as u32, 7u32);
        for k in 0..n * n {
            x.push(Point::new(edge * f64::from(k % n), edge * f64::from(k / n), height));
        }
        for k in (0..n * (n - 1)).filter(|k| k % n != n - 1).map(|k| first + k) {
            triangles.extend([[k, k + 1, k + n + 1], [k, k + n + 1, k + n]]);
        }
        bodies.resize(x.len(), body as u32);
    }
    let topology = Topology::builder(x.len()).triangles(triangles).build().unwrap();
    let model = CollisionModel::new(topology, bodies, vec![BodyFilter::DEFORMABLE; 2], vec![]).unwrap();
    (model, x)
}

fn collision(
    model: &CollisionModel,
    x: &[Point],
    rest: &[Point],
    thickness: Option<f64>,
) -> Collision<TwinEngine> {
    let count = x.len();
    let lengths = Lengths {
        edges: &vec![EDGE; count],
        margins: &vec![DELTA; count],
        deltas: &vec![DELTA; count],
        thicknesses: &thickness.map_or(vec![], |t| vec![t; count]),
        min_separation: MIN_SEPARATION,
        edge_limits: &[],
    };
    Collision::new(TwinEngine::new(), model, x, rest, &lengths, &Constraints::default(), 0.9).unwrap()
}

/// The candidates with their states.
fn states(collision: &mut Collision<TwinEngine>) -> HashMap<Candidate, PairState> {
    let b = collision.buffers;
    let read = [
        (b.control, words::<Control>(1)),
        (b.candidates, words::<Candidate>(collision.capacity)),
        (b.states, words::<PairState>(collision.capacity)),
    ];
    let all = collision.engine.run(&Recording::default(), &read).unwrap();
    let control: Control = bytemuck::cast_slice(&all[0])[0];
    let candidates: &[Candidate] = bytemuck::cast_slice(&all[1]);
    let states: &[PairState] = bytemuck::cast_slice(&all[2]);
    candidates.iter().copied().zip(states.iter().copied()).take(control.candidates as usize).collect()
}

#[test]
fn desired_distances_are_those_of_bodies_rest_shapes_and_gaps() {
    let (model, x) = sheets();
    let rest: Vec<Point> = x.iter().map(|x| x * 1.5 + Vector::new(7.0, 0.0, 0.0)).collect();
    for (thickness, growth) in [(None, f64::INFINITY), (None, 1e-4), (Some(2e-3), f64::INFINITY)] {
        let mut collision = collision(&model, &x, &rest, thickness);
        collision.begin(&x, growth).unwrap();
        collision.step().unwrap();
        let (mut neighbors, mut close) = (0, 0);
        for (candidate, state) in states(&mut collision) {
            let edge = |e: u32| model.topology().edges[e as usize];
            let (kind, vertices) = if candidate.kind() == Kind::EdgeEdge as u32 {
                let ([a, b], [c, d]) = (edge(candidate.a()), edge(candidate.b));
                (PairKind::EdgeEdge, [a, b, c, d])
            } else {
                let [a, b, c] = model.topology().triangles[candidate.b as usize];
                (PairKind::VertexTriangle, [candidate.a(), a, b, c])
            };
            let distance =
                |points: &[Point]| distance::closest(kind, &vertices.map(|v| points[v as usize])).distance;
            let body = |side: usize| model.vertex_body()[vertices[side] as usize];
            let mut delta = DELTA;
            if body(0) == body(kind.side_a()) {
                delta = delta.min(0.5 * distance(&rest));
                neighbors += usize::from(delta < DELTA);
            }
            let desired = delta.min(distance(&x) + growth);
            close += usize::from(desired < delta);
            let least = match thickness {
                None => MIN_SEPARATION.min(0.1 * desired),
                Some(thickness) => thickness.min(delta / 1.5).min(distance(&x)),
            };
            let quantum = collision.grid.quantum();
            let [found, found_least] = [state.desired, state.min_separation].map(|l| f64::from(l) * quantum);
            assert!((found - desired).abs() < 1e-6 * DELTA, "{candidate:?}: {found} {desired}");
            assert!((found_least - least).abs() < 1e-5 * DELTA, "{candidate:?}: {found_least} {least}");
        }
        assert!(neighbors > 50 && (close > 50) == growth.is_finite(), "{neighbors} {close}");
    }
}

#[test]
fn pairs_keep_their_states_while_they_are_candidates_and_buffers_grow() {
    let (model, x) = sheets();
    let target: Vec<Point> = x.iter().map(|x| x + Vector::new(0.1, 0.02, -0.03) * (1.0 + x.y)).collect();
    for small in [false, true] {
        let mut collision = collision(&model, &x, &x, None);
        collision.begin(&target, f64::INFINITY).unwrap();
        collision.step().unwrap();
        // Multipliers that tell pairs apart.
        let before = states(&mut collision);
        let mark = |c: &Candidate| (c.kind_and_a.wrapping_mul(31).wrapping_add(c.b) % 1000 + 1) as f32;
        let b = collision.buffers;
        let read = [(b.candidates, words::<Candidate>(before.len()))];
        let list = collision.engine.run(&Recording::default(), &read).unwrap().swap_remove(0);
        let marked: Vec<PairState> = bytemuck::cast_slice::<u32, Candidate>(&list)
            .iter()
            .map(|c| PairState { multiplier: mark(c), friction: [mark(c), 0.0, 1.0], ..before[c] })
            .collect();
        let mut recording = Recording::default();
        recording.write(b.states, &marked);
        collision.engine.run(&recording, &[]).unwrap();

        let (mut kept, mut new, mut grown) = (0, 0, 0);
        for step in 0..6 {
            let known = states(&mut collision);
            if small {
                // Without any room for more.
                collision.capacity = known.len();
            }
            let capacity = collision.capacity;
            collision.step().unwrap();
            grown += usize::from(collision.capacity > capacity);
            for (candidate, state) in states(&mut collision) {
                match known.get(&candidate) {
                    Some(old) => assert_eq!(state, *old, "step {step}"),
                    None => assert_eq!(state.multiplier, 0.0, "step {step}"),
                }
                kept += usize::from(state.multiplier == mark(&candidate));
                new += usize::from(!known.contains_key(&candidate));
            }
        }
        assert!(kept > 100 && new > 10 && (grown > 0) == small, "{kept} {new} {grown}");
        // A new call begins without multipliers.
        collision.begin(&target, f64::INFINITY).unwrap();
        collision.step().unwrap();
        assert!(states(&mut collision).values().all(|state| state.multiplier == 0.0));
    }
}
