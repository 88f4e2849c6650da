//! The two kinds of targets that collision problems have.

use crate::bench::Size;

/// Where the targets of recorded problems come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Targets {
    /// Bowknot's dynamics with its repulsion: few targets are deep in penetration.
    Aware,
    /// Bowknot's dynamics without repulsion: targets lie deep in penetration. The paper's simulator has a
    /// repulsive model (section 6.2), so these are not the paper's targets.
    Unaware,
}

/// Suffix of the names of problem sets with contact-unaware targets.
pub const UNAWARE_SUFFIX: &str = "-unaware";

impl Targets {
    /// The targets of the problem set of that name.
    pub fn of(problems: &str) -> Self {
        if problems.contains(UNAWARE_SUFFIX) { Self::Unaware } else { Self::Aware }
    }

    /// The problem sets that all methods are compared on.
    pub fn problem_sets(self, size: Size) -> &'static [&'static str] {
        match self {
            Self::Aware => size.pick(
                &["needle", "stack", "tube", "bow-knot", "reef-knot", "dress"][..],
                &["needle", "stack", "tube"],
                &["needle"],
            ),
            Self::Unaware => size.pick(
                &[
                    "needle-unaware",
                    "stack-unaware",
                    "tube-unaware",
                    "bow-knot-unaware",
                    "reef-knot-unaware",
                    "dress-unaware",
                ][..],
                &["needle-unaware", "stack-unaware"],
                &["needle-unaware"],
            ),
        }
    }

    /// The word for them in names of tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::Aware => "aware",
            Self::Unaware => "unaware",
        }
    }
}
