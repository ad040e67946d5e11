//! The reference of position control: the lever, or what draft, mix, depth limit, depth and slip guard make of it.
//!
//! ```text
//! pins -> draft signal ---------+-> loop -+--> selector -> limits -> slip guard -> valve speeds -> set point
//! depth sensor -> depth signal -+         |                              ^
//! lever ----------------------------------+                              |
//! speeds -> slip signal -------------------------------------------------+
//! ```
//!
//! It moves the set point of the position law, slowly, and changes nothing below it. Without sensors, or with an
//! implement or quick lift in command, the lever passes unchanged.
//!
//! The lever stays the operator's in each function: it is the lowest position (depth limit), or at most `draft.margin` above
//! it; the depth moves the hitch by at most `depth.margin` from it. So a raised lever takes the implement out of the soil, and above the ground the lever is the set point.

pub mod depth_signal;
pub mod draft_signal;
pub mod function_loop;
pub mod hold;
pub mod in_work;
pub mod lag_loop;
pub mod limits;
pub mod low_pass;
pub mod noise_check;
pub mod received;
pub mod selector;
pub mod situation;
pub mod slip_guard;
pub mod slip_signal;
pub mod soil_sensor;

use hitch_quantities::fixed::Divisor;
use hitch_quantities::units::{Micrometre, MilliDegree, MilliHertz, Millisecond, Newton, PerMille};
use hitch_quantities::{Calibration, Function, Inputs, Reason, Trouble};

use depth_signal::DepthSignal;
use draft_signal::{Draft, DraftSignal};
use function_loop::Errors;
use lag_loop::Gains;
use limits::{deepest, highest, lowest, reachable};
use selector::{Active, Choice};
use slip_guard::SlipGuard;
use slip_signal::SlipSignal;
use soil_sensor::Signal;

use crate::operator::engage::Engagement;

pub use situation::Situation;

/// Weight of the draft without a mix dial.
const MIDDLE: PerMille = PerMille(500);

/// The reference from step to step.
#[derive(Clone, Copy, Debug, Default)]
pub struct ReferenceControl {
    draft: DraftSignal,
    depth: DepthSignal,
    /// For how long the hitch has rested.
    rested_for: Millisecond,
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
    depth: Signal<Micrometre>,
    /// The last measured draft; `None` while the pins are lost.
    measured: Option<Newton>,
    /// Slip and its limit; `None` where it is not limited.
    slip: Result<Option<(PerMille, PerMille)>, Trouble>,
}

impl Default for Sensed {
    fn default() -> Self {
        Self {
            draft: Draft::Suspect,
            depth: Signal::Suspect,
            measured: None,
            slip: Ok(None),
        }
    }
}

impl ReferenceControl {
    /// Whether the machine has what the reference needs.
    #[must_use]
    pub const fn is_fitted(calibration: &Calibration) -> bool {
        has_pins(calibration) || has_depth(calibration)
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

    /// The lost sensor; a pin before the depth sensor, and that before a speed.
    #[must_use]
    pub fn trouble(&self) -> Option<Trouble> {
        let Sensed { draft, depth, .. } = self.sensed;
        let trouble = draft.trouble().or(depth.trouble());
        trouble.or(self.sensed.slip.err())
    }

    /// The draft; `None` while the pins are lost.
    #[must_use]
    pub const fn draft(&self) -> Option<Newton> {
        self.sensed.measured
    }

    /// Whether the draft, or the depth without it, says that the implement is in the soil; `None` without a plausible sensor.
    #[must_use]
    pub fn in_soil(&self) -> Option<bool> {
        match (self.sensed.draft, self.sensed.depth) {
            (Signal::Measured(_), _) => Some(self.draft.is_in_soil()),
            (_, Signal::Measured(_)) => Some(self.depth.is_in_soil()),
            _ => None,
        }
    }

    /// One millisecond of the sensors, in any mode: what determines the set point must not keep them from being filtered and
    /// monitored. `moves`: the hitch moves.
    pub fn sense(&mut self, inputs: &Inputs, moves: bool, calibration: &Calibration) {
        let draft = if has_pins(calibration) {
            self.draft.step(inputs, moves, &calibration.draft)
        } else {
            Draft::Suspect
        };
        let depth = if has_depth(calibration) {
            let (pins, depth) = (&calibration.draft, &calibration.depth);
            self.depth.step(inputs, pins, depth)
        } else {
            Signal::Suspect
        };
        self.rested_for = self.rested_for.counted_while(!moves);
        self.sensed = Sensed {
            draft,
            depth,
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
        let slip = self.sensed.slip;
        // Quick engagement begins where the hitch is, which quick lift may have raised above the lever.
        let begins = situation.engagement == Engagement::Begins;
        let lever_or_hitch = if begins {
            situation.angle
        } else {
            situation.lever
        };
        let present = self.used.unwrap_or(lever_or_hitch);
        let mix = mix(inputs);
        let function = selected(inputs, calibration);
        let is_depth = function == Function::Depth;
        let (crossover, trouble, in_soil) = if is_depth {
            let trouble = self.sensed.depth.trouble();
            let in_soil = self.depth.is_in_soil();
            (calibration.depth.crossover, trouble, in_soil)
        } else {
            let trouble = self.sensed.draft.trouble();
            let in_soil = self.draft.is_in_soil();
            (calibration.draft.crossover, trouble, in_soil)
        };
        let gains = self.gains(crossover, calibration);
        let errors = if is_depth {
            depth_errors(self.sensed.depth, inputs, calibration)
        } else {
            let draft = self.sensed.draft;
            errors(draft, present, mix, inputs, situation, calibration)
        };
        let is_reached = self.is_reached(is_depth, inputs, calibration);
        let choice = Choice {
            function,
            is_off: Function::from_code(inputs.function) == Function::Position,
            errors,
            is_reached,
            engagement: situation.engagement,
            lost: trouble.is_some(),
            in_soil,
            has_rested: !is_depth || self.rested_for >= calibration.depth.rest_time,
            lever: situation.lever,
            angle: situation.angle,
            present,
            aim: self.used.map_or(situation.lever, |_| self.stepped),
        };
        let was_slipping = self.reason == Some(Reason::Slip);
        self.active = match self.active {
            // What the guard has raised stays where it is when a speed is lost.
            Active::Lever if was_slipping && slip.is_err() => choice.held(false),
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
            // The sensors are in doubt: a move ends.
            (Active::Function(function, _), None) => (Some(function), choice.here()),
            (Active::Function(function, control), Some(errors)) => {
                (Some(function), control.demand(errors, gains))
            }
        };
        let lowest = lowest(function, situation.lever, calibration);
        let highest = highest(function, situation, calibration);
        let limited = match function {
            Some(_) => demand.limited(lowest, highest),
            None => demand,
        };
        let slip = slip.filter(|_| self.draft.is_in_soil());
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
        if let (Active::Function(_, control), Some(errors)) = (&mut self.active, choice.errors) {
            control.follow(errors, gains, demand, used);
        }
        let step = match self.active {
            Active::Engages(_) => MilliDegree::ZERO,
            Active::Function(..) if choice.errors.is_none() => MilliDegree::ZERO,
            Active::Holds(_) if self.reason != Some(Reason::Slip) => MilliDegree::ZERO,
            Active::Function(Function::Depth, _) => calibration.depth.step,
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
        if parameters.highest_limit == PerMille::ZERO || !has_pins(calibration) {
            return Ok(None);
        }
        let limit = inputs.slip_limit.unwrap_or(parameters.highest_limit);
        let limit = limit.limited(PerMille::ZERO, parameters.highest_limit);
        let slip = self
            .slip
            .step(inputs, self.draft.is_in_soil(), parameters)?;
        Ok(slip.map(|slip| (slip, limit)))
    }

    /// Whether draft or depth will have reached the set point once the implement has followed the links; during quick
    /// engagement.
    fn is_reached(&mut self, is_depth: bool, inputs: &Inputs, calibration: &Calibration) -> bool {
        let corner = calibration.draft.raised_filter;
        let gains = self.gains(corner, calibration);
        let (quantity, wanted) = if is_depth {
            let wanted = inputs.depth_set_point;
            let least = wanted.map(|wanted| (wanted - calibration.depth.dead_band).0);
            (self.sensed.depth.measured().map(|depth| depth.0), least)
        } else {
            let share = (PerMille::WHOLE - calibration.draft.dead_band).0;
            let wanted = inputs.draft_set_point;
            let least = wanted.map(|wanted| wanted.scaled(share, Divisor::THOUSAND).0);
            (self.sensed.draft.measured().map(|draft| draft.0), least)
        };
        let (Active::Engages(filter), Some(quantity), Some(wanted)) =
            (&mut self.active, quantity, wanted)
        else {
            return false;
        };
        let slow = filter.step(quantity, corner);
        gains.ahead(quantity, slow) >= wanted
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
            (Some(Function::Depth), _) => Some(Reason::Depth),
            _ if choice.function != Function::Position => Some(Reason::AboveGround),
            _ => None,
        }
    }
}

const fn has_pins(calibration: &Calibration) -> bool {
    calibration.draft.fitted.0 != 0
}

const fn has_depth(calibration: &Calibration) -> bool {
    calibration.depth.fitted.0 != 0
}

/// The selected function; position control without its sensor or its set point.
fn selected(inputs: &Inputs, calibration: &Calibration) -> Function {
    let function = Function::from_code(inputs.function);
    let is_possible = match function {
        Function::Position => true,
        Function::Depth => has_depth(calibration) && inputs.depth_set_point.is_some(),
        Function::Draft | Function::Mix | Function::DepthLimit => {
            has_pins(calibration) && inputs.draft_set_point.is_some()
        }
    };
    if is_possible {
        function
    } else {
        Function::Position
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

/// The errors of a measured depth.
fn depth_errors(
    depth: Signal<Micrometre>,
    inputs: &Inputs,
    calibration: &Calibration,
) -> Option<Errors> {
    let set_point = inputs.depth_set_point?;
    let depth = depth.measured()?;
    Some(Errors::of_depth(depth, set_point, &calibration.depth))
}
