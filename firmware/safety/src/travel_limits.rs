//! Limits of the travel: those of the calibration, the dial of the upper limit, and the shut dial of the lowering rate.
//!
//! A dial that is turned below a moving hitch, or shut, leaves control some time to stop it; this is the time of the row.

use hitch_quantities::units::MilliAmp;
use hitch_quantities::{CoilCurrents, Inputs};

use crate::limits::Limits;

/// True if a current drives the hitch further beyond a limit of its travel, or lowers it with the dial shut. `passed`:
/// the currents of the last step.
pub fn are_exceeded(inputs: &Inputs, passed: CoilCurrents, limits: Limits<'_>) -> bool {
    let margin = limits.safety.limit_margin;
    let (lowest, highest) = limits.machine.ends();
    let highest = inputs
        .upper_limit
        .map_or(highest, |dial| dial.limited(lowest, highest));
    let angle = inputs.rocker_angle;
    let is_above = angle.is_some_and(|angle| angle > highest + margin);
    let is_below = angle.is_some_and(|angle| angle < lowest - margin);
    let is_shut = inputs
        .lowering_dial
        .is_some_and(|dial| dial < limits.operator.dial_shut);
    let lifts = passed.lift > MilliAmp::ZERO;
    let lowers = passed.lower > MilliAmp::ZERO;
    lifts && is_above || lowers && (is_below || is_shut)
}
