//! The kinds of targets that collision problems have.

use crate::bench::Size;

/// Where the targets of recorded problems come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Targets {
    /// Bowknot's dynamics with its repulsion: few targets are deep in penetration.
    Aware,
    /// Bowknot's dynamics without repulsion: targets lie deep in penetration.
    Unaware,
    /// Bowknot's dynamics with a repulsion of quadratic energy, as the paper has it.
    Repelled,
}

/// Suffix of the names of problem sets with contact-unaware targets.
pub const UNAWARE_SUFFIX: &str = "-unaware";

/// Suffix of the names of problem sets with targets of the paper's repulsion.
const REPELLED_SUFFIX: &str = "-repelled";

impl Targets {
    /// The targets of the problem set of that name.
    pub fn of(problems: &str) -> Self {
        if problems.contains(UNAWARE_SUFFIX) {
            Self::Unaware
        } else if problems.contains(REPELLED_SUFFIX) {
            Self::Repelled
        } else {
            Self::Aware
        }
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
            Self::Repelled => size.pick(
                &[
                    "needle-repelled",
                    "stack-repelled",
                    "tube-repelled",
                    "bow-knot-repelled",
                    "reef-knot-repelled",
                    "dress-repelled",
                ][..],
                &["needle-repelled"],
                &["needle-repelled"],
            ),
        }
    }

    /// The word for them in tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::Aware => "aware",
            Self::Unaware => "unaware",
            Self::Repelled => "repelled",
        }
    }
}
