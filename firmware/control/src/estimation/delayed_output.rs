//! Observer behind an angle sensor that lags: corrects the position estimate by what the sensor should show.
//!
//! A sensor with the lag `T` shows a hitch that moves with `v` by `T v` behind its place. Taken for the position, such
//! a signal looks like a weak valve first, and like a hitch that moves on after its valve has closed later. The observer
//! therefore has the signal `y` as a third state, and compares the measured value `z` with that:
//!
//! ```text
//! x' = v_model + b + 3 p^2 d     d = T (z - y)
//! b' = p^3 d                     y' = (x - y) / T + (3 p - 1 / T) (z - y)
//! ```
//!
//! All three poles are at `p`, for any lag: 16 /s, as without a lag, and 8 /s for a load that is lifted and oscillates on its compensator
//! ([`Pole`]). The stored state is `d` instead of `y`, since no
//! quotient by a short lag appears in its equation:
//!
//! ```text
//! d' = T z' - (x - z) - 3 p d
//! ```
//!
//! With steps of a millisecond its poles are at `1 - p / 1000`, which is stable for any lag, also one of less than a
//! step. The lag is that of the angle. The signal trails by up to 20 degrees, over which the linkage is not a straight
//! line: with the lag of the piston travel instead, the position would be up to 2 mm off. So `x` and `z` are angles in
//! the last equation, and `d` is an angle times a time, converted at the position. Its unit is 0.001 degree ms: the
//! resolution of the correction is 2 nm.
//!
//! The distance by which the signal trails the position is also computed from the estimated speed alone
//! ([`DelayedOutput::distance`]). It has no measurement noise. The signal has settled once this distance is small.

use hitch_quantities::calibration::linkage::LinkageTable;
use hitch_quantities::fixed::{Divisor, mul_div};
use hitch_quantities::units::{
    Micrometre, MicrometrePerSecond, MilliDegree, MilliDegreePerSecond, Millisecond,
};

/// Steps in a second.
const RATE: i32 = 1_000;

/// Poles of the observer, 1/s.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pole(i32);

impl Pole {
    /// Of a load that follows its valve.
    pub const USUAL: Self = Self(16);
    /// Of a load that oscillates on its compensator, at 2 to 4 Hz behind the open valve: a bias that is as fast as the
    /// oscillation amplifies it.
    pub const OSCILLATING: Self = Self(8);

    /// `p^3` times the square of a step, inverted: a sum of `d` in um ms over this is the bias in um/s.
    #[must_use]
    pub const fn bias_sum(self) -> i32 {
        let Self(pole) = self;
        RATE * RATE / (pole * pole * pole)
    }
}

/// What an angle sensor with lag shows.
#[derive(Clone, Copy, Debug)]
pub struct LaggingAngle<'a> {
    /// The angle.
    pub angle: MilliDegree,
    /// Time constant of the sensor, above zero.
    pub lag: Millisecond,
    /// Rocker angle to piston travel.
    pub linkage: &'a LinkageTable,
}

/// State of the sensor.
#[derive(Clone, Copy, Debug, Default)]
pub struct DelayedOutput {
    /// The last angle.
    measured: Option<MilliDegree>,
    /// `d` as an angle, 0.001 degree ms.
    error_mdeg_ms: i32,
    /// By the estimated speed.
    distance: Trail,
    /// By the speed of the valve model.
    model_distance: Trail,
}

impl DelayedOutput {
    /// Takes in a measurement; `position`: that of the last step. The error `d` as piston travel, um ms.
    pub fn compare(
        &mut self,
        shown: &LaggingAngle<'_>,
        position: Micrometre,
        Pole(pole): Pole,
    ) -> i32 {
        let last = self.measured.unwrap_or(shown.angle);
        let turned = shown.angle - last;
        let place = shown.linkage.angle(position);
        let ahead = place - last;
        let decay = mul_div(self.error_mdeg_ms, 3 * pole, Divisor::at_least_one(RATE));
        self.measured = Some(shown.angle);
        self.error_mdeg_ms = self
            .error_mdeg_ms
            .saturating_add(turned.0.saturating_mul(shown.lag.0))
            .saturating_sub(ahead.0)
            .saturating_sub(decay);
        let error = MilliDegreePerSecond(self.error_mdeg_ms);
        shown.linkage.piston_speed(place, error).0
    }

    /// There is no lag: forgets what was measured.
    pub fn forget(&mut self) {
        self.measured = None;
        self.error_mdeg_ms = 0;
    }

    /// Follows the speeds of one step: the estimated one, and that of the valve model.
    pub fn follow(
        &mut self,
        speed: MicrometrePerSecond,
        model: MicrometrePerSecond,
        lag: Millisecond,
    ) {
        self.distance.follow(speed, lag);
        self.model_distance.follow(model, lag);
    }

    /// Distance by which the sensor shows the hitch behind its place, by the estimated speed.
    #[must_use]
    pub fn distance(&self) -> Micrometre {
        Micrometre(Divisor::THOUSAND.divide(self.distance.nanometre))
    }

    /// Speed with which that distance grows: a speed less this is what the sensor shows of it.
    #[must_use]
    pub fn growth(&self) -> MicrometrePerSecond {
        self.distance.growth
    }

    /// The same for the speed of the valve model.
    #[must_use]
    pub fn model_growth(&self) -> MicrometrePerSecond {
        self.model_distance.growth
    }
}

/// Correction of the position for an error `d`: `3 p^2` times the step.
#[must_use]
pub fn position_correction_nm(error_um_ms: i32, Pole(pole): Pole) -> i32 {
    mul_div(error_um_ms, 3 * pole * pole, Divisor::at_least_one(RATE))
}

/// Distance between a place and what the sensor shows of it, `T` times the shown speed.
#[derive(Clone, Copy, Debug, Default)]
struct Trail {
    nanometre: i32,
    growth: MicrometrePerSecond,
}

impl Trail {
    /// One step with this speed: a speed in um/s is the way of a millisecond in nm. Without lag all of it is shown.
    fn follow(&mut self, speed: MicrometrePerSecond, lag: Millisecond) {
        let whole = self.nanometre.saturating_add(speed.0);
        let hidden = whole.saturating_sub(lag.divisor().divide(whole));
        self.growth = MicrometrePerSecond(hidden.saturating_sub(self.nanometre));
        self.nanometre = hidden;
    }
}
