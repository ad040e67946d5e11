//! Judges what the other rows rely on: the converters' reference, the supply of the sensors, the angle's second track,
//! and both clocks.

use hitch_quantities::Inputs;
use hitch_quantities::calibration::design_parameters::{SafetyParameters, SensorParameters};
use hitch_quantities::units::{Microsecond, MilliDegree, Millisecond, PerMille};

/// What is wrong in this step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeasuringFaults {
    /// The converters' reference is off.
    pub reference: bool,
    /// The supply of the sensors is out of its limits.
    pub sensor_supply: bool,
    /// The tracks of the angle sensor disagree, or one of them is missing.
    pub tracks: bool,
    /// Time that a step too late or too early has lost; zero if it came in time.
    pub lost: Millisecond,
    /// The main clock has another rate than at the start.
    pub clock: bool,
}

/// The faults of a step. What isn't measured is healthy, except for a second track that the calibration says is there.
pub fn judge(
    inputs: &Inputs,
    sensors: &SensorParameters,
    safety: &SafetyParameters,
) -> MeasuringFaults {
    MeasuringFaults {
        reference: differs(inputs.reference, safety.reference_error),
        sensor_supply: inputs.sensor_supply.is_some_and(|supply| {
            supply < safety.sensor_supply_min || supply > safety.sensor_supply_max
        }),
        tracks: sensors.second_track.0 != 0 && tracks_differ(inputs, safety.track_difference),
        lost: lost(inputs.step_time, safety),
        clock: differs(inputs.clock_ratio, safety.clock_error),
    }
}

/// Whole milliseconds that the coils went without the step that was due, at least one for a step that is out of time.
fn lost(step_time: Option<Microsecond>, safety: &SafetyParameters) -> Millisecond {
    const STEP_US: i32 = 1_000;
    let out_of_time =
        |time: &Microsecond| *time > safety.longest_step || *time < safety.shortest_step;
    step_time
        .filter(out_of_time)
        .map_or(Millisecond::ZERO, |time| {
            Millisecond((time.0.saturating_sub(STEP_US) / STEP_US).max(1))
        })
}

/// True if a share is further from the whole than `most`.
fn differs(share: Option<PerMille>, most: PerMille) -> bool {
    share.is_some_and(|share| (share - PerMille::WHOLE).magnitude() > most)
}

fn tracks_differ(inputs: &Inputs, most: MilliDegree) -> bool {
    inputs
        .rocker_angle
        .zip(inputs.second_angle)
        .is_none_or(|(first, second)| (first - second).magnitude() > most)
}
