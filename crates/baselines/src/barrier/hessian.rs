//! Second derivatives of the objective, element by element; each is projected to a positive semidefinite
//! matrix.
//!
//! A pair adds H = B'' g g^T + B' hess d, with g = W^T n the gradient of its distance d; W holds the signed
//! weights sigma_k of its vertices. For the squared distance D(x) = min over b of |o|^2, o = W(b) x linear in
//! the places b of the closest points, the implicit function theorem gives, over the places that are free to
//! move,
//!
//! hess D = 2 [W^T W - C (T^T T)^-1 C^T],   T_a = do/db_a,   C_a = (dW/db_a)^T o + W^T T_a,
//!
//! and hess d = (hess D / 2 - g g^T) / d. Eigenvalues of H below 0 are set to 0 (Teran et al. 2005; Li et al.
//! 2020). For every pair H has rank 5 at most: it acts on W^T n, on W^T times both tangents, and on the C_a,
//! so that a problem of eigenvalues of size 5 replaces one of size 12.

use super::mollifier::{self, Mollifier};
use super::objective::{Contact, Objective};
use bowknot_twoway::geometry::{PairKind, Point, Vector};
use nalgebra::{Matrix2, SMatrix, SVector};
use rayon::prelude::*;

/// Smallest number of elements of a parallel task.
const CHUNK: usize = 64;
/// A weight below this is 0: the closest point is at its bound and cannot slide.
const FREE: f64 = 1e-9;

/// Squared sine of the angle between edges below which they count as parallel.
const PARALLEL: f64 = 1e-12;
/// A column with a smaller share outside the span of the others adds no direction.
const DEPENDENT: f64 = 1e-12;

/// Second derivatives of up to four vertices [N/m], three rows each.
pub type Block12 = SMatrix<f64, 12, 12>;

/// An element's part of the Hessian.
#[derive(Clone, Copy, Debug)]
pub struct Element {
    /// Its vertices; unused places repeat one of them.
    pub vertices: [u32; 4],
    /// Number of its vertices.
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
            matrix: of_contact(contact, &contact.vertices.map(|v| x[v as usize])),
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

/// The Hessian of a pair's barrier with its mollifier, made positive semidefinite.
fn of_contact(contact: &Contact, x: &[Point; 4]) -> Block12 {
    let factors = Factors::of(contact, x);
    let Mollifier { value, slope, curvature } = contact.mollifier;
    if !contact.mollifier.fades() {
        return value * factors.positive_part();
    }
    let turn = mollifier::gradient(x);
    let pull = contact.jet.slope * factors.v.column(0);
    let mixed = turn * pull.transpose();
    let barrier = contact.jet.value;
    let whole = value * factors.matrix()
        + slope * (mixed + mixed.transpose())
        + barrier * (curvature * turn * turn.transpose() + slope * mollifier::hessian(x));
    let eigen = whole.symmetric_eigen();
    let kept = Block12::from_diagonal(&eigen.eigenvalues.map(|e| e.max(0.0)));
    eigen.eigenvectors * kept * eigen.eigenvectors.transpose()
}

/// The changes of the signed weights with each place that is free to move, and the number of such places.
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

/// The Hessian of a pair's barrier as V K V^T.
struct Factors {
    /// W^T n, W^T times two tangents, C_a; zero where a place is not free.
    v: SMatrix<f64, 12, 5>,
    k: SMatrix<f64, 5, 5>,
}

impl Factors {
    fn of(contact: &Contact, x: &[Point; 4]) -> Self {
        let (kind, separation, jet) = (contact.kind, &contact.separation, &contact.jet);
        let sigma = separation.signed_weights(kind);
        let n = separation.normal;
        let mut factors = Self { v: SMatrix::zeros(), k: SMatrix::zeros() };
        let lift = |direction: &Vector| {
            let mut column = SVector::<f64, 12>::zeros();
            for k in 0..kind.vertex_count() {
                column.fixed_rows_mut::<3>(3 * k).copy_from(&(sigma[k] * direction));
            }
            column
        };
        factors.v.set_column(0, &lift(&n));
        factors.k[(0, 0)] = jet.curvature;
        let d = separation.distance;
        if kind == PairKind::VertexHalfSpace || d <= 0.0 {
            return factors;
        }
        let turn = jet.slope / d;
        let tangent = n.cross(&Vector::ith(n.iamin(), 1.0)).normalize();
        for (column, tangent) in [(1, tangent), (2, n.cross(&tangent))] {
            factors.v.set_column(column, &lift(&tangent));
            factors.k[(column, column)] = turn;
        }

        let (changes, count) = places(kind, &separation.weights);
        let slide = |a: usize| -> Vector { (0..4).map(|k| changes[a][k] * x[k].coords).sum() };
        let slides = [slide(0), slide(1)];
        for a in 0..count {
            let mut column = lift(&slides[a]);
            for k in 0..kind.vertex_count() {
                let mut rows = column.fixed_rows_mut::<3>(3 * k);
                rows += changes[a][k] * d * n;
            }
            factors.v.set_column(3 + a, &column);
        }
        let metric = match count {
            2 => {
                let off = slides[0].dot(&slides[1]);
                Matrix2::new(slides[0].norm_squared(), off, off, slides[1].norm_squared())
            }
            1 => Matrix2::new(slides[0].norm_squared(), 0.0, 0.0, 1.0),
            _ => return factors,
        };
        // Between parallel edges the closest points may slide together, and the distance has no second
        // derivative.
        if metric.determinant() > PARALLEL * metric[(0, 0)] * metric[(1, 1)]
            && let Some(inverse) = metric.try_inverse()
        {
            factors.k.fixed_view_mut::<2, 2>(3, 3).copy_from(&(-turn * inverse));
        }
        factors
    }

    /// The Hessian.
    fn matrix(&self) -> Block12 {
        self.v * self.k * self.v.transpose()
    }

    /// The Hessian with its negative eigenvalues set to 0: with V = Q R and orthonormal Q, those of R K R^T.
    fn positive_part(&self) -> Block12 {
        let mut q = SMatrix::<f64, 12, 5>::zeros();
        for a in 0..5 {
            let column = self.v.column(a);
            let mut rest = column.into_owned();
            // Two passes are enough (Kahan, in Parlett 1980): the second removes what rounding left in the
            // first.
            for _ in 0..2 {
                for b in 0..a {
                    rest -= q.column(b) * q.column(b).dot(&rest);
                }
            }
            let length = rest.norm();
            if length > DEPENDENT * column.norm() {
                q.set_column(a, &(rest / length));
            }
        }
        let r = q.transpose() * self.v;
        let eigen = (r * self.k * r.transpose()).symmetric_eigen();
        let vectors = q * eigen.eigenvectors;
        let mut scaled = vectors;
        for (mut column, value) in scaled.column_iter_mut().zip(eigen.eigenvalues.iter()) {
            column *= value.max(0.0);
        }
        scaled * vectors.transpose()
    }
}

#[cfg(test)]
mod tests;
