//! Ratio of the peak velocities of hitch and valve during a lift.
//!
//! The ratio separates an oscillating load from a slow spool. A slow spool delays the flow but does not increase it:
//! the peak velocity of the hitch stays below the peak velocity that the valve model gives. A load that oscillates on
//! its compensator starts late too, but then overshoots its velocity by about one half. Steady flow errors (threshold,
//! oil, droop) reduce distance and velocity by about the same factor, so the limit is scaled with the distance:
//!
//! ```text
//! oscillation:    peak of hitch / peak of valve > 1.2 * measured distance / expected distance
//! ```
//!
//! On first lifts that show too large a lag for a spool, the ratio is 1.1 (95 %: 1.2) for slow spools, and 1.45 (2 %:
//! 1.2) for oscillating loads.

use hitch_quantities::units::{Micrometre, MicrometrePerSecond};

use super::move_record::MoveRecord;

/// Peak velocities of a move, nm/ms.
#[derive(Clone, Copy, Debug, Default)]
pub struct PeakVelocityRatio {
    /// Low-passed position of the hitch.
    position_nm: i32,
    /// Low-passed model velocity.
    valve_nm: i32,
    hitch: PeakSpeed,
    valve: PeakSpeed,
}

/// Filtered velocity and its peak.
#[derive(Clone, Copy, Debug, Default)]
struct PeakSpeed {
    filtered: i32,
    peak: i32,
}

impl PeakVelocityRatio {
    /// Starts a move at this position.
    #[must_use]
    pub fn from(position_nm: i32) -> Self {
        Self {
            position_nm,
            ..Self::default()
        }
    }

    /// One step of a lift. `model`: velocity of the valve model. Both velocities are low-passed with 32 and 4 ms, which
    /// reduces the sensor noise to some mm/s.
    pub fn step(&mut self, measured_nm: i32, model: MicrometrePerSecond) {
        let hitch = measured_nm.saturating_sub(self.position_nm) >> 5;
        self.position_nm = self.position_nm.saturating_add(hitch);
        self.hitch.step(hitch);
        let valve = model.0.saturating_sub(self.valve_nm) >> 5;
        self.valve_nm = self.valve_nm.saturating_add(valve);
        self.valve.step(self.valve_nm);
    }

    /// True if the ratio shows an oscillating load on the lift of this `record`.
    #[must_use]
    pub fn shows_oscillation(&self, record: &MoveRecord) -> bool {
        // 128 um/s times 16 um: half of the word range remains for the speeds and distances of a hitch.
        let product = |speed: PeakSpeed, distance: Micrometre, weight: i32| {
            (speed.peak >> 7)
                .saturating_mul(distance.0 >> 4)
                .saturating_mul(weight)
        };
        let measured = record.expected - record.missing;
        product(self.hitch, record.expected, 5) > product(self.valve, measured, 6)
    }
}

impl PeakSpeed {
    fn step(&mut self, speed: i32) {
        self.filtered = self
            .filtered
            .saturating_add(speed.saturating_sub(self.filtered) >> 2);
        self.peak = self.peak.max(self.filtered);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::valve::phase::Direction;

    /// A lift of 0.4 s at 100 mm/s of the valve. The hitch lags by `lag_ms`, its speed oscillates by `swing`, and it
    /// moves `share` of the distance.
    fn oscillates(lag_ms: f64, swing: f64, share: f64) -> bool {
        let mut ratio = PeakVelocityRatio::from(5_000_000);
        let (mut model, mut truth, mut expected, mut way) = (0.0, 0.0, 0.0, 0.0);
        for ms in 0..700 {
            let opening = if ms < 400 { 100_000.0 } else { 0.0 };
            model += (opening - model) / 40.0;
            truth += (opening - truth) / (40.0 + lag_ms);
            let swings = 1.0 - swing * (f64::from(ms) * 0.017).cos();
            expected += model;
            way += truth * swings * share;
            ratio.step(5_000_000 + way as i32, MicrometrePerSecond(model as i32));
        }
        ratio.shows_oscillation(&MoveRecord {
            direction: Direction::Lift,
            expected: Micrometre((expected * 1e-3) as i32),
            missing: Micrometre(((expected - way) * 1e-3) as i32),
            sensitivity: Micrometre(0),
            sensitivity_nl: 0,
        })
    }

    #[test]
    fn an_oscillating_load_exceeds_the_ratio_and_a_slow_spool_does_not() {
        for share in [0.7, 1.0, 1.05] {
            for lag_ms in [0.0, 10.0, 25.0] {
                assert!(!oscillates(lag_ms, 0.0, share), "{lag_ms} ms, {share}");
            }
            for swing in [0.4, 0.8] {
                assert!(oscillates(0.0, swing, share), "{swing}, {share}");
            }
        }
    }

    #[test]
    fn extremes_do_no_harm() {
        for extreme in [i32::MIN, 0, i32::MAX] {
            let mut ratio = PeakVelocityRatio::from(extreme);
            for _ in 0..100 {
                ratio.step(!extreme, MicrometrePerSecond(extreme));
            }
            let record = |missing| MoveRecord {
                direction: Direction::Lift,
                expected: Micrometre(extreme),
                missing: Micrometre(missing),
                sensitivity: Micrometre(0),
                sensitivity_nl: 0,
            };
            for missing in [i32::MIN, 0, i32::MAX] {
                let _ = ratio.shows_oscillation(&record(missing));
            }
        }
    }
}
