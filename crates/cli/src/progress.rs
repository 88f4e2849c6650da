//! Progress on stderr: on a terminal a bar with the time left, otherwise a plain line every few seconds,
//! without any control code.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Smallest time between two plain lines.
const PLAIN_INTERVAL: Duration = Duration::from_secs(5);

/// Shows the progress of a command.
pub struct Bar {
    bar: ProgressBar,
    plain: bool,
    what: &'static str,
    started: Instant,
    last_line: Option<Instant>,
}

impl Bar {
    /// Progress over `total` items, named by `what`; nothing is shown if `quiet`.
    pub fn new(total: usize, what: &'static str, quiet: bool) -> Self {
        let terminal = std::io::stderr().is_terminal();
        let bar = ProgressBar::new(total as u64);
        bar.set_draw_target(if terminal && !quiet {
            ProgressDrawTarget::stderr_with_hz(10)
        } else {
            ProgressDrawTarget::hidden()
        });
        // The template is fixed and well formed; otherwise the default style would be shown.
        if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} {msg} [{elapsed}, {eta} left]")
        {
            bar.set_style(style);
        }
        let now = Instant::now();
        Self { bar, plain: !terminal && !quiet, what, started: now, last_line: Some(now) }
    }

    /// Changes the total.
    pub fn set_total(&self, total: usize) {
        self.bar.set_length(total as u64);
    }

    /// Marks `count` more items as done.
    pub fn advance(&mut self, count: usize) {
        self.set_position(self.bar.position() as usize + count, "");
    }

    /// Sets the number of items that are done, and a message beside it.
    pub fn set_position(&mut self, position: usize, message: &str) {
        self.bar.set_position(position as u64);
        self.bar.set_message(message.to_owned());
        let due = self.last_line.is_none_or(|last| last.elapsed() >= PLAIN_INTERVAL);
        if self.plain && due {
            self.last_line = Some(Instant::now());
            eprintln!("{}", self.line(position, message));
        }
    }

    /// Prints a line to stderr, above the bar.
    pub fn print(&self, line: &str) {
        self.bar.suspend(|| eprintln!("{line}"));
    }

    /// Removes the bar.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }

    fn line(&self, position: usize, message: &str) -> String {
        let total = self.bar.length().unwrap_or(0);
        let elapsed = self.started.elapsed().as_secs_f64();
        let mut line = format!("{}: {position}/{total}", self.what);
        if position > 0 && (position as u64) < total {
            let left = elapsed / position as f64 * (total as f64 - position as f64);
            line += &format!(", about {left:.0} s left");
        }
        if !message.is_empty() {
            line += &format!(" ({message})");
        }
        line
    }
}
