//! Flat tetrahedra.
//!
//! Four points in a plane are the corners of two simplices that intersect in one point (Radon's theorem): two
//! edges that cross, a triangle and a point in it, an edge and a point on it, or two points at one place. If
//! another tetrahedron has the one simplex as its edge or face, and another one the other, both are split at
//! the common point. Faces then coincide vertex by vertex, and the flat tetrahedron is gone. If no other
//! tetrahedron has one of the two, the flat one covers a part of the surface twice, and goes as it is. No
//! other volume changes.

use super::center;
use crate::repair::solid_report::SolidRepair;
use bowknot_geometry::tet_check::is_flat;
use bowknot_geometry::{Point, TETRAHEDRON_EDGES, Vector};
use bowknot_io::Mesh;

/// Splits per flat tetrahedron of the input, at most: each may leave others flat.
const ROUNDS: usize = 16;
/// A part of a flat tetrahedron this small relative to the whole is none.
const NOTHING: f64 = 1e-9;

/// Drops or collapses all flat tetrahedra. Those whose splits do not end are dropped.
pub(super) fn collapse(mesh: &mut Mesh, solid: &mut SolidRepair) {
    let flat = |mesh: &Mesh, tet: usize| is_flat(&mesh.tets[tet].map(|v| mesh.positions[v as usize]));
    let mut waiting: Vec<usize> = (0..mesh.tets.len()).rev().filter(|&tet| flat(mesh, tet)).collect();
    let mut left = ROUNDS * waiting.len();
    let mut stars = Stars::new(mesh);
    while let Some(tet) = waiting.pop() {
        if stars.dropped[tet] {
            continue;
        }
        let place = center(&mesh.positions, &mesh.tets[tet]);
        stars.dropped[tet] = true;
        let ([first, second], common) = crossing(&mesh.positions, mesh.tets[tet]);
        if left == 0 || stars.around(mesh, &first).is_empty() || stars.around(mesh, &second).is_empty() {
            solid.flat_dropped.add(place);
            continue;
        }
        left -= 1;
        solid.flat_collapsed.add(place);
        let at = match (&first[..], &second[..]) {
            (&[v], _) | (_, &[v]) => v,
            _ => {
                solid.added_vertices += 1;
                stars.of_vertex.push(Vec::new());
                add_vertex(mesh, common, first[0])
            }
        };
        for simplex in [first, second].into_iter().filter(|simplex| *simplex != [at]) {
            let made = stars.split(mesh, &simplex, at);
            waiting.extend(made.into_iter().filter(|&tet| flat(mesh, tet)));
        }
    }
    let mut index = 0;
    mesh.tets.retain(|_| {
        index += 1;
        !stars.dropped[index - 1]
    });
}

/// The tetrahedra of each vertex, some of them stale.
struct Stars {
    of_vertex: Vec<Vec<usize>>,
    dropped: Vec<bool>,
}

impl Stars {
    fn new(mesh: &Mesh) -> Self {
        let mut of_vertex = vec![Vec::new(); mesh.positions.len()];
        for (index, tet) in mesh.tets.iter().enumerate() {
            tet.iter().for_each(|&v| of_vertex[v as usize].push(index));
        }
        Self { of_vertex, dropped: vec![false; mesh.tets.len()] }
    }

    /// Tetrahedra that have all of these vertices, ascending.
    fn around(&self, mesh: &Mesh, simplex: &[u32]) -> Vec<usize> {
        let mut around: Vec<usize> = self.of_vertex[simplex[0] as usize].clone();
        around.retain(|&tet| !self.dropped[tet] && simplex.iter().all(|v| mesh.tets[tet].contains(v)));
        around.sort_unstable();
        around.dedup();
        around
    }

    /// Splits an edge or face at a vertex on it, in all its tetrahedra; a vertex moves there. Tetrahedra that
    /// have both are flat and go. Returns the new ones.
    fn split(&mut self, mesh: &mut Mesh, simplex: &[u32], at: u32) -> Vec<usize> {
        let mut made = Vec::new();
        for tet in self.around(mesh, simplex) {
            self.dropped[tet] = true;
            let corners = mesh.tets[tet];
            if corners.contains(&at) {
                continue;
            }
            for &leaves in simplex {
                let part = corners.map(|v| if v == leaves { at } else { v });
                part.iter().for_each(|&v| self.of_vertex[v as usize].push(mesh.tets.len()));
                made.push(mesh.tets.len());
                mesh.tets.push(part);
                self.dropped.push(false);
            }
        }
        made
    }
}

/// The two simplices of a flat tetrahedron that intersect in one point, and this point.
fn crossing(positions: &[Point], tet: [u32; 4]) -> ([Vec<u32>; 2], Point) {
    let x = tet.map(|v| positions[v as usize]);
    let length = |[i, j]: [usize; 2]| (x[j] - x[i]).norm();
    let by_length = |p: &[usize; 2], q: &[usize; 2]| length(*p).total_cmp(&length(*q));
    let [i, j] = TETRAHEDRON_EDGES.into_iter().min_by(by_length).unwrap_or_default();
    let longest_pair = TETRAHEDRON_EDGES.into_iter().max_by(by_length).unwrap_or_default();
    let longest = length(longest_pair);
    if length([i, j]) <= NOTHING * longest {
        return ([vec![tet[i]], vec![tet[j]]], x[i]);
    }

    // Normal of each face, the corners in ascending order.
    let normals = [0, 1, 2, 3].map(|apex| {
        let [p, q, r] = [0, 1, 2].map(|k| x[k + usize::from(k >= apex)]);
        ((q - p) / longest).cross(&((r - p) / longest))
    });
    let normal = normals.into_iter().max_by(|n, m| n.norm().total_cmp(&m.norm())).unwrap_or_default();
    if normal.norm() <= NOTHING {
        let direction = x[longest_pair[1]] - x[longest_pair[0]];
        let mut order = [0, 1, 2, 3];
        order.sort_by(|&i, &j| (x[i] - x[0]).dot(&direction).total_cmp(&(x[j] - x[0]).dot(&direction)));
        let [i, j, k, _] = order;
        return ([vec![tet[i], tet[k]], vec![tet[j]]], x[j]);
    }
    // The weights w with which the corners depend on each other: the sums of w and of w x vanish.
    let weights = [0, 1, 2, 3].map(|k| normals[k].dot(&normal) * if k % 2 == 0 { 1.0 } else { -1.0 });
    let least = NOTHING * weights.iter().fold(0.0, |largest: f64, w| largest.max(w.abs()));
    let side = |sign: f64| (0..4).filter(move |&k| sign * weights[k] > least);
    let sum: f64 = side(1.0).map(|k| weights[k]).sum();
    let offset: Vector = side(1.0).map(|k| (x[k] - x[0]) * (weights[k] / sum)).sum();
    ([1.0, -1.0].map(|sign| side(sign).map(|k| tet[k]).collect()), x[0] + offset)
}

/// Adds a vertex to the body of another. Returns its number.
fn add_vertex(mesh: &mut Mesh, place: Point, like: u32) -> u32 {
    mesh.positions.push(place);
    if let Some(obstacle) = &mut mesh.obstacle {
        obstacle.push(obstacle[like as usize]);
    }
    if let Some(body) = &mut mesh.body {
        body.push(body[like as usize]);
    }
    mesh.positions.len() as u32 - 1
}
