//! What can be wrong with a problem, and what a solver can fail at.

/// Why a problem is refused or was not solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
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
    /// A row names a node that does not exist.
    #[error("{family} {row} names node {node}, but there are only {nodes} nodes")]
    UnknownNode {
        /// "row", "ball row" or "friction row".
        family: &'static str,
        /// Index of the row.
        row: usize,
        /// The node it names.
        node: u32,
        /// How many nodes there are.
        nodes: usize,
    },
    /// A friction row names a normal row that does not exist.
    #[error("friction row {row} names row {normal} as its normal, but there are only {rows} rows")]
    UnknownNormal {
        /// Index of the friction row.
        row: usize,
        /// The normal row it names.
        normal: u32,
        /// How many rows there are.
        rows: usize,
    },
    /// A friction row cannot be swept with a row that is not its normal's.
    #[error(
        "friction row {friction} cannot be swept with row {row}: it does not exist, has another normal or other nodes"
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
    /// A row's `inverse_diagonal` was never computed; see [`crate::prepare_rows`].
    #[error("{family} {row} was not prepared: its inverse diagonal is NaN")]
    NotPrepared {
        /// "row" or "friction row".
        family: &'static str,
        /// Index of the row.
        row: usize,
    },
    /// A schedule's `starts` decrease or do not end where the list ends.
    #[error("the colour starts of the {family}s must rise from 0 to {expected}")]
    Starts {
        /// "row", "ball row" or "friction row".
        family: &'static str,
        /// Where the last colour must end.
        expected: usize,
    },
    /// A schedule's `order` names a row that does not exist.
    #[error("the order of the {family}s names {index}, but there are only {rows}")]
    Order {
        /// "row", "ball row" or "friction row".
        family: &'static str,
        /// The index it names.
        index: u32,
        /// How many rows there are.
        rows: usize,
    },
    /// Two rows of one colour share a node that can move.
    #[error("{family}s {first} and {second} of colour {colour} share node {node}, which can move")]
    Colour {
        /// "row", "ball row" or "friction row".
        family: &'static str,
        /// The colour.
        colour: usize,
        /// The row met first.
        first: usize,
        /// The row that clashes with it.
        second: usize,
        /// The node that they share.
        node: u32,
    },
    /// A parameter is out of range.
    #[error("{name} is {value}; it must be {allowed}")]
    Parameter {
        /// The parameter.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The values that it may have.
        allowed: &'static str,
    },
    /// A solver stopped at its limit; the state holds the last iterate.
    #[error("not converged: after {sweeps} sweeps the residual is {residual:e}")]
    NotConverged {
        /// Sweeps done.
        sweeps: u32,
        /// Residual of the last one, in the unit of the row values.
        residual: f64,
    },
    /// No node positions satisfy the rows together; only the exact solver tells.
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
