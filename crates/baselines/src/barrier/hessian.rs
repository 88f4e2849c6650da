//! Second derivatives of the objective, element by element, each made positive semidefinite.
//!
//! A pair adds H = B'' g g^T + B' hess d, with g = W^T n the gradient of its distance d; W holds the signed weights sigma_k of
//! its vertices. For the squared distance D(x) = min over b of |o|^2, o = W(b) x linear in the places b of the closest
//! points, the implicit function theorem gives, over the places that are free to move,
//!
//! hess D = 2 [W^T W - C (T^T T)^-1 C^T],   T_a = do/db_a,   C_a = (dW/db_a)^T o + W^T T_a,
//!
//! and hess d = (hess D / 2 - g g^T) / d. Eigenvalues of H below 0 are set to 0 (Teran et al. 2005; Li et al. 2020).

use super::objective::{Contact, Objective};
use bowknot_twoway::geometry::{PairKind, Point, Vector};
use nalgebra::{Matrix2, SMatrix};
use rayon::prelude::*;

/// Elements that one parallel task handles at least.
const CHUNK: usize = 64;
/// Weights nearer than this to 0 are of points that cannot slide on.
const FREE: f64 = 1e-9;

/// Second derivatives of up to four vertices [N/m], three rows each.
pub type Block12 = SMatrix<f64, 12, 12>;

/// An element's part of the Hessian.
#[derive(Clone, Copy, Debug)]
pub struct Element {
    /// Its vertices; unused places repeat one of them.
    pub vertices: [u32; 4],
    /// How many it has.
    pub count: usize,
    /// Positive semidefinite; 0 in unused places.
    pub matrix: Block12,
}

/// The elements of the objective at `x`: pairs in their order, then long edges.
pub fn elements(objective: &Objective, x: &[Point], contacts: &[Contact]) -> Vec<Element> {
    let mut elements: Vec<Element> = contacts
        .par_iter()
        .with_min_len(CHUNK)
        .map(|contact| Element {
            vertices: contact.vertices,
            count: contact.kind.vertex_count(),
            matrix: positive_part(&pair_hessian(contact, &contact.vertices.map(|v| x[v as usize]))),
        })
        .collect();
    let stiffness = objective.params().edge_stiffness;
    elements.extend(objective.long_edges(x).map(|([a, b], _, share, n)| {
        let along = n * n.transpose();
        let across = nalgebra::Matrix3::identity() - along;
        let block = stiffness * (along + share * across);
        let mut matrix = Block12::zeros();
        for (i, j, sign) in [(0, 0, 1.0), (3, 3, 1.0), (0, 3, -1.0), (3, 0, -1.0)] {
            matrix.fixed_view_mut::<3, 3>(i, j).copy_from(&(sign * block));
        }
        Element { vertices: [a, b, a, a], count: 2, matrix }
    }));
    elements
}

/// How the signed weights change with each place that is free to move; and how many there are.
fn places(kind: PairKind, weights: &[f64; 4]) -> ([[f64; 4]; 2], usize) {
    let free = |w: f64| w > FREE;
    let mut places = [[0.0; 4]; 2];
    let mut count = 0;
    let mut add = |change: [f64; 4]| {
        places[count] = change;
        count += 1;
    };
    match kind {
        PairKind::VertexVertex | PairKind::VertexHalfSpace => {}
        PairKind::VertexEdge => {
            if free(weights[1]) && free(weights[2]) {
                add([0.0, 1.0, -1.0, 0.0]);
            }
        }
        PairKind::VertexTriangle => {
            let mut corners = (1..4).filter(|&k| free(weights[k]));
            if let Some(first) = corners.next() {
                for other in corners {
                    let mut change = [0.0; 4];
                    (change[first], change[other]) = (1.0, -1.0);
                    add(change);
                }
            }
        }
        PairKind::EdgeEdge => {
            if free(weights[0]) && free(weights[1]) {
                add([-1.0, 1.0, 0.0, 0.0]);
            }
            if free(weights[2]) && free(weights[3]) {
                add([0.0, 0.0, 1.0, -1.0]);
            }
        }
    }
    (places, count)
}

/// The Hessian of a pair's barrier, as it is.
fn pair_hessian(contact: &Contact, x: &[Point; 4]) -> Block12 {
    let (kind, separation, jet) = (contact.kind, &contact.separation, &contact.jet);
    let sigma = separation.signed_weights(kind);
    let n = separation.normal;
    let mut gradient = SMatrix::<f64, 12, 1>::zeros();
    for k in 0..kind.vertex_count() {
        gradient.fixed_rows_mut::<3>(3 * k).copy_from(&(sigma[k] * n));
    }
    let outer = gradient * gradient.transpose();
    let d = separation.distance;
    if kind == PairKind::VertexHalfSpace || d <= 0.0 {
        return jet.curvature * outer;
    }
    // W^T W
    let mut hessian = Block12::zeros();
    for i in 0..kind.vertex_count() {
        for j in 0..kind.vertex_count() {
            for c in 0..3 {
                hessian[(3 * i + c, 3 * j + c)] = sigma[i] * sigma[j];
            }
        }
    }
    let (changes, count) = places(kind, &separation.weights);
    let slides: Vec<Vector> =
        changes[..count].iter().map(|change| (0..4).map(|k| change[k] * x[k].coords).sum()).collect();
    let columns: Vec<SMatrix<f64, 12, 1>> = (0..count)
        .map(|a| {
            let mut column = SMatrix::<f64, 12, 1>::zeros();
            for k in 0..kind.vertex_count() {
                let row = changes[a][k] * d * n + sigma[k] * slides[a];
                column.fixed_rows_mut::<3>(3 * k).copy_from(&row);
            }
            column
        })
        .collect();
    match count {
        1 => hessian -= columns[0] * columns[0].transpose() / slides[0].norm_squared(),
        2 => {
            let off = slides[0].dot(&slides[1]);
            let metric = Matrix2::new(slides[0].norm_squared(), off, off, slides[1].norm_squared());
            // Parallel edges: where one slides the other may follow, and the distance has no second derivative.
            let determinant = metric.determinant();
            if determinant > 1e-12 * metric[(0, 0)] * metric[(1, 1)]
                && let Some(inverse) = metric.try_inverse()
            {
                for a in 0..2 {
                    for b in 0..2 {
                        hessian -= inverse[(a, b)] * columns[a] * columns[b].transpose();
                    }
                }
            }
        }
        _ => {}
    }
    jet.curvature * outer + jet.slope / d * (hessian - outer)
}

/// The matrix with its eigenvalues below 0 set to 0.
fn positive_part(matrix: &Block12) -> Block12 {
    let eigen = matrix.symmetric_eigen();
    let mut scaled = eigen.eigenvectors;
    for (mut column, value) in scaled.column_iter_mut().zip(eigen.eigenvalues.iter()) {
        column *= value.max(0.0);
    }
    scaled * eigen.eigenvectors.transpose()
}

#[cfg(test)]
mod tests;
