//! Faults of the program itself: how a command ends after a panic, and a panic on request, for the tests of
//! that.

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

#[cfg(test)]
thread_local! {
    /// The time step after which a run of this thread panics.
    static PANIC_AT_STEP: std::cell::Cell<Option<usize>> = const { std::cell::Cell::new(None) };
}

/// Panics in a worker thread if a test has asked for it after this time step.
#[cfg(test)]
pub fn panic_if_asked(step: usize) {
    if PANIC_AT_STEP.get() == Some(step) {
        rayon::scope(|scope| scope.spawn(|_| panic!("asked for by a test")));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::{Arguments, Command};
    use crate::run;
    use clap::Parser;
    use std::fs;
    use std::path::Path;

    /// Runs a small scene to its frame 12, with further options.
    fn go(folder: &Path, more: &[&str]) -> Result<Exit, Failure> {
        let words =
            "bowknot run drape --scale 0.16 --set output.checkpoint_every=4 --frames 12 --quiet --out";
        let words = words.split(' ').chain(folder.to_str()).chain(more.iter().copied());
        let Command::Run(options) = Arguments::parse_from(words).command else { unreachable!("it is `run`") };
        guarded(|| run::simulate(&options))
    }

    #[test]
    fn a_panic_of_a_worker_thread_ends_the_run_with_whole_frames() {
        let place = tempfile::tempdir().expect("a folder");
        let (whole, folder) = (place.path().join("whole"), place.path().join("run"));
        let dump = place.path().join("small.npz");
        let frame = |run: &Path, step: usize| fs::read(run.join(format!("frames/{step:06}.ply"))).ok();
        let same = |last: usize| {
            assert!((0..=last).all(|step| frame(&whole, step).is_some()));
            assert!((0..=last).all(|step| frame(&whole, step) == frame(&folder, step)));
        };
        assert_eq!(go(&whole, &[]).expect("a run"), Exit::Success);
        PANIC_AT_STEP.set(Some(6));
        let failure =
            go(&folder, &["--dump-on-failure", dump.to_str().expect("a name")]).expect_err("a panic");
        PANIC_AT_STEP.set(None);
        assert_eq!(failure.code, 4, "{}", failure.message);
        // The collision stage is not to blame: its last problem is written whole.
        let words = ["time step 6: internal error", "asked for by a test", "--resume", "problem whole to"];
        words.iter().for_each(|words| assert!(failure.message.contains(words), "{}", failure.message));
        assert!(dump.exists());
        same(6);
        assert_eq!(frame(&folder, 7), None);
        assert_eq!(go(&folder, &["--resume"]).expect("the rest"), Exit::Success);
        same(12);
    }

    #[test]
    fn a_panic_of_any_command_is_a_fault_of_the_program() {
        let failure = guarded(|| panic!("asked for by a test")).expect_err("a panic");
        assert!(failure.code == 4 && failure.message.contains("report it"), "{failure:?}");
    }
}
