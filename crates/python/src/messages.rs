//! Warnings of the libraries, for Python's `logging`.

use bowknot::messages;
use pyo3::pyfunction;

/// The messages since the last call: their level as `logging` counts it, and their text.
#[pyfunction]
pub fn take() -> Vec<(u8, String)> {
    messages::take()
        .into_iter()
        .map(|message| (if message.is_error { 40 } else { 30 }, message.text))
        .collect()
}
