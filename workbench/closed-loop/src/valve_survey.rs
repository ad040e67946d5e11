//! Survey of a model's valves: static flow over current with all effects.
//!
//! The plant is on a flow bench at constant currents, so thresholds, scales, hysteresis (rising branch) and return line
//! are part of the curve. A calibration has to invert this curve.

use hitch_plant::units::{lpm_from_m3_s, pa_from_bar};
use hitch_plant::{Currents, Model, Plant, Rig, Valve};

/// Steps of the survey in one ampere.
const STEPS_PER_A: f64 = 1e3;
/// Port pressure for the survey of the lift valve, bar: between cracking pressure and relief pressure the flow does not
/// depend on it.
const LIFT_PORT_BAR: f64 = 20.0;
/// Port pressure for the survey of the lowering valve, bar: the reference drop of its table.
pub const LOWERING_PORT_BAR: f64 = 15.0;
/// Oil temperature of the survey, C.
const OIL_TEMPERATURE_C: f64 = 40.0;
/// Flow that counts as zero, l/min: the hitch would move at 2 um/s.
const NO_FLOW_LPM: f64 = 5e-4;
/// A valve is saturated when its flow is less than this share below its maximum.
const SATURATED_SHARE: f64 = 1e-4;

/// A point of a valve's static curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePoint {
    /// Coil current, A.
    pub current_a: f64,
    /// Flow, l/min.
    pub flow_lpm: f64,
}

/// Static flow, l/min, of one valve at a current, A.
#[must_use]
pub fn static_flow_lpm(model: &Model, valve: Valve, current_a: f64) -> f64 {
    let port_bar = match valve {
        Valve::Lift => LIFT_PORT_BAR,
        Valve::Lower => LOWERING_PORT_BAR,
    };
    let currents = Currents::only(valve, current_a);
    let rig = Rig::Flow {
        port_pressure_pa: pa_from_bar(port_bar),
    };
    let flows = Plant::new(model, rig, OIL_TEMPERATURE_C, currents).flows();
    lpm_from_m3_s(match valve {
        Valve::Lift => flows.lift_m3_s,
        Valve::Lower => flows.lower_m3_s,
    })
}

/// Largest current of a model's valve, A: that of its curve.
#[must_use]
pub fn largest_current_a(model: &Model, valve: Valve) -> f64 {
    let currents_a = valve.of(model.constants()).curve.currents_a();
    currents_a.last().copied().unwrap_or(0.0)
}

/// The section of a valve's curve between threshold and saturation, in steps of 1 mA.
///
/// The first point is the last one without flow (set to zero), the last point the first one with full flow. Fewer than
/// two points: the valve never opens.
#[must_use]
pub fn survey(model: &Model, valve: Valve) -> Vec<CurvePoint> {
    let largest_a = largest_current_a(model, valve);
    let steps = (largest_a * STEPS_PER_A).ceil() as u32;
    let point = |step: u32| {
        let current_a = largest_a.min(f64::from(step) / STEPS_PER_A);
        CurvePoint {
            current_a,
            flow_lpm: static_flow_lpm(model, valve, current_a),
        }
    };
    let mut points: Vec<CurvePoint> = (0..=steps).map(point).collect();
    let largest_lpm = points
        .iter()
        .map(|point| point.flow_lpm)
        .fold(0.0, f64::max);
    let open = points.iter().position(|point| point.flow_lpm > NO_FLOW_LPM);
    let full = points
        .iter()
        .position(|point| point.flow_lpm >= largest_lpm * (1.0 - SATURATED_SHARE));
    let (Some(open), Some(full)) = (open, full) else {
        return Vec::new();
    };
    points.truncate(full + 1);
    points.drain(..open.saturating_sub(1));
    if let Some(first) = points.first_mut().filter(|_| open > 0) {
        first.flow_lpm = 0.0;
    }
    points
}

/// Threshold and saturation current of a valve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ValveEnds {
    /// Largest current without flow, A.
    pub threshold_a: f64,
    /// Smallest current with the largest flow, A.
    pub saturation_a: f64,
}

impl ValveEnds {
    /// Currents of the lift valve.
    #[must_use]
    pub fn of_lift(model: &Model) -> Self {
        Self::of(model, Valve::Lift)
    }

    /// Currents of the lowering valve.
    #[must_use]
    pub fn of_lowering(model: &Model) -> Self {
        Self::of(model, Valve::Lower)
    }

    fn of(model: &Model, valve: Valve) -> Self {
        let points = survey(model, valve);
        let current_a = |point: Option<&CurvePoint>| point.map_or(0.0, |point| point.current_a);
        Self {
            threshold_a: current_a(points.first()),
            saturation_a: current_a(points.last()),
        }
    }
}
