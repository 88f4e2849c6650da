//! Free flight: bodies that nothing is near move as a whole, before the device makes steps.
//!
//! *Within a body* a translation by multiples of the quantum of the grid is exact, so no distance changes.
//! Bodies that would come near each other form a group and are translated alike; with those that are
//! prescribed in any part, and above half-spaces that they would come near, they stay.
//!
//! *Between groups* the boxes decide. All move at the same path time, each along a straight line, so that the
//! gap of two boxes along an axis is linear in the path time and smallest at an end. Groups whose boxes are
//! farther apart than their contact ranges along one axis at both ends are so in between, and no pair of them
//! needs to be looked at. Contact ranges are hundreds of quanta at least, far above what rounding to the grid
//! can change.
//!
//! A flight that ended where bodies come near each other would be longer, but its end is out of contact
//! range: the next step could then be the last, and take bodies closer than they should be, without a contact
//! row.

use bowknot_geometry::{Aabb, HalfSpace, Point, Vector};
use bowknot_twoway::{CallInput, CollisionScene};
use rayon::prelude::*;
use std::ops::Range;

/// Vertices that one task looks at.
const CHUNK: usize = 4096;

/// Where the vertices are after a flight from `start` [m], on a grid with a quantum [m] on which `start`
/// lies. None if it would not save steps, of which each moves a vertex by `longest` local edge lengths at
/// most.
pub fn fly(
    scene: &CollisionScene,
    call: &CallInput,
    [start, target]: [&[Point]; 2],
    quantum: f64,
    longest: f64,
) -> Option<Vec<Point>> {
    let body = scene.model().vertex_body();
    let steps_after = |translation: &(dyn Fn(usize) -> Vector + Sync)| {
        let of_vertex = |v: usize| {
            let left = (target[v] - start[v] - translation(v)).norm();
            (left / (longest * scene.local_edge(v))).ceil()
        };
        let most = |vertices: Range<usize>| vertices.map(of_vertex).fold(0.0, f64::max);
        let count = start.len();
        match count {
            // A parallel loop would pay for the way to its threads.
            ..=CHUNK => most(0..count),
            _ => (0..count.div_ceil(CHUNK))
                .into_par_iter()
                .map(|chunk| most(chunk * CHUNK..count.min((chunk + 1) * CHUNK)))
                .reduce(|| 0.0, f64::max),
        }
    };
    let without = steps_after(&|_| Vector::zeros());
    // The flight itself is a step, and so is at least one after it.
    if without <= 2.0 {
        return None;
    }
    let translations = Bodies::new(scene, call, start, target).translations(scene, quantum);
    let of_body = |v: usize| translations[body[v] as usize];
    let is_shorter = 1.0 + steps_after(&of_body).max(1.0) < without;
    is_shorter.then(|| start.iter().enumerate().map(|(v, x)| x + of_body(v)).collect())
}

/// The bodies of a call.
struct Bodies {
    boxes: Vec<Aabb>,
    /// Vertices of each, and the sum of their displacements to the target [m].
    counts: Vec<usize>,
    sums: Vec<Vector>,
    /// The group of each, named by one of its bodies. The last entry is what stays.
    groups: Vec<usize>,
}

impl Bodies {
    fn new(scene: &CollisionScene, call: &CallInput, start: &[Point], target: &[Point]) -> Self {
        let count = scene.model().bodies().len();
        let mut bodies = Self {
            boxes: vec![Aabb::EMPTY; count],
            counts: vec![0; count],
            sums: vec![Vector::zeros(); count],
            groups: (0..=count).collect(),
        };
        for (v, ((x, y), &body)) in start.iter().zip(target).zip(scene.model().vertex_body()).enumerate() {
            let body = body as usize;
            bodies.boxes[body] = bodies.boxes[body].union(&Aabb { min: *x, max: *x });
            bodies.counts[body] += 1;
            bodies.sums[body] += y - x;
            if !call.is_movable(v) {
                bodies.groups[body] = count;
            }
        }
        bodies
    }

    /// By how much each body is translated [m], in multiples of the quantum [m].
    fn translations(mut self, scene: &CollisionScene, quantum: f64) -> Vec<Vector> {
        loop {
            let means = self.means();
            let round = |f: Vector| f.map(|c| (c / quantum).round() * quantum);
            if !self.unite(scene, &means) {
                return self.groups[..self.boxes.len()].iter().map(|&group| round(means[group])).collect();
            }
        }
    }

    /// The mean displacement of each group [m].
    fn means(&self) -> Vec<Vector> {
        let rest = self.boxes.len();
        let (mut counts, mut sums) = (vec![0; rest + 1], vec![Vector::zeros(); rest + 1]);
        for body in 0..rest {
            counts[self.groups[body]] += self.counts[body];
            sums[self.groups[body]] += self.sums[body];
        }
        sums[rest] = Vector::zeros();
        sums.iter().zip(counts).map(|(sum, count)| sum / (count as f64).max(1.0)).collect()
    }

    /// Makes those one group that come near each other if each group moves by its mean displacement [m].
    /// Whether there are any.
    fn unite(&mut self, scene: &CollisionScene, means: &[Vector]) -> bool {
        let mut any = false;
        for a in 0..self.boxes.len() {
            for b in self.met_by(scene, means, a) {
                let [own, other] = [a, b].map(|body| self.groups[body]);
                any = true;
                // The last group is what stays.
                self.groups
                    .iter_mut()
                    .filter(|group| **group == own.min(other))
                    .for_each(|group| *group = own.max(other));
            }
        }
        any
    }

    /// Bodies of other groups that come later or stay and that `a` comes near; what stays, for a half-space.
    fn met_by(&self, scene: &CollisionScene, means: &[Vector], a: usize) -> Vec<usize> {
        let (model, spacing, rest) = (scene.model(), scene.spacing(), self.boxes.len());
        if self.counts[a] == 0 || self.groups[a] == rest {
            return Vec::new();
        }
        let (motion, margin) = (means[self.groups[a]], spacing.margin(a as u32));
        let is_met = |b: &usize| {
            let (own, other) = (self.groups[a], self.groups[*b]);
            let may_meet =
                own != other && (*b > a || other == rest) && model.may_collide(a as u32, *b as u32);
            let (relative, least) = (means[other] - motion, margin + spacing.margin(*b as u32));
            may_meet && !stay_apart([&self.boxes[a], &self.boxes[*b]], &relative, least)
        };
        let is_above = |h: &HalfSpace| stays_above(h, &self.boxes[a], &motion, 2.0 * margin);
        let ground = (!model.half_spaces().iter().all(is_above)).then_some(rest);
        (0..rest).filter(is_met).chain(ground).collect()
    }
}

/// Whether two boxes stay farther apart than `least` [m] along one axis while the second moves by `motion`
/// [m] relative to the first.
fn stay_apart([a, b]: [&Aabb; 2], motion: &Vector, least: f64) -> bool {
    (0..3).any(|k| {
        let sides = [(b.min[k] - a.max[k], motion[k]), (a.min[k] - b.max[k], -motion[k])];
        sides.iter().any(|(gap, opening)| gap.min(gap + opening) > least)
    })
}

/// Whether a box that moves by `motion` [m] stays farther above a half-space than `least` [m].
fn stays_above(half_space: &HalfSpace, bounds: &Aabb, motion: &Vector, least: f64) -> bool {
    let n = &half_space.normal;
    let lowest: f64 = (0..3).map(|k| (n[k] * bounds.min[k]).min(n[k] * bounds.max[k])).sum();
    let gap = lowest - half_space.offset;
    gap.min(gap + n.dot(motion)) > least
}
