//! The motion estimate: where the hitch is, how fast it goes, and where it would come to rest.
//!
//! The coil currents say, through the valve map and the lag of the spool, how fast the piston should
//! move; the angle sensor says where it is. The estimate integrates the first and is drawn to the second:
//!
//! ```text
//! x' = v_model + b + e / T        e = x_measured - x
//! b' = e / (4 T^2)                both poles at 1 / (2 T)
//! ```
//!
//! `b` is what the map gets wrong (a shifted threshold, an unknown load); it is only learnt while the
//! valves are meant to move something. Position is kept in nanometres: a speed in um/s is then just
//! the way of one millisecond.

use super::design_parameters::{HydraulicParameters, MotionParameters};
use super::fixed::Divisor;
use super::units::{
    MicroLitrePerSecond, Micrometre, MicrometrePerSecond, MilliAmp, SquareMillimetre,
};
use super::valve_map::ValveMap;

/// Estimated motion of the piston.
#[derive(Clone, Copy, Debug, Default)]
pub struct Motion {
    started: bool,
    position_nm: i32,
    bias_sum_nm: i32,
    bias: MicrometrePerSecond,
    model_speed: MicrometrePerSecond,
    lift_spool: Spool,
    lower_spool: Spool,
    closing_permille: i32,
}

impl Motion {
    /// Takes in one measurement. `learn`: the valves are meant to be moving the hitch.
    pub fn update(&mut self, measured: Micrometre, learn: bool, parameters: &MotionParameters) {
        let measured_nm = measured.0.saturating_mul(1000);
        if !self.started {
            self.started = true;
            self.position_nm = measured_nm;
        }
        let position_time = parameters.position_time.divisor();
        self.position_nm = self.position_nm.saturating_add(self.speed().0);
        let error = measured_nm.saturating_sub(self.position_nm);
        self.position_nm = self.position_nm.saturating_add(position_time.divide(error));
        let bias_time = bias_divisor(parameters);
        if learn {
            let limit = parameters.bias_limit.scaled(bias_time.1, Divisor::ONE).0;
            self.bias_sum_nm = self
                .bias_sum_nm
                .saturating_add(error)
                .max(-limit)
                .min(limit);
        } else {
            self.bias_sum_nm = self
                .bias_sum_nm
                .saturating_sub(position_time.divide(self.bias_sum_nm));
        }
        self.bias = MicrometrePerSecond(bias_time.0.divide(self.bias_sum_nm));
    }

    /// Takes in the currents that have just been sent to the coils.
    pub fn drive(
        &mut self,
        lift: MilliAmp,
        lower: MilliAmp,
        map: &ValveMap<'_>,
        hydraulics: &HydraulicParameters,
    ) {
        let lag = hydraulics.spool_lag.divisor();
        let lift = self.lift_spool.follow(lift, lag);
        let lower = self.lower_spool.follow(lower, lag);
        let up = map.lift.flow(lift);
        let down = map.scale.to_present(map.lower.flow(lower));
        self.model_speed = piston_speed(up - down, hydraulics.piston_area);
        let closing = half_closing_share(lift, map.lift.threshold());
        self.closing_permille = closing.max(half_closing_share(lower, map.lower.threshold()));
    }

    /// Forgets what the map got wrong: the next move may go the other way.
    pub fn forget_bias(&mut self) {
        self.bias_sum_nm = 0;
        self.bias = MicrometrePerSecond::ZERO;
    }

    /// Piston travel.
    #[must_use]
    pub fn position(&self) -> Micrometre {
        Micrometre(Divisor::THOUSAND.divide(self.position_nm))
    }

    /// Piston speed.
    #[must_use]
    pub fn speed(&self) -> MicrometrePerSecond {
        self.model_speed + self.bias
    }

    /// Piston speed that the valves alone should give.
    #[must_use]
    pub fn model_speed(&self) -> MicrometrePerSecond {
        self.model_speed
    }

    /// What the valve map gets wrong at present.
    #[must_use]
    pub fn bias(&self) -> MicrometrePerSecond {
        self.bias
    }

    /// Where the piston comes to rest if the demanded speed is zero from now on.
    ///
    /// With a first-order spool, `v' = (u - v) / T`, the point `P = x + T v` moves with exactly the
    /// demanded speed: `P' = v + T v' = u`. Control of `P` needs no allowance for the lag.
    #[must_use]
    pub fn resting_point(&self, hydraulics: &HydraulicParameters) -> Micrometre {
        let over_run = Micrometre(self.speed().0).scaled(hydraulics.spool_lag.0, Divisor::THOUSAND);
        self.position() + over_run
    }

    /// Where the piston comes to rest if the coil is cut now.
    ///
    /// The spool then makes for zero current, not for its threshold: from current `I` it is shut after
    /// `T ln(I / I0)`, about `T (I - I0) / I0`, and flow falls evenly meanwhile: half of that at full speed.
    #[must_use]
    pub fn cut_point(&self, hydraulics: &HydraulicParameters) -> Micrometre {
        let full = self.resting_point(hydraulics) - self.position();
        self.position() + full.scaled(self.closing_permille, Divisor::THOUSAND)
    }
}

/// `(I - I0) / (2 I0)` in thousandths, at most one.
fn half_closing_share(current: MilliAmp, threshold: MilliAmp) -> i32 {
    let above = (current - threshold).max(MilliAmp::ZERO);
    let twice = Divisor::at_least_one(threshold.0.saturating_mul(2));
    above.scaled(1000, twice).0.min(1000)
}

/// `4 T^2` as divisor and as number: from the sum of position errors to the bias.
fn bias_divisor(parameters: &MotionParameters) -> (Divisor, i32) {
    let time = parameters.position_time.0.max(1);
    let product = time.saturating_mul(time).saturating_mul(4);
    (Divisor::at_least_one(product), product)
}

/// Flow that moves the piston at `speed`.
#[must_use]
pub fn flow(speed: MicrometrePerSecond, area: SquareMillimetre) -> MicroLitrePerSecond {
    // um/s * mm2 = 1e-3 mm3/s
    MicroLitrePerSecond(speed.0).scaled(area.0, Divisor::THOUSAND)
}

/// Piston speed that a flow gives.
#[must_use]
pub fn piston_speed(flow: MicroLitrePerSecond, area: SquareMillimetre) -> MicrometrePerSecond {
    MicrometrePerSecond(flow.0).scaled(1000, Divisor::at_least_one(area.0))
}

/// First-order lag of solenoid and spool, in current.
#[derive(Clone, Copy, Debug, Default)]
struct Spool {
    microampere: i32,
}

impl Spool {
    fn follow(&mut self, coil: MilliAmp, lag: Divisor) -> MilliAmp {
        let error = coil.0.saturating_mul(1000).saturating_sub(self.microampere);
        self.microampere = self.microampere.saturating_add(lag.divide(error));
        MilliAmp(Divisor::THOUSAND.divide(self.microampere))
    }
}
