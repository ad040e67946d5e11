//! What a model needs from data sheets: the questions of `hitch model new`, and of the page.

use hitch_plant::units::lpm_from_m3_s;
use hitch_plant::{Valve, ValveCurve};

/// Questions: constant and text.
pub const QUESTIONS: [(&str, &str); 18] = [
    ("pump.kind", "Pump, fixed-displacement or load-sensing"),
    ("cylinder.cylinders", "Number of lift cylinders"),
    ("cylinder.bore_mm", "Bore of each cylinder, mm"),
    ("cylinder.stroke_mm", "Cylinder stroke, mm"),
    (
        "pump.theoretical_flow_lpm",
        "Pump, largest displacement times speed, l/min",
    ),
    ("pump.standby_pressure_bar", "Pump, standby pressure, bar"),
    ("compensator.margin_bar", "Compensator margin, bar"),
    (
        "check_valve.cracking_pressure_bar",
        "Check valve, cracking pressure, bar",
    ),
    ("relief_valve.set_pressure_bar", "Relief setting, bar"),
    (
        "lift_valve.reference_drop_bar",
        "Lift valve, pressure drop of its flow curve, bar",
    ),
    (
        "lower_valve.reference_drop_bar",
        "Lowering valve, pressure drop of its flow curve, bar",
    ),
    (
        "solenoid.resistance_ohm",
        "Solenoids, resistance with wiring, ohm",
    ),
    (
        "loads.light_kg",
        "Light implement, kg; 0: from the relief setting",
    ),
    ("loads.usual_kg", "Most common implement, kg; 0: as above"),
    ("loads.heavy_kg", "Heaviest implement, kg; 0: as above"),
    (
        "sensors.rocker_angle_noise_deg",
        "Noise of the angle sensor, one sigma, degree",
    ),
    (
        "sensors.cylinder_pressure_noise_bar",
        "Noise of the cylinder pressure sensor, one sigma, bar",
    ),
    (
        "sensors.pump_pressure_noise_bar",
        "Noise of the pump pressure sensor, one sigma, bar",
    ),
];

/// The valves, with what each is called.
pub const VALVES: [(Valve, &str); 2] = [
    (Valve::Lift, "Lift valve"),
    (Valve::Lower, "Lowering valve"),
];

/// What is asked of a valve, in the order of [`ends`]: key and text.
pub const ENDS: [(&str, &str); 3] = [
    ("opens", "opening current, A"),
    ("limit", "current limit, A"),
    ("full", "flow at the current limit, l/min"),
];

/// Current at which a valve opens, A, its current limit, A, and its flow there, l/min.
#[must_use]
pub fn ends(curve: &ValveCurve) -> [f64; 3] {
    let last = curve.currents_a()[curve.currents_a().len() - 1];
    [
        curve.threshold_a(),
        last,
        lpm_from_m3_s(curve.saturation_m3_s()),
    ]
}

/// A flow curve with the shape of `default` and other [`ends`].
///
/// # Errors
/// If the current limit is not above the opening current.
pub fn curve(default: &ValveCurve, now: [f64; 3]) -> Result<ValveCurve, String> {
    let [opens, last, full] = ends(default);
    let [opens_now, last_now, full_now] = now;
    let moved = |&current: &f64| match current <= opens {
        true if current == 0.0 => 0.0,
        true => current * opens_now / opens,
        false => opens_now + (current - opens) * (last_now - opens_now) / (last - opens),
    };
    let currents = default.currents_a().iter().map(moved).collect();
    let flows = default.flows_m3_s().iter();
    let flows = flows.map(|flow| flow * full_now / full).collect();
    ValveCurve::new(currents, flows)
        .map_err(|_| "the current limit has to be above the opening current".to_owned())
}

/// A number of a valve as typed, above 0 and at most 1000.
///
/// # Errors
/// If it is another text.
pub fn positive(answer: &str) -> Result<f64, String> {
    match answer.trim().replace(',', ".").parse::<f64>() {
        Ok(number) if number > 0.0 && number <= 1000.0 => Ok(number),
        _ => Err("it is a number above 0, at most 1000".to_owned()),
    }
}
