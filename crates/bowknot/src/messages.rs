//! Warnings of the libraries for programs that have no subscriber of [`tracing`] of their own: kept until they are taken.
//!
//! Bindings take them on their own thread: a thread of the pool must never wait for a lock of the language, which the
//! thread that waits for the pool may hold.

use std::fmt::{self, Write};
use std::sync::Mutex;
use tracing::field::{Field, Visit};
use tracing::level_filters::LevelFilter;
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Level, Metadata, Subscriber};

/// Most messages that are kept, should nobody take them.
const MOST: usize = 1000;

static MESSAGES: Mutex<Vec<Message>> = Mutex::new(Vec::new());

/// A warning or an error.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// Whether it is an error.
    pub is_error: bool,
    /// Its text.
    pub text: String,
}

/// Begins to keep warnings and errors. Another subscriber of the process, if there is one, stays.
pub fn listen() {
    let _ = tracing::subscriber::set_global_default(Listener);
}

/// The messages since the last call, such as of vertices that were left out.
pub fn take() -> Vec<Message> {
    MESSAGES.lock().map(|mut messages| std::mem::take(&mut *messages)).unwrap_or_default()
}

struct Listener;

impl Subscriber for Listener {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.is_event() && *metadata.level() <= Level::WARN && metadata.target().starts_with("bowknot")
    }

    fn max_level_hint(&self) -> Option<LevelFilter> {
        Some(LevelFilter::WARN)
    }

    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1)
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}

    fn record_follows_from(&self, _: &Id, _: &Id) {}

    fn event(&self, event: &Event<'_>) {
        let mut text = Text::default();
        event.record(&mut text);
        let is_error = *event.metadata().level() == Level::ERROR;
        if let Ok(mut messages) = MESSAGES.lock()
            && messages.len() < MOST
        {
            messages.push(Message { is_error, text: text.message + &text.fields });
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
