//! When a call ends, as the device decides it.

use crate::grid::Grid;
use crate::kernels::stop_rule;

/// When a call ends: of the steps of a submission, those after its end are not made. A state meets the rule
/// if it meets all of its conditions. The host, which looks at the same numbers, may end a call after any
/// other submission.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// No vertex is as far from where the step wanted to go [m]; no prescribed vertex is held back otherwise
    /// than by pairs.
    pub distance: f64,
    /// No vertex that no pair holds back is as far from where the step wanted to go [m].
    pub unhindered: f64,
    /// No body has as large a net residual [m].
    pub net_residual: f64,
    /// The largest mean residual of a body is smaller [m], or the last step has not halved it.
    pub mean_residual: f64,
    /// Largest ratio of an edge's length to its limit [1].
    pub stretch_to_limit: f64,
    /// Most steps beyond the rule, made while vertices are not yet where they should be and no contact
    /// presses.
    pub finishing_steps: usize,
}

impl Stop {
    /// A rule that no state meets.
    pub const NEVER: Self = Self {
        distance: 0.0,
        unhindered: 0.0,
        net_residual: 0.0,
        mean_residual: 0.0,
        stretch_to_limit: 0.0,
        finishing_steps: 0,
    };

    /// The rule in quanta, with the length [m] below which and the ratio of an edge to its limit above which
    /// the next step polishes. A length on the device is below a limit here if and only if it is below it in
    /// double precision, since the quantum is a power of two.
    pub(super) fn params(&self, grid: &Grid, polishing: Option<(f64, f64)>) -> stop_rule::Params {
        let below = |limit: f64| rounded_up(limit / grid.quantum());
        let (distance, stretch) = polishing.unwrap_or_default();
        stop_rule::Params {
            distance: below(self.distance),
            unhindered: below(self.unhindered),
            net_residual: below(self.net_residual),
            mean_residual: below(self.mean_residual),
            stretch: rounded_down(self.stretch_to_limit),
            finishing_steps: self.finishing_steps as u32,
            polish_distance: below(distance),
            polish_stretch: rounded_down(stretch),
            polishes: 0,
            after: 0,
            dispatches: 0,
        }
    }
}

/// The smallest `f32` that is not below the number.
fn rounded_up(number: f64) -> f32 {
    let nearest = number as f32;
    if f64::from(nearest) < number { nearest.next_up() } else { nearest }
}

/// The largest `f32` that is not above the number.
fn rounded_down(number: f64) -> f32 {
    let nearest = number as f32;
    if f64::from(nearest) > number { nearest.next_down() } else { nearest }
}

#[cfg(test)]
mod tests {
    use super::{rounded_down, rounded_up};

    #[test]
    fn limits_in_single_precision_divide_its_numbers_as_those_in_double_precision_do() {
        let mut random = fastrand::Rng::with_seed(1);
        for _ in 0..1000 {
            let limit = random.f64() * 1e3;
            let near = limit as f32;
            for x in [near.next_down(), near, near.next_up()] {
                assert_eq!(x < rounded_up(limit), f64::from(x) < limit);
                assert_eq!(x <= rounded_down(limit), f64::from(x) <= limit);
            }
        }
        assert_eq!([rounded_up(0.0), rounded_down(0.0)], [0.0; 2]);
        assert_eq!(rounded_up(f64::INFINITY), f32::INFINITY);
    }
}
