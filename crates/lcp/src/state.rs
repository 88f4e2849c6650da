//! The moving part of a problem: positions and multipliers.

use crate::error::LcpError;
use crate::problem::LcpProblem;
use crate::vector::{TangentVector, Vector};

/// Positions and multipliers. The solvers keep `y` consistent with the multipliers: y is y_free plus the
/// moves that [`crate::apply_multipliers`] computes from them.
#[derive(Debug, Default)]
pub struct LcpState<'a> {
    /// Node positions.
    pub y: &'a mut [Vector],
    /// Multiplier of each row.
    pub lambda: &'a mut [f64],
    /// Multiplier f of each distance limit: -f pulls node a, +f pulls node b. It points from b to a where the
    /// limit acts; its norm is the scalar multiplier.
    pub limit_multipliers: &'a mut [Vector],
    /// Multipliers of each friction row along its tangents.
    pub friction: &'a mut [TangentVector],
}

impl LcpState<'_> {
    /// Checks that the arrays have the lengths that the problem needs.
    pub(crate) fn check(&self, problem: &LcpProblem<'_>) -> Result<(), LcpError> {
        let check = |what, given: usize, expected: usize| {
            if given == expected { Ok(()) } else { Err(LcpError::Length { what, given, expected }) }
        };
        check("y", self.y.len(), problem.weights().len())?;
        check("lambda", self.lambda.len(), problem.rows().rows.len())?;
        check("limit_multipliers", self.limit_multipliers.len(), problem.distance_limits().rows.len())?;
        check("friction", self.friction.len(), problem.friction().rows.len())
    }

    /// This state with a shorter borrow.
    pub fn reborrow(&mut self) -> LcpState<'_> {
        LcpState {
            y: self.y,
            lambda: self.lambda,
            limit_multipliers: self.limit_multipliers,
            friction: self.friction,
        }
    }
}
