//! Real time: the waits between milliseconds of the ECU, and whether the bench falls behind.

use std::time::{Duration, Instant};

const MILLISECOND: Duration = Duration::from_millis(1);
/// Maximum lag behind real time; beyond it the schedule restarts (slow host, or suspend).
const MOST_BEHIND: Duration = Duration::from_millis(200);
/// Lag from which the bench is behind: the period of the hitch status. A client then misses a whole message.
const BEHIND: Duration = Duration::from_millis(100);
/// Lag below which it keeps up: the period of the fastest broadcast, the hitch motion.
const KEEPS_UP: Duration = Duration::from_millis(20);
/// Time for which it has to keep up before it is no longer behind, ms.
const STEADY_MS: u32 = 1_000;

/// A change between keeping up with real time and not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PaceChange {
    /// The bench is behind real time.
    FallsBehind,
    /// It keeps up again.
    KeepsUp,
}

/// The schedule.
#[derive(Debug)]
pub struct Pace {
    /// Time at which the present millisecond has to be over.
    due: Instant,
    behind: bool,
    /// Milliseconds since the lag was last too large.
    steady_ms: u32,
}

impl Pace {
    /// A schedule that starts at `now`.
    #[must_use]
    pub fn starting(now: Instant) -> Self {
        Self {
            due: now,
            behind: false,
            steady_ms: 0,
        }
    }

    /// A millisecond of the ECU is over at `now`: the time to wait, and whether the bench fell behind or caught up.
    pub fn tick(&mut self, now: Instant) -> (Duration, Option<PaceChange>) {
        self.due += MILLISECOND;
        let wait = self.due.saturating_duration_since(now);
        let lag = now.saturating_duration_since(self.due);
        if lag > MOST_BEHIND {
            self.due = now;
        }
        self.steady_ms = if lag > KEEPS_UP {
            0
        } else {
            self.steady_ms.saturating_add(1)
        };
        let change = match self.behind {
            false if lag > BEHIND => Some(PaceChange::FallsBehind),
            true if self.steady_ms >= STEADY_MS => Some(PaceChange::KeepsUp),
            _ => None,
        };
        self.behind ^= change.is_some();
        (wait, change)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Changes, with the time of each in ms, on a host where each millisecond takes `takes_us` of its number.
    fn changes(count: u32, takes_us: impl Fn(u32) -> u64) -> Vec<(u128, PaceChange)> {
        let start = Instant::now();
        let mut now = start;
        let mut pace = Pace::starting(now);
        let mut changes = Vec::new();
        for number in 0..count {
            now += Duration::from_micros(takes_us(number));
            let (wait, change) = pace.tick(now);
            changes.extend(change.map(|change| ((now - start).as_millis(), change)));
            now += wait;
        }
        changes
    }

    #[test]
    fn a_fast_host_is_never_behind() {
        assert_eq!(changes(10_000, |_| 900), []);
        // Some scheduling delays do not add up.
        let delayed = |number: u32| {
            if number.is_multiple_of(100) {
                15_000
            } else {
                100
            }
        };
        assert_eq!(changes(10_000, delayed), []);
    }

    #[test]
    fn a_slow_host_is_behind_once() {
        // 5 % too slow: the lag is 100 ms after two seconds, and the schedule restarts every four.
        let changes = changes(20_000, |_| 1_050);
        assert_eq!(changes.len(), 1, "{changes:?}");
        assert_eq!(changes[0].1, PaceChange::FallsBehind);
        assert!((2_090..2_120).contains(&changes[0].0), "{changes:?}");
    }

    #[test]
    fn a_suspended_host_is_behind_until_it_has_kept_up_for_a_second() {
        let changes = changes(10_000, |number| if number == 5_000 { 800_000 } else { 100 });
        let kinds: Vec<PaceChange> = changes.iter().map(|change| change.1).collect();
        assert_eq!(kinds, [PaceChange::FallsBehind, PaceChange::KeepsUp]);
        let lasted_ms = changes[1].0 - changes[0].0;
        assert!((990..1_010).contains(&lasted_ms), "{changes:?}");
    }
}
