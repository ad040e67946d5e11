//! Classes of calibration values: who may change which value, when, and in which direction without the key.
//!
//! [`CLASSES`] is the only place that says so. A value that is not in it, or twice, does not compile.

use super::parameter::ParameterInfo;

/// Direction in which a value of the safety class becomes stricter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tightening {
    /// A larger value is stricter.
    Up,
    /// A smaller value is stricter.
    Down,
    /// Neither direction is always stricter: changed with the key only.
    None,
}

impl Tightening {
    /// Whether `new` is looser than `present`, or not known to be stricter.
    #[must_use]
    pub const fn loosens(self, present: i32, new: i32) -> bool {
        match self {
            Self::Up => new < present,
            Self::Down => new > present,
            Self::None => new != present,
        }
    }
}

/// Class of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// Ramps and gains, which the controller takes up from wherever it is: tuned while the hitch moves.
    Live,
    /// What the machine is: written at rest, with the service contact closed.
    Machine,
    /// Limits, thresholds and times of the envelope, of the sensors and of the travel: as [`Self::Machine`], stored in
    /// an own block, and loosened with the key only.
    Safety(Tightening),
}

impl Class {
    /// Whether a value of this class may be changed while the hitch moves.
    #[must_use]
    pub const fn is_live(self) -> bool {
        matches!(self, Self::Live)
    }

    /// Whether a value of this class belongs to the safety block.
    #[must_use]
    pub const fn is_safety(self) -> bool {
        matches!(self, Self::Safety(_))
    }

    /// Whether changing a value from `present` to `new` requires the key.
    #[must_use]
    pub const fn requires_key(self, present: i32, new: i32) -> bool {
        match self {
            Self::Safety(tightening) => tightening.loosens(present, new),
            Self::Live | Self::Machine => false,
        }
    }
}

/// Values of one group and one class.
#[derive(Clone, Copy, Debug)]
pub struct Classified {
    /// Name of the group.
    pub group: &'static str,
    /// Their class.
    pub class: Class,
    /// Their names in the group.
    pub names: &'static [&'static str],
}

const fn row(group: &'static str, class: Class, names: &'static [&'static str]) -> Classified {
    Classified {
        group,
        class,
        names,
    }
}

/// Stricter if larger, stricter if smaller, and neither.
const UP: Class = Class::Safety(Tightening::Up);
const DOWN: Class = Class::Safety(Tightening::Down);
const KEY_ONLY: Class = Class::Safety(Tightening::None);

/// The class of each scalar. The tables of valves and linkage are of the class [`Class::Machine`].
#[rustfmt::skip]
pub const CLASSES: &[Classified] = &[
    row("hydraulics", Class::Machine, &[
        "piston_area", "load_ratio", "spool_lag", "lower_spool_lag", "compensator_lag", "hysteresis", "reference_drop",
        "assumed_drop", "smallest_drop", "largest_drop", "pressure_offset", "pressure_filter", "drop_learning", "relief_pressure", "relief_margin",
    ]),
    row("sensors", UP, &[
        "angle_min", "lever_min", "pressure_min", "second_track",
    ]),
    row("sensors", DOWN, &[
        "angle_max", "angle_jump", "lever_max", "pressure_max", "bridged", "angle_lag",
    ]),
    row("lock", UP, &[
        "lever_movement", "healthy_time", "engine_running", "engine_settling", "engine_required",
    ]),
    row("lock", DOWN, &[
        "pick_up_window", "lever_time",
    ]),
    row("operator", Class::Machine, &[
        "dial_middle_speed", "dial_open", "quick_lift_angle", "float_lever", "float_angle", "float_exit",
        "float_exit_time",
    ]),
    row("operator", UP, &[
        "dial_shut", "second_contact",
    ]),
    row("motion", Class::Machine, &[
        "position_time", "lowering_time", "lift_trail", "lowering_trail", "lag_limit", "swing_lag", "bias_limit",
    ]),
    row("position", Class::Live, &[
        "lever_deadband", "stop_band", "restart_band", "approach_gain", "creep_speed", "lift_speed", "lower_speed",
        "lift_acceleration", "lift_deceleration", "swinging_acceleration", "swinging_deceleration",
        "lower_acceleration", "lower_deceleration", "abort_deceleration",
    ]),
    row("position", UP, &[
        "lower_limit",
    ]),
    row("position", DOWN, &[
        "upper_limit",
    ]),
    row("rate", Class::Live, &[
        "rate_slope", "trim_time", "trim_limit",
    ]),
    row("rate", DOWN, &[
        "rate_limit", "longest_travel",
    ]),
    row("hold", Class::Machine, &[
        "dwell", "rest_time", "correction_memory",
    ]),
    row("hold", DOWN, &[
        "corrections", "corrected_travel",
    ]),
    row("saturation", Class::Machine, &[
        "window", "demanded_travel", "relief_time", "retry_time", "attempts",
    ]),
    row("teach", Class::Machine, &[
        "rest_time", "filter_time", "ramp_start", "ramp_slope", "ramp_end", "moved", "most_shift", "most_spread",
        "lift_excess", "lower_excess", "look_time", "longest_drive", "stroke",
    ]),
    row("teach", UP, &[
        "end_margin",
    ]),
    row("teach", DOWN, &[
        "most_offset", "most_stretch",
    ]),
    row("current", Class::Machine, &[
        "nominal_resistance", "lowest_resistance", "highest_resistance", "adaptation", "settling_time",
        "proportional", "integral", "freewheel_drop", "assumed_supply", "dither_amplitude", "dither_period",
    ]),
    row("bus", Class::Live, &[
        "measured_period",
    ]),
    row("bus", KEY_ONLY, &[
        "engine_address", "second_engine_address",
    ]),
    row("remote", KEY_ONLY, &[
        "consent",
    ]),
    row("remote", UP, &[
        "lowest",
    ]),
    row("remote", DOWN, &[
        "highest", "speed", "ground_speed",
    ]),
    row("draft", Class::Machine, &[
        "fitted", "left_zero", "right_zero", "left_span", "right_span", "output_min", "output_max", "difference",
        "difference_share", "check_time", "healthy_time", "still_time", "frozen_time", "noise_limit", "work_filter", "raised_filter", "soil_draft", "force_per_degree",
        "crossover", "length", "assumed_speed", "dead_band", "step", "margin",
    ]),
    row("depth", Class::Machine, &[
        "fitted", "zero", "span", "filter", "noise_limit", "rest_time", "dead_band", "per_degree", "crossover", "step", "margin",
    ]),
    row("slip", Class::Machine, &[
        "highest_limit", "lowest_speed", "time_out", "frozen_time", "filter", "slip_per_degree", "crossover",
        "most_raise", "radius_time", "radius_range",
    ]),
    row("ride", Class::Machine, &[
        "gain", "low_corner", "high_corner", "lead", "forcing", "dead_band", "centring_time",
    ]),
    row("ride", UP, &[
        "begin_speed", "end_speed", "height",
    ]),
    row("ride", DOWN, &[
        "fitted", "speed", "band", "time_out",
    ]),
    row("work", Class::Machine, &[
        "angle", "band",
    ]),
    row("safety", UP, &[
        "arming_movement", "shortest_step", "supply_min", "following_share", "following_speed",
        "sensor_supply_min",
    ]),
    row("safety", DOWN, &[
        "lift_current_limit", "lower_current_limit", "free_current", "current_slope", "command_age", "sensor_time",
        "longest_step", "overrun_time", "supply_max", "supply_time", "frozen_time", "still_time", "noise_limit",
        "following_margin", "following_lag", "started_lag", "lift_onset_speed", "lower_onset_speed",
        "onset_budget", "onset_debt", "stop_debt", "following_allowance", "end_zone",
        "contradiction", "limit_margin", "limit_time", "testable_current", "open_time", "excess_current",
        "short_time", "leftover_current", "decay_time", "reference_error", "reference_time", "sensor_supply_max",
        "sensor_supply_time", "track_difference", "track_time", "clock_error", "clock_time",
    ]),
    row("safety", KEY_ONLY, &[
        "onset_time", "onset_travel",
    ]),
];

/// The class of a scalar; the build fails if it has none or several.
pub(super) const fn class_of(group: &str, parameter: &ParameterInfo) -> Class {
    let mut found = None;
    let mut index = 0;
    while index < CLASSES.len() {
        let row = &CLASSES[index];
        let mut name = 0;
        while is_same(row.group, group) && name < row.names.len() {
            if is_same(row.names[name], parameter.name) {
                assert!(found.is_none(), "a value has two classes");
                found = Some(row.class);
            }
            name += 1;
        }
        index += 1;
    }
    match found {
        Some(class) => class,
        None => panic!("a value has no class"),
    }
}

const fn is_same(one: &str, other: &str) -> bool {
    let (one, other) = (one.as_bytes(), other.as_bytes());
    let mut same = one.len() == other.len();
    let mut index = 0;
    while same && index < one.len() {
        same = one[index] == other[index];
        index += 1;
    }
    same
}
