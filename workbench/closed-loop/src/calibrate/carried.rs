//! What a calibration carries of each effect of a model, into which of its values, and what it does not carry.

use std::fmt::Write as _;

use hitch_controller_host::calibration_file::scalar;
use hitch_plant::hooks::effect::full_name;
use hitch_plant::{AddedEffect, Model};
use hitch_quantities::Calibration;

/// Where an effect goes.
struct Destination {
    ids: &'static [&'static str],
    /// Tables (`lift`, `lower`, `linkage`) and scalars (`group.name`) that follow from it.
    into: &'static [&'static str],
    /// What is not carried, and what the controller does about it; empty if everything is.
    remains: &'static str,
}

const fn to(
    ids: &'static [&'static str],
    into: &'static [&'static str],
    remains: &'static str,
) -> Destination {
    Destination { ids, into, remains }
}

const OIL_SWING: &[&str] = &[
    "position.creep_speed",
    "position.lift_deceleration",
    "position.lower_deceleration",
    "motion.position_time",
    "motion.lowering_time",
];

/// The only place that says where an effect goes. The curves of the valves are those of the survey: at 20 bar while
/// lifting, at the reference drop while lowering, with oil of 40 C.
#[rustfmt::skip]
const DESTINATIONS: &[Destination] = &[
    to(&["lift-threshold-shift", "lift-flow-scale", "compensator-margin", "check-valve-loss", "pump-leakage", "pump-flow"],
        &["lift"], ""),
    to(&["lower-threshold-shift", "lower-flow-scale", "return-line-loss"], &["lower"], ""),
    to(&["flow-force"], &["lower"], "its change with the load, which the observer corrects"),
    to(&["oil-viscosity"], &["lift", "lower"], "its change with the temperature, which the observer corrects"),
    to(&["solenoid-hysteresis"], &["lift", "lower", "hydraulics.hysteresis"], ""),
    to(&["spool-stiction"], &["lift", "lower"], "the jumps of the spools; teaching finds their hysteresis"),
    to(&["spool-lag"], &["hydraulics.spool_lag", "hydraulics.lower_spool_lag", "position.creep_speed", "position.lift_deceleration",
        "position.lower_deceleration"], "a second order, where the model has one: such spools keep the ramps of the base, and overshoot"),
    to(&["compensator-droop"], &["lift", "hydraulics.compensator_lag", "position.swinging_acceleration",
        "position.swinging_deceleration"], "its change with the load, which the observer corrects"),
    to(&["entrained-air", "bulk-modulus", "hose-compliance", "load-inertia"], OIL_SWING, "the share of each: all set the one lowest frequency"),
    to(&["angle-sensor-lag"], &["sensors.angle_lag"], "a dead time, where the model has one"),
    to(&["angle-sensor-gain"], &["linkage", "position.lower_limit", "position.upper_limit"],
        "the scale of lever and displays: all angles are those that the sensor shows"),
    to(&["pressure-sensor-offset"], &["hydraulics.pressure_offset"], ""),
    to(&["lowering-leakage"], &["hold.correction_memory"],
        "a leak that needs a correction in less than 1.5 s, or grows by half: the drift monitor reports it, repair the valve"),
    to(&["relief-override"], &[], "the relief pressure is that of the constants"),
    to(&["coulomb-friction", "stribeck-friction", "viscous-friction", "pin-friction", "load-arm"], &[],
        "no value for it; the observer corrects the speed"),
    to(&["pin-backlash"], &[], "no value for it; it remains as an error of the position"),
    to(&["ground-contact"], &[], "no value for it; the hitch detects the ground"),
];

/// One line for each effect of `model`: the values that follow from it, and what is not carried. `base`: the calibration
/// before.
#[must_use]
pub fn lines(model: &Model, base: &Calibration, calibration: &Calibration) -> Vec<String> {
    let line = |added: &AddedEffect| {
        let name = full_name(added.effect);
        let known = DESTINATIONS
            .iter()
            .find(|destination| destination.ids.contains(&added.effect.id()));
        let Some(destination) = known else {
            return format!(
                "{name}: a term of the model; carried as far as it changes the valves' curves"
            );
        };
        let changes = destination
            .into
            .iter()
            .filter_map(|path| change(path, base, calibration));
        let changes: Vec<String> = changes.collect();
        let mut line = if changes.is_empty() {
            format!("{name}: not carried")
        } else {
            format!("{name} -> {}", changes.join(", "))
        };
        if !destination.remains.is_empty() {
            let join = if changes.is_empty() {
                ": "
            } else {
                "; not carried: "
            };
            let _ = write!(line, "{join}{}", destination.remains);
        }
        line
    };
    model.effects.iter().map(line).collect()
}

/// A table by its name, or a scalar with its values before and after; `None` if it has not changed.
fn change(path: &str, base: &Calibration, calibration: &Calibration) -> Option<String> {
    let table = match path {
        "lift" => Some(base.lift != calibration.lift),
        "lower" => Some(base.lower != calibration.lower),
        "linkage" => Some(base.linkage != calibration.linkage),
        _ => None,
    };
    if let Some(changed) = table {
        return changed.then(|| match path {
            "linkage" => "linkage table".to_owned(),
            _ => format!("{path} curve"),
        });
    }
    let (before, after) = (scalar(base, path)?, scalar(calibration, path)?);
    (before.value != after.value).then(|| {
        format!(
            "{path} {} -> {} {}",
            before.value, after.value, after.suffix
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_effect_of_the_catalogue_has_one_destination_with_existing_values() {
        for effect in hitch_effects::CATALOGUE {
            let of = |destination: &&Destination| destination.ids.contains(&effect.id());
            assert_eq!(DESTINATIONS.iter().filter(of).count(), 1, "{}", effect.id());
        }
        for destination in DESTINATIONS {
            for path in destination.into {
                let exists = ["lift", "lower", "linkage"].contains(path)
                    || scalar(&Calibration::nominal(), path).is_some();
                assert!(exists, "{path}");
            }
            for id in destination.ids {
                assert!(hitch_effects::find(id).is_some(), "{id}");
            }
            assert!(!(destination.into.is_empty() && destination.remains.is_empty()));
        }
    }
}
