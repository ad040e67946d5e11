//! Time of the samples: the ECU's clock, which wraps, on the time axis of the monitor.

use hitch_protocols::j1939::measured::TIME_WRAPS_MS;

/// Time that may pass by the ECU's clock in excess of that on the monitor's, s: frames are delayed, but a restarted ECU
/// seems to have been far ahead.
const MOST_AHEAD_S: f64 = 1.0;

/// The clock.
#[derive(Debug, Default)]
pub struct SampleClock {
    /// Time of the last sample by the ECU, ms, and its arrival, s.
    last: Option<(u16, f64)>,
    /// Time of the last sample, s.
    time_s: Option<f64>,
}

/// Time of a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampleTime {
    /// On the monitor's time axis, s.
    pub time_s: f64,
    /// Whether the sample follows the previous one by the clock of the ECU.
    pub continues: bool,
}

impl SampleClock {
    /// Time of a sample with this time of the ECU, ms, that arrives `now_s` after the start of the monitor; `None` for a
    /// repeated sample, and for a time that is none.
    pub fn at(&mut self, ecu_ms: u16, now_s: f64) -> Option<SampleTime> {
        let wraps_ms = TIME_WRAPS_MS;
        if u32::from(ecu_ms) >= wraps_ms {
            return None;
        }
        let followed = match self.last {
            Some((before_ms, _)) if before_ms == ecu_ms => return None,
            Some((before_ms, arrived_s)) => {
                let passed_ms = (u32::from(ecu_ms) + wraps_ms - u32::from(before_ms)) % wraps_ms;
                let (passed_s, waited_s) = (f64::from(passed_ms) * 1e-3, now_s - arrived_s);
                let is_plausible =
                    passed_s <= waited_s + MOST_AHEAD_S && waited_s < f64::from(wraps_ms) * 1e-3;
                self.time_s
                    .filter(|_| is_plausible)
                    .map(|time_s| time_s + passed_s)
            }
            None => None,
        };
        let earliest_s = self.time_s.map_or(now_s, |time_s| time_s + 1e-3);
        let time_s = followed.unwrap_or(now_s.max(earliest_s));
        self.time_s = Some(time_s);
        self.last = Some((ecu_ms, now_s));
        Some(SampleTime {
            time_s,
            continues: followed.is_some(),
        })
    }

    /// The next sample is of another ECU.
    pub fn restart(&mut self) {
        self.last = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_goes_on_over_the_wrap_and_late_frames() {
        let mut clock = SampleClock::default();
        assert_eq!(clock.at(63_980, 10.0).unwrap().time_s, 10.0);
        let over = clock.at(0, 10.3).unwrap();
        assert!(
            over.continues && (over.time_s - 10.02).abs() < 1e-9,
            "{over:?}"
        );
        assert_eq!(clock.at(0, 10.3), None);
        assert_eq!(clock.at(64_000, 10.3), None);
        assert_eq!(clock.at(u16::MAX, 10.3), None);
    }

    #[test]
    fn a_restart_of_the_ecu_begins_anew_at_the_present_time() {
        let mut clock = SampleClock::default();
        clock.at(30_000, 10.0).unwrap();
        let restarted = clock.at(20, 14.0).unwrap();
        assert_eq!((restarted.time_s, restarted.continues), (14.0, false));
        // Times never decrease.
        assert!(clock.at(920, 14.0).unwrap().continues);
        clock.restart();
        assert!(clock.at(100, 14.1).unwrap().time_s > 14.9);
    }

    #[test]
    fn a_slow_ecu_and_a_burst_of_late_frames_continue() {
        let mut clock = SampleClock::default();
        clock.at(0, 0.0).unwrap();
        for (ecu_ms, now_s) in [(1_000, 3.0), (1_020, 6.0), (1_040, 6.0), (1_060, 6.0)] {
            let time = clock.at(ecu_ms, now_s).unwrap();
            assert!(time.continues && (time.time_s - f64::from(ecu_ms) * 1e-3).abs() < 1e-9);
        }
    }
}
