//! Faults of a problem, and failures of the solvers.

use bowknot_errors::{Errors, ParamError};

/// Why a problem is refused or was not solved.
///
/// `constraint` is "row", "distance limit" or "friction row".
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LcpError {
    /// Two arrays that belong together have different lengths.
    #[error("{what} has {given} entries where {expected} are needed")]
    Length {
        /// The array.
        what: &'static str,
        /// Its length.
        given: usize,
        /// The length it should have.
        expected: usize,
    },
    /// A constraint names a node that does not exist.
    #[error("{constraint} {index} names node {node}, but there are only {nodes} nodes")]
    UnknownNode {
        /// Type of the constraint.
        constraint: &'static str,
        /// Index of the constraint.
        index: usize,
        /// The node it names.
        node: u32,
        /// How many nodes there are.
        nodes: usize,
    },
    /// A friction row names a normal row that does not exist.
    #[error("friction row {index} names row {normal} as its normal, but there are only {rows} rows")]
    UnknownNormal {
        /// Index of the friction row.
        index: usize,
        /// The normal row it names.
        normal: u32,
        /// How many rows there are.
        rows: usize,
    },
    /// A friction row cannot be swept with a row that is not its normal's.
    #[error(
        "friction row {friction} cannot be swept with row {row}: it does not exist, has another normal or \
         other nodes"
    )]
    Attached {
        /// The row.
        row: usize,
        /// The friction row named for it.
        friction: u32,
    },
    /// An inverse weight is negative, infinite or NaN.
    #[error("the inverse weight of node {node} is {value}; it must be finite and at least 0")]
    Weight {
        /// The node.
        node: usize,
        /// Its inverse weight.
        value: f64,
    },
    /// The `inverse_diagonal` of a constraint was never computed; see [`crate::prepare_rows`].
    #[error("{constraint} {index} was not prepared: its inverse diagonal is NaN")]
    NotPrepared {
        /// Type of the constraint.
        constraint: &'static str,
        /// Index of the constraint.
        index: usize,
    },
    /// The `starts` of a schedule decrease or do not end where the list ends.
    #[error("the color starts of the {constraint}s must rise from 0 to {expected}")]
    Starts {
        /// Type of the constraints.
        constraint: &'static str,
        /// Where the last color must end.
        expected: usize,
    },
    /// The `order` of a schedule names a constraint that does not exist.
    #[error("the order of the {constraint}s names {index}, but there are only {count}")]
    Order {
        /// Type of the constraints.
        constraint: &'static str,
        /// The index it names.
        index: u32,
        /// How many of these constraints there are.
        count: usize,
    },
    /// Two constraints of one color share a node that can move.
    #[error("{constraint}s {first} and {second} of color {color} share node {node}, which can move")]
    Color {
        /// Type of the constraints.
        constraint: &'static str,
        /// The color.
        color: usize,
        /// The constraint that comes first.
        first: usize,
        /// The constraint that clashes with it.
        second: usize,
        /// The node that they share.
        node: u32,
    },
    /// Parameters are out of range.
    #[error(transparent)]
    Parameters(#[from] Errors<ParamError>),
    /// A solver stopped at its largest number of sweeps. The state holds the last iterate.
    #[error("not converged: after {sweeps} sweeps the residual is {residual:e}")]
    NotConverged {
        /// Sweeps done.
        sweeps: u32,
        /// Residual of the last one, in the unit of the row values.
        residual: f64,
    },
    /// No node positions satisfy all rows together. Only the exact solver can find this out.
    #[error("infeasible: row {row} contradicts others")]
    Infeasible {
        /// The row that could not be added.
        row: usize,
    },
    /// A number that must be finite is not.
    #[error("{what} {index} is not finite")]
    NotFinite {
        /// What the number belongs to.
        what: &'static str,
        /// Its index.
        index: usize,
    },
}
