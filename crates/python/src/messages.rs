//! Warnings of the libraries, for Python's `logging`.
//!
//! They are kept until Python takes them: a thread of the pool must never wait for the interpreter's lock, which
//! the thread that waits for the pool may hold.

use pyo3::pyfunction;
use std::fmt::{self, Write};
use std::sync::Mutex;
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Level, Metadata, Subscriber};

/// Most messages that are kept, should nobody take them.
const MOST: usize = 1000;

static MESSAGES: Mutex<Vec<(u8, String)>> = Mutex::new(Vec::new());

/// Begins to keep warnings and errors. Another listener of the process, if there is one, stays.
pub fn listen() {
    let _ = tracing::subscriber::set_global_default(Listener);
}

/// The messages since the last call: their level as `logging` counts it, and their text.
#[pyfunction]
pub fn take() -> Vec<(u8, String)> {
    MESSAGES.lock().map(|mut messages| std::mem::take(&mut *messages)).unwrap_or_default()
}

struct Listener;

impl Subscriber for Listener {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.is_event() && *metadata.level() <= Level::WARN && metadata.target().starts_with("bowknot")
    }

    fn max_level_hint(&self) -> Option<tracing::metadata::LevelFilter> {
        Some(tracing::metadata::LevelFilter::WARN)
    }

    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1)
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}

    fn record_follows_from(&self, _: &Id, _: &Id) {}

    fn event(&self, event: &Event<'_>) {
        let mut text = Text::default();
        event.record(&mut text);
        let level = if *event.metadata().level() == Level::ERROR { 40 } else { 30 };
        if let Ok(mut messages) = MESSAGES.lock()
            && messages.len() < MOST
        {
            messages.push((level, text.message + &text.fields));
        }
    }

    fn enter(&self, _: &Id) {}

    fn exit(&self, _: &Id) {}
}

/// The message of an event, and its other fields.
#[derive(Default)]
struct Text {
    message: String,
    fields: String,
}

impl Visit for Text {
    fn record_debug(&mut self, field: &Field, value: &dyn fmt::Debug) {
        // Writing to a string does not fail.
        let _ = match field.name() {
            "message" => write!(self.message, "{value:?}"),
            name => write!(self.fields, " {name}={value:?}"),
        };
    }
}
