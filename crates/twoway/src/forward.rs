//! The default forward stage.

use crate::{ForwardStep, Problem, Reach, Search, State, Statistics};
use bowknot_geometry::Vector;
use bowknot_stepper::{Bound, StepReport, Stepper};

/// Longest step of a swept search, in local edge lengths.
const SWEPT_REACH: f64 = 4.0;
/// Radius of the tube around a swept path that a vertex may stray in, in local edge lengths. Small enough that
/// neighbours in the mesh, some third of an edge apart, stay clear of each other.
const SWEPT_TUBE: f64 = 0.1;
/// Share of that radius that may really be used; the rest covers rounding.
const SWEPT_USABLE: f64 = 1.0 - 1e-3;
/// Searches along one step before it is shortened instead.
const SWEPT_ROUNDS: usize = 3;

/// The default [`ForwardStep`].
#[derive(Debug, Default)]
pub struct CertifiedForward {
    stepper: Stepper,
    /// Step sizes that the swept search assumed.
    assumed: Vec<f64>,
    paths: Vec<Vector>,
    tubes: Vec<f64>,
    /// Whether a long step of this call had to be cut short: hard contact, where looking far ahead does not pay.
    crowded: bool,
}

impl ForwardStep for CertifiedForward {
    fn begin(&mut self, problem: &Problem, _: &State) {
        self.stepper.begin(problem.rest.len());
        self.stepper.set_groups(&problem.groups);
        self.crowded = false;
    }

    fn advance(
        &mut self,
        problem: &Problem,
        state: &mut State,
        search: &mut dyn Search,
        statistics: &mut Statistics,
    ) -> StepReport {
        self.stepper.aim(&state.x, &state.y);
        if !self.sweep(problem, state, search, statistics) {
            let damping = problem.params.stepper.damping;
            let contacts = state.contacts.as_contacts();
            statistics.frozen_pairs += match problem.params.stepper.bound {
                Bound::Planes => self.stepper.limit_by_planes(&contacts, damping),
                Bound::Isotropic => self.stepper.limit_by_distances(&contacts, damping),
            };
            match search.reach() {
                Reach::Distance(unlisted) => {
                    let room = unlisted - problem.spacing.largest_floor();
                    self.stepper.limit_by_unlisted(room, damping);
                }
                Reach::Balls(budgets) => {
                    if self.stepper.limit_by_budgets(&state.x, budgets) {
                        search.request();
                    }
                }
            }
        }
        self.limit_bodies(problem);
        state.previous.clone_from(&state.x);
        self.stepper.advance(&mut state.x)
    }
}

impl CertifiedForward {
    /// Takes a long step where one pays, as long as no contact pushes: limits it by every pair that could meet along it, on a clock common to
    /// all vertices. Returns whether it did; if not, the step sizes so far are valid limits, not yet all.
    ///
    /// Vertices are assumed to move along u = alpha_0 d; the search lists every pair whose boxes, moving so and
    /// inflated by the tubes, meet at one and the same time. A listed pair whose slab stays open when it is carried
    /// along is as safe as an unlisted one while every vertex stays in its tube; the others' planes lower alpha. Where
    /// (alpha_0 - alpha) |d| stays within the tube for all vertices, the first two kinds cannot meet at any common
    /// time; otherwise alpha_0 is lowered to alpha and the search repeated, and at last the whole step is
    /// scaled: with tau = tube / worst and alpha <- min(alpha, tau alpha_0) the vertices follow the assumed paths
    /// on the clock tau t, and stray by at most tau (alpha_0 - alpha) |d| <= tube, since alpha >= tau alpha.
    fn sweep(
        &mut self,
        problem: &Problem,
        state: &mut State,
        search: &mut dyn Search,
        statistics: &mut Statistics,
    ) -> bool {
        let params = &problem.params.stepper;
        let far = params.swept_travel * problem.lengths.edge;
        let longest = |stepper: &Stepper| {
            let displacements = stepper.displacements().iter().enumerate();
            displacements.map(|(v, d)| stepper.alpha(v) * d.norm()).fold(0.0, f64::max)
        };
        let usable = params.bound == Bound::Planes && matches!(search.reach(), Reach::Balls(_));
        // What flies ahead of what is held only makes the rows between them harder: long steps then cost searches and
        // steps.
        let pushed = state.contacts.multipliers.iter().any(|&multiplier| multiplier > 0.0);
        if !usable || pushed || self.crowded || !far.is_finite() || longest(&self.stepper) <= far {
            return false;
        }
        let count = state.x.len();
        let damping = params.damping;
        self.tubes.clear();
        for v in 0..count {
            let (length, h) = (self.stepper.displacements()[v].norm(), problem.local_edge[v]);
            self.tubes.push(if length == 0.0 { 0.0 } else { SWEPT_TUBE * h });
            if length > SWEPT_REACH * h {
                self.stepper.limit(v, SWEPT_REACH * h / length);
            }
        }
        // The pairs known so far tell whether anything can go far at all, before any search is paid for.
        self.assume();
        self.limit_beside(problem, state, damping, statistics);
        if longest(&self.stepper) <= far {
            return false;
        }
        for round in 1..=SWEPT_ROUNDS {
            self.assume();
            search.update_swept(problem, state, &self.paths, &self.tubes, statistics);
            self.limit_beside(problem, state, damping, statistics);
            let worst = (0..count)
                .filter(|&v| self.tubes[v] > 0.0)
                .map(|v| {
                    let strayed =
                        (self.assumed[v] - self.stepper.alpha(v)) * self.stepper.displacements()[v].norm();
                    strayed / (SWEPT_USABLE * self.tubes[v])
                })
                .fold(0.0, f64::max);
            if worst <= 1.0 {
                break;
            }
            if round == SWEPT_ROUNDS {
                self.crowded = true;
                for v in 0..count {
                    self.stepper.limit(v, self.assumed[v] / worst);
                }
            }
        }
        true
    }

    /// Takes the present step sizes as what vertices are assumed to do.
    fn assume(&mut self) {
        let displacements = self.stepper.displacements();
        self.assumed.clear();
        self.assumed.extend((0..displacements.len()).map(|v| self.stepper.alpha(v)));
        self.paths.clear();
        self.paths.extend(displacements.iter().zip(&self.assumed).map(|(d, a)| *a * *d));
    }

    /// Limits the step by the listed pairs that would not stay clear along the assumed paths.
    fn limit_beside(&self, problem: &Problem, state: &State, damping: f64, statistics: &mut Statistics) {
        let contacts = state.contacts.as_contacts();
        statistics.frozen_pairs +=
            self.stepper.limit_by_carried_planes(&contacts, &self.paths, &self.tubes, damping);
        self.limit_bodies(problem);
    }

    /// Makes obstacles and groups of pinned vertices go as one.
    fn limit_bodies(&self, problem: &Problem) {
        self.stepper.limit_by_bodies(&problem.model, &problem.obstacle_vertices);
        self.stepper.limit_by_groups(problem.group_count);
    }
}
