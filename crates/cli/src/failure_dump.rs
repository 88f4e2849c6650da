//! `--dump-on-failure`: the smallest state that shows a failure, as an archive.

use crate::exit::Failure;
use crate::interrupt::Interrupt;
use crate::output;
use bowknot::recording::{self, Failure as Shown, Limits, Reduction};
use bowknot::run::SmallestState;
use bowknot::twoway::Params;
use bowknot_errors::counted;
use std::panic;
use std::path::Path;

/// Refuses a file that is read, has another ending than `.npz`, or is in no folder.
pub fn refuse(file: &Path, inputs: &[&Path]) -> Result<(), Failure> {
    output::refuse_overwrite(file, inputs)?;
    output::refuse_unwritable(file, "npz")
}

/// Looks for the smallest state within the default limits, until the user wants the command to end. Panics on
/// the way are results, and not printed.
pub fn reduce<T>(interrupt: &Interrupt, search: impl FnOnce(Limits<'_>) -> T) -> T {
    eprintln!("looking for the smallest state that shows the failure");
    let hook = panic::take_hook();
    panic::set_hook(Box::new(|_| {}));
    let found = search(Limits { stop: &|| interrupt.is_set(), ..Limits::default() });
    panic::set_hook(hook);
    found
}

/// Writes the state, and says what it holds and how it shows the failure. `params` are those that the problem
/// is resolved with; none if it is a state alone.
pub fn write(file: &Path, smallest: &SmallestState, params: Option<&Params>) -> Result<String, Failure> {
    let SmallestState { failure, reduction } = smallest;
    let Reduction { states, of, tries, minimal } = reduction;
    states.write(file)?;
    let elements = counted(states.element_count(), "element", "elements");
    let name = file.display();
    let Some(failure) = failure else {
        return Ok(format!(
            "wrote the last collision problem whole to {name}, with {elements}: by itself it does not show \
             the failure"
        ));
    };
    let how = match minimal {
        true => "none of them can be left out",
        false => "the search ended at its limit, so that fewer may do",
    };
    let command = match failure {
        Shown::Intersects => format!("bowknot check {name}"),
        other => {
            let check = if *other == Shown::Unsafe { " --check" } else { "" };
            format!("bowknot resolve {name} --out result.npz{check}{}", options(params))
        }
    };
    let tries = counted(*tries, "try", "tries");
    Ok(format!(
        "wrote {elements} of {of} to {name}, that show it; {how} ({tries}). To see it again:\n  {command}"
    ))
}

/// The options that give `resolve` these parameters.
fn options(params: Option<&Params>) -> String {
    match params.map(recording::assignments) {
        None => String::new(),
        Some(Some(sets)) => sets.iter().map(|set| format!(" --set '{set}'")).collect(),
        Some(None) => " with the tables [contact] and [solver] of the scene as --set".to_owned(),
    }
}
