//! Says on standard error what takes so long; only where that is a terminal.
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// A line that shows what is being done and for how long; it goes away when dropped.
#[derive(Debug)]
pub struct Progress(ProgressBar);

impl Progress {
    /// Shows the first message.
    pub fn start(message: impl Into<String>) -> Self {
        let bar = ProgressBar::new_spinner();
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} ({elapsed})") {
            bar.set_style(style);
        }
        bar.set_message(message.into());
        bar.enable_steady_tick(Duration::from_millis(120));
        Self(bar)
    }

    /// Shows a bar for work of `total` steps.
    pub fn of(total: usize, message: impl Into<String>) -> Self {
        let bar = ProgressBar::new(total as u64);
        let template = "{spinner} [{bar:30}] {pos} of {len}, {msg} ({elapsed}, {eta} to go)";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style.progress_chars("=> "));
        }
        bar.set_message(message.into());
        bar.enable_steady_tick(Duration::from_millis(120));
        Self(bar)
    }

    /// Says how many steps of a bar are done, and what to say of them.
    pub fn reach(&self, steps: usize, message: impl Into<String>) {
        self.0.set_position(steps as u64);
        self.0.set_message(message.into());
    }

    /// Replaces the message.
    pub fn say(&self, message: impl Into<String>) {
        self.0.set_message(message.into());
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
