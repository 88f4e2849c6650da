//! From hard intersection-free states toward any finite targets, no step of the whole method intersects, and
//! bodies keep their thickness. The judge decides this and shares no code with the stepper.
//!
//! The seeds are fixed, so that each run draws the same problems; `cargo xtask soak` draws others.
//! `BOWKNOT_SEEDS=20 cargo test --release -p bowknot-safety` draws ten times as many.

use bowknot_safety::search::{Failure, search_many};
use bowknot_safety::{Tally, check, scenario};

/// How many times the usual number of problems is drawn, times two.
pub fn seeds() -> u64 {
    std::env::var("BOWKNOT_SEEDS").ok().and_then(|text| text.parse().ok()).unwrap_or(2)
}

/// Fails with the smallest problem that fails.
pub fn expect(outcome: Result<Tally, Box<Failure>>) -> Tally {
    outcome.unwrap_or_else(|failure| panic!("{failure}"))
}

#[test]
fn no_step_from_small_pieces_intersects() {
    let tally = expect(search_many(1, 500 * seeds(), scenario::any, check));
    // A method that refuses everything or never moves is safe but useless.
    let Tally { cases, unusable, refused, moved, .. } = tally;
    assert!(10 * unusable < cases && 4 * refused < cases && 4 * moved > 3 * (cases - unusable), "{tally:?}");
}

#[test]
fn no_step_from_generated_states_intersects() {
    let tally = expect(search_many(2, 30 * seeds(), scenario::generated, check));
    assert!(10 * tally.moved >= 9 * tally.cases, "{tally:?}");
}
