//! The values that are tuned, and their ranges.

use hitch_controller_host::calibration_file::{scalar, set};
use hitch_quantities::{Calibration, ValidCalibration};

use super::Change;

/// `group.name` of the tuned values.
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

/// Largest factor by which a value may change: beyond it the stated reason of the value does not hold.
const MOST_DOUBLINGS: f64 = 2.0;

/// The tuned values, without those of `fixed`.
#[must_use]
pub fn without(fixed: &[String]) -> Vec<&'static str> {
    let is_fixed = |knob: &str| fixed.iter().any(|name| name == knob);
    KNOBS.into_iter().filter(|knob| !is_fixed(knob)).collect()
}

/// Lower bound of a tuned value.
#[derive(Debug, Clone, Copy)]
pub struct Least {
    /// The value.
    pub knob: &'static str,
    /// Bound, in its unit.
    pub value: f64,
}

/// `base` with each value multiplied by two to the power of its coordinate, limited below by `least`; `None` if the
/// result is not a valid calibration.
pub fn with_values(
    base: &Calibration,
    knobs: &[&str],
    least: Least,
    point: &[f64],
) -> Option<ValidCalibration> {
    let mut calibration = base.clone();
    for (key, doublings) in knobs.iter().zip(point) {
        let found = scalar(base, key)?;
        let factor = doublings.clamp(-MOST_DOUBLINGS, MOST_DOUBLINGS).exp2();
        let low = match *key == least.knob {
            true => least.value.clamp(found.low, found.high),
            false => found.low,
        };
        let value = (found.value * factor).clamp(low, found.high);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_knob_is_not_turned_below_its_least_value() {
        let base = Calibration::nominal();
        let least = Least {
            knob: "hydraulics.hysteresis",
            value: 0.12,
        };
        let turned = |doublings: f64| {
            let knobs = ["hydraulics.hysteresis", "hydraulics.pressure_filter"];
            with_values(&base, &knobs, least, &[doublings, doublings]).unwrap()
        };
        assert_eq!(turned(-2.0).hydraulics.hysteresis.0, 120);
        assert_eq!(turned(-2.0).hydraulics.pressure_filter.0, 60);
        assert_eq!(turned(1.0).hydraulics.hysteresis.0, 160);
    }
}
