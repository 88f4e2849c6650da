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
    /// Directions of guesses with their images and curvatures.
    guesses: Vec<Guess<T>>,
    guess_count: usize,
    partial: Vec<f64>,
}

#[derive(Debug, Default)]
struct Guess<T: Real> {
    direction: Vec<Lane<T>>,
    image: Vec<Lane<T>>,
    curvature: f64,
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
        for vector in [&mut self.x, &mut self.z, &mut self.p, &mut self.q] {
            vector.resize(b.len(), Lane::default());
        }
        self.x.fill(Lane::default());
        self.guess_count = 0;
        b.par_iter().with_min_len(CHUNK).map(|b| Lane::new(b, factor)).collect_into_vec(&mut self.r);
        self.preconditioner.apply(levels, &self.r, &mut self.z)
    }

    /// Copies the preconditioned residual, times `factor`.
    pub fn copy_preconditioned(&self, factor: f64, to: &mut [Vector]) {
        to.iter_mut().zip(&self.z).for_each(|(to, z)| *to = z.vector() * factor);
    }

    /// Moves x to the minimum of the energy along `guess` times `factor`, made conjugate to the guesses
    /// before.
    pub fn try_guess(&mut self, system: &System<'_>, guess: &[Vector], factor: f64) {
        if self.guesses.len() == self.guess_count {
            self.guesses.push(Guess { direction: Vec::new(), image: Vec::new(), curvature: 0.0 });
        }
        let (before, rest) = self.guesses.split_at_mut(self.guess_count);
        let Guess { direction: p, image: q, curvature } = &mut rest[0];
        guess.par_iter().with_min_len(CHUNK).map(|g| Lane::new(g, factor)).collect_into_vec(p);
        q.resize(guess.len(), Lane::default());
        *curvature = self.operator.multiply(system, p, q);
        for other in before {
            let share = T::from_f64(-dot(p, &other.image, &mut self.partial) / other.curvature);
            add_scaled(p, share, &other.direction);
            add_scaled(q, share, &other.image);
            *curvature = dot(p, q, &mut self.partial);
        }
        if *curvature > 0.0 && curvature.is_finite() {
            let step = dot(p, &self.r, &mut self.partial) / *curvature;
            add_scaled(&mut self.x, T::from_f64(step), p);
            add_scaled(&mut self.r, T::from_f64(-step), q);
            self.guess_count += 1;
        }
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

fn dot<T: Real>(a: &[Lane<T>], b: &[Lane<T>], partial: &mut Vec<f64>) -> f64 {
    a.par_chunks(CHUNK)
        .zip(b.par_chunks(CHUNK))
        .map(|(a, b)| a.iter().zip(b).map(|(a, b)| a.dot(b)).sum())
        .collect_into_vec(partial);
    partial.iter().sum()
}

fn add_scaled<T: Real>(y: &mut [Lane<T>], factor: T, x: &[Lane<T>]) {
    y.par_chunks_mut(CHUNK).zip(x.par_chunks(CHUNK)).for_each(|(y, x)| {
        y.iter_mut().zip(x).for_each(|(y, x)| *y += *x * factor);
    });
}
