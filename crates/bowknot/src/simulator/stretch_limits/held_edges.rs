//! Limits of edges between prescribed vertices that are held farther apart than the limits allow.
//!
//! Prescribed vertices go where they are told, so the edges between them yield: each gets the length that it
//! has where edges exceed their limits least (`least_excess.rs`). That length follows from the places of the
//! prescribed vertices alone; those of the others are where the search for it begins. All limits can then be
//! met at once, since there is a place for every vertex at which they are, and edges that need not be longer
//! keep theirs. Where nothing asks for it any more, an edge goes back to its limit as fast as the forces
//! shorten it: a limit that were below its length at once would be a wall in its way.
//!
//! Where all vertices meet the limits as they are, there is nothing to look for. By Kirszbraun's theorem a map from the prescribed vertices at rest to their places that lengthens no
//! distance by more than a factor goes on to all vertices with that factor. So there is not either while no two
//! of them are farther apart than their distance at rest times the stretch limit.

use super::held_apart::{HeldPair, OverLimit};
use super::least_excess::LimitedGraph;
use super::limited_edges::ROOM;
use bowknot_geometry::{Point, UnionFind, Vector};
use bowknot_twoway::lcp::DistanceLimit;
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// Share of its limit by which an edge may be too long before it counts. Larger: limits are exceeded by more
/// before anybody is told. Smaller: the tolerance of the search for the least excess shows.
const SLACK: f64 = 2e-3;

/// Vertices that one thread takes at least.
const MIN_VERTICES: usize = 64;

/// Where an edge that goes back begins, in the way on which its force grows without bound. 1: it is at its
/// wall, where Newton's method begins badly. Smaller: edges under large loads do not go back.
const GOES_BACK: f64 = 0.99;

/// The edges that yield.
#[derive(Clone, Debug, Default)]
pub(crate) struct HeldEdges {
    /// The vertices for which the patches were made.
    prescribed: Vec<bool>,
    patches: Vec<Patch>,
    /// Edges between two prescribed vertices, which are in no patch.
    between: Vec<DistanceLimit>,
    /// Edges that go back to their limits, with the limits of the present time step [m].
    going_back: Vec<(u32, f64)>,
}

/// Free vertices that edges connect, and the prescribed ones around them.
#[derive(Clone, Debug)]
struct Patch {
    /// Free ones first.
    vertices: Vec<u32>,
    free: usize,
    /// Edges between places in `vertices`, with their limits [m], and their indices among the limited edges.
    edges: Vec<([u32; 2], f64)>,
    indices: Vec<u32>,
    graph: LimitedGraph,
    /// Smallest ratio of a limit to the rest length.
    stretch: f64,
    /// Places of the prescribed ones when this was last looked at [m].
    places: Vec<Point>,
    /// Whether all limits can be met with these places, wherever the others are.
    is_loose: bool,
    /// Whether the limits are those of these places and, unless loose, of the state of this time step.
    is_current: bool,
    /// The limits of the edges then [m].
    limits: Vec<f64>,
}

impl HeldEdges {
    /// The limits [m] of edges that yield, by index; an edge may have several.
    pub fn limits(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        self.patches.iter().flat_map(Patch::yielding).chain(self.going_back.iter().copied())
    }

    /// What prescribed vertices ask for at `x` [m] beyond the limits; none if all can be met.
    pub fn over(&self, x: &[Point]) -> Option<OverLimit> {
        let larger = |a: OverLimit, b: OverLimit| if b.excess > a.excess { b } else { a };
        let between = self.between.iter().filter_map(|&DistanceLimit { vertices, limit: allowed_m }| {
            let distance_m = (x[vertices[0] as usize] - x[vertices[1] as usize]).norm();
            let pair = Some(HeldPair { vertices, distance_m, allowed_m });
            let over = OverLimit { edge: vertices, excess: distance_m / allowed_m, pair };
            (over.excess > 1.0 + SLACK).then_some(over)
        });
        self.patches.iter().filter_map(Patch::over).chain(between).reduce(larger)
    }

    /// Begins a time step at positions `x` [m], for edges among the `limited` ones; `before` are those that
    /// yielded in the last one, with their limits. Returns whether limits may have changed.
    pub fn begin_step(
        &mut self,
        limited: &[DistanceLimit],
        [rest, x]: [&[Point]; 2],
        prescribed: &[bool],
        before: &[DistanceLimit],
    ) -> bool {
        let prescribed = &prescribed[..rest.len()];
        let others = self.prescribed != prescribed;
        if others {
            self.prescribed = prescribed.to_vec();
            self.patches = patches(limited, rest, prescribed);
            let is_between = |edge: &&DistanceLimit| edge.vertices.iter().all(|&v| prescribed[v as usize]);
            self.between = limited.iter().filter(is_between).copied().collect();
        }
        let went_back = !self.going_back.is_empty();
        self.going_back = going_back(limited, x, before);
        // The state alone decides, so that a resumed run has the same bits.
        self.patches.iter_mut().for_each(|patch| patch.is_current &= patch.is_loose);
        let moved = self.go_on(rest, x);
        others || moved || went_back || !self.going_back.is_empty()
    }

    /// Goes on within a time step with the prescribed vertices at other places in `x` [m]. Returns whether
    /// limits may have changed.
    pub fn go_on(&mut self, rest: &[Point], x: &[Point]) -> bool {
        let mut changed = false;
        for patch in &mut self.patches {
            changed |= patch.update(rest, x);
        }
        changed
    }
}

/// The edges of those that yielded `before` that are still too long at `x`, by index, with limits [m] to
/// begin from.
fn going_back(limited: &[DistanceLimit], x: &[Point], before: &[DistanceLimit]) -> Vec<(u32, f64)> {
    if before.is_empty() {
        return Vec::new();
    }
    let before: FxHashMap<[u32; 2], f64> = before.iter().map(|edge| (edge.vertices, edge.limit)).collect();
    let goes_back = |(k, edge): (u32, &DistanceLimit)| {
        let [a, b] = edge.vertices.map(|v| x[v as usize]);
        let from = (a - b).norm() / (1.0 + GOES_BACK * ROOM);
        let limit = before.get(&edge.vertices)?.min(from);
        (limit > edge.limit).then_some((k, limit))
    };
    (0..).zip(limited).filter_map(goes_back).collect()
}

/// The patches with two prescribed vertices or more.
fn patches(limited: &[DistanceLimit], rest: &[Point], prescribed: &[bool]) -> Vec<Patch> {
    let is_free = |v: u32| !prescribed[v as usize];
    if limited.iter().all(|edge| edge.vertices.into_iter().all(is_free)) {
        return Vec::new();
    }
    let mut sets = UnionFind::new(rest.len());
    for [a, b] in limited.iter().map(|edge| edge.vertices) {
        if is_free(a) && is_free(b) {
            sets.join(a, b);
        }
    }
    let mut of_set: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (k, edge) in (0..).zip(limited) {
        if let Some(&v) = edge.vertices.iter().find(|v| is_free(**v)) {
            of_set.entry(sets.find(v)).or_default().push(k);
        }
    }
    of_set.into_values().filter_map(|indices| Patch::new(limited, indices, rest, is_free)).collect()
}

impl Patch {
    /// Of the `limited` edges with these indices; none with fewer than two prescribed vertices.
    fn new(
        limited: &[DistanceLimit],
        indices: Vec<u32>,
        rest: &[Point],
        is_free: impl Fn(u32) -> bool,
    ) -> Option<Self> {
        let mut vertices: Vec<u32> = indices.iter().flat_map(|&k| limited[k as usize].vertices).collect();
        vertices.sort_unstable_by_key(|v| (!is_free(*v), *v));
        vertices.dedup();
        let free = vertices.partition_point(|v| is_free(*v));
        if vertices.len() < free + 2 {
            return None;
        }
        let places: BTreeMap<u32, u32> = vertices.iter().copied().zip(0..).collect();
        let mut stretch = f64::INFINITY;
        let edge = |&k: &u32| {
            let DistanceLimit { vertices: [a, b], limit } = limited[k as usize];
            let length = (rest[a as usize] - rest[b as usize]).norm();
            stretch = f64::min(stretch, limit / length);
            ([places[&a], places[&b]], limit)
        };
        let edges: Vec<([u32; 2], f64)> = indices.iter().map(edge).collect();
        let graph = LimitedGraph::new(&edges, free);
        let limits: Vec<f64> = edges.iter().map(|(_, limit)| *limit).collect();
        let places = Vec::new();
        Some(Self {
            vertices,
            free,
            edges,
            indices,
            graph,
            stretch,
            places,
            is_loose: false,
            is_current: false,
            limits,
        })
    }

    /// The edges that yield, by index among all, with their limits [m].
    fn yielding(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        let edges = self.indices.iter().zip(&self.edges).zip(&self.limits);
        edges.filter(|((_, (_, of_scene)), limit)| *limit > of_scene).map(|((k, _), limit)| (*k, *limit))
    }

    /// What is asked for beyond the limits.
    fn over(&self) -> Option<OverLimit> {
        let excess = |k: u32| (1.0 + SLACK) * self.limits[k as usize] / self.edges[k as usize].1;
        let over =
            (0..self.edges.len() as u32).filter(|&k| self.limits[k as usize] > self.edges[k as usize].1);
        let most = over.reduce(|a, b| if excess(b) > excess(a) { b } else { a })?;
        let edge = self.edges[most as usize].0.map(|v| self.vertices[v as usize]);
        Some(OverLimit { edge, excess: excess(most), pair: self.pair_over(most) })
    }

    /// Finds the limits at which the prescribed vertices can be where they are in `x` [m]; returns whether they
    /// are others than before.
    fn update(&mut self, rest: &[Point], x: &[Point]) -> bool {
        let held = &self.vertices[self.free..];
        let places: Vec<Point> = held.iter().map(|v| x[*v as usize]).collect();
        let moved = places != self.places;
        if self.is_current && !moved {
            return false;
        }
        let rest: Vec<Point> = self.vertices.iter().map(|v| rest[*v as usize]).collect();
        if moved {
            self.places = places;
            self.is_loose = self.can_be_met(&rest[self.free..]);
        }
        self.is_current = true;
        let mut limits: Vec<f64> = self.edges.iter().map(|(_, limit)| *limit).collect();
        if !self.is_loose
            && let Some(points) = self.least_excess(&rest, x)
        {
            for (limit, ([a, b], _)) in limits.iter_mut().zip(&self.edges) {
                *limit = limit.max((points[*a as usize] - points[*b as usize]).norm() / (1.0 + SLACK));
            }
        }
        let changed = limits != self.limits;
        self.limits = limits;
        changed
    }

    /// Places of all vertices where edges exceed their limits least [m]; none if they do not at `x`.
    fn least_excess(&self, rest: &[Point], x: &[Point]) -> Option<Vec<Point>> {
        let mut points: Vec<Point> = self.vertices.iter().map(|v| x[*v as usize]).collect();
        if self.graph.are_met(&points, SLACK) {
            return None;
        }
        // Far from `x`, as after a jump, the guess may be the better start.
        let guess = self.guess(rest);
        if self.graph.energy(&guess) < self.graph.energy(&points) {
            points = guess;
        }
        self.graph.settle(&mut points, SLACK);
        Some(points)
    }

    /// Whether all limits can certainly be met: no two prescribed vertices are too far apart, in comparison
    /// with `rest`.
    fn can_be_met(&self, rest: &[Point]) -> bool {
        let most = ((1.0 + SLACK) * self.stretch).powi(2);
        let places = &self.places;
        (1..places.len()).into_par_iter().with_min_len(MIN_VERTICES).all(|a| {
            (0..a)
                .all(|b| (places[a] - places[b]).norm_squared() <= most * (rest[a] - rest[b]).norm_squared())
        })
    }

    /// Places of all vertices to start from: displacements are means of those of the prescribed ones, with
    /// weights of one over the squared distance at `rest`.
    fn guess(&self, rest: &[Point]) -> Vec<Point> {
        let held = &rest[self.free..];
        let moved: Vec<Vector> = self.places.iter().zip(held).map(|(x, rest)| x - rest).collect();
        let guess = |x: &Point| {
            let (mut sum, mut weights) = (Vector::zeros(), 0.0);
            for (rest, moved) in held.iter().zip(&moved) {
                let weight = 1.0 / (x - rest).norm_squared().max(f64::MIN_POSITIVE);
                sum += moved * weight;
                weights += weight;
            }
            x + sum / weights
        };
        let free = rest[..self.free].par_iter().with_min_len(MIN_VERTICES).map(guess);
        let mut points: Vec<Point> = free.collect();
        points.extend_from_slice(&self.places);
        points
    }

    /// The two prescribed vertices that are farthest beyond what edges allow on a way over an `edge`; none if
    /// edges allow all.
    fn pair_over(&self, edge: u32) -> Option<HeldPair> {
        let ([a, b], limit) = self.edges[edge as usize];
        let [from_a, from_b] = [a, b].map(|v| self.ways_from(v));
        let mut most: Option<HeldPair> = None;
        let held = self.free..self.vertices.len();
        for (first, second) in held.clone().flat_map(|i| held.clone().map(move |j| (i, j))) {
            let distance_m = (self.places[first - self.free] - self.places[second - self.free]).norm();
            let allowed_m = from_a[first] + limit + from_b[second];
            let share = |pair: HeldPair| pair.distance_m / pair.allowed_m;
            if distance_m > (1.0 + SLACK) * allowed_m
                && most.is_none_or(|m| distance_m / allowed_m > share(m))
            {
                let mut vertices = [first, second].map(|v| self.vertices[v]);
                vertices.sort_unstable();
                most = Some(HeldPair { vertices, distance_m, allowed_m });
            }
        }
        most
    }

    /// Sum of the limits along the shortest way from one vertex to each, not through prescribed ones [m].
    fn ways_from(&self, start: u32) -> Vec<f64> {
        let mut ways = vec![f64::INFINITY; self.vertices.len()];
        ways[start as usize] = 0.0;
        // Lengths at least 0 are ordered as their bits are.
        let mut ahead = BinaryHeap::from([Reverse((0_u64, start))]);
        while let Some(Reverse((way, v))) = ahead.pop() {
            let way = f64::from_bits(way);
            if way > ways[v as usize] || v as usize >= self.free {
                continue;
            }
            for &(next, limit) in self.graph.neighbors(v) {
                let way = way + limit;
                if way < ways[next as usize] {
                    ways[next as usize] = way;
                    ahead.push(Reverse((way.to_bits(), next)));
                }
            }
        }
        ways
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Limits of 1.05 on the edges of a grid of n x n vertices, one apart, with both diagonals.
    fn grid(n: u32) -> (Vec<DistanceLimit>, Vec<Point>) {
        let rest: Vec<Point> =
            (0..n * n).map(|v| Point::new(f64::from(v % n), f64::from(v / n), 0.0)).collect();
        let near = |a: u32, b: u32| (rest[a as usize] - rest[b as usize]).norm() < 1.5;
        let pairs = (0..n * n).flat_map(|a| (a + 1..n * n).map(move |b| [a, b]));
        let edge = |vertices: [u32; 2]| {
            let [a, b] = vertices.map(|v| rest[v as usize]);
            DistanceLimit { vertices, limit: 1.05 * (a - b).norm() }
        };
        (pairs.filter(|&[a, b]| near(a, b)).map(edge).collect(), rest)
    }

    /// With the vertices of `held` at their places times a scale, the others anywhere.
    fn limits(n: u32, held: &[u32], scale: f64) -> (Vec<DistanceLimit>, Vec<f64>, Option<OverLimit>) {
        let (limited, rest) = grid(n);
        let mut x = vec![Point::new(9.0, 9.0, 9.0); rest.len()];
        let mut prescribed = vec![false; rest.len()];
        for v in held.iter().map(|v| *v as usize) {
            (x[v], prescribed[v]) = (rest[v] * scale, true);
        }
        let mut edges = HeldEdges::default();
        edges.begin_step(&limited, [&rest, &x], &prescribed, &[]);
        let mut limits: Vec<f64> = limited.iter().map(|edge| edge.limit).collect();
        edges.limits().for_each(|(k, limit)| limits[k as usize] = limit);
        (limited, limits, edges.over(&x))
    }

    #[test]
    fn edges_between_vertices_that_are_held_too_far_apart_yield_and_no_others() {
        for scale in [1.0, 1.05, 1.052] {
            let (limited, limits, over) = limits(6, &[7, 10], scale);
            assert!(limited.iter().zip(&limits).all(|(edge, limit)| edge.limit == *limit) && over.is_none());
        }
        let (limited, limits, over) = limits(6, &[7, 10], 1.1);
        for (edge, limit) in limited.iter().zip(limits) {
            let [a, b] = edge.vertices;
            // The way from 7 over 8 and 9 to 10.
            let expected = if b == a + 1 && (7..10).contains(&a) { 1.1 / (1.0 + SLACK) } else { edge.limit };
            assert!((limit - expected).abs() < 2e-4, "{edge:?}: {limit}");
        }
        let over = over.expect("over");
        let HeldPair { vertices, distance_m, allowed_m } = over.pair.expect("two are too far apart");
        assert_eq!(vertices, [7, 10]);
        assert!((distance_m - 3.3).abs() < 1e-12 && (allowed_m - 3.15).abs() < 1e-12);
        assert!((over.excess - 1.1 / 1.05).abs() < 1e-3, "{}", over.excess);
    }

    #[test]
    fn a_patch_whose_border_is_held_yields_evenly() {
        let n = 8;
        let border: Vec<u32> =
            (0..n * n).filter(|v| [0, n - 1].contains(&(v % n)) || [0, n - 1].contains(&(v / n))).collect();
        let (limited, limits, over) = limits(n, &border, 1.1);
        for (edge, limit) in limited.iter().zip(limits) {
            if edge.vertices.iter().all(|v| !border.contains(v)) {
                let ratio = limit / edge.limit;
                assert!((ratio - 1.1 / 1.05).abs() < 5e-3, "{edge:?}: {ratio}");
            }
        }
        assert!(over.is_some_and(|over| over.pair.is_some()));
    }

    /// A bent chain that is pulled straight: its ends are farther apart than at rest, and no limit is exceeded.
    /// From a guess at its places that is found in thousands of steps only.
    #[test]
    fn where_the_state_meets_all_limits_none_yields() {
        let n = 600;
        let at = |k: u32| std::f64::consts::PI * f64::from(k) / f64::from(n);
        let rest: Vec<Point> = (0..=n).map(|k| Point::new(at(k).cos(), at(k).sin(), 0.0)).collect();
        let edge = |k: usize| DistanceLimit {
            vertices: [k as u32, k as u32 + 1],
            limit: 1.05 * (rest[k + 1] - rest[k]).norm(),
        };
        let limited: Vec<DistanceLimit> = (0..n as usize).map(edge).collect();
        let prescribed: Vec<bool> = (0..=n).map(|k| k == 0 || k == n).collect();
        // Uneven ones have edges beyond their limits, but the chain as a whole is long enough.
        for (stretch, uneven, is_over) in
            [(1.04, 0.0, false), (1.049, 0.0, false), (1.045, 0.03, false), (1.08, 0.0, true)]
        {
            let along = |k: u32| stretch * (at(k) + uneven / 7.0 * (7.0 * at(k)).sin());
            let x: Vec<Point> = (0..=n).map(|k| Point::new(along(k), 0.0, 0.0)).collect();
            let mut edges = HeldEdges::default();
            edges.begin_step(&limited, [&rest, &x], &prescribed, &[]);
            assert_eq!(edges.over(&x).is_some(), is_over, "{stretch} {uneven}");
            assert_eq!(edges.limits().count(), if is_over { n as usize } else { 0 }, "{stretch} {uneven}");
        }
    }

    #[test]
    fn a_body_that_is_held_throughout_is_looked_at_in_each_time_step() {
        let (limited, rest) = grid(2);
        let mut edges = HeldEdges::default();
        for (scale, is_over) in [(1.0, false), (1.1, true), (1.02, false)] {
            let x: Vec<Point> = rest.iter().map(|x| x * scale).collect();
            edges.begin_step(&limited, [&rest, &x], &[true; 4], &[]);
            assert_eq!(edges.over(&x).is_some(), is_over, "{scale}");
            assert_eq!(edges.limits().count(), 0);
        }
    }

    #[test]
    fn what_yielded_goes_back_with_its_length() {
        let (limited, rest) = grid(3);
        let x: Vec<Point> = rest.iter().map(|x| x * 1.2).collect();
        let before =
            [DistanceLimit { limit: 1.15, ..limited[0] }, DistanceLimit { limit: 1.3, ..limited[3] }];
        let back = going_back(&limited, &x, &before);
        let [a, b] = limited[3].vertices.map(|v| x[v as usize]);
        assert_eq!(
            back,
            [(0, 1.15), (3, (a - b).norm().min(1.3 * (1.0 + GOES_BACK * ROOM)) / (1.0 + GOES_BACK * ROOM))]
        );
        assert_eq!(going_back(&limited, &rest, &before), []);
    }
}
