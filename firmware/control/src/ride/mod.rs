//! Ride damping: a carried implement yields to the jolts of the road, so that it brakes the pitch of the tractor.
//!
//! ```text
//! cylinder pressure -> band-pass, lead -> -gain --+--> limits of speed and band -> dead band -> piston speed
//! set point - travel -> 1 / centring time --------+
//! ```
//!
//! A hitch that gives way with a speed in proportion to its load is a damper between tractor and implement. It acts with the
//! hitch at rest at the set point of the lever, high enough, and with a ground speed above a threshold. A sensor that is
//! missing, a move of the lever, or any other command ends it in the same step.

pub mod band_pass;

use hitch_quantities::calibration::field_parameters::RideParameters;
use hitch_quantities::fixed::{Divisor, mul_div};
use hitch_quantities::units::{
    Micrometre, MicrometrePerSecond, MilliBar, MilliDegree, MilliDegreePerSecond,
};
use hitch_quantities::{Calibration, Inputs, Trouble};

use crate::reference::received::Received;
use band_pass::BandPass;

/// Speed for the distance to the end of the band, 1/s: a quarter of the inverse of a spool lag of 55 ms, behind which the hitch
/// then stops without overshoot.
const BRAKING_PER_S: i32 = 5;

/// What ride damping depends on besides inputs and calibration.
#[derive(Clone, Copy, Debug)]
pub struct Situation {
    /// The hitch is at rest at the set point of the lever, or damping moves it about that.
    pub is_free: bool,
    /// Set point.
    pub set_point: MilliDegree,
    /// Its piston travel.
    pub target: Micrometre,
    /// Highest angle by dial and calibration.
    pub highest: MilliDegree,
    /// Largest lowering speed by the dial.
    pub lowering: MicrometrePerSecond,
    /// Measured piston travel.
    pub travel: Micrometre,
}

/// Ride damping from step to step.
#[derive(Clone, Copy, Debug, Default)]
pub struct RideDamping {
    ground: Received,
    band_pass: BandPass,
    /// The band-passed pressure of this step; `None` without a sensor.
    swing: Option<MilliBar>,
    demand: Option<MicrometrePerSecond>,
}

impl RideDamping {
    /// Whether the machine has it.
    #[must_use]
    pub const fn is_fitted(calibration: &Calibration) -> bool {
        calibration.ride.fitted.0 != 0
    }

    /// The demanded piston speed, positive upwards, 0 with both valves closed; `None`: it does not act.
    #[must_use]
    pub const fn demand(&self) -> Option<MicrometrePerSecond> {
        self.demand
    }

    /// The lost sensor that keeps it off, if the bus reports it nowhere else.
    #[must_use]
    pub fn trouble(&self, calibration: &Calibration) -> Option<Trouble> {
        let is_lost = Self::is_fitted(calibration) && self.ground.last.is_none();
        is_lost.then_some(Trouble::GroundSpeed)
    }

    /// It does not act.
    pub fn end(&mut self) {
        self.demand = None;
    }

    /// One millisecond of the sensors, in any mode, so that the filters have settled when damping begins.
    pub fn sense(
        &mut self,
        inputs: &Inputs,
        pressure: Option<MilliBar>,
        parameters: &RideParameters,
    ) {
        self.ground.step(inputs.ground_speed, parameters.time_out);
        self.swing = pressure.map(|pressure| self.band_pass.step(pressure, parameters));
        if pressure.is_none() {
            self.band_pass.reset();
        }
    }

    /// One step: whether it acts, and the speed.
    pub fn step(&mut self, situation: &Situation, calibration: &Calibration) {
        let parameters = &calibration.ride;
        let threshold = match self.demand {
            Some(_) => parameters.end_speed,
            None => parameters.begin_speed,
        };
        let is_fast = self.ground.last.is_some_and(|speed| speed >= threshold);
        let lowers = situation.lowering > MicrometrePerSecond::ZERO;
        let is_high = situation.set_point >= lowest_carried(calibration);
        let acts = situation.is_free && is_fast && lowers && is_high;
        self.demand = match self.swing {
            Some(swing) if acts => {
                Some(self.opened(speed(swing, situation, calibration), parameters))
            }
            _ => None,
        };
    }

    /// The wanted speed, where a valve is open for it or is to open; both valves closed otherwise.
    fn opened(
        &self,
        wanted: MicrometrePerSecond,
        parameters: &RideParameters,
    ) -> MicrometrePerSecond {
        let present = self.demand.unwrap_or(MicrometrePerSecond::ZERO);
        let is_open = present.0.signum() == wanted.0.signum();
        if is_open || wanted.magnitude() >= parameters.dead_band {
            wanted
        } else {
            MicrometrePerSecond::ZERO
        }
    }
}

/// The lowest set point of a carried implement.
fn lowest_carried(calibration: &Calibration) -> MilliDegree {
    let position = &calibration.position;
    let travel = position.upper_limit - position.lower_limit;
    let share = mul_div(travel.0, calibration.ride.height.0, Divisor::THOUSAND);
    position.lower_limit + MilliDegree(share)
}

/// The law.
fn speed(swing: MilliBar, situation: &Situation, calibration: &Calibration) -> MicrometrePerSecond {
    let parameters = &calibration.ride;
    let yielding = mul_div(swing.0, parameters.gain.0, Divisor::THOUSAND).saturating_neg();
    let off = situation.target - situation.travel;
    // A distance in micrometres over a time in milliseconds is a speed in millimetres a second.
    let centring = mul_div(off.0, 1_000, parameters.centring_time.divisor());
    let wanted = MicrometrePerSecond(yielding.saturating_add(centring));
    let most = parameters.speed;
    let [down, up] = room(situation, calibration).map(|room| {
        let braked = MicrometrePerSecond(room.0.saturating_mul(BRAKING_PER_S));
        braked.limited(MicrometrePerSecond::ZERO, most)
    });
    wanted.limited(-down.min(situation.lowering), up)
}

/// Piston travel that is left downwards and upwards within band and limits.
fn room(situation: &Situation, calibration: &Calibration) -> [Micrometre; 2] {
    let band = calibration.ride.band;
    let set_point = situation.set_point;
    let below = band.min(set_point - calibration.position.lower_limit);
    let above = band.min(situation.highest - set_point);
    let one_degree = MilliDegreePerSecond(1_000);
    // A micrometre a second at a degree a second is a micrometre for a degree.
    let per_degree = calibration.linkage.piston_speed(set_point, one_degree).0;
    let travel = |angle: MilliDegree| Micrometre(mul_div(angle.0, per_degree, Divisor::THOUSAND));
    let off = situation.travel - situation.target;
    [travel(below) + off, travel(above) - off]
}
