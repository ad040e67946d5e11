//! Whether a hitch outran its valve on a move: what a load does that swings, and what no spool does, however slow.
//!
//! A slow spool gives late what its valve should give, and no more: the fastest that the hitch gets stays below the
//! fastest that its valve should let it. A load that swings on its compensator is late too, but has to be half as fast
//! again as its valve to make up for it. What the valve gives less all the way (its threshold, the oil, a droop) makes
//! way and speed less by about the same share:
//!
//! ```text
//! outran:    fastest of hitch / fastest of valve > 1.2 * measured way / expected way
//! ```
//!
//! Of first lifts that trail their valve by too much for a spool, that is 1.1 (95 %: 1.2) for slow spools, and 1.45
//! (2 %: 1.2) for loads that swing.

use hitch_quantities::units::{Micrometre, MicrometrePerSecond};

use super::course::Told;

/// Fastest of a move, in nanometres a millisecond.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outrun {
    /// Where the hitch was a while ago.
    place_nm: i32,
    valve_nm: i32,
    hitch: Fastest,
    valve: Fastest,
}

/// The smoothed speed and the fastest that it was.
#[derive(Clone, Copy, Debug, Default)]
struct Fastest {
    now: i32,
    most: i32,
}

impl Outrun {
    /// A move begins here.
    #[must_use]
    pub fn from(place_nm: i32) -> Self {
        Self {
            place_nm,
            ..Self::default()
        }
    }

    /// One step of a lift; `model`: what the valve should give now. Both speeds are smoothed over 32 and 4 ms: the
    /// sensor's noise is some mm/s then.
    pub fn step(&mut self, measured_nm: i32, model: MicrometrePerSecond) {
        let hitch = measured_nm.saturating_sub(self.place_nm) >> 5;
        self.place_nm = self.place_nm.saturating_add(hitch);
        self.hitch.step(hitch);
        let valve = model.0.saturating_sub(self.valve_nm) >> 5;
        self.valve_nm = self.valve_nm.saturating_add(valve);
        self.valve.step(self.valve_nm);
    }

    /// True if the hitch was faster than its valve by a fifth on the lift that `told`.
    #[must_use]
    pub fn outran(&self, told: &Told) -> bool {
        // 128 um/s times 16 um: half of a word is left for what hitches do.
        let product = |fastest: Fastest, way: Micrometre, weight: i32| {
            (fastest.most >> 7)
                .saturating_mul(way.0 >> 4)
                .saturating_mul(weight)
        };
        let way = told.expected - told.missing;
        product(self.hitch, told.expected, 5) > product(self.valve, way, 6)
    }
}

impl Fastest {
    fn step(&mut self, speed: i32) {
        self.now = self.now.saturating_add(speed.saturating_sub(self.now) >> 2);
        self.most = self.most.max(self.now);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::valve::phase::Direction;

    /// A lift of 0.4 s at 100 mm/s by its valve; the hitch trails it by `lag_ms`, its speed swings by `swing`, and it
    /// goes by `share` of the way.
    fn outran(lag_ms: f64, swing: f64, share: f64) -> bool {
        let mut outrun = Outrun::from(5_000_000);
        let (mut model, mut truth, mut expected, mut way) = (0.0, 0.0, 0.0, 0.0);
        for ms in 0..700 {
            let opening = if ms < 400 { 100_000.0 } else { 0.0 };
            model += (opening - model) / 40.0;
            truth += (opening - truth) / (40.0 + lag_ms);
            let swings = 1.0 - swing * (f64::from(ms) * 0.017).cos();
            expected += model;
            way += truth * swings * share;
            outrun.step(5_000_000 + way as i32, MicrometrePerSecond(model as i32));
        }
        outrun.outran(&Told {
            direction: Direction::Lift,
            expected: Micrometre((expected * 1e-3) as i32),
            missing: Micrometre(((expected - way) * 1e-3) as i32),
            sensitivity: Micrometre(0),
            sensitivity_nl: 0,
        })
    }

    #[test]
    fn a_load_that_swings_outruns_its_valve_and_a_slow_spool_does_not() {
        for share in [0.7, 1.0, 1.05] {
            for lag_ms in [0.0, 10.0, 25.0] {
                assert!(!outran(lag_ms, 0.0, share), "{lag_ms} ms, {share}");
            }
            for swing in [0.4, 0.8] {
                assert!(outran(0.0, swing, share), "{swing}, {share}");
            }
        }
    }

    #[test]
    fn extremes_do_no_harm() {
        for extreme in [i32::MIN, 0, i32::MAX] {
            let mut outrun = Outrun::from(extreme);
            for _ in 0..100 {
                outrun.step(!extreme, MicrometrePerSecond(extreme));
            }
            let told = |missing| Told {
                direction: Direction::Lift,
                expected: Micrometre(extreme),
                missing: Micrometre(missing),
                sensitivity: Micrometre(0),
                sensitivity_nl: 0,
            };
            for missing in [i32::MIN, 0, i32::MAX] {
                let _ = outrun.outran(&told(missing));
            }
        }
    }
}
