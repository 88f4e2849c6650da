//! Triangles of nearly equal size on a surface that planes cut into panels.

use bowknot_scene::geometry::{Point, Vector};
use bowknot_scene::shapes::{RoundCones, TriangleMesh};
use std::collections::{BTreeMap, BTreeSet};

/// A smooth function whose zero set cuts the surface.
pub type Cut = fn(&Point) -> f64;

/// Rounds of evening out, collapses and flips.
const ROUNDS: usize = 60;
/// Edges shorter than this share of the length asked for are collapsed.
const SHORT: f64 = 0.5;

/// A surface with edges on cuts: vertices there stay on their cuts, and those on two cuts where these meet.
pub struct Remesh<'a, const N: usize> {
    solid: &'a RoundCones,
    cuts: &'a [Cut; N],
    /// The mesh, which may have borders at cuts.
    pub mesh: TriangleMesh,
    /// The edges on cuts, and on which each is. The smaller vertex comes first.
    pub edges: BTreeMap<[u32; 2], [bool; N]>,
}

impl<'a, const N: usize> Remesh<'a, N> {
    /// Only those edges count that the mesh has.
    pub fn new(
        solid: &'a RoundCones,
        cuts: &'a [Cut; N],
        mesh: TriangleMesh,
        mut edges: BTreeMap<[u32; 2], [bool; N]>,
    ) -> Self {
        let kept = triangles_of_edges(&mesh.triangles);
        edges.retain(|edge, _| kept.contains_key(edge));
        Self { solid, cuts, mesh, edges }
    }

    /// Moves vertices onto the cuts, evens out the triangles, and removes short edges.
    pub fn run(&mut self, edge: f64) {
        for round in 0..ROUNDS {
            self.even_out();
            if round % 5 == 4 && round < ROUNDS - 10 {
                self.collapse(SHORT * edge);
                self.flip();
            }
        }
    }

    /// The cuts that each vertex is on.
    fn cuts_of(&self) -> Vec<[bool; N]> {
        let mut cuts_of = vec![[false; N]; self.mesh.positions.len()];
        for (edge, cuts) in &self.edges {
            for &v in edge {
                (0..N).for_each(|cut| cuts_of[v as usize][cut] |= cuts[cut]);
            }
        }
        cuts_of
    }

    /// Moves vertices halfway to the middle of their neighbors, of those on the same cut for vertices on a
    /// cut.
    fn even_out(&mut self) {
        let cuts_of = self.cuts_of();
        let count = |v: u32| cuts_of[v as usize].iter().filter(|on| **on).count();
        let mut neighbors: Vec<Vec<u32>> = vec![Vec::new(); cuts_of.len()];
        for &[a, b] in triangles_of_edges(&self.mesh.triangles).keys() {
            let on_cut = self.edges.contains_key(&[a, b]);
            for (v, other) in [(a, b), (b, a)] {
                if count(v) == 0 || (count(v) == 1 && on_cut) {
                    neighbors[v as usize].push(other);
                }
            }
        }
        let last = self.mesh.positions.clone();
        for (v, position) in self.mesh.positions.iter_mut().enumerate() {
            if !neighbors[v].is_empty() {
                let sum: Vector = neighbors[v].iter().map(|&n| last[n as usize].coords).sum();
                *position += 0.5 * (sum / neighbors[v].len() as f64 - last[v].coords);
            }
            for _ in 0..4 {
                onto(&|p| self.solid.field(p), position);
                (0..N).filter(|&cut| cuts_of[v][cut]).for_each(|cut| onto(&self.cuts[cut], position));
            }
        }
    }

    /// Collapses short edges, unless a cut would move or the surface would be pinched.
    fn collapse(&mut self, shortest: f64) {
        let cuts_of = self.cuts_of();
        let on = |v: u32| cuts_of[v as usize];
        let count = |v: u32| on(v).iter().filter(|on| **on).count();
        let all = triangles_of_edges(&self.mesh.triangles);
        let mut neighbors: Vec<BTreeSet<u32>> = vec![BTreeSet::new(); cuts_of.len()];
        for &[a, b] in all.keys() {
            neighbors[a as usize].insert(b);
            neighbors[b as usize].insert(a);
        }
        let mut touched = vec![false; cuts_of.len()];
        let mut into: Vec<u32> = (0..cuts_of.len() as u32).collect();
        for (&[a, b], triangles) in &all {
            let [x, y] = [a, b].map(|v| self.mesh.positions[v as usize]);
            // The vertex on fewer cuts goes; if it is on any, along them.
            let (gone, kept) = if count(a) <= count(b) { (a, b) } else { (b, a) };
            let stays = (0..N).all(|cut| !on(gone)[cut] || on(kept)[cut]);
            let along = count(gone) == 0 || (stays && self.edges.contains_key(&[a, b]));
            let around: Vec<u32> = neighbors[a as usize].union(&neighbors[b as usize]).copied().collect();
            let shared = neighbors[a as usize].intersection(&neighbors[b as usize]).count();
            if (x - y).norm() < shortest
                && along
                && shared == triangles.len()
                && around.iter().all(|v| !touched[*v as usize])
            {
                around.iter().for_each(|v| touched[*v as usize] = true);
                into[gone as usize] = kept;
            }
        }
        let rename = |v: u32| into[v as usize];
        for triangle in &mut self.mesh.triangles {
            *triangle = triangle.map(rename);
        }
        self.mesh.triangles.retain(|&[a, b, c]| a != b && b != c && c != a);
        let edges = std::mem::take(&mut self.edges);
        for ([a, b], cuts) in edges {
            let [a, b] = [rename(a), rename(b)];
            if a != b {
                let entry = self.edges.entry([a.min(b), a.max(b)]).or_insert([false; N]);
                (0..N).for_each(|cut| entry[cut] |= cuts[cut]);
            }
        }
    }

    /// Flips edges off the cuts whose opposite angles add up to more than half a turn.
    fn flip(&mut self) {
        let all = triangles_of_edges(&self.mesh.triangles);
        let mut used = vec![false; self.mesh.triangles.len()];
        let mut made: BTreeSet<[u32; 2]> = BTreeSet::new();
        for (&[a, b], triangles) in &all {
            let &[t, u] = triangles.as_slice() else { continue };
            if used[t] || used[u] || self.edges.contains_key(&[a, b]) {
                continue;
            }
            // The first triangle runs from a to b, the second back.
            let [t, u] = if follows(&self.mesh.triangles[t], a, b) { [t, u] } else { [u, t] };
            let [c, d] = [t, u].map(|t| self.mesh.triangles[t].into_iter().find(|v| *v != a && *v != b));
            let (Some(c), Some(d)) = (c, d) else { continue };
            let cotangent = |at: u32| {
                let x = |v: u32| self.mesh.positions[v as usize];
                let (p, q) = (x(a) - x(at), x(b) - x(at));
                p.dot(&q) / p.cross(&q).norm().max(f64::MIN_POSITIVE)
            };
            let new = [c.min(d), c.max(d)];
            if cotangent(c) + cotangent(d) < -1e-6 && !all.contains_key(&new) && made.insert(new) {
                self.mesh.triangles[t] = [a, d, c];
                self.mesh.triangles[u] = [d, b, c];
                (used[t], used[u]) = (true, true);
            }
        }
    }
}

/// Whether the triangle has the edge from `a` to `b` in this direction.
fn follows(triangle: &[u32; 3], a: u32, b: u32) -> bool {
    (0..3).any(|k| triangle[k] == a && triangle[(k + 1) % 3] == b)
}

/// The triangles at each edge, whose smaller vertex comes first.
pub fn triangles_of_edges(triangles: &[[u32; 3]]) -> BTreeMap<[u32; 2], Vec<usize>> {
    let mut map: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
    for (t, &[a, b, c]) in triangles.iter().enumerate() {
        for [p, q] in [[a, b], [b, c], [c, a]] {
            map.entry([p.min(q), p.max(q)]).or_default().push(t);
        }
    }
    map
}

/// Moves a point towards the zero set of a function.
fn onto(field: &dyn Fn(&Point) -> f64, p: &mut Point) {
    let gradient = gradient(field, p);
    *p -= gradient * (field(p) / gradient.norm_squared().max(0.01));
}

/// Gradient by central differences.
pub fn gradient(field: &dyn Fn(&Point) -> f64, p: &Point) -> Vector {
    const H: f64 = 1e-5;
    Vector::from_fn(|c, _| {
        let step = Vector::ith(c, H);
        (field(&(p + step)) - field(&(p - step))) / (2.0 * H)
    })
}
