//! Exceptions, with the texts of the command. Their `name` tells programs what kind of error they are.

use bowknot::{DriveError, SimulationError};
use std::fmt::Display;
use wasm_bindgen::JsValue;

/// What a function throws.
pub type Thrown = JsValue;

fn named(name: &str, message: &str) -> Thrown {
    let error = js_sys::Error::new(message);
    error.set_name(name);
    error.into()
}

/// What a user gave is refused.
pub fn input(message: impl Display) -> Thrown {
    named("InputError", &message.to_string())
}

/// A state intersects that must not.
pub fn intersection(message: impl Display) -> Thrown {
    named("IntersectionError", &message.to_string())
}

/// A fault of the library itself.
pub fn internal(message: impl Display) -> Thrown {
    let report = "This is a fault of the program, please report it.";
    named("InternalError", &format!("internal error: {message}\n{report}"))
}

/// A simulation that cannot begin or go on.
pub fn simulation(error: SimulationError) -> Thrown {
    match error {
        SimulationError::StartIntersects { .. } | SimulationError::Drive(DriveError::Intersects { .. }) => {
            intersection(error)
        }
        SimulationError::Internal { .. } => named("InternalError", &error.to_string()),
        error => input(error),
    }
}

/// Makes exceptions of panics, which would otherwise end as `unreachable` without a word. What panicked stays borrowed,
/// and refuses to be used again.
pub fn throw_panics() {
    std::panic::set_hook(Box::new(|panic| {
        #[cfg(feature = "threads")]
        crate::threads::tell(&panic.to_string());
        wasm_bindgen::throw_val(internal(panic))
    }));
}
