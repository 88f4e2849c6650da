//! The borrowed view of a problem: constraints, their schedules, and inverse weights.
//!
//! The problem is the projection of node positions y_free onto the constraints, in the metric of the masses
//! 1/w. The inverse weight w of a node that cannot move is 0:
//!
//! ```text
//! y = y_free + W (J^T lambda + multipliers of distance limits + friction)
//! row:             s = b + sum_k g_k . y_k,   0 <= lambda <= upper,   lambda complementary to s
//! distance limit:  |y_a - y_b| <= L
//! friction:        |lambda_t| <= mu lambda_n, opposing the slip
//! ```

use crate::error::LcpError;
use crate::rows::{Constraint, DistanceLimit, FrictionRow, Row};
use crate::schedule::{ConstraintSet, Schedule};

/// A checked problem: every index is in range, every row prepared, every weight finite.
///
/// A sweep visits the distance limits first, then the rows, then friction: the rows (contacts) come later
/// than the distance limits, so a sweep leaves them less violated. With [`LcpProblem::attach_friction`] each
/// friction row is visited right after its normal's row.
#[derive(Clone, Copy, Debug)]
pub struct LcpProblem<'a> {
    weights: &'a [f64],
    rows: ConstraintSet<'a, Row>,
    distance_limits: ConstraintSet<'a, DistanceLimit>,
    friction: ConstraintSet<'a, FrictionRow>,
    /// Friction row of each row, or empty.
    attached: &'a [u32],
}

impl<'a> LcpProblem<'a> {
    /// The entry of [`Self::attach_friction`] for a row without friction.
    pub const NO_FRICTION: u32 = u32::MAX;

    /// Checks the parts and keeps them. `weights[i]` >= 0 is the inverse weight of node i. Cost: one pass
    /// over the indices. Colors are not checked, see [`crate::validate_colors`].
    ///
    /// # Errors
    /// The first fault: [`LcpError::Weight`], [`LcpError::UnknownNode`], [`LcpError::UnknownNormal`],
    /// [`LcpError::NotPrepared`], [`LcpError::Starts`], [`LcpError::Order`].
    pub fn new(
        weights: &'a [f64],
        rows: ConstraintSet<'a, Row>,
        distance_limits: ConstraintSet<'a, DistanceLimit>,
        friction: ConstraintSet<'a, FrictionRow>,
    ) -> Result<Self, LcpError> {
        if let Some(node) = weights.iter().position(|w| !(w.is_finite() && *w >= 0.0)) {
            return Err(LcpError::Weight { node, value: weights[node] });
        }
        check_set(&rows, weights.len())?;
        check_set(&distance_limits, weights.len())?;
        check_set(&friction, weights.len())?;
        match friction.rows.iter().position(|f| f.normal as usize >= rows.rows.len()) {
            Some(row) => {
                let normal = friction.rows[row].normal;
                Err(LcpError::UnknownNormal { index: row, normal, rows: rows.rows.len() })
            }
            None => Ok(Self { weights, rows, distance_limits, friction, attached: &[] }),
        }
    }

    /// A problem of rows alone, in the order of the slice.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of_rows(weights: &'a [f64], rows: &'a [Row]) -> Result<Self, LcpError> {
        Self::new(weights, ConstraintSet::serial(rows), ConstraintSet::default(), ConstraintSet::default())
    }

    /// This problem with other distance limits. Cost: one pass over their indices; nothing else is
    /// checked again. It serves where limits are added between sweeps.
    ///
    /// # Errors
    /// As [`Self::new`], for the distance limits.
    pub fn with_distance_limits(
        self,
        distance_limits: ConstraintSet<'a, DistanceLimit>,
    ) -> Result<Self, LcpError> {
        check_set(&distance_limits, self.weights.len())?;
        Ok(Self { distance_limits, ..self })
    }

    /// Makes Gauss-Seidel sweeps visit each friction row right after its normal's row, rather than all
    /// friction rows after all rows: the rows of one contact are solved together. `friction_of` names the
    /// friction row of each row, or [`Self::NO_FRICTION`]. Friction rows then have no schedule of their own.
    /// Colors stay valid, because a friction row has the nodes of its normal's row.
    ///
    /// # Errors
    /// [`LcpError::Length`]; [`LcpError::Attached`] for a friction row that does not exist, has another
    /// normal, or moves a node that its normal's row does not have.
    pub fn attach_friction(mut self, friction_of: &'a [u32]) -> Result<Self, LcpError> {
        let rows = self.rows.rows;
        if friction_of.len() != rows.len() {
            return Err(LcpError::Length {
                what: "friction_of",
                given: friction_of.len(),
                expected: rows.len(),
            });
        }
        for (row, &friction) in friction_of.iter().enumerate().filter(|(_, f)| **f != Self::NO_FRICTION) {
            let fits = self.friction.rows.get(friction as usize).is_some_and(|f| {
                let nodes = &rows[row].vertices;
                let moved = |v: &&u32| self.weights[**v as usize] != 0.0;
                f.normal as usize == row && f.vertices.iter().filter(moved).all(|v| nodes.contains(v))
            });
            if !fits {
                return Err(LcpError::Attached { row, friction });
            }
        }
        self.attached = friction_of;
        Ok(self)
    }

    /// The friction row of each row, as given to [`Self::attach_friction`]; empty if friction rows have their
    /// own schedule.
    pub fn attached(&self) -> &'a [u32] {
        self.attached
    }

    /// Inverse weight of each node.
    pub fn weights(&self) -> &'a [f64] {
        self.weights
    }

    /// The rows.
    pub fn rows(&self) -> ConstraintSet<'a, Row> {
        self.rows
    }

    /// The distance limits.
    pub fn distance_limits(&self) -> ConstraintSet<'a, DistanceLimit> {
        self.distance_limits
    }

    /// The friction rows.
    pub fn friction(&self) -> ConstraintSet<'a, FrictionRow> {
        self.friction
    }
}

fn check_set<T: Constraint>(set: &ConstraintSet<'_, T>, nodes: usize) -> Result<(), LcpError> {
    let (name, count) = (T::NAME, set.rows.len());
    for (index, item) in set.rows.iter().enumerate() {
        if let Some(&node) = item.nodes().iter().find(|&&v| v as usize >= nodes) {
            return Err(LcpError::UnknownNode { constraint: name, index, node, nodes });
        }
        if !item.prepared() {
            return Err(LcpError::NotPrepared { constraint: name, index });
        }
    }
    let Schedule { order, starts } = set.schedule;
    if let Some(&index) = order.unwrap_or_default().iter().find(|&&r| r as usize >= count) {
        return Err(LcpError::Order { constraint: name, index, count });
    }
    let expected = set.swept();
    let rising = starts.windows(2).all(|w| w[0] <= w[1]);
    let spans = starts.first() == Some(&0) && starts.last().map(|&end| end as usize) == Some(expected);
    if starts.is_empty() || (rising && spans) {
        Ok(())
    } else {
        Err(LcpError::Starts { constraint: name, expected })
    }
}
