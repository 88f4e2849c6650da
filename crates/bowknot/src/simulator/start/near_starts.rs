//! Pairs that start nearer than their contact distance.

use bowknot_geometry::{PairKind, Point};
use bowknot_proximity::{CollisionModel, Pair};
use bowknot_scene::world::World;
use bowknot_twoway::Resolver;
use rustc_hash::FxHashMap;
use serde::Serialize;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::fmt;

/// Within a connected part, elements are neighbors if a path along edges of at most so many contact distances
/// joins them. On a flat mesh the path between two elements nearer than their contact distance is at most
/// twice as long as they are far, and passes two more elements, whose edges are shorter than that distance;
/// around a fold so tight that its layers touch it is half a circle, pi/2 of the distance.
const NEIGHBOR_DISTANCES: f64 = 4.0;
/// Elements at most so many edges apart are neighbors whatever their length: thin triangles are lower than
/// their edges are long.
const NEIGHBOR_EDGES: usize = 3;

/// Pairs of two bodies, or of one connected part of a body, that start nearer than their contact distance.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NearStart {
    /// Names of the two bodies; a half-space has that of its obstacle.
    pub bodies: [String; 2],
    /// Whether they are folds of one connected part. These need only half of their distance at the start.
    /// Others are pushed apart to their contact distance.
    pub within_part: bool,
    /// Number of pairs of elements, neighbors along the surface not counted.
    pub pairs: usize,
    /// The smallest distance of any of them [m].
    pub distance_m: f64,
    /// The contact distance of that pair [m].
    pub contact_distance_m: f64,
    /// Where that is [m].
    pub place_m: [f64; 3],
}

impl fmt::Display for NearStart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { bodies: [a, b], pairs, distance_m, contact_distance_m, place_m: [x, y, z], .. } = self;
        let between = match (self.within_part, a == b) {
            (true, _) => format!("of folds of {a}"),
            (false, true) => format!("of parts of {a}"),
            (false, false) => format!("of {a} and {b}"),
        };
        let [distance, full] = [distance_m, contact_distance_m].map(|length| 1e3 * length);
        write!(f, "{pairs} {between}, the nearest {distance:.3} of {full:.3} mm at ({x:.4}, {y:.4}, {z:.4})")
    }
}

/// The pairs in range at the present state that are nearer than their contact distance, by bodies, most
/// first.
pub(crate) fn near_starts(world: &World, resolver: &Resolver) -> Vec<NearStart> {
    let (scene, state) = (resolver.scene(), resolver.state());
    let model = scene.model();
    let mut neighbors = Neighbors::default();
    let mut found: FxHashMap<(u32, Side, bool), NearStart> = FxHashMap::default();
    for kind in PairKind::ALL {
        for place in state.contacts.pairs.range(kind) {
            let pair = &state.contacts.pairs.pairs()[place];
            let distance = state.contacts.separations[place].distance;
            let full = scene.spacing().of(model, kind, pair).delta;
            if distance >= full || distance.is_nan() {
                continue;
            }
            let within_part = is_within_part(model, kind, pair);
            if within_part && neighbors.are(world, &state.x, kind, pair, NEIGHBOR_DISTANCES * full) {
                continue;
            }
            let body = |side: usize| model.vertex_body()[pair.vertices[side] as usize];
            let other = match kind {
                PairKind::VertexHalfSpace => Side::HalfSpace(pair.elements[1]),
                _ => Side::Body(body(kind.side_a())),
            };
            let (first, second) = match other {
                Side::Body(other) => (body(0).min(other), Side::Body(body(0).max(other))),
                Side::HalfSpace(_) => (body(0), other),
            };
            let entry = found.entry((first, second, within_part)).or_insert_with(|| NearStart {
                bodies: [world.name_of(first).to_owned(), name_of(world, second)],
                within_part,
                pairs: 0,
                distance_m: f64::INFINITY,
                contact_distance_m: full,
                place_m: [0.0; 3],
            });
            entry.pairs += 1;
            if distance < entry.distance_m {
                let at = state.x[pair.vertices[0] as usize].coords.into();
                (entry.distance_m, entry.contact_distance_m, entry.place_m) = (distance, full, at);
            }
        }
    }
    let mut sorted: Vec<((u32, Side, bool), NearStart)> = found.into_iter().collect();
    sorted.sort_by_key(|(key, near)| (Reverse(near.pairs), *key));
    sorted.into_iter().map(|(_, near)| near).collect()
}

/// The second side of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Side {
    Body(u32),
    HalfSpace(u32),
}

fn name_of(world: &World, side: Side) -> String {
    match side {
        Side::Body(body) => world.name_of(body).to_owned(),
        Side::HalfSpace(plane) => world.half_space_names.get(plane as usize).cloned().unwrap_or_default(),
    }
}

fn is_within_part(model: &CollisionModel, kind: PairKind, pair: &Pair) -> bool {
    let component = |side: usize| model.vertex_component()[pair.vertices[side] as usize];
    kind != PairKind::VertexHalfSpace && component(0) == component(kind.side_a())
}

/// Finds neighbors along edges, those inside of solids included: both sides of a thin plate are neighbors.
#[derive(Debug, Default)]
struct Neighbors {
    /// The vertices that edges join each vertex with; made when first needed.
    edges: Vec<Vec<u32>>,
    /// The vertex and bound of the last search.
    last: Option<(u32, f64)>,
    /// Lengths of the shortest paths that it has found to each vertex [m], infinite where it has not been; a few edges
    /// count as no length.
    lengths: Vec<f64>,
    /// The vertices where it has been.
    reached: Vec<u32>,
}

impl Neighbors {
    /// Whether the sides of a pair are joined by a path of at most `bound` [m], or of a few edges.
    fn are(&mut self, world: &World, x: &[Point], kind: PairKind, pair: &Pair, bound: f64) -> bool {
        if self.edges.is_empty() {
            self.edges = edges(world);
            self.lengths = vec![f64::INFINITY; self.edges.len()];
        }
        if self.last != Some((pair.vertices[0], bound)) {
            self.last = Some((pair.vertices[0], bound));
            self.reach(world, x, pair.vertices[0], bound);
        }
        let mut others = pair.vertices[kind.side_a()..kind.vertex_count()].iter();
        others.any(|&v| self.lengths[v as usize].is_finite())
    }

    /// Finds the vertices within `bound` [m] along edges, or within a few edges. Source: Dijkstra, "A note on two
    /// problems in connexion with graphs", 1959.
    fn reach(&mut self, world: &World, x: &[Point], from: u32, bound: f64) {
        let Self { edges, lengths, reached, .. } = self;
        // Of vertices inside of solids the world alone has the places.
        let at = |v: u32| x.get(v as usize).unwrap_or(&world.positions[v as usize]);
        reached.drain(..).for_each(|v| lengths[v as usize] = f64::INFINITY);
        lengths[from as usize] = 0.0;
        reached.push(from);
        // Lengths are not negative, so that their bits are in their order.
        let mut queue = BinaryHeap::from([Reverse((0.0_f64.to_bits(), from))]);
        while let Some(Reverse((length, v))) = queue.pop() {
            let length = f64::from_bits(length);
            if length > lengths[v as usize] {
                continue;
            }
            for &next in &edges[v as usize] {
                let sum = length + (at(v) - at(next)).norm();
                let known = &mut lengths[next as usize];
                if sum <= bound && sum < *known {
                    if known.is_infinite() {
                        reached.push(next);
                    }
                    *known = sum;
                    queue.push(Reverse((sum.to_bits(), next)));
                }
            }
        }
        let mut ring = vec![from];
        for _ in 0..NEIGHBOR_EDGES {
            ring = ring.iter().flat_map(|&v| &edges[v as usize]).copied().collect();
            ring.sort_unstable();
            ring.dedup();
            for &v in &ring {
                if lengths[v as usize].is_infinite() {
                    lengths[v as usize] = 0.0;
                    reached.push(v);
                }
            }
        }
    }
}

/// The vertices that edges of elements join each vertex with.
fn edges(world: &World) -> Vec<Vec<u32>> {
    let of_surfaces = world.collision.topology().edges.iter().copied();
    let of_tets = world.bodies.iter().flat_map(|body| &body.tets);
    let of_tets = of_tets.flat_map(|&[a, b, c, d]| [[a, b], [a, c], [a, d], [b, c], [b, d], [c, d]]);
    let mut edges = vec![Vec::new(); world.positions.len()];
    for [a, b] in of_surfaces.chain(of_tets) {
        edges[a as usize].push(b);
        edges[b as usize].push(a);
    }
    for list in &mut edges {
        list.sort_unstable();
        list.dedup();
    }
    edges
}

#[cfg(test)]
mod tests;
