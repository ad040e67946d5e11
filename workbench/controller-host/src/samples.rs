//! Samples in engineering units, as the controller's inputs.

use hitch_quantities::units::{
    Count, Micrometre, MilliAmp, MilliBar, MilliCelsius, MilliDegree, MilliDegreePerSecond,
    MilliVolt, MillimetrePerSecond, Newton, PerMille, RevolutionPerMinute, SupplyShare,
};
use hitch_quantities::{Inputs, Switches};

/// Names of the sampled quantities, each ending in its unit. From [`FIRST_OF_FIELD`] on they are those of draft and slip control.
pub const QUANTITIES: [&str; 22] = [
    "lever_deg",
    "rocker_angle_deg",
    "cylinder_pressure_bar",
    "pump_pressure_bar",
    "oil_temperature_c",
    "supply_v",
    "jog_deg_per_s",
    "upper_limit_deg",
    "lowering_dial_percent",
    "engine_speed_rpm",
    "measured_lift_current_a",
    "measured_lower_current_a",
    "left_draft_pin_percent",
    "right_draft_pin_percent",
    "ground_speed_m_per_s",
    "wheel_speed_m_per_s",
    "draft_set_point_n",
    "mix_percent",
    "slip_limit_percent",
    "function_code",
    "depth_sensor_percent",
    "depth_set_point_mm",
];

/// Index of the first quantity of draft and slip control.
pub const FIRST_OF_FIELD: usize = 12;

/// Names of the operator's switches.
pub const SWITCHES: [&str; 8] = [
    "transport_lock",
    "hold",
    "quick_lift",
    "teach",
    "consent",
    "up_released",
    "down_released",
    "engage",
];

/// The inputs of a step: values in the order of [`QUANTITIES`], `None` for a sample that is missing, and the
/// [`SWITCHES`].
#[must_use]
pub fn inputs(
    values: &[Option<f64>; QUANTITIES.len()],
    switches: [bool; SWITCHES.len()],
) -> Inputs {
    let scaled =
        |index: usize, counts: f64| values[index].map(|value: f64| (value * counts).round() as i32);
    let milli = |index: usize| scaled(index, 1e3);
    let [
        transport_lock,
        hold,
        quick_lift,
        teach,
        consent,
        up_released,
        down_released,
        engage,
    ] = switches;
    Inputs {
        lever: milli(0).map(MilliDegree),
        rocker_angle: milli(1).map(MilliDegree),
        cylinder_pressure: milli(2).map(MilliBar),
        pump_pressure: milli(3).map(MilliBar),
        oil_temperature: milli(4).map(MilliCelsius),
        supply: milli(5).map(MilliVolt),
        jog: milli(6).map(MilliDegreePerSecond),
        upper_limit: milli(7).map(MilliDegree),
        lowering_dial: scaled(8, 10.0).map(PerMille),
        engine_speed: scaled(9, 1.0).map(RevolutionPerMinute),
        lift_current: milli(10).map(MilliAmp),
        lower_current: milli(11).map(MilliAmp),
        // The caller is the clock, and values don't come from converters.
        step_time: None,
        second_angle: None,
        sensor_supply: None,
        reference: None,
        set_point: None,
        clock_ratio: None,
        left_pin: milli(12).map(SupplyShare),
        right_pin: milli(13).map(SupplyShare),
        ground_speed: milli(14).map(MillimetrePerSecond),
        wheel_speed: milli(15).map(MillimetrePerSecond),
        draft_set_point: scaled(16, 1.0).map(Newton),
        mix: scaled(17, 10.0).map(PerMille),
        slip_limit: scaled(18, 10.0).map(PerMille),
        function: scaled(19, 1.0).map(Count),
        depth_sensor: milli(20).map(SupplyShare),
        depth_set_point: milli(21).map(Micrometre),
        enable_line_fault: false,
        switches: Switches {
            transport_lock,
            hold,
            quick_lift,
            teach,
            consent,
            up_released,
            down_released,
            engage,
        },
    }
}
