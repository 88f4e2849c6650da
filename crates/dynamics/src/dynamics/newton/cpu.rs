//! The bodies on the CPU, in double precision.

use super::bodies::{Answer, Bodies, BodyEnergies, Imbalance, LinearSolve, Promise};
use super::momentum::{Inertia, shift_group};
use super::state::{Step, Workspace, negate_forces};
use crate::elements::filter::Filter;
use crate::groups::Group;
use crate::linear::accuracy::Limits;
use crate::linear::parts::Parts;
use crate::linear::solver::Problem;
use crate::linear::springs::LinearSprings;
use crate::linear::system::System;
use crate::linear::vectors::dot;
use crate::model::DynamicsModel;
use crate::nodes::CHUNK;
use crate::params::DynamicsParams;
use crate::repulsion::springs::Repulsion;
use bowknot_geometry::Vector;
use rayon::prelude::*;

/// Steps shorter than this share of the largest coordinate are rounding errors.
pub const NEGLIGIBLE_STEP: f64 = 1e-12;

/// The bodies from `work.x` to `work.trial`.
pub struct CpuBodies<'a> {
    pub model: &'a DynamicsModel,
    pub params: &'a DynamicsParams,
    pub step: &'a Step,
    pub work: &'a mut Workspace,
    watched: &'a [u32],
    /// The iterate that the target began with.
    began: Vec<Vector>,
    kept: Vec<Vector>,
}

impl<'a> CpuBodies<'a> {
    /// A target from the iterate in `work`.
    pub fn new(
        model: &'a DynamicsModel,
        params: &'a DynamicsParams,
        step: &'a Step,
        work: &'a mut Workspace,
        watched: &'a [u32],
    ) -> Self {
        let began = work.x.clone();
        Self { model, params, step, work, watched, began, kept: Vec::new() }
    }

    fn gather(&self, position: impl Fn(usize) -> Vector) -> Vec<Vector> {
        self.watched.iter().map(|&node| position(node as usize)).collect()
    }
}

impl Bodies for CpuBodies<'_> {
    fn linearize(&mut self, filter: Filter) -> Answer<()> {
        self.linearize_bodies(filter);
        Ok(())
    }

    fn iterate(&self) -> Vec<Vector> {
        self.gather(|n| self.work.x[n])
    }

    fn iterate_at_ends(&self) -> Vec<Vector> {
        let work = &*self.work;
        self.gather(|n| if work.free[n] { work.x[n] } else { work.x[n] + work.imposed[n] })
    }

    fn inertial_at_ends(&self) -> Vec<Vector> {
        let work = &*self.work;
        self.gather(|n| if work.free[n] { self.step.inertial[n] } else { work.x[n] + work.imposed[n] })
    }

    fn solve(
        &mut self,
        springs: &LinearSprings,
        parts: &Parts,
        limits: &Limits,
        groups: &[Group],
    ) -> Answer<LinearSolve> {
        let Self { model, params, step, work, .. } = self;
        if !springs.is_empty() {
            let gradient = work.gradient.par_iter_mut().enumerate().with_min_len(CHUNK);
            gradient.for_each(|(node, gradient)| *gradient += springs.gradient(node));
        }
        // There are two guesses: the way to the positions where inertia leads, and the way to the last
        // target. In free flight the first is all but exact, near the solution of a step the second.
        // Corrections use them as well: what is still missing along them is what conjugate gradients find
        // last.
        let guesses = 1 + usize::from(step.last_target.is_some());
        let targets = [Some(&step.inertial), step.last_target.as_ref()];
        for (guess, target) in work.guesses.iter_mut().zip(targets) {
            let Some(target) = target else { continue };
            for (node, guess) in guess.iter_mut().enumerate() {
                *guess = if work.free[node] { target[node] - work.x[node] } else { Vector::zeros() };
            }
        }
        // b = -(g + H p) over free nodes, with p the imposed displacements of the prescribed nodes.
        let system = System {
            pattern: &model.pattern,
            values: &work.values,
            scalar: &step.scalar,
            springs: (!springs.is_empty()).then_some(springs),
            free: &work.free,
        };
        if work.imposed.iter().any(|p| *p != Vector::zeros()) {
            system.multiply(&work.imposed, &mut work.right_side);
        } else {
            work.right_side.fill(Vector::zeros());
        }
        negate_forces(&mut work.right_side, &work.gradient, &work.free);
        let [inertia, last] = &work.guesses;
        let guesses: &[&[Vector]] = &[last.as_slice(), inertia.as_slice()][2 - guesses..];
        let problem = Problem { system: &system, parts, positions: &work.x, b: &work.right_side };
        let info = work.solver.solve(&problem, guesses, limits, &mut work.step);
        let inertia = Inertia::new(params, step);
        for group in groups {
            shift_group(model, group, &inertia, work.solver.residual(), &mut work.step);
        }
        Ok(LinearSolve { info, scales: work.solver.scales().to_vec() })
    }

    fn place(&mut self, length: f64) -> Answer<BodyEnergies> {
        self.work.place(length);
        Ok(self.energies_of_trial())
    }

    fn promise(&mut self) -> Promise {
        let work = &*self.work;
        // A maximum is the same in any order.
        let largest = |values: &[Vector]| values.iter().map(|v| v.amax()).fold(0.0, f64::max);
        Promise {
            predicted: dot(&work.step, &work.right_side),
            is_negligible: largest(&work.step) <= NEGLIGIBLE_STEP * largest(&work.x),
        }
    }

    fn trial(&self) -> Vec<Vector> {
        self.gather(|n| self.work.trial[n])
    }

    fn distance_from_iterate(&self) -> f64 {
        largest_distance(&self.work.trial, &self.work.x, &self.work.free)
    }

    fn distance_from_start(&self) -> f64 {
        largest_distance(&self.work.trial, &self.began, &self.work.free)
    }

    fn start_from_trial(&mut self) -> Answer<()> {
        self.work.start_from_trial();
        Ok(())
    }

    fn keep_trial(&mut self) -> Answer<()> {
        self.kept.clone_from(&self.work.trial);
        Ok(())
    }

    fn start_from_kept_trial(&mut self) -> Answer<()> {
        self.work.trial.copy_from_slice(&self.kept);
        self.start_from_trial()
    }

    fn out_of_balance(
        &mut self,
        repulsion: &Repulsion,
        counted: &[bool],
        filter: Filter,
    ) -> Answer<Imbalance> {
        self.linearize_bodies(filter);
        let forces = repulsion.forces_on_nodes(&self.iterate());
        let Self { model, step, work, watched, .. } = self;
        watched.iter().zip(forces).for_each(|(&node, force)| work.gradient[node as usize] -= force);
        for node in 0..work.x.len() {
            let counts = work.free[node] && counted[node];
            work.right_side[node] = if counts { -work.gradient[node] } else { Vector::zeros() };
        }
        let system = System {
            pattern: &model.pattern,
            values: &work.values,
            scalar: &step.scalar,
            springs: (!repulsion.linear().is_empty()).then_some(repulsion.linear()),
            free: &work.free,
        };
        work.solver.precondition(&system, &work.x, &work.right_side, &mut work.step);
        let products = model.components.iter().map(|component| {
            let nodes = (component.start as usize..component.end as usize).filter(|&n| work.free[n]);
            nodes.map(|n| work.right_side[n].dot(&work.step[n])).sum()
        });
        Ok(Imbalance {
            products: products.collect(),
            squared_force: work.right_side.iter().map(Vector::norm_squared).sum(),
        })
    }
}

/// Largest |y - x| over free nodes [m].
fn largest_distance(y: &[Vector], x: &[Vector], free: &[bool]) -> f64 {
    let distance = |((y, x), _): ((&Vector, &Vector), &bool)| (y - x).norm();
    y.iter().zip(x).zip(free).filter(|(_, free)| **free).map(distance).fold(0.0, f64::max)
}
