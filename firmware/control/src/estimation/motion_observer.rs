//! Motion observer: estimates position and speed of the piston, and predicts where it will stop.
//!
//! The valve map and the spool lag convert the coil currents to a model speed. The angle sensor measures the position.
//! The observer integrates the model speed and corrects it with the measured position:
//!
//! ```text
//! x' = v_model + b + e / T        e = x_measured - x
//! b' = e / (4 T^2)                both poles at 1 / (2 T)
//! ```
//!
//! `b` is the speed error of the valve map (a shifted threshold, an unknown load). It is adapted only while a move is
//! demanded. The observer of a sensor that lags is [`super::delayed_output`], the model of a sinking load
//! [`super::free_fall`]. The spool lags are identified from the position error ([`super::spool_lag`]) and kept for later
//! moves. The position is in nanometres: a speed in um/s is then the distance of one millisecond.

use hitch_quantities::calibration::design_parameters::{HydraulicParameters, MotionParameters};
use hitch_quantities::fixed::Divisor;
use hitch_quantities::piston::piston_speed;
use hitch_quantities::units::{
    MicroLitrePerSecond, Micrometre, MicrometrePerSecond, MilliAmp, Millisecond,
};
use hitch_quantities::{Calibration, CoilCurrents};

use super::compensator_oscillation::CompensatorOscillation;
use super::damping::Damping;
use super::delayed_output::{self, DelayedOutput, LaggingAngle, Pole};
use super::free_fall::FreeFall;
use super::millisecond_q3::MillisecondQ3;
use super::move_record::MoveRecord;
use super::peak_velocity_ratio::PeakVelocityRatio;
use super::spool::Spool;
use super::spool_lag::{LagRegression, SpoolLagEstimator, nominal_lags};
use super::stop_prediction::{StopPrediction, distance_in};
use super::valve_closing_delay::ValveClosingDelay;
use crate::valve::closing::ClosingCurves;
use crate::valve::drop_scale::DropScale;
use crate::valve::phase::{Direction, Phase};

/// Estimates the motion of the piston.
#[derive(Clone, Copy, Debug, Default)]
pub struct MotionObserver {
    started: bool,
    position_nm: i32,
    position: Micrometre,
    /// Sum of errors; see [`Correction`].
    bias_sum: i32,
    bias: MicrometrePerSecond,
    /// Speed of the valve model.
    model_speed: MicrometrePerSecond,
    /// Its lowering part, positive downwards.
    sinking: MicrometrePerSecond,
    /// Steady-state speed of the present valve openings.
    opening_speed: MicrometrePerSecond,
    lag_regression: LagRegression,
    velocity_ratio: PeakVelocityRatio,
    /// Lag estimates of lift and lowering valve.
    lags: [SpoolLagEstimator; 2],
    /// Correction of the lag of the active valve by the present move.
    lag_correction: MillisecondQ3,
    oscillation: CompensatorOscillation,
    damping: Damping,
    /// Closing delays of lift and lowering valve.
    closing_delays: [ValveClosingDelay; 2],
    /// True on a move to a set point. The closing delay is not used for a correction: it is so slow that most of its
    /// distance follows after the predicted end.
    uses_closing_delay: bool,
    /// Predicted stop and speed at the last cut of the coil.
    cut: (Micrometre, MicrometrePerSecond),
    lift_spool: Spool,
    lower_spool: Spool,
    /// Slope dQ/dI of the open valve at its reference drop, for each ampere.
    slope: MicroLitrePerSecond,
    /// What a sensor with lag shows.
    output: DelayedOutput,
    /// Spool positions of lift and lowering valve, as equivalent currents.
    spools: [MilliAmp; 2],
}

impl MotionObserver {
    /// Takes in one measurement; `lagging`: that of a sensor with lag. The speed bias is adapted only while a move is
    /// demanded.
    pub fn update(
        &mut self,
        measured: Micrometre,
        lagging: Option<&LaggingAngle<'_>>,
        phase: Phase,
        parameters: &MotionParameters,
    ) {
        let measured_nm = measured.0.saturating_mul(1000);
        if !self.started {
            self.started = true;
            self.position_nm = measured_nm;
            self.position = measured;
        }
        self.damping.step(measured_nm);
        let correction = match lagging {
            Some(shown) => self.delayed_correction(shown, self.oscillation.pole(phase), parameters),
            None => self.direct_correction(measured_nm, parameters),
        };
        self.position_nm = self.position_nm.saturating_add(correction.position_nm);
        self.position = Micrometre(Divisor::THOUSAND.divide(self.position_nm));
        self.update_bias(&correction, phase, parameters);
        let lag = lagging.map_or(Millisecond::ZERO, |shown| shown.lag);
        self.output.follow(self.speed(), self.model_speed, lag);
    }

    /// Moves the position by one step; its correction by a sensor without lag.
    fn direct_correction(&mut self, measured_nm: i32, parameters: &MotionParameters) -> Correction {
        let (time, bias_time) = if self.sinking > MicrometrePerSecond::ZERO {
            (parameters.lowering_time, parameters.lowering_time)
        } else {
            (
                parameters.position_time,
                self.oscillation
                    .bias_time(parameters.position_time, self.model_speed),
            )
        };
        let position_time = time.divisor();
        self.position_nm = self.position_nm.saturating_add(self.speed().0);
        let error = measured_nm.saturating_sub(self.position_nm);
        self.output.forget();
        Correction {
            error,
            position_nm: position_time.divide(error),
            bias_sum: bias_sum(bias_time),
            decay: position_time,
        }
    }

    /// The same by a sensor with lag.
    fn delayed_correction(
        &mut self,
        shown: &LaggingAngle<'_>,
        pole: Pole,
        parameters: &MotionParameters,
    ) -> Correction {
        let error = self.output.compare(shown, self.position, pole);
        self.position_nm = self.position_nm.saturating_add(self.speed().0);
        Correction {
            error,
            position_nm: delayed_output::position_correction_nm(error, pole),
            bias_sum: pole.bias_sum(),
            decay: parameters.position_time.divisor(),
        }
    }

    /// Integrates the error while a move is demanded.
    fn update_bias(
        &mut self,
        correction: &Correction,
        phase: Phase,
        parameters: &MotionParameters,
    ) {
        if phase.is_moving() {
            let limit = parameters.bias_limit.0.saturating_mul(correction.bias_sum);
            self.bias_sum = self
                .bias_sum
                .saturating_add(correction.error)
                .max(limit.saturating_neg())
                .min(limit);
        } else {
            self.bias_sum = self
                .bias_sum
                .saturating_sub(correction.decay.divide(self.bias_sum));
        }
        let divisor = Divisor::at_least_one(correction.bias_sum);
        self.bias = MicrometrePerSecond(divisor.divide(self.bias_sum));
    }

    /// Updates the lag estimate of the active spool, in each step of a move. The motion that a sensor with lag shows does
    /// not tell the lag of the spool from an error of its own: then nothing is estimated.
    pub fn update_spool_lag(
        &mut self,
        measured: Micrometre,
        phase: Phase,
        parameters: &MotionParameters,
        angle_lag: Millisecond,
    ) {
        // Without flow there is no position error, and the active valve is not known.
        let flows = self.model_speed != MicrometrePerSecond::ZERO;
        if phase == Phase::Holding || !flows || angle_lag > Millisecond::ZERO {
            return;
        }
        let [lift, lower] = self.lags;
        let sinks = self.sinking > MicrometrePerSecond::ZERO;
        let (usual, lag) = if sinks {
            (parameters.lowering_trail, lower)
        } else {
            (parameters.lift_trail, lift)
        };
        let measured_nm = measured.0.saturating_mul(1000);
        self.lag_regression
            .step(measured_nm, self.model_speed, self.slope, usual.into());
        self.lag_correction = self
            .lag_regression
            .additional_lag(lag, parameters.lag_limit.into());
        if !sinks {
            self.velocity_ratio.step(measured_nm, self.model_speed);
            let excess_lag = lift.additional_lag() + self.lag_correction - lower.identified();
            self.oscillation
                .suspect(excess_lag, parameters.swing_lag.into());
        }
    }

    /// Uses the closing delay in this move: it is a move to a set point.
    pub fn enable_closing_delay(&mut self) {
        self.uses_closing_delay = true;
    }

    /// Records the predicted stop and the speed at the moment the coil is cut.
    pub fn record_cut(&mut self, closing: &ClosingCurves, calibration: &Calibration) {
        let place = self
            .stop_prediction(&calibration.hydraulics)
            .predicted_stop_after_cut(self.closing_share(closing));
        self.cut = (place, self.opening_speed + self.bias);
    }

    /// Identifies lag and closing delay from an undisturbed move that ended at `rest`. `of_offset`: part of the
    /// distance error that the threshold offset causes. True if the move may also be used to identify the offset.
    pub fn learn_from_move(
        &mut self,
        record: &MoveRecord,
        of_offset: Micrometre,
        rest: Micrometre,
        calibration: &Calibration,
    ) -> bool {
        let (parameters, hydraulics) = (&calibration.motion, &calibration.hydraulics);
        let angle_lag = calibration.sensors.angle_lag;
        if angle_lag > Millisecond::ZERO {
            self.learn_closing_delay(record.direction, rest, hydraulics);
            return true;
        }
        self.lag_regression.correct(record, of_offset);
        let limit = parameters.lag_limit.into();
        let [lift, lower] = &mut self.lags;
        if record.direction == Direction::Lift {
            let excess_lag = lift.additional_lag() - lower.identified();
            let residual_lag = excess_lag + self.lag_regression.additional_lag(*lift, limit);
            let oscillation_limit = parameters.swing_lag.into();
            self.oscillation
                .rule_out(self.velocity_ratio.shows_oscillation(record));
            if !self.oscillation.evaluate_move(
                excess_lag + self.lag_correction,
                residual_lag,
                oscillation_limit,
            ) {
                return false;
            }
        }
        let (lag, other) = match record.direction {
            Direction::Lift => (lift, lower),
            Direction::Lower => (lower, lift),
        };
        lag.learn(&self.lag_regression, limit);
        if record.direction == Direction::Lift {
            self.oscillation
                .revoke(lag.additional_lag() - other.identified());
        }
        other.initialize_from(*lag);
        self.lag_correction = MillisecondQ3::default();
        self.learn_closing_delay(record.direction, rest, hydraulics);
        true
    }

    /// Identifies the closing delay of a valve from where the hitch came to rest.
    fn learn_closing_delay(
        &mut self,
        direction: Direction,
        rest: Micrometre,
        hydraulics: &HydraulicParameters,
    ) {
        let [lift, lower] = &mut self.closing_delays;
        let [lift_lag, lower_lag] = nominal_lags(hydraulics);
        let (delay, other, spool_lag) = match direction {
            Direction::Lift => (lift, lower, lift_lag),
            Direction::Lower => (lower, lift, lower_lag),
        };
        let (place, speed) = self.cut;
        delay.learn(rest - place, speed, spool_lag);
        other.initialize_from(*delay);
    }

    /// A lift overshot its set point by far.
    pub fn confirm_oscillation(&mut self) {
        self.oscillation.confirm();
    }

    /// The present move is obstructed or cancelled, no evidence of an oscillation.
    pub fn discard_move(&mut self) {
        self.oscillation.discard_move();
    }

    /// True if the load oscillates on its compensator: ramps have to be gentle.
    #[must_use]
    pub fn has_compensator_oscillation(&self) -> bool {
        self.oscillation.is_detected()
    }

    /// Speed correction that damps the oscillation of the load on its oil.
    #[must_use]
    pub fn damping(&self, direction: Direction) -> MicrometrePerSecond {
        match direction {
            Direction::Lift if !self.has_compensator_oscillation() => {
                self.damping.demand(self.speed() - self.output.growth())
            }
            _ => MicrometrePerSecond::ZERO,
        }
    }

    /// Total lags of lift and lowering spool: nominal plus identified.
    fn lags(&self, hydraulics: &HydraulicParameters) -> [MillisecondQ3; 2] {
        let [nominal_lift, nominal_lower] = nominal_lags(hydraulics).map(MillisecondQ3::from);
        let [lift, lower] = self.lags.map(|lag| lag.additional_lag());
        [nominal_lift + lift, nominal_lower + lower]
    }

    /// Takes in the regulated currents and updates the valve model. `slowing`: the move decelerates.
    pub fn apply_currents(
        &mut self,
        currents: CoilCurrents,
        slowing: bool,
        scale: DropScale,
        calibration: &Calibration,
    ) {
        let hydraulics = &calibration.hydraulics;
        let [lift_lag, lower_lag] = self.lags(hydraulics).map(MillisecondQ3::divisor);
        let lift = self
            .lift_spool
            .follow(currents.lift, hydraulics.hysteresis, lift_lag);
        let lower = self
            .lower_spool
            .follow(currents.lower, hydraulics.hysteresis, lower_lag);
        let (up, lift_slope) = calibration.lift.flow_and_slope(lift);
        let (down, lower_slope) = calibration.lower.flow_and_slope(lower);
        let down = scale.to_present(down);
        let before = self.model_speed;
        let area = hydraulics.piston_area;
        let settled = piston_speed(down, area);
        self.sinking = FreeFall::of(hydraulics.load_ratio).next_speed(self.sinking, settled);
        self.opening_speed = piston_speed(up, area) - settled;
        self.model_speed = piston_speed(up, area) - self.sinking;
        if slowing {
            self.scale_bias_with_flow(before);
        }
        self.spools = [lift, lower];
        self.slope = if down > MicroLitrePerSecond::ZERO {
            lower_slope
        } else {
            lift_slope
        };
    }

    /// Scales the bias with the flow. The map error is mostly proportional to the flow (load, viscosity), and the
    /// measured position would correct it too late for stopping.
    fn scale_bias_with_flow(&mut self, before: MicrometrePerSecond) {
        let fall = before.magnitude() - self.model_speed.magnitude();
        if fall > MicrometrePerSecond::ZERO {
            let share = Divisor::at_least_one(before.magnitude().0).divide(self.bias_sum);
            self.bias_sum = self.bias_sum.saturating_sub(share.saturating_mul(fall.0));
        }
    }

    /// A move begins: resets bias and identification. `compensator_lag`: that of the calibration.
    pub fn begin_move(&mut self, compensator_lag: Millisecond) {
        self.lag_regression = LagRegression::from(self.position_nm);
        self.velocity_ratio = PeakVelocityRatio::from(self.position_nm);
        self.uses_closing_delay = false;
        self.oscillation.begin_move(compensator_lag);
        self.lag_correction = MillisecondQ3::default();
        self.bias_sum = 0;
        self.bias = MicrometrePerSecond::ZERO;
    }

    /// Positions of lift and lowering spool, as currents.
    #[must_use]
    pub const fn spools(&self) -> [MilliAmp; 2] {
        self.spools
    }

    /// Piston travel.
    #[must_use]
    pub fn position(&self) -> Micrometre {
        self.position
    }

    /// Piston speed.
    #[must_use]
    pub fn speed(&self) -> MicrometrePerSecond {
        self.model_speed + self.bias
    }

    /// Position that the angle sensor shows of a hitch at the estimated one.
    #[must_use]
    pub fn shown_position(&self) -> Micrometre {
        self.position - self.output.distance()
    }

    /// Speed of the valve model behind the lag of the angle sensor.
    #[must_use]
    pub fn shown_model_speed(&self) -> MicrometrePerSecond {
        self.model_speed - self.output.model_growth()
    }

    /// True if the angle sensor shows the position within this distance.
    #[must_use]
    pub fn is_shown_within(&self, distance: Micrometre) -> bool {
        self.output.distance().magnitude() <= distance
    }

    /// Piston speed of the valve model.
    #[must_use]
    pub fn model_speed(&self) -> MicrometrePerSecond {
        self.model_speed
    }

    /// Slope dQ/dI of the open valve at its reference drop, for each ampere.
    #[must_use]
    pub fn slope(&self) -> MicroLitrePerSecond {
        self.slope
    }

    /// Present speed error of the valve map.
    #[must_use]
    pub fn bias(&self) -> MicrometrePerSecond {
        self.bias
    }

    /// Lag of the lowering spool, with what moves have identified.
    #[must_use]
    pub fn lowering_lag(&self, hydraulics: &HydraulicParameters) -> Millisecond {
        let [_, lower] = self.lags(hydraulics);
        (lower + self.lag_correction).rounded()
    }

    /// Predicts where the piston stops.
    #[must_use]
    pub fn stop_prediction(&self, hydraulics: &HydraulicParameters) -> StopPrediction {
        let speed = self.opening_speed + self.bias;
        let [lift, lower] = self.lags(hydraulics);
        let [lift_delay, lower_delay] = self.closing_delays;
        let (lag, delay) = if self.opening_speed < MicrometrePerSecond::ZERO {
            (lower, lower_delay)
        } else {
            (lift, lift_delay)
        };
        let delay = if self.uses_closing_delay {
            delay.delay()
        } else {
            MillisecondQ3(0)
        };
        let lag = (lag + self.lag_correction).max(MillisecondQ3(0));
        let within = |time| distance_in(time, speed);
        StopPrediction {
            without_lag: self.position()
                - FreeFall::of(hydraulics.load_ratio).stopping_distance(self.sinking)
                + within(delay),
            lag_distance: within(lag),
        }
    }

    /// Share of the spool lag distance that remains if the coil is cut now, in thousandths.
    ///
    /// The spool then moves towards zero current instead of its threshold, and closes earlier; see
    /// [`crate::valve::closing`].
    #[must_use]
    pub fn closing_share(&self, closing: &ClosingCurves) -> i32 {
        let [lift, lower] = self.spools;
        if self.model_speed < MicrometrePerSecond::ZERO {
            closing.lower.share(lower)
        } else {
            closing.lift.share(lift)
        }
    }
}

/// Correction of one step.
#[derive(Clone, Copy, Debug)]
struct Correction {
    /// What the bias integrates: the position error, nm, or that of a sensor with lag, um ms.
    error: i32,
    /// Correction of the position, nm.
    position_nm: i32,
    /// Sum of errors for a bias of 1 um/s.
    bias_sum: i32,
    /// Time constant with which the bias decays while no move is demanded.
    decay: Divisor,
}

/// `4 T^2`: converts the sum of position errors to the bias.
fn bias_sum(time: Millisecond) -> i32 {
    let time = time.0.max(1);
    // Half a second at most.
    time.wrapping_mul(time).wrapping_mul(4)
}
