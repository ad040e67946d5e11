//! Progress reports on standard error: one line that changes on a terminal, otherwise a line at intervals.
use std::io::{IsTerminal, Write};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// Interval between two lines if standard error is not a terminal.
const LINE_PERIOD: Duration = Duration::from_secs(10);

/// A line with the current work and its duration; it is erased on drop.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    /// `None` on a terminal.
    lines: Option<Lines>,
}

/// Lines for a log.
#[derive(Debug)]
struct Lines {
    start: Instant,
    last: Mutex<Instant>,
}

impl Progress {
    /// Shows the first message.
    pub fn start(message: impl Into<String>) -> Self {
        Self::with(
            ProgressBar::new_spinner(),
            "{spinner} {msg} ({elapsed})",
            message,
        )
    }

    /// Shows nothing, for work that is one of many.
    #[must_use]
    pub fn hidden() -> Self {
        Self {
            bar: ProgressBar::hidden(),
            lines: None,
        }
    }

    /// Shows a bar for work of `total` steps.
    pub fn of(total: usize, message: impl Into<String>) -> Self {
        let template = "{spinner} [{bar:30}] {pos} of {len}, {msg} ({elapsed}, {eta} to go)";
        Self::with(ProgressBar::new(total as u64), template, message)
    }

    fn with(bar: ProgressBar, template: &str, message: impl Into<String>) -> Self {
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style.progress_chars("=> "));
        }
        bar.set_message(message.into());
        bar.enable_steady_tick(Duration::from_millis(120));
        let now = Instant::now();
        let lines = (!std::io::stderr().is_terminal()).then(|| Lines {
            start: now,
            last: Mutex::new(now),
        });
        Self { bar, lines }
    }

    /// Sets the completed steps of a bar, with a message.
    pub fn reach(&self, steps: usize, message: impl Into<String>) {
        self.bar.set_position(steps as u64);
        let message = message.into();
        let total = self.bar.length().unwrap_or_default();
        self.line(&format!("{steps} of {total}, {message}"));
        self.bar.set_message(message);
    }

    /// Replaces the message.
    pub fn say(&self, message: impl Into<String>) {
        let message = message.into();
        self.line(&message);
        self.bar.set_message(message);
    }

    /// Reports a result without delay: a log gets a line for each.
    pub fn result(&self, message: impl Into<String>) {
        let message = message.into();
        if let Some(lines) = &self.lines {
            lines.write(&message);
        }
        self.bar.set_message(message);
    }

    /// Writes a line if standard error is not a terminal and the interval has passed.
    fn line(&self, message: &str) {
        let Some(lines) = &self.lines else { return };
        let Ok(mut last) = lines.last.lock() else {
            return;
        };
        if last.elapsed() >= LINE_PERIOD {
            *last = Instant::now();
            lines.write(message);
        }
    }
}

impl Lines {
    fn write(&self, message: &str) {
        let elapsed_s = self.start.elapsed().as_secs();
        // A failure to write progress does not stop the work.
        let _ = writeln!(std::io::stderr(), "{message} ({elapsed_s} s)");
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
