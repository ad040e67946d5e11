//! Until when a computation goes on.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Limit of a computation: a time, and a request to end. A fit beyond it returns the values that it has.
#[derive(Debug, Clone, Copy, Default)]
pub struct Limit<'a> {
    /// The time; `None` without one.
    pub deadline: Option<Instant>,
    /// Set by a request to end; `None` if there can be none.
    pub requested: Option<&'a AtomicBool>,
}

/// Share of the time that is left for conclusions after a search.
const FOR_CONCLUSIONS: f64 = 0.25;

impl Limit<'_> {
    /// Whether the time has passed, or the end was requested.
    #[must_use]
    pub fn is_over(self) -> bool {
        self.deadline.is_some_and(|time| Instant::now() >= time)
            || self
                .requested
                .is_some_and(|end| end.load(Ordering::Relaxed))
    }

    /// The limit of a search from now on, which leaves time for conclusions from its result.
    #[must_use]
    pub fn of_search(self) -> Self {
        self.after(1.0 - FOR_CONCLUSIONS)
    }

    /// The same with a share of the time from now on.
    #[must_use]
    pub fn after(self, share: f64) -> Self {
        let now = Instant::now();
        let left = |time: Instant| now + time.saturating_duration_since(now).mul_f64(share);
        Self {
            deadline: self.deadline.map(left),
            ..self
        }
    }
}
