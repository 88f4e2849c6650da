//! What a caller gives with each call.

use crate::multipliers::PairMultipliers;
use bowknot_geometry::Point;
use bowknot_lcp::DistanceLimit;

/// What changes from call to call, beside positions and target.
#[derive(Clone, Copy, Debug, Default)]
pub struct ResolveInput<'a> {
    /// Which vertices are prescribed, one entry per vertex. They move to their targets and yield to nothing,
    /// but wait where they would cut through something. Obstacle vertices always are prescribed. Empty: only
    /// those.
    pub prescribed: &'a [bool],
    /// Time step that the call stands for [s]; it scales the separation speed and the default step limit.
    pub time_step: Option<f64>,
    /// Positions at the start of the time step [m], from which friction measures slip if a time step makes
    /// several calls. None: the positions that the call starts from.
    pub start: Option<&'a [Point]>,
    /// Group of each vertex, [`Self::NO_GROUP`] for none. The prescribed vertices of a group move and wait
    /// together, by the same fraction of their displacements. Every obstacle is a group of its own anyway.
    /// Empty: no groups.
    pub groups: &'a [u32],
    /// Vertices whose contacts the target knows, one entry per vertex; empty: none. Pairs with one of them
    /// that are near at the start of the call only get rows that guard part of their gap: the target is to
    /// decide about the rest.
    pub known: &'a [bool],
    /// What pairs carry at the start, in any order: the first backward step starts from it. Pairs without an
    /// entry carry nothing; entries of pairs that are out of range, or without finite numbers, are left out.
    pub carried: &'a [PairMultipliers],
    /// Edges that may be longer than their stretch limits, because prescribed vertices ask for more, and how
    /// long [m]. Entries below the limit, and of edges without one, change nothing.
    pub yielding: &'a [DistanceLimit],
    /// Largest number of two-way steps, if smaller than that of the parameters, for a caller that continues
    /// from any state.
    pub max_steps: Option<usize>,
}

impl ResolveInput<'_> {
    /// The entry of [`Self::groups`] for vertices in no group.
    pub const NO_GROUP: u32 = u32::MAX;
}
