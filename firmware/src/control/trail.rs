//! The lag of this machine's spools, told from how far the hitch trails a lift that sets in.
//!
//! A spool that is slower by `dT` than the estimate takes it for leaves the hitch behind by `dT v`, where `v` is the speed
//! that its opening gives, whatever that does meanwhile. So over the rise of a move
//!
//! ```text
//! dT = sum(v behind) / sum(v^2)
//! ```
//!
//! The flow of a compensated lift is known to a few per cent, which spoils that only slowly: the sums end early. A load
//! that is lowered trails its valve by inertia more than by the spool's lag and tells nothing.

use super::fixed::{Divisor, mul_div_seldom};
use super::units::{Micrometre, MicrometrePerSecond, Microsecond};

/// Sum of squares, mm2/s2, from which a lift has told enough: 40 ms at full speed.
const ENOUGH: i32 = 600_000;
/// ... and beyond which an error of the flow would show: 100 ms at full speed.
const COMPLETE: i32 = 2_000_000;

/// Sums over the rise of a lift.
#[derive(Clone, Copy, Debug, Default)]
pub struct Trail {
    /// Where the hitch should be by the valves alone, in nanometres.
    expected_nm: i32,
    /// mm/s times um.
    speed_behind: i32,
    /// mm2/s2.
    speed_squared: i32,
    told: bool,
}

impl Trail {
    /// A lift begins here.
    #[must_use]
    pub fn from(position_nm: i32) -> Self {
        Self {
            expected_nm: position_nm,
            ..Self::default()
        }
    }

    /// One step; `model`: what the valves should give now, `slowing`: the rise is over. Once, when it is known: how much
    /// slower than assumed the spool is.
    pub fn step(
        &mut self,
        measured: Micrometre,
        model: MicrometrePerSecond,
        slowing: bool,
    ) -> Option<Microsecond> {
        if self.told {
            return None;
        }
        self.expected_nm = self.expected_nm.saturating_add(model.0);
        let behind = Divisor::THOUSAND
            .divide(self.expected_nm)
            .saturating_sub(measured.0);
        let speed = Divisor::THOUSAND.divide(model.0);
        self.speed_behind = self
            .speed_behind
            .saturating_add(speed.saturating_mul(behind));
        self.speed_squared = self
            .speed_squared
            .saturating_add(speed.saturating_mul(speed));
        self.told = slowing || self.speed_squared >= COMPLETE;
        (self.told && self.speed_squared >= ENOUGH).then(|| {
            let squared = Divisor::at_least_one(self.speed_squared);
            Microsecond(mul_div_seldom(self.speed_behind, 1000, squared))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lift that ramps to `speed` in um/s with a spool that is `slower_ms` slower than the one of the estimate.
    fn told(speed: f64, flow_error: f64, slower_ms: f64) -> Option<Microsecond> {
        let (lag_ms, mut trail) = (40.0, Trail::from(5_000_000));
        let (mut model, mut truth, mut place_nm) = (0.0, 0.0, 5_000_000.0);
        for ms in 1..400 {
            let opening = speed * (f64::from(ms) / 40.0).min(1.0);
            model += (opening - model) / lag_ms;
            truth += (opening - truth) / (lag_ms + slower_ms);
            place_nm += truth * (1.0 + flow_error);
            let measured = Micrometre((place_nm / 1000.0) as i32);
            let found = trail.step(measured, MicrometrePerSecond(model as i32), ms > 300);
            if found.is_some() {
                assert!(trail.step(measured, MicrometrePerSecond(0), true).is_none());
                return found;
            }
        }
        None
    }

    #[test]
    fn the_lag_of_a_spool_is_told_by_a_lift() {
        // Large differences are told a third short: the regression goes by the estimate's speed. The next lift tells the rest.
        let error_ms = |speed: f64, flow_error: f64, slower_ms: f64| {
            let found = told(speed, flow_error, slower_ms).unwrap();
            (f64::from(found.0) * 1e-3 - slower_ms).abs()
        };
        for slower_ms in [-20.0, -10.0, -5.0, 0.0, 5.0, 10.0, 20.0_f64] {
            let short_ms = 0.4 * slower_ms.abs();
            for speed in [90_000.0, 147_000.0] {
                let error_ms = error_ms(speed, 0.0, slower_ms);
                assert!(error_ms <= 1.0 + short_ms, "{slower_ms}: {error_ms} off");
            }
            let error_ms = error_ms(147_000.0, -0.05, slower_ms);
            assert!(
                error_ms <= 5.0 + short_ms,
                "{slower_ms}, 5 % less flow: {error_ms} off"
            );
        }
    }

    #[test]
    fn a_short_lift_tells_nothing() {
        assert_eq!(told(30_000.0, 0.0, 10.0), None);
    }
}
