//! Exceptions, with the texts of the command.

use bowknot::SimulationError;
use pyo3::PyErr;
use std::fmt::Display;

pyo3::import_exception!(bowknot._errors, BowknotError);
pyo3::import_exception!(bowknot._errors, InputError);
pyo3::import_exception!(bowknot._errors, IntersectionError);
pyo3::import_exception!(bowknot._errors, DeviceError);
pyo3::import_exception!(bowknot._errors, InternalError);

/// What a user gave is refused.
pub fn input(message: impl Display) -> PyErr {
    InputError::new_err(message.to_string())
}

/// A state intersects that must not.
pub fn intersection(message: impl Display) -> PyErr {
    IntersectionError::new_err(message.to_string())
}

/// There is no such device, or it has failed.
pub fn device(message: impl Display) -> PyErr {
    DeviceError::new_err(message.to_string())
}

/// A fault of the library itself.
pub fn internal(message: impl Display) -> PyErr {
    InternalError::new_err(format!(
        "internal error: {message}\nThis is a fault of the program, please report it."
    ))
}

/// A simulation that cannot begin or go on.
pub fn simulation(error: SimulationError) -> PyErr {
    use bowknot::DriveError;
    match error {
        SimulationError::StartIntersects { .. } | SimulationError::Drive(DriveError::Intersects { .. }) => {
            intersection(error)
        }
        SimulationError::Backend { .. } => device(error),
        SimulationError::Internal { .. } => InternalError::new_err(error.to_string()),
        error => input(error),
    }
}

/// Something in use by another thread.
pub fn busy(what: &str) -> PyErr {
    BowknotError::new_err(format!("the {what} is at work in another thread; use one per thread"))
}

/// Something that an internal error has left behind.
pub fn broken(what: &str) -> PyErr {
    BowknotError::new_err(format!("an internal error has ended this {what}; make a new one"))
}
