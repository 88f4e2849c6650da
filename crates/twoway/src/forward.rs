//! The default forward stage.

use crate::{ForwardStep, Problem, Reach, Search, State, Statistics};
use bowknot_geometry::Vector;
use bowknot_stepper::{Bound, StepReport, Stepper};
use std::time::Instant;

/// Longest step of a swept search, in local edge lengths.
const SWEPT_REACH: f64 = 4.0;
/// Radius of the tube around a swept path that a vertex may stray in, in local edge lengths.
const SWEPT_TUBE: f64 = 0.3;
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
    path: Vec<Vector>,
    tubes: Vec<f64>,
}

impl ForwardStep for CertifiedForward {
    fn begin(&mut self, problem: &Problem, _: &State) {
        self.stepper.begin(problem.rest.len());
    }

    fn advance(
        &mut self,
        problem: &Problem,
        state: &mut State,
        search: &mut dyn Search,
        statistics: &mut Statistics,
    ) -> StepReport {
        let clock = Instant::now();
        let searching = statistics.seconds.search;
        self.stepper.aim(&state.x, &state.y);
        let damping = problem.params.stepper.damping;
        let contacts = state.contacts.as_contacts();
        statistics.frozen_pairs += match problem.params.stepper.bound {
            Bound::Planes => self.stepper.limit_by_planes(&contacts, damping),
            Bound::Isotropic => self.stepper.limit_by_distances(&contacts, damping),
        };
        match search.reach() {
            Reach::Distance(unlisted) => self.stepper.limit_by_unlisted(unlisted, damping),
            Reach::Balls(_) if self.wants_far(problem) => {
                self.limit_by_sweep(problem, state, search, statistics);
            }
            Reach::Balls(budgets) => {
                if self.stepper.limit_by_budgets(&state.x, budgets) {
                    search.request();
                }
            }
        }
        self.stepper.limit_by_bodies(&problem.model, &problem.obstacle_vertices);
        state.previous.clone_from(&state.x);
        let report = self.stepper.advance(&mut state.x);
        statistics.seconds.forward += clock.elapsed().as_secs_f64() - (statistics.seconds.search - searching);
        report
    }
}

impl CertifiedForward {
    /// Whether the known pairs would let some vertex travel so far that following it pays.
    fn wants_far(&self, problem: &Problem) -> bool {
        let far = problem.params.stepper.swept_travel * problem.lengths.edge;
        far.is_finite()
            && self.stepper.displacements().iter().enumerate().any(|(v, d)| {
                let length = d.norm();
                length > far && self.stepper.alpha(v) * length > far
            })
    }

    /// Limits the step by every pair that could meet along it, on a clock common to all vertices.
    ///
    /// Vertices are assumed to move along u = alpha_0 d; the search lists every pair whose boxes, moving so and
    /// inflated by the tubes, meet at one and the same time. The planes of the new pairs lower alpha. Where
    /// (alpha_0 - alpha) |d| stays within the tube for all vertices, an unlisted pair cannot meet at any common
    /// time; otherwise alpha_0 is lowered to alpha and the search repeated, and at last the whole step is
    /// scaled: with tau = tube / worst and alpha <- min(alpha, tau alpha_0) the vertices follow the assumed paths
    /// on the clock tau t, and stray by at most tau (alpha_0 - alpha) |d| <= tube, since alpha >= tau alpha.
    fn limit_by_sweep(
        &mut self,
        problem: &Problem,
        state: &mut State,
        search: &mut dyn Search,
        statistics: &mut Statistics,
    ) {
        let count = state.x.len();
        let damping = problem.params.stepper.damping;
        self.tubes.clear();
        for v in 0..count {
            let (length, h) = (self.stepper.displacements()[v].norm(), problem.local_edge[v]);
            self.tubes.push(if length == 0.0 { 0.0 } else { SWEPT_TUBE * h });
            if length > SWEPT_REACH * h {
                self.stepper.limit(v, SWEPT_REACH * h / length);
            }
        }
        self.stepper.limit_by_bodies(&problem.model, &problem.obstacle_vertices);
        for round in 1..=SWEPT_ROUNDS {
            self.assumed.clear();
            self.assumed.extend((0..count).map(|v| self.stepper.alpha(v)));
            self.path.clear();
            self.path.extend(self.stepper.displacements().iter().zip(&self.assumed).map(|(d, a)| *a * *d));
            search.update_swept(problem, state, &self.path, &self.tubes, statistics);
            let contacts = state.contacts.as_contacts();
            statistics.frozen_pairs += self.stepper.limit_by_planes(&contacts, damping);
            self.stepper.limit_by_bodies(&problem.model, &problem.obstacle_vertices);
            let worst = (0..count)
                .filter(|&v| self.tubes[v] > 0.0)
                .map(|v| {
                    let strayed =
                        (self.assumed[v] - self.stepper.alpha(v)) * self.stepper.displacements()[v].norm();
                    strayed / (SWEPT_USABLE * self.tubes[v])
                })
                .fold(0.0, f64::max);
            if worst <= 1.0 {
                return;
            }
            if round == SWEPT_ROUNDS {
                for v in 0..count {
                    self.stepper.limit(v, self.assumed[v] / worst);
                }
            }
        }
    }
}
