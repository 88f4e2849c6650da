//! Limits on the lengths of edges, divided on the host into clusters: a workgroup sweeps a cluster in its own
//! memory.
//!
//! Clusters of a round share no vertex that moves, so a round is one dispatch. The first round holds the
//! edges inside of parts of up to [`MOST_VERTICES`] vertices, the second those inside of parts of what is
//! left between them, and so on. Edges of one color of a cluster share no vertex that moves.

use crate::grid::Grid;
use crate::layout::{EdgeCluster, EdgeLimit};
use bowknot_geometry::Point;
use std::collections::HashMap;
use std::ops::Range;

/// Vertices of a cluster that move, at most: as many as the shader has room for.
pub(crate) const MOST_VERTICES: usize = 256;

/// Shares of the vertices on one side of a cut, of which the one that cuts the fewest edges is taken. Cuts of
/// later rounds must lie elsewhere than those of the rounds before, which are in the middle.
const CUTS: [f64; 6] = [0.5, 0.42, 0.58, 0.34, 0.66, 0.26];

/// An edge with its largest length [m].
type Limited = ([u32; 2], f64);

/// The limited edges in the order of their clusters and colors.
#[derive(Clone, Debug, Default)]
pub(crate) struct Edges {
    edges: Vec<Limited>,
    /// Places of the vertices of each edge in their cluster.
    places: Vec<[u32; 2]>,
    /// The clusters, their vertices and where their colors end among the edges.
    pub clusters: Vec<EdgeCluster>,
    pub vertices: Vec<u32>,
    pub color_ends: Vec<u32>,
    /// Clusters of each round.
    rounds: Vec<Range<usize>>,
}

impl Edges {
    /// Those of `edges` that have a finite limit [m] and a vertex that moves. Parts are compact at `points`.
    pub fn new(edges: &[[u32; 2]], limits: &[f64], points: &[Point], moves: impl Fn(u32) -> bool) -> Self {
        let limited = edges.iter().zip(limits).filter(|(_, limit)| limit.is_finite());
        let mut left: Vec<Limited> = limited.map(|(edge, limit)| (*edge, *limit)).collect();
        left.retain(|(edge, _)| edge.iter().any(|&v| moves(v)));
        let mut divided = Self::default();
        let mut places = vec![0; points.len()];
        while !left.is_empty() {
            let first = divided.clusters.len();
            let mut parts = parts(&left, points, &moves, first == 0);
            if parts.iter().all(|(part, _)| part.is_none()) {
                // No part holds an edge: those that share no vertex do instead.
                parts = disjoint(&left, points.len(), &moves);
            }
            parts.sort_by_key(|(part, _)| *part);
            let between = parts.partition_point(|(part, _)| part.is_none());
            for cluster in parts[between..].chunk_by(|(a, _), (b, _)| a == b) {
                let edges = cluster.iter().map(|(_, edge)| *edge).collect();
                divided.add(edges, &mut places, &moves);
            }
            left = parts[..between].iter().map(|(_, edge)| *edge).collect();
            divided.rounds.push(first..divided.clusters.len());
        }
        divided
    }

    /// Adds a cluster.
    fn add(&mut self, mut edges: Vec<Limited>, places: &mut [u32], moves: &impl Fn(u32) -> bool) {
        let mut vertices: Vec<u32> = edges.iter().flat_map(|(edge, _)| *edge).filter(|&v| moves(v)).collect();
        vertices.sort_unstable();
        vertices.dedup();
        (0..).zip(&vertices).for_each(|(place, &v)| places[v as usize] = place);
        let first_color = self.color_ends.len() as u32;
        let first_edge = self.edges.len() as u32;
        // Color by color: all edges whose vertices are not yet taken in it.
        let mut taken = vec![u32::MAX; vertices.len()];
        let mut color = 0;
        while !edges.is_empty() {
            edges.retain(|&(edge, limit)| {
                let own = edge.map(|v| if moves(v) { places[v as usize] } else { EdgeLimit::FIXED });
                let moving = || own.into_iter().filter(|place| *place != EdgeLimit::FIXED);
                if moving().any(|place| taken[place as usize] == color) {
                    return true;
                }
                moving().for_each(|place| taken[place as usize] = color);
                self.edges.push((edge, limit));
                self.places.push(own);
                false
            });
            self.color_ends.push(self.edges.len() as u32);
            color += 1;
        }
        self.clusters.push(EdgeCluster {
            first_vertex: self.vertices.len() as u32,
            vertices: vertices.len() as u32,
            first_edge,
            first_color,
            colors: color,
        });
        self.vertices.append(&mut vertices);
    }

    pub fn len(&self) -> usize {
        self.edges.len()
    }

    /// The clusters of each round.
    pub fn rounds(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        self.rounds.iter().cloned()
    }

    /// The limits of the scene, larger for those of the `yielding` edges [m], without multipliers.
    pub fn limits(&self, grid: &Grid, yielding: &[Limited]) -> Vec<EdgeLimit> {
        let key = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
        let larger: HashMap<[u32; 2], f64> =
            yielding.iter().map(|(edge, limit)| (key(*edge), *limit)).collect();
        let limit = |(&([a, b], limit), &[place_a, place_b]): (&Limited, &[u32; 2])| {
            let longest = grid.length(larger.get(&key([a, b])).map_or(limit, |larger| limit.max(*larger)));
            EdgeLimit {
                a,
                b,
                limit: longest,
                longest,
                places: place_a | place_b << 16,
                ..EdgeLimit::default()
            }
        };
        self.edges.iter().zip(&self.places).map(limit).collect()
    }
}

/// The part of each edge; none for those between parts.
fn parts(
    edges: &[Limited],
    points: &[Point],
    moves: &impl Fn(u32) -> bool,
    is_first: bool,
) -> Vec<(Option<u32>, Limited)> {
    let mut part_of = vec![u32::MAX; points.len()];
    let mut count = 0;
    let mut room = 0;
    for mut group in connected(edges, points.len(), moves) {
        if group.vertices.len() <= MOST_VERTICES {
            // Small groups share a part.
            if group.vertices.len() > room {
                (count, room) = (count + 1, MOST_VERTICES);
            }
            room -= group.vertices.len();
            group.vertices.iter().for_each(|v| part_of[*v as usize] = count);
        } else {
            room = 0;
            divide(&mut group.vertices, group.edges, points, is_first, &mut |part| {
                count += 1;
                part.iter().for_each(|v| part_of[*v as usize] = count);
            });
        }
    }
    let part = |&(edge, limit): &Limited| {
        let mut own = edge.into_iter().filter(|v| moves(*v)).map(|v| part_of[v as usize]);
        let first = own.next();
        (first.filter(|first| own.all(|other| other == *first)), (edge, limit))
    };
    edges.iter().map(part).collect()
}

/// Parts of edges that share no vertex that moves.
fn disjoint(edges: &[Limited], vertices: usize, moves: &impl Fn(u32) -> bool) -> Vec<(Option<u32>, Limited)> {
    let mut taken = vec![false; vertices];
    let mut count = 0;
    let part = |&(edge, limit): &Limited| {
        if edge.iter().any(|&v| moves(v) && taken[v as usize]) {
            return (None, (edge, limit));
        }
        edge.iter().for_each(|&v| taken[v as usize] = true);
        count += 1;
        (Some((2 * count - 2) / MOST_VERTICES as u32), (edge, limit))
    };
    edges.iter().map(part).collect()
}

/// Vertices that edges connect, and those edges that have two vertices that move.
struct Group {
    vertices: Vec<u32>,
    edges: Vec<[u32; 2]>,
}

/// The connected groups of vertices that move, in the order of their first vertices.
fn connected(edges: &[Limited], vertices: usize, moves: &impl Fn(u32) -> bool) -> Vec<Group> {
    let mut roots: Vec<u32> = (0..vertices as u32).collect();
    fn root(roots: &mut [u32], mut v: u32) -> u32 {
        while roots[v as usize] != v {
            roots[v as usize] = roots[roots[v as usize] as usize];
            v = roots[v as usize];
        }
        v
    }
    let mut in_use = vec![false; vertices];
    for ([a, b], _) in edges {
        [*a, *b].into_iter().filter(|v| moves(*v)).for_each(|v| in_use[v as usize] = true);
        if moves(*a) && moves(*b) {
            let [a, b] = [*a, *b].map(|v| root(&mut roots, v));
            // The smaller one, so that groups do not depend on the order of the edges.
            roots[a.max(b) as usize] = a.min(b);
        }
    }
    let mut groups: Vec<Group> = Vec::new();
    let mut group_of = vec![u32::MAX; vertices];
    for v in (0..vertices as u32).filter(|v| in_use[*v as usize]) {
        let root = root(&mut roots, v) as usize;
        if group_of[root] == u32::MAX {
            group_of[root] = groups.len() as u32;
            groups.push(Group { vertices: Vec::new(), edges: Vec::new() });
        }
        group_of[v as usize] = group_of[root];
        groups[group_of[root] as usize].vertices.push(v);
    }
    for (edge, _) in edges.iter().filter(|(edge, _)| edge.iter().all(|v| moves(*v))) {
        groups[group_of[edge[0] as usize] as usize].edges.push(*edge);
    }
    groups
}

/// Divides vertices by cuts until each part is small enough, and visits the parts. The first round cuts in
/// the middle of the longest side, the others where the fewest edges are.
fn divide(
    vertices: &mut [u32],
    edges: Vec<[u32; 2]>,
    points: &[Point],
    is_first: bool,
    visit: &mut dyn FnMut(&[u32]),
) {
    if vertices.len() <= MOST_VERTICES {
        visit(vertices);
        return;
    }
    let along = |axis: usize, v: u32| points[v as usize][axis];
    let sides: [f64; 3] = std::array::from_fn(|axis| {
        let coordinates = || vertices.iter().map(|v| along(axis, *v));
        coordinates().fold(f64::NEG_INFINITY, f64::max) - coordinates().fold(f64::INFINITY, f64::min)
    });
    let longest = (0..3).fold(0, |best, axis| if sides[axis] > sides[best] { axis } else { best });
    // Ties are broken by number, so that the parts depend on the input alone.
    let is_before = |axis: usize, a: u32, b: u32| along(axis, a).total_cmp(&along(axis, b)).then(a.cmp(&b));
    let (mut best, mut fewest) = ((longest, vertices.len() / 2), usize::MAX);
    if !is_first {
        for axis in (0..3).filter(|axis| sides[*axis] >= 0.5 * sides[longest]) {
            vertices.sort_unstable_by(|a, b| is_before(axis, *a, *b));
            for cut in CUTS {
                let place = (cut * vertices.len() as f64) as usize;
                let middle = vertices[place];
                let is_left = |v: u32| is_before(axis, v, middle).is_lt();
                let crossing = edges.iter().filter(|[a, b]| is_left(*a) != is_left(*b)).count();
                if crossing < fewest {
                    (best, fewest) = ((axis, place), crossing);
                }
            }
        }
    }
    let (axis, place) = best;
    vertices.select_nth_unstable_by(place, |a, b| is_before(axis, *a, *b));
    let middle = vertices[place];
    let is_left = |v: u32| is_before(axis, v, middle).is_lt();
    let of_side = |side: bool| -> Vec<[u32; 2]> {
        let inside = |edge: &&[u32; 2]| edge.iter().all(|v| is_left(*v) == side);
        if is_first { Vec::new() } else { edges.iter().filter(inside).copied().collect() }
    };
    let [left_edges, right_edges] = [of_side(true), of_side(false)];
    drop(edges);
    let (left, right) = vertices.split_at_mut(place);
    divide(left, left_edges, points, is_first, visit);
    divide(right, right_edges, points, is_first, visit);
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    /// A sheet of n x n vertices with a fan of long edges around vertex 0, which does not move, and loose
    /// edges.
    fn edges(n: u32) -> (Vec<[u32; 2]>, Vec<Point>) {
        let mut edges: Vec<[u32; 2]> = (1..20).map(|v| [0, v * n / 2 + 3]).collect();
        for k in (0..n * n).filter(|k| k % n != n - 1) {
            edges.push([k, k + 1]);
            edges.extend([[k, k + n], [k, k + n + 1]].into_iter().filter(|[_, b]| *b < n * n));
        }
        edges.extend((0..50).map(|k| [n * n + 2 * k, n * n + 2 * k + 1]));
        let point = |k: u32| Point::new(f64::from(k % n), f64::from(k / n), 0.1 * f64::from(k * 37 % 11));
        (edges, (0..n * n + 100).map(point).collect())
    }

    #[test]
    fn clusters_of_a_round_and_edges_of_a_color_share_no_vertex_that_moves() {
        let (all, points) = edges(40);
        let mut limits = vec![1.0; all.len()];
        limits[3] = f64::INFINITY;
        let moves = |v: u32| v > 0;
        let divided = Edges::new(&all, &limits, &points, moves);
        assert_eq!(divided.len(), all.len() - 1);
        let mut seen: HashSet<[u32; 2]> = HashSet::new();
        let (mut first_edge, mut first_cluster) = (0, 0);
        for round in divided.rounds() {
            assert_eq!(round.start, first_cluster);
            first_cluster = round.end;
            let mut of_round = HashSet::new();
            for cluster in &divided.clusters[round] {
                let own = &divided.vertices[cluster.first_vertex as usize..][..cluster.vertices as usize];
                assert!(own.len() <= MOST_VERTICES && own.iter().all(|v| moves(*v) && of_round.insert(*v)));
                assert_eq!(cluster.first_edge as usize, first_edge);
                for color in 0..cluster.colors {
                    let end = divided.color_ends[(cluster.first_color + color) as usize] as usize;
                    let mut of_color = HashSet::new();
                    for e in first_edge..end {
                        let (edge, places) = (divided.edges[e].0, divided.places[e]);
                        for (v, place) in edge.into_iter().zip(places) {
                            let expected = if moves(v) { own[place as usize] } else { v };
                            assert!(v == expected && (!moves(v) || of_color.insert(v)));
                        }
                        assert!(seen.insert(edge));
                    }
                    first_edge = end;
                }
            }
        }
        assert_eq!(first_edge, all.len() - 1);
        let sizes: Vec<usize> = divided.rounds().map(|round| round.len()).collect();
        assert!(sizes.len() <= 4, "{sizes:?}");
    }

    #[test]
    fn large_meshes_have_few_rounds() {
        for (n, most) in [(10, 1), (100, 4), (300, 4)] {
            let (all, points) = edges(n);
            let divided = Edges::new(&all, &vec![1.0; all.len()], &points, |v| v > 0);
            let sizes: Vec<usize> = divided.rounds().map(|round| round.len()).collect();
            assert!(sizes.len() <= most, "{sizes:?}");
        }
    }

    #[test]
    fn edges_between_many_vertices_that_lie_apart_are_divided_as_well() {
        // All vertices of one side with all of the other side: no part that is compact holds an edge.
        let all: Vec<[u32; 2]> =
            (0..300).flat_map(|a| (0..4).map(move |b| [a, 300 + (a + b) % 300])).collect();
        let points: Vec<Point> = (0..600).map(|v| Point::new(f64::from(v), 0.0, 0.0)).collect();
        let divided = Edges::new(&all, &vec![1.0; all.len()], &points, |_| true);
        assert_eq!(divided.len(), all.len());
    }

    #[test]
    fn edges_that_yield_may_be_longer() {
        let (all, points) = edges(4);
        let divided = Edges::new(&all, &vec![1.0; all.len()], &points, |v| v > 0);
        let grid = Grid::around(&points, 20.0, 1e-3).expect("a grid");
        let [a, b] = all[30];
        let limits = divided.limits(&grid, &[([b, a], 2.0), (all[31], 0.5), ([0, 2], 3.0)]);
        for limit in limits {
            let expected = if [limit.a, limit.b] == [a, b] { 2.0 } else { 1.0 };
            assert_eq!(limit.longest, grid.length(expected));
        }
    }
}
