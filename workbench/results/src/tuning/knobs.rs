//! The values that are tuned, and their ranges.

use hitch_controller_host::calibration_file::{scalar, set};
use hitch_quantities::{Calibration, ValidCalibration};

use super::change::Change;

/// `group.name` of the tuned values. The fastest speed of the button is not one of them: it is chosen for safety.
pub const KNOBS: [&str; 13] = [
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
    "rate.rate_slope",
    "rate.trim_time",
    "rate.trim_limit",
];

/// Group of the values that only act while a button is held.
const RATE: &str = "rate.";

/// Largest factor by which a value may change: beyond it the stated reason of the value does not hold.
const MOST_DOUBLINGS: f64 = 2.0;

/// The values that a set of moves, and of presses of the button, can tune; each only if it is not empty.
#[must_use]
pub fn tuned_by(moves: bool, presses: bool) -> Vec<&'static str> {
    let acts = |knob: &&str| {
        if knob.starts_with(RATE) {
            presses
        } else {
            moves
        }
    };
    KNOBS.into_iter().filter(acts).collect()
}

/// `knobs` without those of `fixed`.
#[must_use]
pub fn without(knobs: &[&'static str], fixed: &[String]) -> Vec<&'static str> {
    let is_fixed = |knob: &str| fixed.iter().any(|name| name == knob);
    let knobs = knobs.iter().copied();
    knobs.filter(|knob| !is_fixed(knob)).collect()
}

/// Lower bound of a tuned value.
#[derive(Debug, Clone, Copy)]
pub struct Least {
    /// The value.
    pub knob: &'static str,
    /// Bound, in its unit.
    pub value: f64,
}

/// `base` with each value multiplied by two to the power of its coordinate, limited below by `least` if there is one; `None` if the
/// result is not a valid calibration.
pub fn with_values(
    base: &Calibration,
    knobs: &[&str],
    least: Option<Least>,
    point: &[f64],
) -> Option<ValidCalibration> {
    let mut calibration = base.clone();
    for (key, doublings) in knobs.iter().zip(point) {
        let found = scalar(base, key)?;
        let factor = doublings.clamp(-MOST_DOUBLINGS, MOST_DOUBLINGS).exp2();
        let bound = least.filter(|least| *key == least.knob);
        let low = bound.map_or(found.low, |least| least.value.clamp(found.low, found.high));
        let value = (found.value * factor).clamp(low, found.high);
        set(&mut calibration, &format!("{key}={value}")).ok()?;
    }
    calibration.sealed().validate().ok()
}

/// The values of `knobs` before and after.
pub fn changes(knobs: &[&str], before: &Calibration, after: &Calibration) -> Vec<Change> {
    knobs
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
    fn the_button_tunes_its_own_values() {
        let button = tuned_by(false, true);
        assert_eq!(
            button,
            ["rate.rate_slope", "rate.trim_time", "rate.trim_limit"]
        );
        assert_eq!(tuned_by(true, true).len(), KNOBS.len());
        assert!(
            tuned_by(true, false)
                .iter()
                .all(|knob| !button.contains(knob))
        );
        assert_eq!(without(&button, &["rate.trim_time".to_owned()]).len(), 2);
        assert!(tuned_by(false, false).is_empty());
    }

    #[test]
    fn a_knob_is_not_turned_below_its_least_value() {
        let base = Calibration::nominal();
        let least = Least {
            knob: "hydraulics.hysteresis",
            value: 0.12,
        };
        let turned = |doublings: f64| {
            let knobs = ["hydraulics.hysteresis", "hydraulics.pressure_filter"];
            with_values(&base, &knobs, Some(least), &[doublings, doublings]).unwrap()
        };
        assert_eq!(turned(-2.0).hydraulics.hysteresis.0, 120);
        assert_eq!(turned(-2.0).hydraulics.pressure_filter.0, 60);
        assert_eq!(turned(1.0).hydraulics.hysteresis.0, 160);
    }
}
