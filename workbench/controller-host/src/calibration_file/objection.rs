//! What the firmware objects to in a calibration, in words.

use hitch_quantities::CalibrationError;

use super::key::key;

/// The firmware's objection to a calibration: section, fault, and suggested correction.
pub fn objection(error: CalibrationError) -> (&'static str, String, &'static str) {
    use CalibrationError as E;
    match error {
        E::ValvePoint { valve, index } => (
            valve,
            format!("point {} of [{valve}] is out of order", index + 1),
            "start at zero flow; currents and flows have to rise strictly",
        ),
        E::ValveGap { valve, index } => (
            valve,
            format!(
                "point {} of [{valve}] is too close to the previous one",
                index + 1
            ),
            "flows have to differ by at least 0.25 % of the largest one, and by 0.0003 l/min",
        ),
        E::ValveSize { valve } => (
            valve,
            format!("[{valve}] has no points"),
            "give at least two",
        ),
        E::Linkage { index } => (
            "linkage",
            format!("travel {} of [linkage] does not rise", index + 1),
            "the travel has to rise strictly with the angle",
        ),
        E::Crossed { group, low, high } => (
            group,
            format!("{low} of [{group}] is not below {high}"),
            "exchange them",
        ),
        E::AngleLag { found, most } => (
            "sensors",
            format!(
                "angle_lag_ms of [sensors] is {}, and at most {} with the onset speeds of [safety]: a frozen angle would \
                 cost too much travel",
                found.0, most.0
            ),
            "use a faster sensor or filter, or lower lift_onset_speed and lower_onset_speed of [safety]",
        ),
        E::Parameter { group, what } => (
            group,
            format!("{} of [{group}] is out of range", key(what.parameter)),
            "see the reasons in a file written by `hitch calibrate`",
        ),
        E::Version { .. } | E::Checksum { .. } => {
            ("format", "the block is damaged".to_owned(), "write it anew")
        }
    }
}
