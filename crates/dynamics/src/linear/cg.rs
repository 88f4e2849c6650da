//! Preconditioned conjugate gradients in single or double precision.

use super::lane::{Lane, Real};
use super::operator::Operator;
use super::preconditioner::{Levels, Preconditioner};
use super::system::System;
use crate::nodes::CHUNK;
use bowknot_geometry::Vector;
use rayon::prelude::*;

/// A system in the numbers that a solve computes with, and the vectors of the solve.
#[derive(Debug, Default)]
pub(crate) struct Krylov<T: Real> {
    operator: Operator<T>,
    preconditioner: Preconditioner<T>,
    /// The solution.
    x: Vec<Lane<T>>,
    /// The residual.
    r: Vec<Lane<T>>,
    /// The preconditioned residual.
    z: Vec<Lane<T>>,
    /// The search direction, and H times it.
    p: Vec<Lane<T>>,
    q: Vec<Lane<T>>,
}

impl<T: Real> Krylov<T> {
    /// Prepares for preconditioning residuals of `system`, for which `levels` were built.
    pub fn fill_preconditioner(&mut self, system: &System<'_>, levels: &Levels) {
        self.preconditioner.fill(system, levels);
    }

    /// Prepares for solves.
    pub fn fill_operator(&mut self, system: &System<'_>) {
        self.operator.fill(system);
    }

    /// Starts from x = 0 with the residual `b` times `factor`. Returns its squared norm, that of the
    /// preconditioner.
    pub fn begin(&mut self, levels: &mut Levels, b: &[Vector], factor: f64) -> f64 {
        self.load(b, factor);
        self.preconditioner.apply(levels, &self.r, &mut self.z)
    }

    /// The same without the norm.
    pub fn load(&mut self, b: &[Vector], factor: f64) {
        for vector in [&mut self.x, &mut self.z, &mut self.p, &mut self.q] {
            vector.resize(b.len(), Lane::default());
        }
        self.x.fill(Lane::default());
        b.par_iter().with_min_len(CHUNK).map(|b| Lane::new(b, factor)).collect_into_vec(&mut self.r);
    }

    /// Copies the preconditioned residual, times `factor`.
    pub fn copy_preconditioned(&self, factor: f64, to: &mut [Vector]) {
        to.iter_mut().zip(&self.z).for_each(|(to, z)| *to = z.vector() * factor);
    }

    /// Iterates until the squared norm of the residual is at most `goal` or `max_iterations` are made.
    /// Returns the number of iterations and the squared norm.
    pub fn iterate(
        &mut self,
        system: &System<'_>,
        levels: &mut Levels,
        goal: f64,
        max_iterations: usize,
    ) -> (usize, f64) {
        let Self { operator, preconditioner, x, r, z, p, q, .. } = self;
        let mut rz = preconditioner.apply(levels, r, z);
        p.copy_from_slice(z);
        let goal = goal.max(T::MAX_REDUCTION * T::MAX_REDUCTION * rz);
        let mut iterations = 0;
        while rz > goal && iterations < max_iterations {
            let curvature = operator.multiply(system, p, q);
            // H is positive definite; the loop ends here on numbers that are not finite and when p vanishes.
            if !(curvature > 0.0 && curvature.is_finite()) {
                break;
            }
            let step = T::from_f64(rz / curvature);
            r.par_chunks_mut(CHUNK).zip(q.par_chunks(CHUNK)).for_each(|(r, q)| {
                r.iter_mut().zip(q).for_each(|(r, q)| *r -= *q * step);
            });
            let next = preconditioner.apply(levels, r, z);
            let ratio = T::from_f64(next / rz);
            rz = next;
            // x moves along p here, where p is read in any case.
            x.par_chunks_mut(CHUNK).zip(p.par_chunks_mut(CHUNK)).zip(z.par_chunks(CHUNK)).for_each(
                |((x, p), z)| {
                    for k in 0..x.len() {
                        x[k] += p[k] * step;
                        p[k] = z[k] + p[k] * ratio;
                    }
                },
            );
            iterations += 1;
        }
        (iterations, rz)
    }

    /// Adds x times `factor` to `sum`.
    pub fn add_solution(&self, factor: f64, sum: &mut [Vector]) {
        sum.par_chunks_mut(CHUNK).zip(self.x.par_chunks(CHUNK)).for_each(|(sum, x)| {
            sum.iter_mut().zip(x).for_each(|(sum, x)| *sum += x.vector() * factor);
        });
    }

    /// Copies the residual, times `factor`.
    pub fn copy_residual(&self, factor: f64, to: &mut [Vector]) {
        to.iter_mut().zip(&self.r).for_each(|(to, r)| *to = r.vector() * factor);
    }
}
