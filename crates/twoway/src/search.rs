//! The default search stage: searches when budgets are used up, and only refreshes contact geometry otherwise.

use crate::{FLOOR_MARGIN, Problem, Reach, Search, State, Statistics};
use bowknot_constraints::{DesiredDistance, FrictionModel};
use bowknot_geometry::{PairKind, Separation, Vector, separation};
use bowknot_proximity::{PairList, ProximitySearch};
use bowknot_stepper::{Budget, Budgets};
use rayon::prelude::*;
use std::time::Instant;

/// Pairs that one parallel task evaluates at least.
const CHUNK: usize = 1024;

/// The default [`Search`].
#[derive(Debug)]
pub struct BudgetedSearch {
    search: ProximitySearch,
    budget: Budget,
    budgets: Budgets,
    /// Search radii handed down: budget plus half of the range within which pairs matter.
    radii: Vec<f64>,
    /// The paper's D^(l), for the uniform budget.
    unlisted: f64,
    requested: bool,
    /// The list before the present one, to carry over what belongs to pairs.
    old: PairList,
    moved: Vec<bool>,
}

impl BudgetedSearch {
    /// A search over the problem's primitives.
    pub fn new(problem: &Problem) -> Self {
        Self {
            search: ProximitySearch::new(&problem.model),
            budget: problem.params.stepper.budget,
            budgets: Budgets::default(),
            radii: Vec::new(),
            unlisted: 0.0,
            requested: true,
            old: PairList::default(),
            moved: Vec::new(),
        }
    }

    fn set_budgets(&mut self, problem: &Problem, state: &State) {
        let params = &problem.params.stepper;
        self.budgets.anchors.clone_from(&state.x);
        self.budgets.radii.clear();
        match params.budget {
            Budget::PerVertex => {
                let (low, high) = (params.budget_min, params.budget_max);
                self.budgets.radii.extend(
                    state.x.iter().zip(&state.y).zip(&problem.local_edge).enumerate().map(
                        |(v, ((x, y), h))| {
                            let wanted = Budgets::radius_for((y - x).norm());
                            // A prescribed vertex with nowhere to go, such as an obstacle at rest, stays put.
                            if wanted == 0.0 && problem.prescribed[v] {
                                0.0
                            } else {
                                wanted.clamp(low * h, high * h)
                            }
                        },
                    ),
                );
                let bodies = problem.model.vertex_body();
                let margin = |body: &u32| problem.spacing.margin(*body);
                self.radii.clear();
                self.radii.extend(self.budgets.radii.iter().zip(bodies).map(|(r, body)| r + margin(body)));
            }
            Budget::Uniform => {
                let radius = params.budget_max * problem.spacing.largest_delta();
                self.unlisted = 2.0 * radius;
                self.budgets.radii.resize(state.x.len(), radius);
                self.radii.clear();
                self.radii.extend_from_slice(&self.budgets.radii);
            }
        }
    }

    /// Carries what belongs to pairs over to the new list, and sets it up for new ones.
    fn inherit(&mut self, problem: &Problem, state: &mut State, statistics: &mut Statistics) {
        let contacts = &mut state.contacts;
        let inherited = contacts.pairs.match_with(&self.old);
        let growth = state.time_step.map_or(f64::INFINITY, |dt| problem.lengths.separation_speed * dt);
        let model = &problem.model;
        let (pairs, separations) = (&contacts.pairs, &contacts.separations);
        let (old_desired, old_multipliers) = (&contacts.desired, &contacts.multipliers);
        let old_floors = &contacts.floors;
        let values: Vec<Inherited> = inherited
            .par_iter()
            .enumerate()
            .with_min_len(CHUNK)
            .map(|(p, &old)| match old_desired.get(old as usize) {
                Some(&desired) => Inherited {
                    desired,
                    floor: old_floors[old as usize],
                    multiplier: old_multipliers[old as usize],
                    lowered: false,
                },
                None => {
                    let (kind, pair) = (pairs.kind(p), &pairs.pairs()[p]);
                    let spacing = problem.spacing.of(model, kind, pair);
                    let rule = DesiredDistance { delta: spacing.delta, growth };
                    let separation = &separations[p];
                    let (desired, lowered) = rule.of(model, kind, pair, &problem.rest, separation.distance);
                    let floor = match spacing.floor {
                        None => problem.lengths.floor.min(0.1 * desired),
                        Some(floor) => {
                            // Neighbours have the floor that their rest distance has room for; a tighter start
                            // has its own gap for a floor, from which it grows call by call.
                            let (at_ease, _) = rule.at_ease(model, kind, pair, &problem.rest);
                            floor.min(at_ease / FLOOR_MARGIN).min(separation.width.max(0.0))
                        }
                    };
                    Inherited { desired, floor, multiplier: 0.0, lowered }
                }
            })
            .collect();
        statistics.lowered_pairs += values.iter().filter(|v| v.lowered).count();
        contacts.desired.clear();
        contacts.desired.extend(values.iter().map(|v| v.desired));
        contacts.multipliers.clear();
        contacts.multipliers.extend(values.iter().map(|v| v.multiplier));
        if problem.friction_model() == FrictionModel::Coulomb {
            let old = std::mem::take(&mut contacts.friction_multipliers);
            contacts.friction_multipliers.extend(
                inherited.iter().map(|&p| old.get(p as usize).copied().unwrap_or_else(Vector::zeros)),
            );
            contacts.frictions.clear();
            for kind in PairKind::ALL {
                let list = &contacts.pairs.pairs()[contacts.pairs.range(kind)];
                let friction = |pair| problem.contact.friction_of_pair(model, kind, pair);
                contacts.frictions.extend(list.iter().map(friction));
            }
        }
        contacts.floors.clear();
        contacts.floors.extend(values.iter().map(|v| v.floor));
    }

    fn evaluate_moved(&mut self, problem: &Problem, state: &mut State, statistics: &mut Statistics) {
        self.moved.clear();
        self.moved.extend(state.x.iter().zip(&state.previous).map(|(a, b)| a != b));
        let (moved, x) = (&self.moved, &state.x);
        let pairs = &state.contacts.pairs;
        let half_spaces = problem.model.half_spaces();
        let mut reused = 0;
        for kind in PairKind::ALL {
            let range = pairs.range(kind);
            let list = &pairs.pairs()[range.clone()];
            reused += state.contacts.separations[range]
                .par_iter_mut()
                .zip(list)
                .with_min_len(CHUNK)
                .map(|(slot, pair)| {
                    let count = kind.vertex_count();
                    if !pair.vertices[..count].iter().any(|&v| moved[v as usize]) {
                        return 1usize;
                    }
                    *slot = evaluate(kind, &pair.vertices, pair.elements[1], x, half_spaces);
                    0
                })
                .sum::<usize>();
        }
        statistics.skipped.evaluations += reused;
    }
}

/// What belongs to a pair from search to search.
struct Inherited {
    desired: f64,
    floor: f64,
    multiplier: f64,
    lowered: bool,
}

/// Contact geometry of a pair at `x`.
pub(crate) fn evaluate(
    kind: PairKind,
    vertices: &[u32; 4],
    half_space: u32,
    x: &[bowknot_geometry::Point],
    half_spaces: &[bowknot_geometry::HalfSpace],
) -> Separation {
    match kind {
        PairKind::VertexHalfSpace => {
            separation::separate_half_space(&x[vertices[0] as usize], &half_spaces[half_space as usize])
        }
        _ => separation::separate(kind, &vertices.map(|v| x[v as usize])),
    }
}

impl Search for BudgetedSearch {
    fn begin(&mut self, _: &Problem, state: &mut State) {
        self.requested = true;
        self.old = PairList::default();
        state.contacts.pairs = PairList::default();
        state.contacts.desired.clear();
        state.contacts.multipliers.clear();
        state.contacts.frictions.clear();
        state.contacts.friction_multipliers.clear();
    }

    fn update(&mut self, problem: &Problem, state: &mut State, statistics: &mut Statistics) {
        let params = &problem.params.stepper;
        if params.budget == Budget::Uniform && !self.requested {
            let moved = state.x.iter().zip(&state.previous).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            self.unlisted -= 2.0 * moved * (1.0 + 1e-12);
            self.requested = self.unlisted < 2.0 * params.budget_min * problem.spacing.largest_delta();
        }
        if !self.requested {
            statistics.skipped.searches += 1;
            return self.refresh(problem, state, statistics);
        }
        let clock = Instant::now();
        self.set_budgets(problem, state);
        std::mem::swap(&mut self.old, &mut state.contacts.pairs);
        let contacts = &mut state.contacts;
        self.search.search(
            &problem.model,
            &state.x,
            &self.radii,
            &mut contacts.pairs,
            &mut contacts.separations,
        );
        self.inherit(problem, state, statistics);
        self.requested = false;
        statistics.searches += 1;
        statistics.seconds.search += clock.elapsed().as_secs_f64();
    }

    fn update_swept(
        &mut self,
        problem: &Problem,
        state: &mut State,
        displacements: &[Vector],
        deviations: &[f64],
        statistics: &mut Statistics,
    ) {
        let clock = Instant::now();
        // No margin for contacts to come: the next update searches again, and lists them.
        self.radii.clear();
        // But for floors: what is not listed must not fall below them.
        let bodies = problem.model.vertex_body();
        let margin = |body: &u32| problem.spacing.floor_margin(*body);
        self.radii.extend(deviations.iter().zip(bodies).map(|(d, body)| d + margin(body)));
        std::mem::swap(&mut self.old, &mut state.contacts.pairs);
        let contacts = &mut state.contacts;
        self.search.search_swept(
            &problem.model,
            &state.x,
            displacements,
            &self.radii,
            &mut contacts.pairs,
            &mut contacts.separations,
        );
        self.inherit(problem, state, statistics);
        self.requested = true;
        statistics.searches += 1;
        statistics.seconds.search += clock.elapsed().as_secs_f64();
    }

    fn refresh(&mut self, problem: &Problem, state: &mut State, statistics: &mut Statistics) {
        let clock = Instant::now();
        self.evaluate_moved(problem, state, statistics);
        statistics.seconds.evaluate += clock.elapsed().as_secs_f64();
    }

    fn request(&mut self) {
        self.requested = true;
    }

    fn reach(&self) -> Reach<'_> {
        match self.budget {
            Budget::PerVertex => Reach::Balls(&self.budgets),
            Budget::Uniform => Reach::Distance(self.unlisted),
        }
    }
}
