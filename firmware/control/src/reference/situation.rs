//! What the reference depends on besides inputs and calibration.

use hitch_quantities::units::{MicrometrePerSecond, MilliDegree};

use crate::operator::engage::Engagement;

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
