//! Results on stdout.

use crate::exit::Failure;
use serde::Serialize;
use std::io::{ErrorKind, Write};

/// Prints lines of results. It is not an error if the reader, such as `head`, has closed the pipe.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = std::io::stdout().lock();
    match writeln!(stdout, "{text}").and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::input(format!("cannot write to stdout: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints an object as JSON.
pub fn print_json(value: &impl Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(value)
        .map_err(|error| Failure::input(format!("cannot write the result as JSON: {error}")))?;
    print(&text)
}
