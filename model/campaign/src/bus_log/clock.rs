//! The clock of a node that tells when it has sampled.
//!
//! What a frame waits for the bus, for an adapter or for a busy computer is in its time stamp and not in this clock,
//! which goes round every so often. The stamps tell how often it went round.

/// Most that a frame is delayed, and the clocks go apart in the course of a log, s.
const MOST_APART_S: f64 = 1.0;

/// A clock and what it showed first.
#[derive(Debug, Clone, Default)]
pub struct Clock {
    origin: Option<Origin>,
}

#[derive(Debug, Clone, Copy)]
struct Origin {
    logged_s: f64,
    shown_s: f64,
}

impl Clock {
    /// The time at which the clock showed `shown_s`, in a frame that was logged at `logged_s`; it goes round after
    /// `period_s`. `None` if it can't be: somebody has set the clock, or its node was switched off in between.
    pub fn time_s(&mut self, logged_s: f64, shown_s: f64, period_s: f64) -> Option<f64> {
        let origin = *self.origin.get_or_insert(Origin { logged_s, shown_s });
        let within_round_s = origin.logged_s + (shown_s - origin.shown_s);
        let rounds = ((logged_s - within_round_s) / period_s).round();
        let time_s = within_round_s + rounds * period_s;
        ((time_s - logged_s).abs() <= MOST_APART_S).then_some(time_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goes_round_and_forgets_delays() {
        let mut clock = Clock::default();
        assert_eq!(clock.time_s(10.0, 63.0, 64.0), Some(10.0));
        // Half a second late, and round twice.
        assert_eq!(clock.time_s(139.5, 0.0, 64.0), Some(139.0));
    }

    #[test]
    fn a_clock_that_was_set_is_noticed() {
        let mut clock = Clock::default();
        clock.time_s(10.0, 20.0, 64.0);
        assert_eq!(clock.time_s(11.0, 0.0, 64.0), None);
    }
}
