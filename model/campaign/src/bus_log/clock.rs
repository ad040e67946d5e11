//! The sampling clock of a node, transmitted as a signal.
//!
//! The time stamp of a frame includes delays by arbitration, the adapter or a busy computer; the sampling clock does
//! not, but it wraps around. The time stamps determine the number of wraps.

/// Largest delay of a frame, and largest drift between the clocks over a log, s.
const LARGEST_DELAY_S: f64 = 1.0;

/// A clock with its first value.
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
    /// Time of the clock value `shown_s` in a frame logged at `logged_s`; the clock wraps after `period_s`. `None` if
    /// it is inconsistent: the clock was set, or its node restarted.
    pub fn time_s(&mut self, logged_s: f64, shown_s: f64, period_s: f64) -> Option<f64> {
        let origin = *self.origin.get_or_insert(Origin { logged_s, shown_s });
        let within_round_s = origin.logged_s + (shown_s - origin.shown_s);
        let rounds = ((logged_s - within_round_s) / period_s).round();
        let time_s = within_round_s + rounds * period_s;
        ((time_s - logged_s).abs() <= LARGEST_DELAY_S).then_some(time_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goes_round_and_forgets_delays() {
        let mut clock = Clock::default();
        assert_eq!(clock.time_s(10.0, 63.0, 64.0), Some(10.0));
        // Half a second late, and wrapped twice.
        assert_eq!(clock.time_s(139.5, 0.0, 64.0), Some(139.0));
    }

    #[test]
    fn a_clock_that_was_set_is_noticed() {
        let mut clock = Clock::default();
        clock.time_s(10.0, 20.0, 64.0);
        assert_eq!(clock.time_s(11.0, 0.0, 64.0), None);
    }
}
