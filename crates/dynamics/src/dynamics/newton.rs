//! The way from a state to the target: Newton iterations, those that correct them, the line search.

use crate::drag::Drag;
use crate::elements::{CHUNK, Filter, Motion, Rows};
use crate::linear::block::BlockValues;
use crate::linear::cg::{self, CgWorkspace, Limits};
use crate::linear::preconditioner::Preconditioner;
use crate::linear::scalar::SplitForm;
use crate::linear::system::System;
use crate::linear::vectors::{add_scaled, dot};
use crate::momentum::{Inertia, restore_momentum};
use crate::repulsion::Repulsion;
use crate::{DynamicsModel, DynamicsParams, NewtonInfo, Residual};
use bowknot_geometry::{Point, Vector};
use nalgebra::Matrix3;
use rayon::prelude::*;

/// Share of the promised decrease at which a Newton step counts as arrived. The quadratic model then errs by some tenth of
/// the decrease, the next iteration by about its square.
const AGREEMENT: f64 = 0.9;

/// Share of the potential below which a correction's decrease is not worth another.
const VAIN_DECREASE: f64 = 1e-6;

/// Share of what the target gained at which the quadratic model may have been wrong about a correction that is the last.
const MISSED: f64 = 0.01;

/// Share of the whole displacement below which a correction is the last.
const SMALL_CORRECTION: f64 = 0.2;

/// Share of the contact forces that may be wrong, by springs that pull, are missing, or rub too much or too little.
const SETTLED: f64 = 0.002;

/// Newton iterations made for them at most. In a heap of cloth thousands of contacts come and go, and what is wrong now is
/// found after the collision stage; but friction that is wrong by 1 % changes how bodies slide by 5 %
/// where it nearly holds them.
const SETTLING_ITERATIONS: usize = 6;

/// Share of wrong forces at which they must go on, and how many there may then be.
const UNSETTLED: f64 = 0.3;
const MOST_SETTLING: usize = 8;

/// Residual of a rough linear solve, relative to its own right-hand side.
const ROUGH: f64 = 0.03;

/// Newton iterations more at most while springs that pull give energy. One has been enough wherever it was seen.
const FURTHER_ITERATIONS: usize = 4;

/// Share of the potential's terms that contacts may give: multipliers lag behind what they should be.
const NO_GAIN: f64 = 1e-3;

/// Newton iterations made with contacts that only push, at most.
const ONE_SIDED_ITERATIONS: usize = 6;

/// Energies that differ by less than this share of their terms are equal: what rounding leaves of
/// sums over 10^5 nodes, with room.
const ENERGY_ROUNDING: f64 = 1e-12;

/// Steps shorter than this share of the largest coordinate are rounding: not worth a line search,
/// whose energies would differ by noise.
const NEGLIGIBLE_STEP: f64 = 1e-12;

/// The time step under way, by node.
#[derive(Debug, Default)]
pub struct Step {
    pub dt: f64,
    pub start: Vec<Vector>,
    /// Velocities at the start.
    pub velocities: Vec<Vector>,
    /// Positions at the start, by vertex.
    pub positions: Vec<Point>,
    pub inertial: Vec<Vector>,
    /// The last target, if there was one: the warm start of the next solve.
    pub last_target: Option<Vec<Vector>>,
    /// Bending plus its damping / dt, as a matrix.
    pub scalar: SplitForm,
    /// Potential without springs that no target may exceed, but by what springs store: that at the start of the step [J].
    pub most: Option<f64>,
    /// None in a vacuum.
    pub drag: Option<Drag>,
    /// Whether springs have been set since the last Newton iteration, or the step has only begun.
    pub fresh: bool,
}

/// Buffers; may be dropped at any time.
#[derive(Debug, Default)]
pub struct Workspace {
    pub x: Vec<Vector>,
    pub trial: Vec<Vector>,
    pub free: Vec<bool>,
    pub gradient: Vec<Vector>,
    pub right_side: Vec<Vector>,
    pub imposed: Vec<Vector>,
    pub guesses: [Vec<Vector>; 2],
    pub step: Vec<Vector>,
    pub values: BlockValues,
    pub preconditioner: Preconditioner,
    pub cg: CgWorkspace,
    /// See [`Limits::least_scale`]: that of the first solve of the time step, 0 in it.
    pub least_scale: f64,
    /// What has been computed in this time step.
    pub known: Known,
}

/// What is known of a state, so that it is not computed twice.
#[derive(Debug, Default)]
pub struct Known {
    /// Where `energies` were computed last [m]; empty if nowhere in this time step.
    energies_at: Vec<Vector>,
    energies: [f64; 2],
    /// Where the bodies were linearised last [m], with which filter, and their gradient [N].
    linearised_at: Vec<Vector>,
    filter: Option<Filter>,
    gradient: Vec<Vector>,
}

impl Known {
    /// Forgets all: a time step begins.
    pub fn clear(&mut self) {
        self.energies_at.clear();
        self.linearised_at.clear();
    }
}

impl Workspace {
    /// Makes the Newton step times `length` the trial, prescribed nodes at their keyframes.
    fn place(&mut self, length: f64) {
        self.trial.copy_from_slice(&self.x);
        add_scaled(&mut self.trial, 1.0, &self.imposed);
        add_scaled(&mut self.trial, length, &self.step);
    }

    /// Makes the trial the state that the next iteration starts from; prescribed nodes are at their keyframes there.
    fn start_from_trial(&mut self) {
        self.x.copy_from_slice(&self.trial);
        self.imposed.fill(Vector::zeros());
    }
}

/// How well a linear system is solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Accuracy {
    /// To [`ROUGH`]: what is linearised here will be linearised again elsewhere.
    Rough,
    /// To [`DynamicsParams::cg_tolerance`].
    Full,
}

/// What an iteration works on: from `work.x` to `work.trial`, by node.
pub struct Newton<'a> {
    pub model: &'a DynamicsModel,
    pub params: &'a DynamicsParams,
    pub repulsion: &'a mut Repulsion,
    pub step: &'a mut Step,
    pub work: &'a mut Workspace,
}

impl Newton<'_> {
    /// Makes the target.
    ///
    /// The first linear system of a time step, or of any target without contacts, and the last one of each target are solved accurately, those between roughly, as they are
    /// linearised again where they lead: an inexact Newton method (Dembo, Eisenstat and Steihaug 1982).
    pub fn reach(&mut self) -> NewtonInfo {
        if self.repulsion.is_empty() { self.approach() } else { self.approach_contacts() }
    }

    /// A Newton iteration, and as many to correct it as it takes.
    fn approach(&mut self) -> NewtonInfo {
        let mut info = self.iterate(Accuracy::Full);
        if info.agreement < AGREEMENT || self.model.has_strands() {
            let start = self.work.x.clone();
            self.correct(&start, info.decrease(), &mut info);
            self.refine(&mut info);
        }
        info
    }

    /// Solves once more, accurately, if the last solve was rough.
    fn refine(&mut self, info: &mut NewtonInfo) {
        if info.cg.residual > self.params.cg_tolerance {
            self.repulsion.settle(&self.work.trial);
            self.work.start_from_trial();
            info.add(&self.iterate(Accuracy::Full));
        }
    }

    /// The same with springs: contacts are guessed, the guess is improved by what it led to, and only then is the way
    /// corrected. The guess is where inertia leads; in a heap that comes down half of it is wrong, and corrections of a way
    /// among wrong contacts are for nothing.
    ///
    /// A spring that pulls, wrongly, can only do so within this bound: the potential without springs must not end above
    /// where it started, but by what pressed springs had stored, so that no energy comes from them (a target of implicit
    /// Euler keeps elastic and kinetic energy below those before). Where it does, springs are settled further, which nearly
    /// always ends it at once; or else the target is made without them, as if nothing were in the way.
    fn approach_contacts(&mut self) -> NewtonInfo {
        let (start, imposed) = (self.work.x.clone(), self.work.imposed.clone());
        let mut placed = start.clone();
        add_scaled(&mut placed, 1.0, &imposed);
        let [kinetic, internal] = self.energies_at(&placed);
        let most =
            *self.step.most.get_or_insert(kinetic + internal + NO_GAIN * (kinetic.abs() + internal.abs()));

        let accuracy = if self.step.last_target.is_none() { Accuracy::Full } else { Accuracy::Rough };
        let first = self.iterate(accuracy);
        let (mut info, mut last) = (first, first);
        for iteration in 0..MOST_SETTLING {
            let tolerated = if iteration < SETTLING_ITERATIONS { SETTLED } else { UNSETTLED };
            if self.repulsion.settle(&self.work.trial) <= tolerated {
                break;
            }
            self.work.start_from_trial();
            last = self.iterate(Accuracy::Rough);
            info.add(&last);
        }
        if self.model.has_strands() || last.agreement < AGREEMENT {
            self.correct(&start, first.decrease(), &mut info);
        }
        self.refine(&mut info);

        let most = most + self.repulsion.stored_energy(&placed);
        let gains = |newton: &mut Self| newton.at_trial(Self::energies_at).iter().sum::<f64>() > most;
        for _ in 0..FURTHER_ITERATIONS {
            if !gains(self) {
                return info;
            }
            self.repulsion.settle(&self.work.trial);
            self.work.start_from_trial();
            info.add(&self.iterate(Accuracy::Full));
        }
        if gains(self) {
            self.work.x.copy_from_slice(&start);
            self.work.imposed.copy_from_slice(&imposed);
            tracing::debug!("contacts give energy: a target with ones that only push");
            self.push_only(&mut info);
        }
        info
    }

    /// Makes the target with springs that have no multipliers: they push one way, and friction resists slip from the start of the
    /// step. The line search sees their energy as it is, so that none is gained but what was stored.
    fn push_only(&mut self, info: &mut NewtonInfo) {
        self.repulsion.forget_multipliers(&self.work.x);
        for _ in 0..ONE_SIDED_ITERATIONS {
            let next = self.iterate(Accuracy::Full);
            info.add(&next);
            if !self.repulsion.settle_without_multipliers(&self.work.trial) {
                break;
            }
            self.work.start_from_trial();
        }
    }

    /// Iterations after those of `info`, the first of which started at `start` and lowered the potential by `gained` [J], until
    /// the model is good.
    ///
    /// Where the quadratic model is poor, its minimum is far from that of the potential: left there, stiff bodies
    /// that turn lose most of their motion. A good step after a poor one may only have restored lengths.
    /// What a straw gains by turning is little beside the stretch that a step restores, so that the promise says
    /// nothing about it: strands look at the next step.
    ///
    /// A step that would be cut is tried whole first, whatever it does to the potential: the watchdog technique
    /// (Chamberlain, Powell, Lemarechal and Pedersen 1982). A stiff rod that turns stretches along its straight step, a
    /// line search would stop it there for good, and the next step restores its length.
    fn correct(&mut self, start: &[Vector], mut gained: f64, info: &mut NewtonInfo) {
        let strands = self.model.has_strands();
        let mut arrived = false;
        while !arrived && info.iterations <= self.params.correcting_iterations {
            let shortened = (info.step_length < 1.0).then(|| (self.work.trial.clone(), *info));
            if shortened.is_some() {
                self.work.place(1.0);
            }
            self.work.start_from_trial();
            let mut next = self.iterate(Accuracy::Rough);
            match shortened {
                Some((trial, before)) if next.energy_after >= before.energy_after => {
                    self.work.trial.copy_from_slice(&trial);
                    self.work.start_from_trial();
                    info.add(&next);
                    next = self.iterate(Accuracy::Rough);
                }
                _ => {}
            }
            info.add(&next);
            let moved = largest_distance(&self.work.trial, start, &self.work.free);
            let small = next.max_displacement <= SMALL_CORRECTION * moved;
            gained += next.decrease();
            let missed = (1.0 - next.agreement) * next.decrease();
            let good = next.agreement >= AGREEMENT || !strands && missed <= MISSED * gained;
            let vain = next.decrease() <= VAIN_DECREASE * next.energy_before.abs();
            arrived = small && good || vain;
        }
    }

    /// One iteration.
    fn iterate(&mut self, accuracy: Accuracy) -> NewtonInfo {
        self.linearise();
        let Self { model, params, repulsion, step, work } = self;

        // b = -(g + H p) over free nodes, p the imposed displacement of the prescribed ones.
        let system = System {
            pattern: &model.pattern,
            values: &work.values,
            scalar: &step.scalar,
            repulsion: repulsion.any_pushes().then_some(&**repulsion),
            free: &work.free,
        };
        if work.imposed.iter().any(|p| *p != Vector::zeros()) {
            system.multiply(&work.imposed, &mut work.right_side);
        } else {
            work.right_side.fill(Vector::zeros());
        }
        for ((b, g), &free) in work.right_side.iter_mut().zip(&work.gradient).zip(&work.free) {
            *b = if free { -(*b + g) } else { Vector::zeros() };
        }

        // Guesses: to where inertia leads, and to where the last target was. Near the solution of a step the second is all but
        // exact; in free flight the first is. Corrections start from them too: what is still missing along them is what
        // conjugate gradients find last.
        let guess_count = 1 + usize::from(step.last_target.is_some());
        for (guess, target) in work.guesses.iter_mut().zip([Some(&step.inertial), step.last_target.as_ref()])
        {
            let Some(target) = target else { continue };
            for (node, guess) in guess.iter_mut().enumerate() {
                *guess = if work.free[node] { target[node] - work.x[node] } else { Vector::zeros() };
            }
        }
        let [inertia, last] = &work.guesses;
        let guesses: &[&[Vector]] = &[last.as_slice(), inertia.as_slice()][2 - guess_count..];
        work.preconditioner.build(&system, &work.x);
        let limits = Limits {
            tolerance: params.cg_tolerance,
            own_tolerance: match accuracy {
                Accuracy::Rough => ROUGH,
                Accuracy::Full => 0.0,
            },
            least_scale: work.least_scale,
            max_iterations: params.cg_max_iterations,
        };
        let mut info = NewtonInfo {
            iterations: 1,
            cg: cg::solve(
                &system,
                &mut work.preconditioner,
                &work.right_side,
                guesses,
                limits,
                &mut work.step,
                &mut work.cg,
            ),
            ..NewtonInfo::default()
        };
        if work.least_scale == 0.0 {
            work.least_scale = work.cg.scale();
        }
        let inertia = Inertia {
            per_mass: 1.0 / (step.dt * step.dt) + params.air_drag / step.dt,
            drag: step.drag.as_ref(),
            rate: 1.0 / step.dt,
        };
        restore_momentum(model, repulsion, &inertia, &work.free, work.cg.residual(), &mut work.step);
        self.search_line(&mut info);
        info.max_displacement = largest_distance(&self.work.trial, &self.work.x, &self.work.free);
        info
    }

    /// Fills gradient and H at `work.x`. The first time after they were set, springs get their stiffness, and the guess which
    /// of them push.
    pub fn linearise(&mut self) {
        self.linearise_bodies();
        let Self { model, repulsion, step, work, .. } = self;
        if repulsion.is_empty() {
            return;
        }
        if std::mem::take(&mut step.fresh) {
            let end = |n: usize, x: &Vector| if work.free[n] { *x } else { work.x[n] + work.imposed[n] };
            let placed = |x: &[Vector]| x.iter().enumerate().map(|(n, x)| end(n, x)).collect::<Vec<_>>();
            let iterate = step.last_target.is_some().then(|| placed(&work.x));
            let inertial = placed(&step.inertial);
            let diagonal = &work.values.diagonal;
            repulsion.prepare(model, diagonal, 1.0 / step.dt, &work.free, &inertial, iterate.as_deref());
        }
        repulsion.linearise(&work.x);
        let gradient = work.gradient.par_iter_mut().enumerate().with_min_len(CHUNK);
        gradient.for_each(|(node, gradient)| *gradient += repulsion.gradient(node));
    }

    /// All but repulsion.
    pub fn linearise_bodies(&mut self) {
        let Self { model, params, step, work, .. } = self;
        let motion = Motion { x: &work.x, start: &step.start, rate: 1.0 / step.dt };
        let filter = Filter::new(params.hessian_filter, step.last_target.is_none());
        let known = &mut work.known;
        if known.linearised_at == work.x && known.filter == Some(filter) {
            work.gradient.copy_from_slice(&known.gradient);
            return;
        }
        let inertia = 1.0 / (step.dt * step.dt);
        let drag = params.air_drag / step.dt;

        // Every chunk gets the blocks of its own rows.
        let mut blocks = work.values.blocks.as_mut_slice();
        let mut rows = Vec::new();
        let chunks = work.gradient.chunks_mut(CHUNK).zip(work.values.diagonal.chunks_mut(CHUNK));
        for (chunk, (gradient, diagonal)) in chunks.enumerate() {
            let nodes = chunk * CHUNK..chunk * CHUNK + gradient.len();
            let first_block = model.pattern.starts[nodes.start] as usize;
            let end_block = model.pattern.starts[nodes.end] as usize;
            let (mine, rest) = blocks.split_at_mut(end_block - first_block);
            blocks = rest;
            rows.push(Rows { nodes, gradient, diagonal, blocks: mine, first_block });
        }
        rows.into_par_iter().enumerate().for_each(|(chunk, mut rows)| {
            let near = &step.scalar.near[rows.first_block..];
            for (block, &value) in rows.blocks.iter_mut().zip(near) {
                *block = Matrix3::from_diagonal_element(value);
            }
            for (row, node) in rows.nodes.clone().enumerate() {
                let mass = model.node_masses[node];
                let (x, start) = (motion.x[node], motion.start[node]);
                rows.diagonal[row] =
                    Matrix3::from_diagonal_element(mass * (inertia + drag) + step.scalar.diagonal[node]);
                rows.gradient[row] = (x - step.inertial[node]) * (mass * inertia)
                    + (x - start) * (mass * drag)
                    + model.bending.product(node, motion.x);
                if let Some(damping) = &model.bending_damping {
                    rows.gradient[row] +=
                        (damping.product(node, motion.x) - damping.product(node, motion.start)) * motion.rate;
                }
                if let Some(drag) = &step.drag {
                    rows.diagonal[row] += drag.matrix[node] * motion.rate;
                    rows.gradient[row] += drag.matrix[node] * (x - start) * motion.rate - drag.push[node];
                }
            }
            for family in &model.families {
                family.linearise(chunk, motion, filter, &mut rows);
            }
        });
        known.linearised_at.clone_from(&work.x);
        known.filter = Some(filter);
        known.gradient.clone_from(&work.gradient);
    }

    /// How far `work.x` is from solving the step, with the springs' carried forces for contact forces, as far as nodes are `counted`.
    pub fn residual(&mut self, counted: &[bool]) -> Residual {
        self.linearise_bodies();
        self.repulsion.subtract_carried(&mut self.work.gradient);
        let Self { model, step, work, .. } = self;
        for node in 0..work.x.len() {
            let counts = work.free[node] && counted[node];
            work.right_side[node] = if counts { -work.gradient[node] } else { Vector::zeros() };
        }
        let system = System {
            pattern: &model.pattern,
            values: &work.values,
            scalar: &step.scalar,
            repulsion: None,
            free: &work.free,
        };
        work.preconditioner.build(&system, &work.x);
        work.preconditioner.apply(&work.right_side, &mut work.step);
        let mut largest: f64 = 0.0;
        for component in &model.components {
            let nodes = || (component.start as usize..component.end as usize).filter(|&n| work.free[n]);
            let mass: f64 = nodes().map(|n| model.node_masses[n]).sum();
            let product: f64 = nodes().map(|n| work.right_side[n].dot(&work.step[n])).sum();
            if mass > 0.0 {
                largest = largest.max(product / mass);
            }
        }
        let force = work.right_side.iter().map(Vector::norm_squared).sum::<f64>().sqrt();
        Residual { force, distance: step.dt * largest.sqrt() }
    }

    /// Inertial and inner part of the incremental potential at `x` without repulsion [J].
    fn energies(&self, x: &[Vector]) -> [f64; 2] {
        let Self { model, params, step, .. } = self;
        let free = &self.work.free;
        let motion = Motion { x, start: &step.start, rate: 1.0 / step.dt };
        let inertia = 0.5 / (step.dt * step.dt);
        let drag = 0.5 * params.air_drag / step.dt;
        let chunks = x.len().div_ceil(CHUNK);
        let partial: Vec<[f64; 2]> = (0..chunks)
            .into_par_iter()
            .map(|chunk| {
                let mut kinetic = 0.0;
                for node in chunk * CHUNK..((chunk + 1) * CHUNK).min(x.len()) {
                    if free[node] {
                        let share = inertia * (x[node] - step.inertial[node]).norm_squared()
                            + drag * (x[node] - step.start[node]).norm_squared();
                        kinetic += model.node_masses[node] * share;
                        if let Some(drag) = &step.drag {
                            let moved = x[node] - step.start[node];
                            kinetic += moved
                                .dot(&(drag.matrix[node] * moved * (0.5 * motion.rate) - drag.push[node]));
                        }
                    }
                }
                let elements: f64 = model.families.iter().map(|family| family.energy(chunk, motion)).sum();
                [kinetic, elements + model.bending.chunk_energy(chunk, x)]
            })
            .collect();
        let (mut kinetic, mut internal) = (0.0, 0.0);
        for [k, i] in partial {
            kinetic += k;
            internal += i;
        }
        if let Some(damping) = &model.bending_damping {
            let moved: Vec<Vector> = x.iter().zip(&step.start).map(|(x, x0)| x - x0).collect();
            internal += damping.energy(&moved) / step.dt;
        }
        [kinetic, internal]
    }

    /// The same, not computed again where they were computed last.
    fn energies_at(&mut self, x: &[Vector]) -> [f64; 2] {
        if self.work.known.energies_at != x {
            self.work.known.energies = self.energies(x);
            self.work.known.energies_at.clear();
            self.work.known.energies_at.extend_from_slice(x);
        }
        self.work.known.energies
    }

    /// Incremental potential at `x`, and the size of its largest term: what rounding is relative to [J].
    pub fn potential(&mut self, x: &[Vector]) -> (f64, f64) {
        let [kinetic, mut internal] = self.energies_at(x);
        internal += self.repulsion.energy(x);
        (kinetic + internal, kinetic.abs() + internal.abs())
    }

    /// Calls `evaluate` with the trial.
    fn at_trial<T>(&mut self, evaluate: impl FnOnce(&mut Self, &[Vector]) -> T) -> T {
        let trial = std::mem::take(&mut self.work.trial);
        let value = evaluate(self, &trial);
        self.work.trial = trial;
        value
    }

    /// Backtracking from the full Newton step; leaves the target in `work.trial`.
    ///
    /// Prescribed nodes are at their keyframes from the first trial on: the line runs over free nodes
    /// only, from the state with free nodes at x. The predicted decrease is that of the quadratic model
    /// from there, p.b. Should no trial pass (the keyframes jump far, so that the model is poor), the
    /// lowest is taken.
    fn search_line(&mut self, info: &mut NewtonInfo) {
        self.work.place(0.0);
        let (before, scale) = self.at_trial(Self::potential);
        info.energy_before = before;
        let predicted = dot(&self.work.step, &self.work.right_side);
        // Maxima are the same in any order.
        let largest = |values: &[Vector]| values.iter().map(|v| v.amax()).fold(0.0, f64::max);
        let halvings = self.params.line_search_halvings;
        let accept = halvings == 0 || largest(&self.work.step) <= NEGLIGIBLE_STEP * largest(&self.work.x);
        let mut best = (f64::INFINITY, 1.0);
        let mut length = 1.0;
        for halving in 0..=halvings {
            self.work.place(length);
            let (energy, terms) = self.at_trial(Self::potential);
            if energy < best.0 {
                best = (energy, length);
            }
            let slack = ENERGY_ROUNDING * scale.max(terms);
            let passes = energy <= before - self.params.line_search_decrease * length * predicted + slack;
            if passes || accept {
                (info.energy_after, info.step_length) = (energy, length);
                let model = predicted * length * (1.0 - 0.5 * length);
                let kept = (before - energy) / model;
                info.agreement =
                    if accept || model <= slack { 1.0 } else { length.min(kept).min(1.0 / kept) };
                return;
            }
            if halving < halvings {
                length *= 0.5;
            }
        }
        (info.energy_after, info.step_length) = best;
        self.work.place(best.1);
        tracing::debug!(step_length = best.1, "no trial of the line search decreased the energy enough");
    }
}

/// Largest |y - x| over free nodes [m].
fn largest_distance(y: &[Vector], x: &[Vector], free: &[bool]) -> f64 {
    let distance = |((y, x), _): ((&Vector, &Vector), &bool)| (y - x).norm();
    y.iter().zip(x).zip(free).filter(|(_, free)| **free).map(distance).fold(0.0, f64::max)
}
