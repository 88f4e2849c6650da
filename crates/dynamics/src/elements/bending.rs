//! Quadratic bending: its Hessian is constant, has one number per pair of nodes, and is assembled once.
//!
//! For sheets that bend much more easily than they stretch, the integrated jump of the surface's derivative
//! across an inner edge e is a vector K_e x that is linear in positions, with cotangent weights K_e over the
//! four vertices of the two triangles at e (Bergou, Wardetzky, Harmon, Zorin and Grinspun 2006, "A Quadratic
//! Bending Model for Inextensible Surfaces").
//!
//! Bergou et al. sum `3/(A0 + A1) |K_e x|^2` over edges. That sum does not converge to the energy of a plate:
//! the energy of a cylinder is 1.5 times D/2 kappa^2 on equilateral triangles and 3 to 9 times on right
//! triangles, depending on its direction. Here the jumps at the three edges of a triangle are first combined
//! to its curvature tensor (Grinspun, Gingold, Reisman and Zorin 2006, "Computing Discrete Shape Operators on
//! General Meshes"), which is linear in x like the jumps:
//!
//! ```text
//! L_T = sum_e K_e x / (2 A_T) (n_e n_e^T),   E = D/2 sum_T A_T |L_T|^2 = sum_T D/(8 A_T) sum_ef (n_e.n_f)^2 (K_e x).(K_f x)
//! ```
//!
//! n_e is the normal of e in the triangle's plane at rest. E is exact for constant curvature on every mesh of
//! two families of parallel lines and their diagonals, and zero for flat states only. The jump across a free
//! edge is the one with the least energy (a Schur complement), as the moment vanishes there. D is the
//! stiffness of a strip with free sides; Poisson's ratio of bending is taken as 0.
//!
//! The rest state is flat; [`super::shell`] is for sheets that are curved at rest.

use crate::linear::scalar::ScalarBuilder;
use bowknot_geometry::Vector;
use std::collections::BTreeMap;

/// The jumps across the edges of one triangle.
pub(crate) struct Stencil {
    /// The corners, then for each corner the vertex beyond the edge opposite of it: u32::MAX if that edge is
    /// free. Vertices beyond may coincide on small closed surfaces.
    local: [u32; 6],
    /// Weights of K_e over these nodes, by the corner opposite of e.
    jumps: [[f64; 6]; 3],
    /// (n_e.n_f)^2 with free edges condensed.
    gram: [[f64; 3]; 3],
    /// Area at rest [m^2].
    area: f64,
}

/// Adds the bending energy of one sheet, with stiffness `stiffness` [N m], to the quadratic form.
///
/// `triangles` are over nodes with rest positions `rest`. An edge of more than two triangles counts as free.
pub(crate) fn add_bending(triangles: &[[u32; 3]], rest: &[Vector], stiffness: f64, form: &mut ScalarBuilder) {
    for_each_stencil(triangles, rest, |Stencil { local, jumps, gram, area }| {
        for p in 0..6 {
            for q in p + 1..6 {
                // The diagonal follows from the sums of rows, which are zero.
                let mut value = 0.0;
                for e in 0..3 {
                    for f in 0..3 {
                        value += gram[e][f] * jumps[e][p] * jumps[f][q];
                    }
                }
                if value != 0.0 {
                    form.add(local[p], local[q], stiffness / (4.0 * area) * value);
                }
            }
        }
    });
}

/// Calls `visit` with the stencil of every triangle.
pub(crate) fn for_each_stencil(triangles: &[[u32; 3]], rest: &[Vector], mut visit: impl FnMut(&Stencil)) {
    // The triangles of each edge, with the corner opposite of it. The order of a BTreeMap is deterministic.
    let mut edges: BTreeMap<[u32; 2], Vec<(u32, u8)>> = BTreeMap::new();
    for (t, nodes) in triangles.iter().enumerate() {
        for corner in 0..3 {
            let (a, b) = (nodes[(corner + 1) % 3], nodes[(corner + 2) % 3]);
            edges.entry([a.min(b), a.max(b)]).or_default().push((t as u32, corner as u8));
        }
    }
    for (t, nodes) in triangles.iter().enumerate() {
        let corners = nodes.map(|n| rest[n as usize]);
        let area = 0.5 * (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).norm();
        let mut local = [nodes[0], nodes[1], nodes[2], u32::MAX, u32::MAX, u32::MAX];
        let mut jumps = [[0.0; 6]; 3];
        let mut inner = [false; 3];
        for corner in 0..3 {
            let (i, j) = ((corner + 1) % 3, (corner + 2) % 3);
            let (a, b) = (nodes[i], nodes[j]);
            let sides = &edges[&[a.min(b), a.max(b)]];
            let [(t0, c0), (t1, c1)] = sides[..] else { continue };
            let (other, far_corner) = if t0 as usize == t { (t1, c1) } else { (t0, c0) };
            let far = triangles[other as usize][far_corner as usize];
            inner[corner] = true;
            local[3 + corner] = far;
            let position = |n: u32| rest[n as usize];
            let near = flux(position(a), position(b), corners[corner]);
            let beyond = flux(position(a), position(b), position(far));
            jumps[corner][i] = near[0] + beyond[0];
            jumps[corner][j] = near[1] + beyond[1];
            jumps[corner][corner] = near[2];
            jumps[corner][3 + corner] = beyond[2];
        }
        let gram = free_edges_condensed(&corners, inner);
        visit(&Stencil { local, jumps, gram, area });
    }
}

impl Stencil {
    /// The stencil over distinct nodes, corners first.
    pub fn merged(&self) -> Merged {
        let mut merged =
            Merged { nodes: Vec::new(), jumps: Default::default(), gram: self.gram, area: self.area };
        for (p, &node) in self.local.iter().enumerate().filter(|(_, node)| **node != u32::MAX) {
            let place = merged.nodes.iter().position(|n| *n == node).unwrap_or_else(|| {
                merged.nodes.push(node);
                merged.jumps.iter_mut().for_each(|jump| jump.push(0.0));
                merged.nodes.len() - 1
            });
            (0..3).for_each(|e| merged.jumps[e][place] += self.jumps[e][p]);
        }
        merged
    }
}

/// A stencil over distinct nodes.
pub(crate) struct Merged {
    pub nodes: Vec<u32>,
    /// Weights of K_e over the nodes.
    pub jumps: [Vec<f64>; 3],
    /// (n_e.n_f)^2 with free edges condensed.
    pub gram: [[f64; 3]; 3],
    /// Area at rest [m^2].
    pub area: f64,
}

/// Weights of x_a, x_b and x_o in |e| times the outward derivative, across edge ab, of the linear function on
/// triangle abo.
fn flux(a: Vector, b: Vector, o: Vector) -> [f64; 3] {
    let cotangent = |p: Vector, q: Vector, r: Vector| {
        let (u, v) = (q - p, r - p);
        u.dot(&v) / u.cross(&v).norm()
    };
    let (at_a, at_b) = (cotangent(a, b, o), cotangent(b, a, o));
    [at_b, at_a, -(at_a + at_b)]
}

/// The matrix (n_e.n_f)^2 of the edges opposite of each corner, with the jumps of free edges eliminated by
/// minimization.
fn free_edges_condensed(corners: &[Vector; 3], inner: [bool; 3]) -> [[f64; 3]; 3] {
    let directions: [Vector; 3] =
        std::array::from_fn(|c| (corners[(c + 2) % 3] - corners[(c + 1) % 3]).normalize());
    // Normals in the plane form the same angles as the edges.
    let mut gram: [[f64; 3]; 3] =
        std::array::from_fn(|e| std::array::from_fn(|f| directions[e].dot(&directions[f]).powi(2)));
    for free in (0..3).filter(|&e| !inner[e]) {
        let row = gram[free];
        // The pivot is 1 for the first free edge and 1 - cos^4 for the second; it can be 0 only for the
        // third.
        for e in 0..3 {
            for f in 0..3 {
                gram[e][f] -= if row[free] > 1e-12 { row[e] * row[f] / row[free] } else { 0.0 };
            }
        }
        (0..3).for_each(|e| (gram[e][free], gram[free][e]) = (0.0, 0.0));
    }
    gram
}

#[cfg(test)]
mod tests;
