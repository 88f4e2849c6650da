//! A shirt with long sleeves for the character: four panels that lie together at their seams without being
//! joined.
//!
//! The shirt is a surface around the character, cut by planes. What lies beyond the hem, the neckline and the
//! cuffs is dropped. The seams are the sides with the shoulders, the armholes, and below the sleeves.
//! Vertices next to a cut are moved onto it, so that borders are smooth lines. Then each panel gets border
//! vertices of its own. Those of two panels differ by up to some ten micrometers, as if each panel had been
//! rounded by itself.

use crate::character::{ARM, ARM_RADII};
use crate::parts::{pair, part};
use crate::remesh::{Cut, Remesh, gradient, triangles_of_edges};
use bowknot_scene::geometry::{Point, Vector};
use bowknot_scene::shapes::{RoundCones, TriangleMesh};
use std::collections::BTreeMap;

/// Length of the edges [m].
const EDGE: f64 = 0.0135;
/// How far the shirt is from the arms [m].
const GAP: f64 = 0.022;
/// Distance of the armholes from the middle [m].
const ARMHOLE: f64 = 0.2;
/// How far a border vertex is moved at most along each axis [m].
const ROUNDING: f64 = 1e-5;

/// What cuts the surface: front from back, sleeves from trunk; then what is dropped where the function is
/// above 0: below the hem, above the neckline, beyond the cuffs.
const CUTS: [Cut; 5] = [
    |p| p.x,
    |p| p.y.abs() - ARMHOLE,
    |p| 0.40 - p.z,
    |p| p.z + 0.3 * p.x - 0.835,
    |p| {
        let [_, elbow, wrist] = ARM.map(Point::from);
        (wrist - elbow).normalize().dot(&(Point::new(p.x, p.y.abs(), p.z) - wrist)) + 0.045
    },
];

/// One entry per cut.
type OnCuts = [bool; CUTS.len()];

/// Index of the cut between front and back.
const FRONT: usize = 0;
/// Index of the cut between sleeves and trunk.
const SLEEVE: usize = 1;
/// The first of the cuts beyond which the surface is dropped.
const DROPPED: usize = 2;

/// The surface that the shirt is cut from.
fn solid() -> RoundCones {
    let [shoulder, elbow, wrist] = ARM;
    let [at_shoulder, at_elbow, at_wrist] = ARM_RADII.map(|radius| radius + GAP);
    // Beyond the cuffs.
    let end = [wrist[0], wrist[1] + 0.06, wrist[2] - 0.04];
    let parts = [
        pair([[0.0, 0.045, 0.69], [0.005, 0.045, 0.56]], [0.12, 0.135], 0.03).to_vec(),
        pair([[0.005, 0.045, 0.56], [0.0, 0.045, 0.34]], [0.135, 0.14], 0.03).to_vec(),
        vec![part([[0.01, 0.0, 0.56], [0.015, 0.0, 0.60]], [0.156, 0.151], 0.06)],
        vec![part([[0.0, 0.0, 0.74], [0.0, 0.0, 0.88]], [0.075, 0.072], 0.05)],
        pair([shoulder, elbow], [at_shoulder, at_elbow], 0.05).to_vec(),
        pair([elbow, wrist], [at_elbow, at_wrist + 0.004], 0.02).to_vec(),
        pair([wrist, end], [at_wrist + 0.004, at_wrist + 0.006], 0.02).to_vec(),
    ];
    RoundCones { parts: parts.concat() }
}

/// The shirt [m, z up].
pub fn panels() -> TriangleMesh {
    let solid = solid();
    let mut mesh = solid.mesh(EDGE);
    let sides = sides(&mesh);
    let edges = cut_edges(&mesh, &sides);
    // Only what is kept moves: a cut that goes on where the surface is dropped does not matter.
    let keep: Vec<bool> = sides.iter().map(|side| side[DROPPED..].iter().all(|beyond| !beyond)).collect();
    mesh.triangles = (0..keep.len()).filter(|&t| keep[t]).map(|t| mesh.triangles[t]).collect();
    let mut panels = Remesh::new(&solid, &CUTS, mesh, edges);
    panels.run(EDGE);
    let Remesh { mesh, edges, .. } = panels;

    let seam = |(&[a, b], cuts): (&[u32; 2], &OnCuts)| {
        let middle =
            mesh.positions[a as usize] + (mesh.positions[b as usize] - mesh.positions[a as usize]) * 0.5;
        // Sleeves are not cut on their upper side.
        let upper = gradient(&|p: &Point| solid.field(p), &middle).z > 0.0;
        cuts[SLEEVE] || (cuts[FRONT] && (CUTS[SLEEVE](&middle) < 0.0 || !upper))
    };
    let seams: Vec<[u32; 2]> = edges.iter().filter(|edge| seam(*edge)).map(|(edge, _)| *edge).collect();
    let (mut mesh, copies) = separated(&mesh, &seams);
    for (v, position) in mesh.positions.iter_mut().enumerate().filter(|(v, _)| copies[*v]) {
        *position += Vector::from_fn(|c, _| ROUNDING * noise(3 * v + c));
    }
    mesh
}

/// On which side of each cut every triangle is.
fn sides(mesh: &TriangleMesh) -> Vec<OnCuts> {
    let middle = |t: &[u32; 3]| {
        let sum: Vector = t.iter().map(|v| mesh.positions[*v as usize].coords).sum();
        Point::from(sum / 3.0)
    };
    let mut sides: Vec<OnCuts> =
        mesh.triangles.iter().map(|t| CUTS.map(|cut| cut(&middle(t)) > 0.0)).collect();
    let mut neighbors: Vec<Vec<usize>> = vec![Vec::new(); mesh.triangles.len()];
    for triangles in triangles_of_edges(&mesh.triangles).values() {
        if let &[t, u] = triangles.as_slice() {
            neighbors[t].push(u);
            neighbors[u].push(t);
        }
    }
    // A triangle with two edges on one cut would lose its area when its vertices are moved onto it.
    for cut in 0..CUTS.len() {
        for _ in 0..10 {
            for t in 0..sides.len() {
                let other = neighbors[t].iter().filter(|u| sides[**u][cut] != sides[t][cut]).count();
                sides[t][cut] ^= other > 1;
            }
        }
    }
    sides
}

/// The edges between triangles on different sides of a cut, with the cuts.
fn cut_edges(mesh: &TriangleMesh, sides: &[OnCuts]) -> BTreeMap<[u32; 2], OnCuts> {
    let mut edges = BTreeMap::new();
    for (edge, triangles) in triangles_of_edges(&mesh.triangles) {
        if let &[t, u] = triangles.as_slice() {
            let differs = std::array::from_fn(|cut| sides[t][cut] != sides[u][cut]);
            if differs.contains(&true) {
                edges.insert(edge, differs);
            }
        }
    }
    edges
}

/// The mesh with a vertex of its own on either side of each seam, panel by panel; and which vertices are at
/// seams.
fn separated(mesh: &TriangleMesh, seams: &[[u32; 2]]) -> (TriangleMesh, Vec<bool>) {
    // Corners of triangles that are one vertex: those joined by an edge that is no seam.
    let mut groups = Groups::new(3 * mesh.triangles.len());
    let mut panels = Groups::new(mesh.triangles.len());
    let corner = |t: usize, v: u32| 3 * t + mesh.triangles[t].iter().position(|w| *w == v).unwrap_or(0);
    for (edge, triangles) in triangles_of_edges(&mesh.triangles) {
        if let (&[t, u], Err(_)) = (triangles.as_slice(), seams.binary_search(&edge)) {
            edge.iter().for_each(|&v| groups.join(corner(t, v), corner(u, v)));
            panels.join(t, u);
        }
    }
    let mut order: Vec<usize> = (0..mesh.triangles.len()).collect();
    order.sort_by_key(|&t| panels.root(t));
    let mut numbers: BTreeMap<usize, u32> = BTreeMap::new();
    let (mut result, mut at_seam) = (TriangleMesh::default(), Vec::new());
    for t in order {
        let triangle = std::array::from_fn(|k| {
            *numbers.entry(groups.root(3 * t + k)).or_insert_with(|| {
                let v = mesh.triangles[t][k];
                at_seam.push(seams.iter().any(|seam| seam.contains(&v)));
                result.positions.push(mesh.positions[v as usize]);
                result.positions.len() as u32 - 1
            })
        });
        result.triangles.push(triangle);
    }
    (result, at_seam)
}

/// Disjoint sets, each named by its smallest member.
struct Groups(Vec<usize>);

impl Groups {
    fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    fn root(&self, mut at: usize) -> usize {
        while self.0[at] != at {
            at = self.0[at];
        }
        at
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }
}

/// A number from -1 to 1 that depends on `n` as if by chance.
fn noise(n: usize) -> f64 {
    2.0 * ((n as f64 + 1.0) * 0.618_033_988_749_895).fract() - 1.0
}
