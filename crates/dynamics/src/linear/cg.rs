//! Preconditioned conjugate gradients in single or double precision.

use super::lane::{Lane, Real};
use super::operator::Operator;
use super::parts::{Parts, Piece};
use super::preconditioner::{Levels, Preconditioner};
use super::system::System;
use crate::nodes::CHUNK;
use bowknot_geometry::Vector;
use rayon::prelude::*;
use std::ops::Range;

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

    /// Prepares for solves with `levels`, which `build` builds. That is largely one thread's work, so the operator is prepared
    /// beside it, and what `beside` does.
    pub fn fill(
        &mut self,
        system: &System<'_>,
        levels: &mut Levels,
        build: impl FnOnce(&mut Levels) + Send,
        beside: impl FnOnce() + Send,
    ) {
        let Self { operator, preconditioner, .. } = self;
        rayon::join(
            || {
                build(levels);
                preconditioner.fill(system, levels);
            },
            || {
                operator.fill(system);
                beside();
            },
        );
    }

    /// Prepares for products with the matrix.
    pub fn fill_operator(&mut self, system: &System<'_>) {
        self.operator.fill(system);
    }

    /// Starts from x = 0 with the residual `b` times `factor`. Returns its squared norms by part, those of the
    /// preconditioner.
    pub fn begin(&mut self, levels: &mut Levels, parts: &Parts, b: &[Vector], factor: f64) -> Vec<f64> {
        self.load(b, factor);
        let all = vec![true; parts.count()];
        self.preconditioner.apply(levels, (parts, &all), &self.r, &mut self.z)
    }

    /// Starts from x = 0 with the residual `b` times `factor`, without the norm.
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

    /// Iterates until the squared norm of the residual of each part is at most its entry of `goals`, or `max_iterations` are
    /// made. Returns the number of iterations and the squared norms.
    pub fn iterate(
        &mut self,
        system: &System<'_>,
        levels: &mut Levels,
        parts: &Parts,
        goals: &[f64],
        max_iterations: usize,
    ) -> (usize, Vec<f64>) {
        let Self { operator, preconditioner, x, r, z, p, q, .. } = self;
        let mut active = vec![true; parts.count()];
        let mut rz = preconditioner.apply(levels, (parts, &active), r, z);
        p.copy_from_slice(z);
        let goal = |(goal, rz): (&f64, &f64)| goal.max(T::MAX_REDUCTION * T::MAX_REDUCTION * rz);
        let goals: Vec<f64> = goals.iter().zip(&rz).map(goal).collect();
        let mut iterations = 0;
        let (mut steps, mut ratios) = (vec![T::default(); parts.count()], vec![T::default(); parts.count()]);
        loop {
            for (part, active) in active.iter_mut().enumerate() {
                *active &= rz[part] > goals[part];
            }
            if !active.contains(&true) || iterations == max_iterations {
                break;
            }
            let curvatures = operator.multiply(system, (parts, &active), p, q);
            for (part, active) in active.iter_mut().enumerate() {
                // H is positive definite; a part ends here on numbers that are not finite and when p vanishes.
                *active &= curvatures[part] > 0.0 && curvatures[part].is_finite();
                steps[part] = T::from_f64(rz[part] / curvatures[part]);
            }
            if !active.contains(&true) {
                break;
            }
            r.par_chunks_mut(CHUNK).zip(q.par_chunks(CHUNK)).enumerate().for_each(|(chunk, (r, q))| {
                for (nodes, part) in local(parts, &active, chunk) {
                    r[nodes.clone()].iter_mut().zip(&q[nodes]).for_each(|(r, q)| *r -= *q * steps[part]);
                }
            });
            let next = preconditioner.apply(levels, (parts, &active), r, z);
            for part in (0..parts.count()).filter(|&part| active[part]) {
                ratios[part] = T::from_f64(next[part] / rz[part]);
                rz[part] = next[part];
            }
            // x moves along p here, where p is read in any case.
            let chunks = x.par_chunks_mut(CHUNK).zip(p.par_chunks_mut(CHUNK)).zip(z.par_chunks(CHUNK));
            chunks.enumerate().for_each(|(chunk, ((x, p), z))| {
                for (nodes, part) in local(parts, &active, chunk) {
                    let (step, ratio) = (steps[part], ratios[part]);
                    for k in nodes {
                        x[k] += p[k] * step;
                        p[k] = z[k] + p[k] * ratio;
                    }
                }
            });
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

/// Nodes of the active parts in a chunk, counted from its first, with their parts.
fn local<'a>(
    parts: &'a Parts,
    active: &'a [bool],
    chunk: usize,
) -> impl Iterator<Item = (Range<usize>, usize)> + 'a {
    let first = chunk * CHUNK;
    let pieces = parts.of_chunk(chunk).iter().filter(|piece| active[piece.part]);
    pieces.map(move |Piece { nodes, part }| (nodes.start - first..nodes.end - first, *part))
}
