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
//! `b` is what the map gets wrong (a shifted threshold, an unknown load); it is only learnt while the valves are meant
//! to move something. A load that sinks follows its valve by [`super::free_fall`]. How slow the spools of this machine
//! are is learnt from how far the hitch trails them ([`super::lag`]), and kept from move to move. Position is kept in
//! nanometres: a speed in um/s is then just the way of one millisecond.

use hitch_quantities::calibration::design_parameters::{HydraulicParameters, MotionParameters};
use hitch_quantities::fixed::Divisor;
use hitch_quantities::piston::piston_speed;
use hitch_quantities::units::{
    MicroLitrePerSecond, Micrometre, MicrometrePerSecond, MilliAmp, Millisecond,
};
use hitch_quantities::{Calibration, CoilCurrents};

use super::course::Told;
use super::damping::Damping;
use super::free_fall::{next_speed, run_out};
use super::lag::{Eighths, Lag, Trail, known_lags};
use super::late::Late;
use super::outrun::Outrun;
use super::swing::Swing;
use crate::valve::closing::Closing;
use crate::valve::drop_scale::DropScale;
use crate::valve::phase::{Direction, Phase};

/// Estimated motion of the piston.
#[derive(Clone, Copy, Debug, Default)]
pub struct Motion {
    started: bool,
    position_nm: i32,
    position: Micrometre,
    bias_sum_nm: i32,
    bias: MicrometrePerSecond,
    /// What the valves give now.
    model_speed: MicrometrePerSecond,
    /// The part of it that goes down.
    sinking: MicrometrePerSecond,
    /// What their openings give in the long run.
    opening_speed: MicrometrePerSecond,
    trail: Trail,
    outrun: Outrun,
    /// Lags of lift and lowering valve.
    lags: [Lag; 2],
    /// How much slower than that the valve in use is, by what this move has told so far.
    further: Eighths,
    swing: Swing,
    damping: Damping,
    /// How late lift and lowering valve close.
    late: [Late; 2],
    /// Whether that counts: on a move to a set point it does, a correction creeps, and most of its way is still to come
    /// when the estimate thinks it over.
    counts_late: bool,
    /// Where the hitch should come to rest since its coil was cut, and how fast its valve let it go then.
    cut: (Micrometre, MicrometrePerSecond),
    lift_spool: Spool,
    lower_spool: Spool,
    /// How much the flow through the valve that is open changes for each ampere, at the drop of its table.
    slope: MicroLitrePerSecond,
    /// Currents that the spools have followed to, lift and lowering.
    spools: [MilliAmp; 2],
}

impl Motion {
    /// Takes in one measurement; what the map gets wrong is learnt while the valves are meant to be moving the hitch.
    pub fn update(&mut self, measured: Micrometre, phase: Phase, parameters: &MotionParameters) {
        let measured_nm = measured.0.saturating_mul(1000);
        if !self.started {
            self.started = true;
            self.position_nm = measured_nm;
        }
        self.damping.step(measured_nm);
        let (time, bias_time) = match self.sinking > MicrometrePerSecond::ZERO {
            true => (parameters.lowering_time, parameters.lowering_time),
            false => (
                parameters.position_time,
                self.swing
                    .bias_time(parameters.position_time, self.model_speed),
            ),
        };
        let position_time = time.divisor();
        self.position_nm = self.position_nm.saturating_add(self.speed().0);
        let error = measured_nm.saturating_sub(self.position_nm);
        self.position_nm = self.position_nm.saturating_add(position_time.divide(error));
        self.position = Micrometre(Divisor::THOUSAND.divide(self.position_nm));
        let bias_time = bias_divisor(bias_time);
        if phase.is_moving() {
            let limit = parameters.bias_limit.0.saturating_mul(bias_time.1);
            self.bias_sum_nm = self
                .bias_sum_nm
                .saturating_add(error)
                .max(limit.saturating_neg())
                .min(limit);
        } else {
            self.bias_sum_nm = self
                .bias_sum_nm
                .saturating_sub(position_time.divide(self.bias_sum_nm));
        }
        self.bias = MicrometrePerSecond(bias_time.0.divide(self.bias_sum_nm));
    }

    /// How far the hitch trails its valve tells how slow its spool is, at each step of a move.
    pub fn follow_trail(
        &mut self,
        measured: Micrometre,
        phase: Phase,
        parameters: &MotionParameters,
    ) {
        // Without flow there is no speed to trail, and it is not known which valve is in use.
        let flows = self.model_speed != MicrometrePerSecond::ZERO;
        if phase == Phase::Holding || !flows {
            return;
        }
        let [lift, lower] = self.lags;
        let sinks = self.sinking > MicrometrePerSecond::ZERO;
        let (usual, lag) = match sinks {
            true => (parameters.lowering_trail, lower),
            false => (parameters.lift_trail, lift),
        };
        let measured_nm = measured.0.saturating_mul(1000);
        self.trail
            .step(measured_nm, self.model_speed, self.slope, usual.into());
        self.further = self.trail.further(lag, parameters.lag_limit.into());
        if !sinks {
            self.outrun.step(measured_nm, self.model_speed);
            let beyond_spools = lift.further() + self.further - lower.told();
            self.swing
                .notice(beyond_spools, parameters.swing_lag.into());
        }
    }

    /// The move that begins goes to a set point.
    pub fn count_late(&mut self) {
        self.counts_late = true;
    }

    /// The coil has just been cut: where that should bring the hitch.
    pub fn cut(&mut self, closing: &Closing, calibration: &Calibration) {
        let place = self
            .run_on(&calibration.hydraulics)
            .cut_point(self.share_of_cut(closing));
        self.cut = (place, self.opening_speed + self.bias);
    }

    /// Takes in the end of a move at `rest` that nothing else had a part in, `of_offset` of whose missing way is its
    /// valve's threshold's; true if its way tells of its valve.
    pub fn learn_lag(
        &mut self,
        told: &Told,
        of_offset: Micrometre,
        rest: Micrometre,
        parameters: &MotionParameters,
    ) -> bool {
        self.trail.end(told, of_offset);
        let limit = parameters.lag_limit.into();
        let [lift, lower] = &mut self.lags;
        if told.direction == Direction::Lift {
            let beyond = lift.further() - lower.told();
            let left = beyond + self.trail.further(*lift, limit);
            let suspicious = parameters.swing_lag.into();
            self.swing.acquit(self.outrun.outran(told));
            if !self.swing.decide(beyond + self.further, left, suspicious) {
                return false;
            }
        }
        let [late_lift, late_lower] = &mut self.late;
        let (lag, other, late, other_late) = match told.direction {
            Direction::Lift => (lift, lower, late_lift, late_lower),
            Direction::Lower => (lower, lift, late_lower, late_lift),
        };
        let (place, speed) = self.cut;
        late.learn(rest - place, speed);
        other_late.assume(*late);
        lag.learn(&self.trail, limit);
        if told.direction == Direction::Lift {
            self.swing.doubt(lag.further() - other.told());
        }
        other.assume(*lag);
        self.further = Eighths::default();
        true
    }

    /// A lift went far beyond its set point.
    pub fn overshot(&mut self) {
        self.swing.prove();
    }

    /// Something stands in the way of the present move.
    pub fn obstruct(&mut self) {
        self.swing.obstruct();
    }

    /// True if the load swings when it is lifted in a hurry.
    #[must_use]
    pub fn swings(&self) -> bool {
        self.swing.is_seen()
    }

    /// What to ask the valve of a `direction` for beyond the speed that is right: it stops a load's swing on its oil.
    #[must_use]
    pub fn damping(&self, direction: Direction) -> MicrometrePerSecond {
        match direction {
            Direction::Lift if !self.swings() => self.damping.demand(self.speed()),
            _ => MicrometrePerSecond::ZERO,
        }
    }

    /// What has been learnt of the lags of this machine's spools, lift and lowering.
    fn lags(&self, hydraulics: &HydraulicParameters) -> [Eighths; 2] {
        let [known_lift, known_lower] = known_lags(hydraulics).map(Eighths::from);
        let [lift, lower] = self.lags.map(|lag| lag.further());
        [known_lift + lift, known_lower + lower]
    }

    /// Takes in the currents that have just been sent to the coils; `slowing`: a move is coming to its end.
    pub fn drive(
        &mut self,
        currents: CoilCurrents,
        slowing: bool,
        scale: DropScale,
        calibration: &Calibration,
    ) {
        let hydraulics = &calibration.hydraulics;
        let [lift_lag, lower_lag] = self.lags(hydraulics).map(Eighths::divisor);
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
        self.sinking = next_speed(self.sinking, settled);
        self.opening_speed = piston_speed(up, area) - settled;
        self.model_speed = piston_speed(up, area) - self.sinking;
        if slowing {
            self.shrink_bias(before);
        }
        self.spools = [lift, lower];
        self.slope = match down > MicroLitrePerSecond::ZERO {
            true => lower_slope,
            false => lift_slope,
        };
    }

    /// What the map gets wrong is mostly a share of the flow (load, viscosity), so it shrinks with the flow; waiting
    /// until the sensor tells so would take longer than stopping does.
    fn shrink_bias(&mut self, before: MicrometrePerSecond) {
        let fall = before.magnitude() - self.model_speed.magnitude();
        if fall > MicrometrePerSecond::ZERO {
            let share = Divisor::at_least_one(before.magnitude().0).divide(self.bias_sum_nm);
            self.bias_sum_nm = self
                .bias_sum_nm
                .saturating_sub(share.saturating_mul(fall.0));
        }
    }

    /// Forgets what the map got wrong: the next move may go the other way.
    pub fn forget_bias(&mut self) {
        self.trail = Trail::from(self.position_nm);
        self.outrun = Outrun::from(self.position_nm);
        self.counts_late = false;
        self.swing.begin();
        self.further = Eighths::default();
        self.bias_sum_nm = 0;
        self.bias = MicrometrePerSecond::ZERO;
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

    /// Piston speed that the valves alone should give.
    #[must_use]
    pub fn model_speed(&self) -> MicrometrePerSecond {
        self.model_speed
    }

    /// How much the flow through the valve that is open changes for each ampere, at the drop of its table.
    #[must_use]
    pub fn slope(&self) -> MicroLitrePerSecond {
        self.slope
    }

    /// What the valve map gets wrong at present.
    #[must_use]
    pub fn bias(&self) -> MicrometrePerSecond {
        self.bias
    }

    /// How far the piston still goes.
    #[must_use]
    pub fn run_on(&self, hydraulics: &HydraulicParameters) -> RunOn {
        let speed = self.opening_speed + self.bias;
        let [lift, lower] = self.lags(hydraulics);
        let [late_lift, late_lower] = self.late;
        let (lag, late) = match self.opening_speed < MicrometrePerSecond::ZERO {
            true => (lower, late_lower),
            false => (lift, late_lift),
        };
        let late = match self.counts_late {
            true => late.by(),
            false => Eighths(0),
        };
        let lag = (lag + self.further).max(Eighths(0));
        let within = |time| way_in(time, speed);
        RunOn {
            from: self.position() - run_out(self.sinking) + within(late),
            of_spool: within(lag),
        }
    }

    /// Share of the spool's part that is left of it if the coil is cut now, in thousandths.
    ///
    /// The spool then makes for zero current, not for its threshold, and is shut sooner; see [`crate::valve::closing`].
    #[must_use]
    pub fn share_of_cut(&self, closing: &Closing) -> i32 {
        let [lift, lower] = self.spools;
        match self.model_speed < MicrometrePerSecond::ZERO {
            true => closing.lower.share(lower),
            false => closing.lift.share(lift),
        }
    }
}

/// How far the piston still goes from where it is.
#[derive(Clone, Copy, Debug)]
pub struct RunOn {
    /// Where it would stop if its spool turned at once and its valve were shut: a load that sinks runs out by what its
    /// inertia adds ([`run_out`]), and a valve closes late ([`Late`]).
    from: Micrometre,
    /// What the spool's lag adds to the way.
    of_spool: Micrometre,
}

impl RunOn {
    /// Where the piston comes to rest if the demanded speed is zero from now on.
    ///
    /// With a first-order spool, `v' = (u - v) / T`, the point `P = x + T v` moves with exactly the
    /// demanded speed: `P' = v + T v' = u`. Control of `P` needs no allowance for the lag.
    #[must_use]
    pub fn resting_point(&self) -> Micrometre {
        self.from + self.of_spool
    }

    /// Where the piston comes to rest if the coil is cut now, with [`Motion::share_of_cut`].
    #[must_use]
    pub fn cut_point(&self, share: i32) -> Micrometre {
        self.from + self.of_spool.scaled(share, Divisor::THOUSAND)
    }
}

/// Takes up the play of a valve once a move slows down, and keeps it taken up until the move is over.
#[derive(Clone, Copy, Debug, Default)]
pub struct Slack {
    fastest: MicrometrePerSecond,
    taken: MilliAmp,
}

impl Slack {
    /// True once a move slows down.
    #[must_use]
    pub fn is_taken(&self) -> bool {
        self.taken > MilliAmp::ZERO
    }

    /// One step at the demanded `speed`; how much less current the same flow needs.
    pub fn take_up(&mut self, speed: MicrometrePerSecond, hysteresis: MilliAmp) -> MilliAmp {
        /// Slower than the fastest by this much means slowing down: more than corrections of the map.
        const SLOWER: MicrometrePerSecond = MicrometrePerSecond(4_000);
        /// Taken up over so many steps: a step of current would swing the load.
        const STEPS: i32 = 16;
        if speed <= MicrometrePerSecond::ZERO {
            *self = Self::default();
            return MilliAmp::ZERO;
        }
        self.fastest = self.fastest.max(speed);
        if self.fastest - speed > SLOWER {
            let step = MilliAmp((hysteresis.0 / STEPS).max(1));
            self.taken = (self.taken + step).min(hysteresis);
        }
        self.taken
    }
}

/// Way at a speed in the time that a valve may take to close. A word holds the product: no hitch is faster than this,
/// and no lag that a calibration may have, with all that a machine may add to it, is longer than 0.7 s.
fn way_in(time: Eighths, speed: MicrometrePerSecond) -> Micrometre {
    const FASTEST: MicrometrePerSecond = MicrometrePerSecond(380_000);
    let speed = speed.limited(-FASTEST, FASTEST);
    Micrometre(Eighths::IN_SECOND.divide(speed.0.wrapping_mul(time.0)))
}

/// `4 T^2` as divisor and as number: from the sum of position errors to the bias.
fn bias_divisor(time: Millisecond) -> (Divisor, i32) {
    let time = time.0.max(1);
    // Half a second at most.
    let product = time.wrapping_mul(time).wrapping_mul(4);
    (Divisor::at_least_one(product), product)
}

/// Play and first-order lag of solenoid and spool, in current on the rising branch.
#[derive(Clone, Copy, Debug, Default)]
struct Spool {
    play: MilliAmp,
    microampere: i32,
}

impl Spool {
    fn follow(&mut self, coil: MilliAmp, hysteresis: MilliAmp, lag: Divisor) -> MilliAmp {
        /// A spool whose coil is off rests from here on: half of what opens any valve.
        const RESTING_MICROAMPERE: i32 = 300_000;
        if coil == MilliAmp::ZERO && self.microampere < RESTING_MICROAMPERE {
            return MilliAmp::ZERO;
        }
        self.play = self.play.limited(coil, coil + hysteresis);
        let goal = self.play.0.saturating_mul(1000);
        let error = goal.saturating_sub(self.microampere);
        self.microampere = self.microampere.saturating_add(lag.divide(error));
        MilliAmp(Divisor::THOUSAND.divide(self.microampere))
    }
}
