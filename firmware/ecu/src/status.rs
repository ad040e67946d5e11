//! Status of a step for the bus.

use hitch_protocols::j1939::{Draft, ExitCode, HitchStatus, InWork, Limit, Troubles};
use hitch_quantities::calibration::design_parameters::PositionParameters;
use hitch_quantities::units::MilliDegree;
use hitch_quantities::{Calibration, Fault, Inputs, Outputs, State};

use crate::arbiter;

/// Distance from the set point above which valves and ramps limit the speed: 2 degrees.
const UNDER_WAY_MDEG: i32 = 2_000;
/// Distance from a travel limit within which a set point counts as at the limit: 0.1 degree.
const AT_LIMIT_MDEG: i32 = 100;

/// The hitch's status after a step. `taken_back`: the operator has moved the lever or pressed the button during remote
/// control. `consents`: the operator consents to remote control.
#[must_use]
pub fn status(
    inputs: &Inputs,
    outputs: &Outputs,
    calibration: &Calibration,
    troubles: Troubles,
    taken_back: bool,
    consents: bool,
) -> HitchStatus {
    let exit = exit_code(outputs);
    let limits = &calibration.position;
    HitchStatus {
        position: inputs
            .rocker_angle
            .map(|angle| arbiter::position(angle, limits)),
        in_work: match (calibration.work.angle, outputs.in_work) {
            (MilliDegree::ZERO, _) => InWork::NotAvailable,
            (_, None) => InWork::Error,
            (_, Some(false)) => InWork::No,
            (_, Some(true)) => InWork::Yes,
        },
        time_until_work: outputs.time_until_work,
        limit: limit(inputs, outputs, limits),
        exit,
        remote_permitted: exit == ExitCode::Clear
            && !inputs.switches.hold
            && inputs.jog.is_none()
            && !taken_back,
        consents,
        draft: match (calibration.draft.fitted.0, outputs.draft) {
            (0, _) => Draft::NotFitted,
            (_, None) => Draft::Lost,
            (_, Some(draft)) => Draft::Measured(draft),
        },
        troubles,
    }
}

fn limit(inputs: &Inputs, outputs: &Outputs, limits: &PositionParameters) -> Limit {
    let to_go = inputs
        .rocker_angle
        .map_or(0, |angle| (outputs.target - angle).magnitude().0);
    let is_under_way = to_go > UNDER_WAY_MDEG;
    let below_top = (limits.upper_limit - outputs.target).0;
    let above_bottom = (outputs.target - limits.lower_limit).0;
    match outputs.trip.is_some_and(|trip| trip.is_final()) {
        true => Limit::NonRecoverable,
        // A set point further away does not make a moving hitch faster.
        false if is_under_way && outputs.state == State::Lifting => Limit::High,
        false if is_under_way && outputs.state == State::Lowering => Limit::Low,
        false if below_top <= AT_LIMIT_MDEG => Limit::High,
        false if above_bottom <= AT_LIMIT_MDEG => Limit::Low,
        false => Limit::None,
    }
}

/// Reason why an implement cannot command the hitch.
fn exit_code(outputs: &Outputs) -> ExitCode {
    match outputs.state {
        State::Locked | State::TransportLock => ExitCode::LockedOut,
        State::Teaching => ExitCode::OperatorOverride,
        State::Fault if outputs.fault == Some(Fault::Lever) => ExitCode::ControlFault,
        State::Fault => ExitCode::FunctionFault,
        State::Holding
        | State::Lifting
        | State::Lowering
        | State::Settling
        | State::Stalled
        | State::Floating => ExitCode::Clear,
    }
}
