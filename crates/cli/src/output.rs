//! Results on stdout, and where results may be written.

use crate::exit::Failure;
use serde::Serialize;
use std::io::{ErrorKind, Write};
use std::path::Path;

/// Refuses to write over a file that the command reads.
pub fn refuse_overwrite(out: &Path, inputs: &[&Path]) -> Result<(), Failure> {
    match inputs.iter().find(|input| is_same(out, input)) {
        Some(input) => {
            let message = format!(
                "{}: is the file that is read, {}, and would be lost: name another one",
                out.display(),
                input.display()
            );
            Err(Failure::input(message))
        }
        None => Ok(()),
    }
}

/// Whether two paths name the same file. A file that does not exist yet is known by its name alone.
pub fn is_same(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => a == b,
    }
}

/// Refuses a file for results with another ending, or in a folder that does not exist: before the work, not
/// after.
pub fn refuse_unwritable(out: &Path, ending: &str) -> Result<(), Failure> {
    if out.extension().is_none_or(|found| !found.eq_ignore_ascii_case(ending)) {
        return Err(Failure::input(format!("{}: the name must end in .{ending}", out.display())));
    }
    match out.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.is_dir()) {
        Some(folder) => {
            Err(Failure::input(format!("{}: no such folder {}", out.display(), folder.display())))
        }
        None => Ok(()),
    }
}

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
