//! The reference of position control: the lever, or what draft, mix, depth limit and slip guard make of it.
//!
//! ```text
//! pins -> draft signal -> draft loop --+--> selector -> limits -> slip guard -> valve speeds -> set point
//! lever -------------------------------+                              ^
//! speeds -> slip signal ----------------------------------------------+
//! ```
//!
//! It moves the set point of the position law, slowly, and changes nothing below it. Without draft pins, or with an
//! implement or quick lift in command, the lever passes unchanged.
//!
//! The lever stays the operator's in each function: it is the lowest position (depth limit), or at most `draft.margin` above
//! it. So a raised lever takes the implement out of the soil, and above the ground the lever is the set point.

pub mod draft_loop;
pub mod draft_signal;
pub mod hold;
pub mod in_work;
pub mod lag_loop;
pub mod low_pass;
pub mod received;
pub mod selector;
pub mod slip_guard;
pub mod slip_signal;

use hitch_quantities::fixed::Divisor;
use hitch_quantities::units::{
    MicrometrePerSecond, MilliDegree, MilliDegreePerSecond, MilliHertz, Newton, PerMille,
};
use hitch_quantities::{Calibration, Function, Inputs, Reason, Trouble};

use draft_loop::Errors;
use draft_signal::{Draft, DraftSignal};
use lag_loop::Gains;
use selector::{Active, Choice};
use slip_guard::SlipGuard;
use slip_signal::SlipSignal;

use crate::operator::engage::Engagement;

/// Weight of the draft without a mix dial.
const MIDDLE: PerMille = PerMille(500);

/// What the reference depends on besides inputs and calibration.
#[derive(Clone, Copy, Debug)]
pub struct Situation {
    /// Lever, without its noise.
    pub lever: MilliDegree,
    /// Switch of quick engagement.
    pub engagement: Engagement,
    /// Rocker angle.
    pub angle: MilliDegree,
    /// Upper limit of the set point.
    pub highest: MilliDegree,
    /// Largest piston speed of lift and lowering valve.
    pub valve_speeds: [MicrometrePerSecond; 2],
}

/// The reference from step to step.
#[derive(Clone, Copy, Debug, Default)]
pub struct ReferenceControl {
    draft: DraftSignal,
    slip: SlipSignal,
    sensed: Sensed,
    active: Active,
    guard: SlipGuard,
    /// Set point before its steps; `None`: the lever's.
    used: Option<MilliDegree>,
    /// Set point in steps.
    stepped: MilliDegree,
    reason: Option<Reason>,
}

/// What the sensors say in a step.
#[derive(Clone, Copy, Debug)]
struct Sensed {
    draft: Draft,
    /// The last measured draft; `None` while the pins are lost.
    measured: Option<Newton>,
    /// Slip and its limit; `None` where it is not limited.
    slip: Result<Option<(PerMille, PerMille)>, Trouble>,
}

impl Default for Sensed {
    fn default() -> Self {
        Self {
            draft: Draft::Suspect,
            measured: None,
            slip: Ok(None),
        }
    }
}

impl ReferenceControl {
    /// Whether the machine has what the reference needs.
    #[must_use]
    pub const fn is_fitted(calibration: &Calibration) -> bool {
        calibration.draft.fitted.0 != 0
    }

    /// Another set point is in command, or position control has ended: the lever begins anew.
    pub fn end(&mut self) {
        self.active = Active::Lever;
        self.guard = SlipGuard::default();
        self.used = None;
        self.reason = None;
    }

    /// What determines the set point, if it is not the lever alone.
    #[must_use]
    pub const fn reason(&self) -> Option<Reason> {
        self.reason
    }

    /// Whether quick engagement lowers the hitch.
    #[must_use]
    pub const fn engages(&self) -> bool {
        matches!(self.active, Active::Engages(_))
    }

    /// The lost sensor; a pin before a speed.
    #[must_use]
    pub fn trouble(&self) -> Option<Trouble> {
        match self.sensed.draft {
            Draft::Lost(trouble) => Some(trouble),
            _ => self.sensed.slip.err(),
        }
    }

    /// The draft; `None` while the pins are lost.
    #[must_use]
    pub const fn draft(&self) -> Option<Newton> {
        self.sensed.measured
    }

    /// Whether the draft says that the implement is in the soil; `None` without plausible pins.
    #[must_use]
    pub fn in_soil(&self) -> Option<bool> {
        match self.sensed.draft {
            Draft::Measured(_) => Some(self.draft.is_in_soil()),
            Draft::Suspect | Draft::Lost(_) => None,
        }
    }

    /// One millisecond of the sensors, in any mode: what determines the set point must not keep them from being filtered and
    /// monitored. `moves`: the hitch moves.
    pub fn sense(&mut self, inputs: &Inputs, moves: bool, calibration: &Calibration) {
        let draft = self.draft.step(inputs, moves, &calibration.draft);
        self.sensed = Sensed {
            draft,
            measured: match draft {
                Draft::Measured(draft) => Some(draft),
                Draft::Suspect => self.sensed.measured,
                Draft::Lost(_) => None,
            },
            slip: self.limited_slip(inputs, calibration),
        };
    }

    /// One step: the set point, by what was sensed before.
    pub fn step(
        &mut self,
        inputs: &Inputs,
        situation: &Situation,
        calibration: &Calibration,
    ) -> MilliDegree {
        let Sensed { draft, slip, .. } = self.sensed;
        // Quick engagement begins where the hitch is, which quick lift may have raised above the lever.
        let begins = situation.engagement == Engagement::Begins;
        let lever_or_hitch = if begins {
            situation.angle
        } else {
            situation.lever
        };
        let present = self.used.unwrap_or(lever_or_hitch);
        let mix = mix(inputs);
        let gains = self.gains(calibration.draft.crossover, calibration);
        let errors = errors(draft, present, mix, inputs, situation, calibration);
        let has_draft = self.has_draft(inputs.draft_set_point, calibration);
        let choice = Choice {
            function: selected(inputs),
            errors,
            has_draft,
            engagement: situation.engagement,
            lost: matches!(draft, Draft::Lost(_)),
            in_soil: self.draft.is_in_soil(),
            lever: situation.lever,
            angle: situation.angle,
            present,
            aim: self.used.map_or(situation.lever, |_| self.stepped),
        };
        let was_slipping = self.reason == Some(Reason::Slip);
        self.active = match self.active {
            // What the guard has raised stays where it is when a speed is lost.
            Active::Lever if was_slipping && slip.is_err() => choice.held(),
            active => active.next(&choice, gains, &calibration.lock),
        };
        let slip = slip.ok().flatten();
        self.demand(&choice, slip, (gains, mix), situation, calibration)
    }

    /// The set point of the active function, limited, raised by the guard, no faster than the valves, and in steps.
    fn demand(
        &mut self,
        choice: &Choice,
        slip: Option<(PerMille, PerMille)>,
        (gains, weight): (Gains, PerMille),
        situation: &Situation,
        calibration: &Calibration,
    ) -> MilliDegree {
        let (function, demand) = match (self.active, choice.errors) {
            (Active::Lever, _) => (None, situation.lever),
            (Active::Holds(hold), _) => (None, hold.set_point()),
            (Active::Engages(_), errors) => (None, deepest(choice, errors, calibration)),
            // The pins are in doubt: a move ends.
            (Active::Draft(function, _), None) => (Some(function), choice.here()),
            (Active::Draft(function, control), Some(errors)) => {
                (Some(function), control.demand(errors, gains))
            }
        };
        let lowest = lowest(function, situation.lever, calibration);
        let limited = match function {
            Some(_) => demand.limited(lowest, situation.highest),
            None => demand,
        };
        let slip = slip.filter(|_| choice.in_soil);
        let slip_gains = self.gains(calibration.slip.crossover, calibration);
        let raised = self
            .guard
            .step(slip, limited, slip_gains, &calibration.slip)
            .min(situation.highest.max(limited));
        self.reason = self.reason_of(function, choice, [demand, lowest, limited, raised]);
        if matches!(self.active, Active::Lever) && raised == limited {
            self.used = None;
            return situation.lever;
        }
        let used = reachable(choice.present, raised, situation, calibration);
        if let (Active::Draft(_, control), Some(errors)) = (&mut self.active, choice.errors) {
            control.follow(errors, gains, demand, used);
        }
        let step = match self.active {
            Active::Engages(_) => MilliDegree::ZERO,
            Active::Draft(..) if choice.errors.is_none() => MilliDegree::ZERO,
            Active::Holds(_) if self.reason != Some(Reason::Slip) => MilliDegree::ZERO,
            _ => calibration.draft.step.scaled(weight.0, Divisor::THOUSAND),
        };
        self.in_steps(used, step)
    }

    /// The set point in steps, so that position control makes one move of each.
    fn in_steps(&mut self, used: MilliDegree, step: MilliDegree) -> MilliDegree {
        let begins = self.used.is_none();
        self.used = Some(used);
        if begins || (used - self.stepped).magnitude() >= step {
            self.stepped = used;
        }
        self.stepped
    }

    /// Slip and its limit; `None` where it is not limited.
    fn limited_slip(
        &mut self,
        inputs: &Inputs,
        calibration: &Calibration,
    ) -> Result<Option<(PerMille, PerMille)>, Trouble> {
        let parameters = &calibration.slip;
        if parameters.highest_limit == PerMille::ZERO {
            return Ok(None);
        }
        let limit = inputs.slip_limit.unwrap_or(parameters.highest_limit);
        let limit = limit.limited(PerMille::ZERO, parameters.highest_limit);
        let slip = self
            .slip
            .step(inputs, self.draft.is_in_soil(), parameters)?;
        Ok(slip.map(|slip| (slip, limit)))
    }

    /// Whether the draft will have reached its set point once the implement has followed the links; during quick engagement.
    fn has_draft(&mut self, set_point: Option<Newton>, calibration: &Calibration) -> bool {
        let corner = calibration.draft.raised_filter;
        let gains = self.gains(corner, calibration);
        let (Active::Engages(filter), Draft::Measured(draft), Some(set_point)) =
            (&mut self.active, self.sensed.draft, set_point)
        else {
            return false;
        };
        let slow = filter.step(draft.0, corner);
        let ahead = Newton(gains.ahead(draft.0, slow));
        let band = set_point.scaled(calibration.draft.dead_band.0, Divisor::THOUSAND);
        ahead >= set_point - band
    }

    fn gains(&self, crossover: MilliHertz, calibration: &Calibration) -> Gains {
        let parameters = &calibration.draft;
        let speed = self.slip.ground_speed().unwrap_or(parameters.assumed_speed);
        Gains::of(crossover, parameters.length, speed)
    }

    /// Why the set point is what it is: `demand` within `lowest` and the upper limit is `limited`, and `raised` by the guard.
    fn reason_of(
        &self,
        function: Option<Function>,
        choice: &Choice,
        [demand, lowest, limited, raised]: [MilliDegree; 4],
    ) -> Option<Reason> {
        if raised > limited {
            return Some(Reason::Slip);
        }
        match (function, self.active) {
            (_, Active::Holds(_)) => Some(Reason::Holds),
            (_, Active::Engages(_)) => Some(Reason::Engages),
            (Some(_), _) if demand < lowest => Some(Reason::Floor),
            (Some(_), _) if demand > limited => Some(Reason::Ceiling),
            (Some(Function::Draft), _) => Some(Reason::Draft),
            (Some(Function::Mix), _) => Some(Reason::Mix),
            (Some(Function::DepthLimit), _) => Some(Reason::DepthLimit),
            _ if choice.function != Function::Position => Some(Reason::AboveGround),
            _ => None,
        }
    }
}

/// The selected function; position control without a set point of the draft.
fn selected(inputs: &Inputs) -> Function {
    match inputs.draft_set_point {
        Some(_) => Function::from_code(inputs.function),
        None => Function::Position,
    }
}

/// Weight of the draft by function and dial.
fn mix(inputs: &Inputs) -> PerMille {
    match Function::from_code(inputs.function) {
        Function::Mix => inputs.mix.unwrap_or(MIDDLE),
        _ => PerMille::WHOLE,
    }
}

/// The errors of a measured draft.
fn errors(
    draft: Draft,
    present: MilliDegree,
    mix: PerMille,
    inputs: &Inputs,
    situation: &Situation,
    calibration: &Calibration,
) -> Option<Errors> {
    let Draft::Measured(draft) = draft else {
        return None;
    };
    let set_point: Newton = inputs.draft_set_point?;
    let lever_ahead = situation.lever - present;
    Some(Errors::of(
        (draft, set_point),
        lever_ahead,
        mix,
        &calibration.draft,
    ))
}

/// The lowest set point of a function.
fn lowest(
    function: Option<Function>,
    lever: MilliDegree,
    calibration: &Calibration,
) -> MilliDegree {
    let floor = match function {
        Some(Function::DepthLimit) => lever,
        _ => lever - calibration.draft.margin,
    };
    floor.max(calibration.position.lower_limit)
}

/// Where quick engagement lowers to: as deep as the selected function may, and without one to the lower limit. It stays where it
/// is while the pins are in doubt.
fn deepest(choice: &Choice, errors: Option<Errors>, calibration: &Calibration) -> MilliDegree {
    match (choice.function, errors) {
        (Function::Position, _) => calibration.position.lower_limit,
        (_, None) => choice.present,
        (function, Some(_)) => {
            lowest(Some(function), choice.lever, calibration).min(choice.present)
        }
    }
}

/// The set point `wanted`, no further from the present one than the valves move the hitch in a step.
fn reachable(
    present: MilliDegree,
    wanted: MilliDegree,
    situation: &Situation,
    calibration: &Calibration,
) -> MilliDegree {
    let one_degree = MilliDegreePerSecond(1_000);
    let per_degree = calibration
        .linkage
        .piston_speed(situation.angle, one_degree);
    let per_degree = Divisor::at_least_one(per_degree.0);
    // Degrees in a second are millidegrees in a millisecond.
    let [up, down] = situation
        .valve_speeds
        .map(|speed| MilliDegree(per_degree.divide(speed.0)));
    wanted.limited(present - down, present + up)
}
