//! What a function returns, and the words to it.

use bowknot::{DriveError, SimulationError};
use std::cell::RefCell;
use std::ffi::{CString, c_char};
use std::fmt::Display;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Whether a call did what it was asked for; if not, `bowknot_error` says why.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BowknotStatus {
    /// It did.
    Ok = 0,
    /// What was given is refused; nothing has changed.
    Input = 1,
    /// A state intersects that must not; nothing has changed.
    Intersects = 2,
    /// A fault of the library itself. The handle can only be freed.
    Internal = 3,
}

/// Why a call fails.
pub(crate) struct Failure(BowknotStatus, String);

thread_local! {
    static LAST: RefCell<CString> = RefCell::default();
}

/// The words to the last call of this thread that failed, empty if none has. They stay until another one fails.
#[unsafe(no_mangle)]
pub extern "C" fn bowknot_error() -> *const c_char {
    LAST.with_borrow(|words| words.as_ptr())
}

/// What was given is refused.
pub(crate) fn input(message: impl Display) -> Failure {
    Failure(BowknotStatus::Input, message.to_string())
}

/// A state intersects that must not.
pub(crate) fn intersects(message: impl Display) -> Failure {
    Failure(BowknotStatus::Intersects, message.to_string())
}

impl From<SimulationError> for Failure {
    fn from(error: SimulationError) -> Self {
        let status = match error {
            SimulationError::StartIntersects { .. }
            | SimulationError::Drive(DriveError::Intersects { .. }) => BowknotStatus::Intersects,
            SimulationError::Internal { .. } => BowknotStatus::Internal,
            _ => BowknotStatus::Input,
        };
        Self(status, error.to_string())
    }
}

impl From<DriveError> for Failure {
    fn from(error: DriveError) -> Self {
        SimulationError::from(error).into()
    }
}

/// Runs the body of a function: keeps the words of its failure, and lets no panic pass into C.
pub(crate) fn guarded(body: impl FnOnce() -> Result<(), Failure>) -> BowknotStatus {
    let done = catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|panic| {
        let words = panic.downcast_ref::<String>().map(String::as_str);
        let words =
            words.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("a panic without words");
        Err(Failure(
            BowknotStatus::Internal,
            format!("internal error: {words}\nThis is a fault of the library, please report it."),
        ))
    });
    let Err(Failure(status, message)) = done else { return BowknotStatus::Ok };
    // A text cannot hold the character that ends it in C.
    let words = CString::new(message.replace('\0', " ")).unwrap_or_default();
    LAST.set(words);
    status
}
