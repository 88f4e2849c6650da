//! Wind and the drag of air: forces on surfaces, strands and grains that grow with the square of the velocity
//! relative to the wind.
//!
//! The relative velocity u = wind - v of an element is split into its component u_n along the normal (for a
//! strand: across it) and u_t in the plane (along the strand):
//!
//! ```text
//! F = rho/2 (A_n c_n |u_n| u_n + A_t c_t |u_t| u_t)
//! ```
//!
//! | element | A_n, c_n | A_t, c_t |
//! |---|---|---|
//! | triangle of cloth | area, `drag_normal` | area, `drag_tangential` (both sides together) |
//! | surface triangle of a solid | half of its area, each side of a plate being one such triangle | the same |
//! | strand edge | diameter times length, `drag_normal` | half of its circumference times length, `drag_tangential` |
//! | grain | cross-section, 0.47, a sphere at Re of 10^3 to 10^5; isotropic | |
//!
//! F is linearized at the start of the step (Rosenbrock's Euler method): F(v) = F(v0) - K (v - v0), with K =
//! -dF/dv positive semi-definite. It is then the gradient of a quadratic form of positions, has its place in
//! the diagonal blocks of the Newton matrix, and velocities tend to the terminal velocity without overshoot
//! at any time step.

use crate::body::BodyShape;
use crate::model::DynamicsModel;
use crate::params::Environment;
use bowknot_geometry::{Vector, boundary_triangles, divide_tetrahedron};
use nalgebra::Matrix3;

/// Drag coefficient of a sphere.
const SPHERE_DRAG: f64 = 0.47;

/// The elements that feel drag, over nodes.
#[derive(Debug, Default)]
pub(crate) struct DragSurfaces {
    /// Triangles with the share of their area that counts.
    triangles: Vec<([u32; 3], f64)>,
    /// Edges of strands with their radius [m].
    edges: Vec<([u32; 2], f64)>,
    /// Grains with their cross-section [m^2].
    grains: Vec<(u32, f64)>,
}

/// Drag in a time step by node: the force at velocity v is `push - matrix v` [N].
#[derive(Debug, Default)]
pub(crate) struct Drag {
    /// Force at velocity 0 [N].
    pub push: Vec<Vector>,
    /// K [N s/m].
    pub matrix: Vec<Matrix3<f64>>,
}

impl DragSurfaces {
    /// The elements of a model.
    pub fn new(model: &DynamicsModel) -> Self {
        let mut surfaces = Self::default();
        let node = |v: u32| model.vertex_node[v as usize];
        for body in model.bodies() {
            match &body.shape {
                BodyShape::Cloth { triangles, .. } => {
                    surfaces.triangles.extend(triangles.iter().map(|t| (t.map(node), 1.0)));
                }
                BodyShape::Solid { tets, .. } => {
                    surfaces.triangles.extend(boundary_triangles(tets).iter().map(|t| (t.map(node), 0.5)));
                }
                BodyShape::QuadraticSolid { tets, .. } => {
                    let parts: Vec<[u32; 4]> = tets.iter().flat_map(divide_tetrahedron).collect();
                    surfaces.triangles.extend(boundary_triangles(&parts).iter().map(|t| (t.map(node), 0.5)));
                }
                BodyShape::Strands { edges, material } => {
                    surfaces.edges.extend(edges.iter().map(|e| (e.map(node), material.radius)));
                }
                BodyShape::Rods { edges, material } => {
                    let ends = edges.iter().map(|&[a, b, _]| [a, b].map(node));
                    surfaces.edges.extend(ends.map(|nodes| (nodes, material.radius)));
                }
                BodyShape::Particles { vertices, material } => {
                    let section = std::f64::consts::PI * material.radius * material.radius;
                    surfaces.grains.extend(vertices.iter().map(|v| (node(*v), section)));
                }
                BodyShape::Obstacle { .. } => {}
            }
        }
        surfaces
    }

    /// Computes the drag at positions `x` [m] and velocities `v` [m/s] of nodes, in `drag`.
    pub fn fill(&self, environment: &Environment, x: &[Vector], v: &[Vector], drag: &mut Drag) {
        drag.push.clear();
        drag.push.resize(x.len(), Vector::zeros());
        drag.matrix.clear();
        drag.matrix.resize(x.len(), Matrix3::zeros());
        let half = 0.5 * environment.air_density;
        for &(nodes, share) in &self.triangles {
            let [a, b, c] = nodes.map(|n| x[n as usize]);
            let cross = (b - a).cross(&(c - a));
            let twice = cross.norm();
            if twice > 0.0 {
                let normal = cross / twice;
                let area = half * 0.5 * twice * share;
                let (across, along) = (area * environment.drag_normal, area * environment.drag_tangential);
                drag.add(&nodes, v, environment.wind, &(normal * normal.transpose()), across, along);
            }
        }
        for &(nodes, radius) in &self.edges {
            let edge = x[nodes[1] as usize] - x[nodes[0] as usize];
            let length = edge.norm();
            if length > 0.0 {
                let axis = edge / length;
                let normal = Matrix3::identity() - axis * axis.transpose();
                let across = half * 2.0 * radius * length * environment.drag_normal;
                let along = half * std::f64::consts::PI * radius * length * environment.drag_tangential;
                drag.add(&nodes, v, environment.wind, &normal, across, along);
            }
        }
        for &(node, section) in &self.grains {
            drag.add(&[node], v, environment.wind, &Matrix3::identity(), half * section * SPHERE_DRAG, 0.0);
        }
    }
}

impl Drag {
    /// Adds the drag of an element in equal shares to its nodes. `normal` is the projection on its normal
    /// directions, in which the factor is `across`; in the other directions it is `along`.
    fn add<const N: usize>(
        &mut self,
        nodes: &[u32; N],
        v: &[Vector],
        wind: Vector,
        normal: &Matrix3<f64>,
        across: f64,
        along: f64,
    ) {
        let share = 1.0 / N as f64;
        let mean = nodes.iter().map(|n| v[*n as usize]).sum::<Vector>() * share;
        let u = wind - mean;
        let u_n = normal * u;
        let u_t = u - u_n;
        let (force_n, matrix_n) = quadratic(&u_n, normal, across);
        let (force_t, matrix_t) = quadratic(&u_t, &(Matrix3::identity() - normal), along);
        let (force, matrix) = ((force_n + force_t) * share, (matrix_n + matrix_t) * share);
        for node in nodes.map(|n| n as usize) {
            self.push[node] += force + matrix * v[node];
            self.matrix[node] += matrix;
        }
    }
}

/// The force c |u| u and its derivative c (|u| P + u u^T/|u|) in the space of the projection P.
#[inline]
fn quadratic(u: &Vector, projection: &Matrix3<f64>, c: f64) -> (Vector, Matrix3<f64>) {
    let speed = u.norm();
    if speed == 0.0 || c == 0.0 {
        return (Vector::zeros(), Matrix3::zeros());
    }
    (u * (c * speed), (projection * speed + u * u.transpose() / speed) * c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_matrix_is_positive_definite_and_the_derivative_of_the_force() {
        let normal = Vector::new(0.6, 0.0, 0.8);
        let projection = normal * normal.transpose();
        let force = |v: Vector| {
            let mut drag = Drag { push: vec![Vector::zeros()], matrix: vec![Matrix3::zeros()] };
            drag.add(&[0], &[v], Vector::new(1.0, 2.0, -0.5), &projection, 1.3, 0.2);
            (drag.push[0] - drag.matrix[0] * v, drag.matrix[0])
        };
        let v = Vector::new(-0.3, 0.4, 2.0);
        let (_, matrix) = force(v);
        for axis in 0..3 {
            let step = Vector::ith(axis, 1e-6);
            let slope = (force(v + step).0 - force(v - step).0) / 2e-6;
            assert!((slope + matrix.column(axis)).norm() < 1e-8, "{slope} {matrix}");
        }
        assert!(matrix.symmetric_eigenvalues().min() > 0.0);
        // On a plate across the flow the force is rho/2 A c u^2.
        let (push, _) = {
            let mut drag = Drag { push: vec![Vector::zeros()], matrix: vec![Matrix3::zeros()] };
            drag.add(&[0], &[Vector::zeros()], normal * 3.0, &projection, 1.3, 0.2);
            (drag.push[0], drag.matrix[0])
        };
        assert!((push - normal * (1.3 * 9.0)).norm() < 1e-12);
    }
}
