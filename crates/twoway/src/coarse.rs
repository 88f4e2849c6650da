//! The coarse correction of the backward step: one factor for all multipliers.

use crate::chunks::{self, Chunks};
use bowknot_geometry::Vector;
use bowknot_lcp as lcp;
use std::ops::Range;

/// Range of the factor. The linear model that it comes from is not valid beyond.
const MIN_FACTOR: f64 = 0.3;
const MAX_FACTOR: f64 = 2.0;

/// Largest growth of the multipliers in a call. In the 61st time step of `bow-knot` at scale 1, with chains
/// of 600 taut edges, the first 16 sweeps ask for 870.
const MAX_GROWTH: f64 = 1e3;

/// Largest number of corrections in a backward step. They remove the large error that sweeps begin with. With
/// friction there is no energy that all of them lower, and in heaps of grains, which take thousands of
/// sweeps, corrections without end keep the multipliers from converging.
const MAX_CORRECTIONS: usize = 64;

/// Whether a friction multiplier is at its bound: the contact slides.
pub(crate) fn is_sliding(row: &lcp::FrictionRow, normal: f64, multiplier: lcp::TangentVector) -> bool {
    multiplier.norm() >= (1.0 - 1e-9) * row.friction * normal
}

/// The coarse correction: one factor s for all multipliers, the maximizer of the dual along that ray.
///
/// With delta = y - y' = W J^T lambda, scaling by s moves y to y' + s delta and each row value linearly. The
/// dual's derivative vanishes where
///
/// sum lambda_p c_p(y) + sum (L |f| - f . (y_a - y_b)) = (1 - s) sum |delta|^2 / w.
///
/// Friction scales with its normals, so it stays within its cone. A sticking contact is the equation
/// slip = 0 and counts with lambda_t . slip. A sliding contact is solved by any slip opposite to its
/// multiplier (in De Saxce's form, lambda (c + mu |slip|) + lambda_t . slip = 0 for every such slip) and does
/// not count.
///
/// In a call it multiplies the multipliers by a bounded factor in all. Where rows contradict each other, such
/// as between pins too far apart, the dual has no maximum. The growing multipliers of such rows would raise
/// all others, those of other bodies included.
#[derive(Debug)]
pub(crate) struct CoarseCorrection {
    /// The factor by which multipliers may still grow. It increases when they shrink.
    growth_left: f64,
    /// Corrections left in the backward step.
    corrections_left: usize,
    sums: Chunks<f64>,
}

impl Default for CoarseCorrection {
    fn default() -> Self {
        Self { growth_left: MAX_GROWTH, corrections_left: 0, sums: Chunks::default() }
    }
}

impl CoarseCorrection {
    /// Starts a call.
    pub fn begin(&mut self) {
        self.growth_left = MAX_GROWTH;
    }

    /// Starts a backward step.
    pub fn begin_step(&mut self) {
        self.corrections_left = MAX_CORRECTIONS;
    }

    /// Scales the multipliers, and y with them. Vertices that are not `touched`, if that is given, have y =
    /// y'.
    pub fn apply(
        &mut self,
        system: &lcp::LcpProblem<'_>,
        free: &[Vector],
        touched: Option<&[u32]>,
        state: &mut lcp::LcpState<'_>,
    ) {
        let Some(left) = self.corrections_left.checked_sub(1) else { return };
        self.corrections_left = left;
        // From a good share on, all vertices in order take less time.
        let touched = touched.filter(|touched| 3 * touched.len() < free.len());
        let best = self.best_factor(system, free, touched, state);
        if !best.is_finite() {
            return;
        }
        let s = best.clamp(MIN_FACTOR, MAX_FACTOR.min(self.growth_left).max(1.0));
        self.growth_left /= s;
        chunks::for_each(state.lambda, |_, l| *l *= s);
        chunks::for_each(state.limit_multipliers, |_, f| *f *= s);
        chunks::for_each(state.friction, |_, f| *f *= s);
        let weights = system.weights();
        let scale = |v: usize, y: &mut Vector| {
            if weights[v] > 0.0 {
                *y = free[v] + s * (*y - free[v]);
            }
        };
        match touched {
            None => chunks::for_each(state.y, scale),
            Some(touched) => touched.iter().for_each(|&v| scale(v as usize, &mut state.y[v as usize])),
        }
    }

    /// The maximizer. It is not finite if no multiplier acts.
    fn best_factor(
        &mut self,
        system: &lcp::LcpProblem<'_>,
        free: &[Vector],
        touched: Option<&[u32]>,
        state: &lcp::LcpState<'_>,
    ) -> f64 {
        let (rows, limits) = (system.rows().rows.len(), system.distance_limits().rows.len());
        let slack = self.sums.sum(rows, |range| slack_of_rows(system, state, range))
            + self.sums.sum(limits, |range| slack_of_limits(system, state, range));
        let energy = |v: usize| {
            let weight = system.weights()[v];
            if weight > 0.0 { (state.y[v] - free[v]).norm_squared() / weight } else { 0.0 }
        };
        let energy = match touched {
            None => self.sums.sum(free.len(), |range| range.map(energy).sum()),
            Some(touched) => {
                self.sums.sum(touched.len(), |range| touched[range].iter().map(|&v| energy(v as usize)).sum())
            }
        };
        1.0 - slack / energy
    }
}

/// Sum of lambda c(y) over rows, and of lambda_t . slip over the sticking ones. A row without a multiplier
/// has no friction either.
fn slack_of_rows(system: &lcp::LcpProblem<'_>, state: &lcp::LcpState<'_>, range: Range<usize>) -> f64 {
    let (rows, friction) = (system.rows().rows, system.friction().rows);
    let mut slack = 0.0;
    for k in range {
        let lambda = state.lambda[k];
        if lambda <= 0.0 {
            continue;
        }
        slack += lambda * rows[k].value(state.y);
        if let Some(&f) = system.attached().get(k)
            && f != lcp::LcpProblem::NO_FRICTION
        {
            let (row, multiplier) = (&friction[f as usize], state.friction[f as usize]);
            if multiplier != lcp::TangentVector::zeros() && !is_sliding(row, lambda, multiplier) {
                slack += multiplier.dot(&row.slip(state.y));
            }
        }
    }
    slack
}

/// Sum of L |f| - f . (y_a - y_b) over distance limits.
fn slack_of_limits(system: &lcp::LcpProblem<'_>, state: &lcp::LcpState<'_>, range: Range<usize>) -> f64 {
    let mut slack = 0.0;
    for (limit, force) in
        system.distance_limits().rows[range.clone()].iter().zip(&state.limit_multipliers[range])
    {
        if *force != Vector::zeros() {
            let [a, b] = limit.vertices.map(|v| v as usize);
            slack += limit.limit * force.norm() - force.dot(&(state.y[a] - state.y[b]));
        }
    }
    slack
}
