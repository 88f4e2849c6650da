//! A separate, slow solver of the problem as stated, by the method of multipliers.
//!
//! Each constraint c >= 0 adds (max(0, lambda - rho c)^2 - lambda^2) / (2 rho) to the objective, and after each
//! minimization lambda becomes max(0, lambda - rho c) (Rockafellar, "A dual approach to solving nonlinear programming
//! problems by unconstrained optimization", Mathematical Programming 5, 1973). In each step of a minimization the
//! constraints are linear, and the model that this makes is minimized (`model`).
//!
//! The way from the start crosses nothing: a step is halved until the judge certifies its path. Below a quarter of
//! its contact distance a pair repels itself by a log barrier besides, so that steps do not become short. At the
//! solution no pair is so near, and the barrier is zero.
//!
//! Prescribed vertices are heavy: they come to their targets as everything gets out of their way. Their targets shift by
//! what they miss, which is the method of multipliers for equalities.

use super::model::{Linear, Model};
use super::statement::{About, Constraint, Statement};
use anyhow::Result;
use bowknot::check::{NearPair, PathOptions};
use bowknot::geometry::{Point, Vector};
use std::collections::HashMap;
use std::time::{Duration, Instant};

/// Mass of prescribed vertices, in mean masses.
const HEAVY: f64 = 1e4;
/// The first and the largest rho, in mean masses.
const RHO: [f64; 2] = [30.0, 1e5];
/// Factor by which rho grows.
const RHO_GROWTH: f64 = 3.0;
/// Share of a contact distance below which the barrier acts.
const BARRIER: f64 = 0.25;
/// Share of the barrier's range below which a pair is so tight that rho grows.
const TIGHT: f64 = 0.3;
/// Longest way of a vertex in a step, in contact distances: pairs are seen before they meet.
const LONGEST: f64 = 0.5;
/// The last minimization ends at this root mean square of its gradient over mass, and the first one at this
/// [contact distances]; those between at this share of what the constraints missed before.
const STATIONARY: f64 = 1e-4;
const ROUGH: f64 = 0.03;
const INEXACT: f64 = 0.03;
/// The method ends when all constraints with a multiplier are met to so much [contact distances].
const MET: f64 = 1e-3;
/// Largest number of steps of a minimization, of halvings of a step, and of minimizations.
const MAX_STEPS: usize = 200;
const MAX_HALVINGS: usize = 30;
const MAX_MINIMIZATIONS: usize = 60;
/// Number of minimizations on the way to the last target.
const ROUGH_MINIMIZATIONS: usize = 3;
/// Share of the promised decrease that a step must make, and the rounding of energies.
const DECREASE: f64 = 1e-4;
const ROUNDING: f64 = 1e-13;

/// The end of a solve, after so many steps.
#[derive(Clone, Debug)]
pub struct Projected {
    pub x: Vec<Point>,
    pub steps: usize,
}

/// Solves the problem, by way of targets at `shares` of the way from the start to the target. The last one is 1.
pub fn project(statement: &Statement<'_>, shares: &[f64], seconds: f64) -> Result<Projected> {
    let mut solver = Solver::new(statement, Instant::now() + Duration::from_secs_f64(seconds));
    for share in shares {
        let states = &statement.case.states;
        solver.aim = states.x.iter().zip(&states.y).map(|(x, y)| x + (y - x) * *share).collect();
        solver.target.clone_from(&solver.aim);
        solver.solve(if *share < 1.0 { ROUGH_MINIMIZATIONS } else { MAX_MINIMIZATIONS })?;
    }
    Ok(Projected { x: solver.x, steps: solver.steps })
}

struct Solver<'a> {
    statement: &'a Statement<'a>,
    masses: Vec<f64>,
    /// Length to which tolerances are relative, the contact distance [m].
    unit: f64,
    x: Vec<Point>,
    /// Where vertices are to be, and where the objective pulls them.
    aim: Vec<Point>,
    target: Vec<Point>,
    /// Pairs that are near wherever no vertex is farther than `unit` from `near_at`.
    near: Vec<NearPair>,
    near_at: Vec<Point>,
    /// Multipliers that are not 0 [mean masses x m].
    multipliers: HashMap<About, f64>,
    rho: f64,
    steps: usize,
    deadline: Instant,
}

impl<'a> Solver<'a> {
    fn new(statement: &'a Statement<'a>, deadline: Instant) -> Self {
        let x = statement.case.states.x.clone();
        Self {
            masses: statement.masses.iter().map(|&m| if m > 0.0 { m } else { HEAVY }).collect(),
            unit: statement.scene.spacing().largest_delta(),
            aim: x.clone(),
            target: x.clone(),
            x,
            near: Vec::new(),
            near_at: Vec::new(),
            multipliers: HashMap::new(),
            rho: RHO[0],
            steps: 0,
            deadline,
            statement,
        }
    }

    /// Pairs within this distance are constraints [m].
    fn reach(&self) -> f64 {
        2.0 * self.statement.range()
    }

    /// The constraints at `x`.
    fn constraints(&mut self, x: &[Point]) -> Result<Vec<Constraint>> {
        let moved = x.iter().zip(&self.near_at).map(|(x, at)| (x - at).norm());
        if self.near_at.is_empty() || moved.fold(0.0, f64::max) > self.unit {
            self.near = self.statement.judge.pairs_within(x, self.reach() + 2.0 * self.unit)?;
            self.near_at = x.to_vec();
        }
        Ok(self.statement.constraints_of(&self.near, x, self.reach()))
    }

    /// Makes at most so many minimizations for the present target.
    fn solve(&mut self, minimizations: usize) -> Result<()> {
        let mut before = f64::INFINITY;
        for _ in 0..minimizations {
            let tolerance = (INEXACT * before).clamp(STATIONARY, ROUGH);
            let stationary = self.minimize(tolerance)?;
            let missed = self.update_multipliers()?;
            let has_converged = stationary && tolerance == STATIONARY && missed <= MET;
            if has_converged || Instant::now() > self.deadline {
                break;
            }
            if missed > 0.3 * before {
                self.rho = (RHO_GROWTH * self.rho).min(RHO[1]);
            }
            before = missed;
        }
        Ok(())
    }

    /// Sets the multipliers; returns the largest distance from complementarity [contact distances].
    fn update_multipliers(&mut self) -> Result<f64> {
        let mut missed = 0.0f64;
        let mut next = HashMap::new();
        for constraint in self.constraints(&self.x.clone())? {
            let lambda = self.excess(&constraint).max(0.0);
            if lambda > 0.0 {
                missed = missed.max(constraint.value.abs());
                // A pair out of reach has no force, so one within it must not have any at its border.
                let largest = match constraint.about {
                    About::Pair(..) => 0.9 * self.rho * (self.reach() - constraint.length),
                    About::Edge(_) => f64::INFINITY,
                };
                next.insert(constraint.about, lambda.min(largest));
            } else {
                missed = missed.max(-constraint.value);
            }
        }
        self.multipliers = next;
        for v in (0..self.x.len()).filter(|&v| !self.statement.is_movable(v)) {
            let short = self.aim[v] - self.x[v];
            missed = missed.max(short.norm());
            self.target[v] += short;
        }
        Ok(missed / self.unit)
    }

    /// Minimizes the augmented objective; returns whether the gradient is at most `tolerance` in the end
    /// [contact distances].
    fn minimize(&mut self, tolerance: f64) -> Result<bool> {
        let mut constraints = self.constraints(&self.x.clone())?;
        let mut energy = self.energy(&self.x, &constraints);
        for _ in 0..MAX_STEPS {
            let linear = constraints.iter().map(|c| self.linear(c)).collect();
            let away = self.x.iter().zip(&self.target).map(|(x, y)| x - y).collect();
            let model = Model { masses: &self.masses, away, linear, rho: self.rho };
            let mut step = vec![Vector::zeros(); self.x.len()];
            let gradient = model.gradient(&step);
            if self.size(&gradient) <= tolerance * self.unit {
                return Ok(true);
            }
            if Instant::now() > self.deadline {
                return Ok(false);
            }
            model.minimize(&mut step);
            let slope: f64 = step.iter().zip(&gradient).map(|(p, g)| p.dot(g)).sum();
            let longest = step.iter().map(Vector::norm).fold(0.0, f64::max);
            let mut length = (LONGEST * self.unit / longest).min(1.0);
            let mut halvings = 0;
            self.steps += 1;
            loop {
                let trial: Vec<Point> = self.x.iter().zip(&step).map(|(x, p)| x + p * length).collect();
                let at_trial = self.constraints(&trial)?;
                let energy_there = self.energy(&trial, &at_trial);
                let enough = energy + DECREASE * length * slope + ROUNDING * energy.abs();
                if energy_there <= enough && self.is_clear(&trial)? {
                    (self.x, constraints, energy) = (trial, at_trial, energy_there);
                    break;
                }
                halvings += 1;
                if halvings == MAX_HALVINGS {
                    return Ok(false);
                }
                length *= 0.5;
            }
            // Many vertices may press on one pair: the barrier has to hold them before steps become short.
            if self.rho < RHO[1] && constraints.iter().any(is_tight) {
                self.rho = (RHO_GROWTH * self.rho).min(RHO[1]);
                energy = self.energy(&self.x, &constraints);
            }
        }
        Ok(false)
    }

    fn is_clear(&self, trial: &[Point]) -> Result<bool> {
        let options = PathOptions { limit: 0, skip_unmoved: true };
        Ok(self.statement.judge.check_path(&self.x, trial, &options)?.is_clear())
    }

    fn multiplier(&self, constraint: &Constraint) -> f64 {
        self.multipliers.get(&constraint.about).copied().unwrap_or(0.0)
    }

    /// lambda - rho c.
    fn excess(&self, constraint: &Constraint) -> f64 {
        self.multiplier(constraint) - self.rho * constraint.value
    }

    fn energy(&self, x: &[Point], constraints: &[Constraint]) -> f64 {
        let away = x.iter().zip(&self.target).zip(&self.masses);
        let inertia: f64 = away.map(|((x, y), m)| m * (x - y).norm_squared()).sum();
        let penalty = |c: &Constraint| {
            let (force, lambda) = (self.excess(c).max(0.0), self.multiplier(c));
            (force * force - lambda * lambda) / (2.0 * self.rho) + self.rho * barrier(c)[0]
        };
        0.5 * inertia + constraints.iter().map(penalty).sum::<f64>()
    }

    fn linear(&self, constraint: &Constraint) -> Linear {
        let Constraint { about, vertices, gradients, value, length } = *constraint;
        let excess = self.excess(constraint);
        let across = if matches!(about, About::Edge(_)) { excess.max(0.0) / (length - value) } else { 0.0 };
        let [_, slope, curvature] = barrier(constraint).map(|b| self.rho * b);
        Linear { vertices, gradients, excess, barrier: [slope, curvature], across }
    }

    /// Root mean square of a gradient over mass, of vertices that are not prescribed [m].
    fn size(&self, gradient: &[Vector]) -> f64 {
        let masses = &self.statement.masses;
        let movable = gradient.iter().zip(masses).filter(|(_, m)| **m > 0.0);
        let sum: f64 = movable.map(|(g, m)| g.norm_squared() / m).sum();
        (sum / masses.iter().sum::<f64>().max(f64::MIN_POSITIVE)).sqrt()
    }
}

fn is_tight(constraint: &Constraint) -> bool {
    let Constraint { about, value, length, .. } = *constraint;
    matches!(about, About::Pair(..)) && value + length < TIGHT * BARRIER * length
}

/// The barrier of a pair and its first two derivatives by the distance d, over rho: -(d - r)^2 ln(d/r) below r.
fn barrier(constraint: &Constraint) -> [f64; 3] {
    let (distance, range) = (constraint.value + constraint.length, BARRIER * constraint.length);
    if matches!(constraint.about, About::Edge(_)) || distance >= range {
        return [0.0; 3];
    }
    if distance <= 0.0 {
        return [f64::INFINITY, 0.0, 0.0];
    }
    let (below, log) = (distance - range, (distance / range).ln());
    let ratio = below / distance;
    [-below * below * log, -below * (2.0 * log + ratio), -2.0 * log - 4.0 * ratio + ratio * ratio]
}
