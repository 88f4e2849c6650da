//! Faults of the program itself: how a command ends after a panic, and a panic on request, for the tests of that.

use crate::exit::{Exit, Failure};
use std::panic::{self, AssertUnwindSafe};

/// Runs a command. A panic of any thread becomes an error; its place and message are on stderr already.
pub fn guarded(command: impl FnOnce() -> Result<Exit, Failure>) -> Result<Exit, Failure> {
    panic::catch_unwind(AssertUnwindSafe(command)).unwrap_or_else(|_| {
        let message =
            "internal error, see the message above: this is a fault of the program, please report it";
        Err(Failure::internal(message))
    })
}

/// Panics in a worker thread after the time step that the variable `BOWKNOT_PANIC_AT_STEP` names.
pub fn panic_if_asked(step: usize) {
    let asked = std::env::var("BOWKNOT_PANIC_AT_STEP").ok().and_then(|text| text.parse().ok());
    if asked == Some(step) {
        rayon::scope(|scope| scope.spawn(|_| panic!("asked for by BOWKNOT_PANIC_AT_STEP")));
    }
}
