//! What may be turned, and by how much.

use hitch_firmware::control::{Calibration, ValidCalibration};

use super::Change;
use crate::calibration_file::{scalar, set};

/// `group.name` of the values that are searched.
pub const KNOBS: [&str; 10] = [
    "position.lift_acceleration",
    "position.lift_deceleration",
    "position.lower_acceleration",
    "position.lower_deceleration",
    "position.approach_gain",
    "position.creep_speed",
    "position.stop_band",
    "motion.position_time",
    "hydraulics.hysteresis",
    "hydraulics.pressure_filter",
];

/// No value gets more than so many times larger or smaller: beyond that its reason no longer holds.
const MOST_DOUBLINGS: f64 = 2.0;

/// The values that are searched, without those of `fixed`.
#[must_use]
pub fn without(fixed: &[String]) -> Vec<&'static str> {
    let is_fixed = |knob: &str| fixed.iter().any(|name| name == knob);
    KNOBS.into_iter().filter(|knob| !is_fixed(knob)).collect()
}

/// `base` with the value of each knob times two to the power of its coordinate; `None` if that isn't a valid
/// calibration.
pub fn with_values(base: &Calibration, knobs: &[&str], point: &[f64]) -> Option<ValidCalibration> {
    let mut calibration = base.clone();
    for (key, doublings) in knobs.iter().zip(point) {
        let found = scalar(base, key)?;
        let factor = doublings.clamp(-MOST_DOUBLINGS, MOST_DOUBLINGS).exp2();
        let value = (found.value * factor).clamp(found.low, found.high);
        set(&mut calibration, &format!("{key}={value}")).ok()?;
    }
    calibration.sealed().validate().ok()
}

/// The values before and after.
pub fn changes(before: &Calibration, after: &Calibration) -> Vec<Change> {
    KNOBS
        .iter()
        .filter_map(|key| {
            let (old, new) = (scalar(before, key)?, scalar(after, key)?);
            Some(Change {
                key: format!("{key}_{}", old.suffix),
                before: old.value,
                after: new.value,
            })
        })
        .collect()
}
