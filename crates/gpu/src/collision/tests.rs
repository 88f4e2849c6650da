#![allow(clippy::unwrap_used)] // helpers of tests are outside the functions that the lint knows as tests

use super::*;
use crate::TwinEngine;
use crate::layout::{Kind, PairState, Row};
use bowknot_geometry::{BodyFilter, PairKind, Topology, Vector, distance};
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
        half_space_deltas: &[],
        thicknesses: &thickness.map_or(vec![], |t| vec![t; count]),
        half_space_thicknesses: &[],
        min_separation: MIN_SEPARATION,
        edge_limits: &[],
    };
    Collision::new(TwinEngine::new(), model, x, rest, &lengths, &Constraints::default(), &Settings::default())
        .unwrap()
}

/// The candidates with their states.
fn states(collision: &mut Collision<TwinEngine>) -> HashMap<Candidate, PairState> {
    let b = collision.buffers;
    let read = [
        (b.control, words::<Control>(1)),
        (b.candidates, words::<Candidate>(collision.buffers.capacity)),
        (b.states, words::<PairState>(collision.buffers.capacity)),
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
    let cases = [
        (None, f64::INFINITY, false),
        (None, 1e-4, false),
        (Some(2e-3), f64::INFINITY, false),
        (None, f64::INFINITY, true),
    ];
    // The upper sheet.
    let upper: Vec<bool> = model.vertex_body().iter().map(|body| *body == 0).collect();
    for (thickness, growth, knows) in cases {
        let mut collision = collision(&model, &x, &rest, thickness);
        let known = if knows { upper.as_slice() } else { &[] };
        collision.begin(&Call { growth, known, ..Call::toward(&x) }).unwrap();
        collision.step().unwrap();
        let (mut neighbors, mut close, mut guarded) = (0, 0, 0);
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
            let component = |side: usize| model.vertex_component()[vertices[side] as usize];
            if component(0) == component(kind.side_a()) {
                delta = delta.min(0.5 * distance(&rest));
                neighbors += usize::from(delta < DELTA);
            }
            let mut desired = delta.min(distance(&x) + growth);
            close += usize::from(desired < delta);
            let least = match thickness {
                None => MIN_SEPARATION.min(0.1 * desired),
                Some(thickness) => thickness.min(delta / 1.5).min(distance(&x)),
            };
            if knows && body(0).min(body(kind.side_a())) == 0 && distance(&x) < 1.3 * delta {
                desired = desired.min((0.7 * distance(&x)).max(least + 0.35 * (delta - least)));
                guarded += usize::from(desired < 0.9 * delta);
            }
            let quantum = collision.grid.quantum();
            let [found, found_least] = [state.desired, state.min_separation].map(|l| f64::from(l) * quantum);
            // Each of the closest points is off by the rounding to the grid.
            assert!((found - desired).abs() < 2.0 * quantum, "{candidate:?}: {found} {desired}");
            assert!((found_least - least).abs() < 2.0 * quantum, "{candidate:?}: {found_least} {least}");
        }
        assert!(neighbors > 50 && (close > 50) == growth.is_finite(), "{neighbors} {close}");
        assert_eq!(guarded > 50, knows, "{guarded}");
    }
}

#[test]
fn pairs_keep_their_states_while_they_are_candidates_and_buffers_grow() {
    let (model, x) = sheets();
    let target: Vec<Point> = x.iter().map(|x| x + Vector::new(0.1, 0.02, -0.03) * (1.0 + x.y)).collect();
    for small in [false, true] {
        let mut collision = collision(&model, &x, &x, None);
        collision.begin(&Call::toward(&target)).unwrap();
        collision.step().unwrap();
        // Values that tell pairs apart.
        let before = states(&mut collision);
        let mark = |c: &Candidate| (c.kind_and_a.wrapping_mul(31).wrapping_add(c.b) % 1000 + 1) as f32;
        let b = collision.buffers;
        let read = [(b.candidates, words::<Candidate>(before.len()))];
        let list = collision.engine.run(&Recording::default(), &read).unwrap().swap_remove(0);
        let marked: Vec<PairState> = bytemuck::cast_slice::<u32, Candidate>(&list)
            .iter()
            .map(|c| PairState { range: mark(c), ..before[c] })
            .collect();
        let mut recording = Recording::default();
        recording.write(b.states, &marked);
        collision.engine.run(&recording, &[]).unwrap();

        let (mut kept, mut new, mut grown) = (0, 0, 0);
        for step in 0..6 {
            let known = states(&mut collision);
            if small {
                // Without any room for more.
                collision.buffers.capacity = known.len();
            }
            let capacity = collision.buffers.capacity;
            collision.step().unwrap();
            grown += usize::from(collision.buffers.capacity > capacity);
            for (candidate, state) in states(&mut collision) {
                match known.get(&candidate) {
                    Some(old) => {
                        let expected =
                            PairState { multiplier: state.multiplier, is_far: state.is_far, ..*old };
                        assert_eq!(state, expected, "step {step}");
                    }
                    // The marks are far below the range of a candidate that is new.
                    None => assert!(state.range > 1e4, "step {step}"),
                }
                kept += usize::from(state.range == mark(&candidate));
                new += usize::from(!known.contains_key(&candidate));
            }
        }
        assert!(kept > 100 && new > 10 && (grown > 0) == small, "{kept} {new} {grown}");
        // A new call begins without them.
        collision.begin(&Call::toward(&target)).unwrap();
        collision.search().unwrap();
        assert!(states(&mut collision).values().all(|state| *state == PairState::NEW));
    }
}

/// Contact rows of the last step.
fn rows(collision: &mut Collision<TwinEngine>) -> Vec<Row> {
    let b = collision.buffers;
    let read = [(b.rows.rows, words::<Row>(collision.row_count))];
    let all = collision.engine.run(&Recording::default(), &read).unwrap();
    bytemuck::cast_slice(&all[0]).to_vec()
}

#[test]
fn two_sheets_that_are_pressed_together_rest_at_the_desired_distance() {
    let (model, x) = sheets();
    // Both want to be where the other is.
    let target: Vec<Point> = x.iter().map(|x| Point::new(x.x, x.y, 3e-3 - x.z)).collect();
    let mut collision = collision(&model, &x, &x, None);
    collision.begin(&Call::toward(&target)).unwrap();
    for _ in 0..40 {
        collision.step().unwrap();
    }
    let end = collision.positions().unwrap();
    let quantum = collision.grid.quantum();
    // Some folds go on trembling, so the least gap differs from step to step.
    let rows = rows(&mut collision);
    let values = rows.iter().filter(|row| row.multiplier > 0.0).map(|row| f64::from(row.value) * quantum);
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let [least, typical] = [values[0], values[values.len() / 4]];
    assert!(values.len() > 10 && least > -0.2 * DELTA && typical > -0.01 * DELTA, "{values:?}");
    // Their corners lie above each other.
    assert!(end[0].z > end[49].z, "{} {}", end[0], end[49]);
}

/// Two sheets that fall through each other, and come to rest: how many steps are submitted together makes no
/// difference, though the device ends submissions, and buffers overflow in the middle of some.
#[test]
fn steps_that_are_submitted_together_have_the_same_bits() {
    let (model, x) = sheets();
    let target: Vec<Point> =
        x.iter().map(|x| Point::new(x.x + if x.z == 0.0 { 0.04 } else { 0.0 }, x.y, 3e-3 - x.z)).collect();
    let stop = Stop {
        distance: EDGE,
        unhindered: EDGE,
        net_residual: EDGE,
        mean_residual: 0.2 * EDGE,
        stretch_to_limit: 1.0,
        finishing_steps: 2,
    };
    let run = |most: usize| {
        let mut collision = collision(&model, &x, &x, None);
        // It submits as many as it may.
        collision.expected_steps = [most; 2];
        collision.begin(&Call { stop, ..Call::toward(&target) }).unwrap();
        let (mut reports, mut halted, mut overflows) = (Vec::new(), 0, [0; 2]);
        while reports.len() < 24 {
            // With room for one more step or so.
            collision.search().unwrap();
            let capacity = states(&mut collision).len() + 200;
            collision.buffers.capacity = capacity;
            // And for a few rows more.
            let rows = collision.buffers.row_capacity.min(collision.row_count + 4);
            collision.buffers.row_capacity = rows;
            let wanted = most.min(24 - reports.len());
            let made = collision.steps(wanted).unwrap();
            let grew = collision.buffers.capacity > capacity;
            let more_rows = collision.buffers.row_capacity > rows;
            halted += usize::from(!grew && !more_rows && made.len() < wanted);
            overflows[0] += usize::from(grew && made.len() > 1);
            overflows[1] += usize::from(more_rows && made.len() > 1);
            reports.extend(made);
        }
        let end = collision.end().unwrap();
        assert_eq!(end.positions, collision.positions().unwrap());
        (reports, end, [halted, overflows[0], overflows[1]])
    };
    let (reports, end, _) = run(1);
    for most in [3, 8] {
        let (others, other_end, counts) = run(most);
        assert_eq!(others, reports, "{most}");
        assert_eq!(other_end, end, "{most}");
        assert!(!end.rows.is_empty() && counts.iter().all(|count| *count > 0), "{most}: {counts:?}");
    }
}

/// Room in buffers that grow, the same as is told to the kernels: they find no room beyond it.
#[derive(Clone, Copy, Debug)]
struct Room {
    candidates: usize,
    old: usize,
    selected: usize,
    rows: usize,
}

impl Room {
    /// More than the sheets need.
    const PLENTY: Self = Self { candidates: 40_000, old: 40_000, selected: 40_000, rows: 40_000 };

    /// Makes buffers of that size, before anything is in them.
    fn give(self, collision: &mut Collision<TwinEngine>) {
        let Collision { engine, buffers: b, .. } = collision;
        let mut replace = |buffer: &mut BufferId, words: usize| {
            engine.free(*buffer);
            *buffer = engine.buffer("of that size", words).unwrap();
        };
        b.capacity = self.candidates;
        (b.old_capacity, b.selection_capacity, b.row_capacity) = (self.old, self.selected, self.rows);
        replace(&mut b.candidates, words::<Candidate>(self.candidates));
        replace(&mut b.separations, words::<crate::layout::Separation>(self.candidates));
        replace(&mut b.states, words::<PairState>(self.candidates));
        replace(&mut b.old_elements, self.old);
        replace(&mut b.old_states, words::<PairState>(self.old));
        replace(&mut b.selection.starts, self.selected + 1);
        replace(&mut b.selection.blocks, self.selected.div_ceil(kernels::SCAN_COUNTS.workgroup));
        replace(&mut b.rows.rows, words::<Row>(self.rows));
        replace(&mut b.rows.pairs, words::<Candidate>(self.rows));
        replace(&mut b.rows.order, self.rows);
        replace(&mut b.rows.waiting, 2 * self.rows);
        replace(&mut b.rows.color_ends, self.rows);
    }

    fn of(collision: &Collision<TwinEngine>) -> [usize; 4] {
        let b = &collision.buffers;
        [b.capacity, b.old_capacity, b.selection_capacity, b.row_capacity]
    }
}

/// What three calls of eight steps came to, the first of them at rest.
struct Calls {
    reports: Vec<StepReport>,
    ends: [End; 3],
    /// Which buffers grew, and how many searches and steps after the first search were made again because of
    /// one.
    grew: [bool; 4],
    again: usize,
    /// Candidates that the first search has found.
    first: usize,
}

fn calls(room: Room) -> Calls {
    let (model, x) = sheets();
    let down: Vec<Point> = x.iter().map(|x| Point::new(x.x + 0.5 * EDGE, x.y, 3e-3 - x.z)).collect();
    let up: Vec<Point> = x.iter().map(|x| x + Vector::new(0.1, 0.02, -0.03) * (1.0 + x.y)).collect();
    let mut collision = collision(&model, &x, &x, None);
    room.give(&mut collision);
    let (mut reports, mut again, mut first) = (Vec::new(), 0, 0);
    let ends = [x, down, up].map(|target| {
        collision.begin(&Call::toward(&target)).unwrap();
        let before = Room::of(&collision);
        collision.search().unwrap();
        if !reports.is_empty() {
            again += usize::from(Room::of(&collision)[0] != before[0]);
        } else {
            let read = [(collision.buffers.control, words::<Control>(1))];
            let control = collision.engine.run(&Recording::default(), &read).unwrap().swap_remove(0);
            let control: Control = bytemuck::cast_slice(&control)[0];
            first = control.candidates as usize;
        }
        for _ in 0..8 {
            let before = Room::of(&collision);
            reports.extend(collision.steps(1).unwrap());
            again += usize::from(Room::of(&collision)[0] != before[0]);
        }
        collision.end().unwrap()
    });
    let given = [room.candidates, room.old, room.selected, room.rows];
    let now = Room::of(&collision);
    Calls { reports, ends, grew: [0, 1, 2, 3].map(|k| now[k] > given[k]), again, first }
}

#[test]
fn buffers_that_are_too_small_change_no_bits() {
    let plenty = Room::PLENTY;
    let with_room = calls(plenty);
    assert!((with_room.grew, with_room.again) == ([false; 4], 0) && !with_room.ends[1].rows.is_empty());
    let agree = |room: Room| {
        let made = calls(room);
        assert!(made.reports == with_room.reports && made.ends == with_room.ends, "{room:?}");
        made
    };
    for (room, buffers) in [
        (Room { candidates: 64, ..plenty }, [true, false, false, false]),
        (Room { old: 64, ..plenty }, [false, true, false, false]),
        (Room { selected: 64, ..plenty }, [false, false, true, false]),
        (Room { rows: 2, ..plenty }, [false, false, false, true]),
        (Room { candidates: 64, old: 64, selected: 64, rows: 2 }, [true; 4]),
    ] {
        assert_eq!(agree(room).grew, buffers, "{room:?}");
    }
    // Just room for the first search: later ones find more.
    let candidates = with_room.first;
    assert!(agree(Room { candidates, old: candidates, selected: candidates, ..plenty }).again > 0);
}

#[test]
fn a_step_that_is_made_again_reports_what_presses() {
    let (model, x) = sheets();
    // The small sheet goes below the large one, and presses.
    let target: Vec<Point> =
        x.iter().map(|x| Point::new(x.x + if x.z == 0.0 { 0.04 } else { 0.0 }, x.y, 3e-3 - x.z)).collect();
    let mut collision = collision(&model, &x, &x, None);
    collision.begin(&Call::toward(&target)).unwrap();
    collision.search().unwrap();
    let mut again = 0;
    for _ in 0..6 {
        // Without any room for more.
        collision.buffers.capacity = states(&mut collision).len();
        let capacity = collision.buffers.capacity;
        let report = collision.step().unwrap();
        again += usize::from(collision.buffers.capacity > capacity && report.pressing > 0);
    }
    assert!(again > 0);
}

/// A triangle that is pressed onto the ground and pulled along it.
#[test]
fn friction_holds_up_to_its_coefficient_times_the_pressure() {
    const PULL: f64 = 5e-3;
    let x = [(0.0, 0.0), (EDGE, 0.0), (0.0, EDGE)].map(|(x, y)| Point::new(x, y, 1.01 * DELTA));
    let topology = Topology::builder(3).triangles(vec![[0, 1, 2]]).build().unwrap();
    let ground = bowknot_geometry::HalfSpace::new(Point::origin(), Vector::z()).unwrap();
    let model =
        CollisionModel::new(topology, vec![0; 3], vec![BodyFilter::DEFORMABLE], vec![ground]).unwrap();
    for (of_body, of_ground, expected) in [(0.0, 0.5, 0.0), (0.8, 0.2, 0.4), (0.5, 0.5, 0.5), (2.0, 2.0, 1.0)]
    {
        let lengths = Lengths {
            edges: &[EDGE; 3],
            margins: &[DELTA; 3],
            deltas: &[DELTA; 3],
            half_space_deltas: &[],
            thicknesses: &[],
            half_space_thicknesses: &[],
            min_separation: MIN_SEPARATION,
            edge_limits: &[],
        };
        let constraints = Constraints {
            frictions: &[of_body; 3],
            half_space_frictions: &[of_ground],
            ..Constraints::default()
        };
        let settings = Settings::default();
        let engine = TwinEngine::new();
        let mut collision =
            Collision::new(engine, &model, &x, &x, &lengths, &constraints, &settings).unwrap();
        // As far down as along: the pressure is worth the way that the ground takes.
        let down = PULL + 0.01 * DELTA;
        let target = x.map(|x| x + Vector::new(PULL, 0.0, -down));
        collision.begin(&Call::toward(&target)).unwrap();
        let last = (0..30).map(|_| collision.step().unwrap()).last().unwrap();
        assert_eq!((last.contact_rows, last.pressing), (3, 3));
        assert!(last.mean_residual < 1e-4 * EDGE && last.net_residual < 1e-4 * EDGE, "{last:?}");
        for (end, start) in collision.positions().unwrap().iter().zip(x) {
            let moved = end - start;
            let held = 1.0 - moved.x / PULL;
            assert!((held - expected).abs() < 0.01, "{of_body}, {of_ground}: {held}");
            assert!(
                (end.z - DELTA).abs() < 1e-3 * DELTA && moved.y.abs() < 2.0 * collision.grid.quantum(),
                "{end}"
            );
        }
    }
}

/// A vertex slides on a sheet whose edges it crosses: only the contact below it has a row.
#[test]
fn pairs_that_are_no_contacts_get_no_rows() {
    let (n, edge) = (9u32, EDGE);
    let mut x: Vec<Point> =
        (0..n * n).map(|k| Point::new(edge * f64::from(k % n), edge * f64::from(k / n), 0.0)).collect();
    let triangles = (0..n * (n - 1)).filter(|k| k % n != n - 1);
    let triangles = triangles.flat_map(|k| [[k, k + 1, k + n + 1], [k, k + n + 1, k + n]]);
    x.push(Point::new(2.05 * edge, 3.02 * edge, DELTA));
    let v = x.len() - 1;
    let topology = Topology::builder(x.len()).triangles(triangles).particles([v as u32]).build().unwrap();
    let bodies = (0..x.len()).map(|k| u32::from(k == v)).collect();
    let filters = vec![BodyFilter::OBSTACLE, BodyFilter::DEFORMABLE];
    let model = CollisionModel::new(topology, bodies, filters, vec![]).unwrap();
    let rows_with = |contacts_only: bool| {
        let count = x.len();
        let lengths = Lengths {
            edges: &vec![EDGE; count],
            margins: &vec![DELTA; count],
            deltas: &vec![DELTA; count],
            half_space_deltas: &[],
            thicknesses: &[],
            half_space_thicknesses: &[],
            min_separation: MIN_SEPARATION,
            edge_limits: &[],
        };
        let settings = Settings { contacts_only, ..Settings::default() };
        let (engine, constraints) = (TwinEngine::new(), Constraints::default());
        let mut collision =
            Collision::new(engine, &model, &x, &x, &lengths, &constraints, &settings).unwrap();
        let mut target = x.clone();
        target[v] += Vector::new(0.3 * edge, 0.0, -0.1 * edge);
        collision.begin(&Call::toward(&target)).unwrap();
        collision.step().unwrap().contact_rows
    };
    assert!(rows_with(true) == 1 && rows_with(false) > 2, "{} {}", rows_with(true), rows_with(false));
}

#[test]
fn targets_are_polished_near_the_end_while_edges_are_too_long() {
    let settings = Settings { polish_sweeps: 64, polish_distance: EDGE, ..Settings::default() };
    let report = |remaining: f64, stretch_to_limit: f64| StepReport {
        remaining,
        stretch_to_limit,
        ..StepReport::default()
    };
    assert!(settings.polishes_after(&report(0.5 * EDGE, 1.02)));
    assert!(!settings.polishes_after(&report(0.5 * EDGE, 1.0)));
    assert!(!settings.polishes_after(&report(2.0 * EDGE, 1.02)));
    let sweeps = [0, 1, 2, 3, 4, 70, usize::MAX].map(|polished| settings.sweeps_to_polish(polished));
    assert_eq!(sweeps, [8, 16, 32, 64, 64, 64, 64]);
    let settings = Settings { polish_sweeps: settings.sweeps, ..settings };
    assert!(!settings.polishes_after(&report(0.5 * EDGE, 1.02)));
}

/// Two grains that the target knows become candidates far from each other.
#[test]
fn distances_of_a_pair_are_set_when_it_comes_into_range() {
    let x = [0.0, 3.0].map(|height| Point::new(0.0, 0.0, height * DELTA));
    let target = [x[0], x[1] - 1.8 * DELTA * Vector::z()];
    let topology = Topology::builder(2).particles([0, 1]).build().unwrap();
    let model = CollisionModel::new(topology, vec![0; 2], vec![BodyFilter::DEFORMABLE], vec![]).unwrap();
    let lengths = Lengths {
        edges: &[10.0 * DELTA; 2],
        margins: &[DELTA; 2],
        deltas: &[DELTA; 2],
        half_space_deltas: &[],
        thicknesses: &[],
        half_space_thicknesses: &[],
        min_separation: MIN_SEPARATION,
        edge_limits: &[],
    };
    let (constraints, settings) = (Constraints::default(), Settings::default());
    let rest = x.map(|x| x * 10.0);
    let mut collision =
        Collision::new(TwinEngine::new(), &model, &x, &rest, &lengths, &constraints, &settings).unwrap();
    collision.begin(&Call { known: &[true; 2], ..Call::toward(&target) }).unwrap();
    let mut desired = || {
        collision.step().unwrap();
        let quantum = collision.grid().quantum();
        states(&mut collision).values().map(|pair| f64::from(pair.desired) * quantum / DELTA).sum::<f64>()
    };
    assert!((desired() - 1.0).abs() < 1e-3, "far");
    assert!((desired() - 0.7 * 1.2).abs() < 1e-3, "near");
}

/// A column of grains on the ground, that weighs down and is pulled aside.
#[test]
fn a_call_that_starts_from_what_the_last_one_carried_has_nothing_left_to_do() {
    let count = 24;
    let x: Vec<Point> = (0..count).map(|k| Point::new(0.0, 0.0, DELTA * (1.0 + f64::from(k)))).collect();
    let topology = Topology::builder(x.len()).particles(0..count).build().unwrap();
    let ground = bowknot_geometry::HalfSpace::new(Point::origin(), Vector::z()).unwrap();
    let model =
        CollisionModel::new(topology, vec![0; x.len()], vec![BodyFilter::DEFORMABLE], vec![ground]).unwrap();
    let lengths = Lengths {
        edges: &vec![DELTA; x.len()],
        margins: &vec![DELTA; x.len()],
        deltas: &vec![DELTA; x.len()],
        half_space_deltas: &[],
        thicknesses: &[],
        half_space_thicknesses: &[],
        min_separation: MIN_SEPARATION,
        edge_limits: &[],
    };
    let constraints = Constraints {
        frictions: &vec![0.8; x.len()],
        half_space_frictions: &[0.8],
        ..Constraints::default()
    };
    // At rest the grains are far from each other, so that they keep their distance though they are of one
    // body.
    let rest: Vec<Point> = x.iter().map(|x| x * 10.0).collect();
    let engine = TwinEngine::new();
    let mut collision =
        Collision::new(engine, &model, &x, &rest, &lengths, &constraints, &Settings::default()).unwrap();
    let pull = Vector::new(0.02, 0.0, -0.1) * DELTA;
    let target: Vec<Point> = x.iter().map(|x| x + pull).collect();
    // As many steps, then the place and what the rows carry.
    let mut call = |steps: usize, carried: &[Carried]| {
        collision.place(&x).unwrap();
        collision.begin(&Call { carried, slip_start: &x, ..Call::toward(&target) }).unwrap();
        let last = (0..steps).map(|_| collision.step().unwrap()).last().unwrap();
        (last, collision.end().unwrap())
    };
    let (_, end) = call(400, &[]);
    let carried: Vec<Carried> = end.rows.iter().map(Carried::from).collect();
    let weight = f64::from(count) * 0.1 * DELTA;
    let at = |end: &End, kind: Kind| {
        let of_kind = end.rows.iter().filter(|row| row.candidate.kind() == kind as u32);
        of_kind.map(|row| row.multiplier).fold(0.0, f64::max)
    };
    assert!((at(&end, Kind::VertexHalfSpace) / weight - 1.0).abs() < 0.01, "{end:?}");
    assert!(end.rows.iter().all(|row| row.friction.norm() > 0.1 * row.multiplier), "{end:?}");
    let (cold, cold_end) = call(1, &[]);
    let (warm, warm_end) = call(1, &carried);
    assert!(warm.largest_move < 1e-3 * cold.largest_move, "{warm:?} {cold:?}");
    let held = at(&cold_end, Kind::VertexHalfSpace) / weight;
    assert!(held < 0.9, "{held}");
    for row in &warm_end.rows {
        let before = end.rows.iter().find(|before| before.candidate == row.candidate).unwrap();
        let change = (row.multiplier - before.multiplier).abs() + (row.friction - before.friction).norm();
        assert!(change < 0.01 * weight, "{row:?} {before:?}");
    }
    // Neither the order of the entries nor that of the grains of a pair matters, and what is no number is
    // left out.
    let swapped = carried.iter().rev().map(|pair| match pair.candidate.kind() == Kind::VertexVertex as u32 {
        true => Carried {
            candidate: Candidate::new(Kind::VertexVertex, pair.candidate.b, pair.candidate.a()),
            friction: -pair.friction,
            ..*pair
        },
        false => *pair,
    });
    let far = Carried { candidate: Candidate::new(Kind::VertexVertex, 0, 20), ..carried[0] };
    let nan = Carried { multiplier: f64::NAN, candidate: Candidate::new(Kind::VertexVertex, 0, 2), ..far };
    let swapped: Vec<Carried> = swapped.chain([far, nan]).collect();
    assert!(call(1, &swapped) == (warm, warm_end));
    // A call without entries starts without them.
    assert!(call(1, &[]) == (cold, cold_end));
}

/// Kernels go by the numbers of candidates and rows, not by what there is room for.
#[test]
fn what_lies_beyond_candidates_and_rows_is_not_touched() {
    let (model, x) = sheets();
    let target: Vec<Point> = x.iter().map(|x| Point::new(x.x, x.y, 3e-3 - x.z)).collect();
    let mut collision = collision(&model, &x, &x, None);
    collision.begin(&Call::toward(&target)).unwrap();
    // Buffers that are too small grow first.
    collision.step().unwrap();
    // The end of the call would put the pairs in range where the selection is.
    collision.before[0] = usize::MAX;
    for _ in 0..3 {
        let b = collision.buffers;
        let buffers = [b.selection.starts, b.selection.blocks, b.rows.rows, b.rows.pairs, b.rows.order];
        let mut recording = Recording::default();
        for buffer in buffers {
            recording.write(buffer, &vec![NONE; collision.engine.words(buffer)]);
        }
        collision.engine.run(&recording, &[]).unwrap();
        let report = collision.step().unwrap();
        // The search within the step may have found others than those that were selected from.
        let all = collision.engine.words_of(b.selection.starts);
        let selected = all.iter().rposition(|start| *start != NONE).unwrap();
        assert!(selected + 200 < b.capacity, "{selected} of {}", b.capacity);
        assert_eq!(all[selected] as usize, report.contact_rows);
        let used = [
            selected + 1,
            selected.div_ceil(256),
            words::<Row>(report.contact_rows),
            words::<Candidate>(report.contact_rows),
            report.contact_rows,
        ];
        for (buffer, used) in buffers.into_iter().zip(used) {
            let words = collision.engine.words_of(buffer);
            assert!(words[used..].iter().all(|word| *word == NONE) && used < words.len());
        }
        assert!(report.contact_rows > 20);
    }
}

/// Grains that have mixed: trees by their order at the start have boxes as large as the heap.
#[test]
fn trees_are_ordered_anew_where_grains_have_mixed() {
    const SIDE: u32 = 12;
    let count = (SIDE * SIDE * SIDE) as usize;
    let start: Vec<Point> = (0..SIDE * SIDE * SIDE)
        .map(|k| {
            Point::from(Vector::from(
                [k % SIDE, k / SIDE % SIDE, k / (SIDE * SIDE)].map(|k| 1.5 * DELTA * f64::from(k)),
            ))
        })
        .collect();
    let mut mixed = start.clone();
    fastrand::Rng::with_seed(3).shuffle(&mut mixed);
    let topology = Topology::builder(count).particles((0..count as u32).collect::<Vec<_>>()).build().unwrap();
    let model = CollisionModel::new(
        topology,
        (0..count as u32).collect(),
        vec![BodyFilter::DEFORMABLE; count],
        vec![],
    )
    .unwrap();
    let mut collision = collision(&model, &start, &start, None);
    collision.place(&mixed).unwrap();
    let mut candidates = |reorders: bool| {
        if reorders {
            collision.reorder(&mixed).unwrap();
        }
        collision.begin(&Call::toward(&mixed)).unwrap();
        collision.search().unwrap();
        let mut found: Vec<Candidate> = states(&mut collision).into_keys().collect();
        found.sort_unstable();
        let b = &collision.trees.particles;
        let slots: Vec<u32> = b.tree.slots.iter().map(|slot| slot.element).collect();
        let words = collision.engine.words_of(b.slots);
        assert_eq!(words[..4 * slots.len()], *bytemuck::cast_slice::<_, u32>(&b.tree.slots));
        // Of the groups that a query compares with: how large they are, in all.
        let extent = |group: &[u32]| {
            let axis = |k: usize| {
                let all = || group.iter().map(|v| mixed[*v as usize][k]);
                all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
            };
            axis(0).max(axis(1)).max(axis(2))
        };
        (found, slots.chunks(8).map(extent).sum::<f64>() / (slots.len() / 8) as f64)
    };
    let (before, old) = candidates(false);
    let (after, new) = candidates(true);
    assert!(before == after && before.len() > count);
    assert!(old > 0.5 * 1.5 * DELTA * f64::from(SIDE) && new < 4.0 * DELTA, "{old} {new}");
}

/// What is placed and begun is recorded and runs with the first steps. Nothing of it is lost, or names a
/// buffer that is gone.
#[test]
fn calls_that_are_refused_or_begun_anew_leave_nothing_behind() {
    let (model, x) = sheets();
    let target: Vec<Point> = x.iter().map(|x| x + Vector::new(0.0, 0.0, DELTA)).collect();
    let moved: Vec<Point> = x.iter().map(|x| x + Vector::new(DELTA, 0.0, 0.0)).collect();
    let carried: Vec<Carried> = (0..9)
        .map(|k| Carried {
            candidate: Candidate::new(Kind::VertexTriangle, k, k),
            multiplier: 1e-3,
            friction: Vector::zeros(),
        })
        .collect();
    let mut collision = collision(&model, &x, &x, None);
    let placed = collision.place(&moved).unwrap();
    let refused = collision.begin(&Call { slip_start: &x[1..], ..Call::toward(&target) });
    assert!(matches!(refused, Err(CollisionError::Length { what: "slip_start", .. })));
    collision.begin(&Call { carried: &carried[..2], ..Call::toward(&moved) }).unwrap();
    collision.begin(&Call { carried: &carried, ..Call::toward(&moved) }).unwrap();
    collision.step().unwrap();
    // The sheets part, upward and downward, from where they were placed.
    let end = collision.end().unwrap().positions;
    assert!(end.iter().zip(&placed).all(|(x, placed)| (x.x - placed.x).abs() < 0.01 * DELTA));
    collision.begin(&Call::toward(&moved)).unwrap();
    collision.step().unwrap();
    let placed = collision.place(&x).unwrap();
    assert_eq!(collision.end().unwrap().positions, placed);
}
