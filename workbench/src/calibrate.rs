//! From an identified model to the firmware's calibration.

use hitch_firmware::control::calibration::{Calibration, CalibrationError};
use hitch_firmware::control::linkage::LINKAGE_POINTS;
use hitch_firmware::control::units::{
    MicroLitrePerSecond, Micrometre, MilliAmp, MilliBar, MilliDegree, Millisecond, SquareMillimetre,
};
use hitch_firmware::control::valve_map::{VALVE_POINTS, ValvePoint, ValveTable};
use hitch_firmware::control::{Controller, ValidCalibration};
use hitch_model::Model;
use hitch_model::model::Dynamics;
use hitch_model::plant::Valve;
use hitch_model::units::{bar_from_pa, m3_s_from_lpm};

use crate::valve_survey::{CurvePoint, LOWERING_PORT_BAR, survey};

/// How far, in A, a straight piece of a valve table may be from the surveyed curve before it is split.
const TOLERANCE_A: f64 = 0.5e-3;

/// How far the limits of travel stay from the mechanical ends.
const END_DISTANCE: MilliDegree = MilliDegree(500);

/// Why a model gives no calibration.
#[derive(Debug, thiserror::Error)]
pub enum CalibrateError {
    /// A valve of the model never opens.
    #[error(
        "the {valve} valve of the model never opens up to 3.5 A; check its curve and threshold effects"
    )]
    Shut {
        /// `lift` or `lower`.
        valve: &'static str,
    },
    /// The firmware refuses what came out.
    #[error("the firmware refuses the calibration of this model: {0:?}")]
    Refused(CalibrationError),
}

/// The calibration of a machine that behaves like `model`: `base` with the model's valves, linkage and circuit.
///
/// # Errors
/// See [`CalibrateError`].
pub fn calibrate(model: &Model, base: &Calibration) -> Result<ValidCalibration, CalibrateError> {
    let constants = model.constants();
    let mut calibration = base.clone();
    calibration.lift = valve_table("lift", &survey(model, Valve::Lift))?;
    calibration.lower = valve_table("lower", &survey(model, Valve::Lowering))?;
    linkage(model, &mut calibration);
    let hydraulics = &mut calibration.hydraulics;
    hydraulics.reference_drop = MilliBar((LOWERING_PORT_BAR * 1e3) as i32);
    hydraulics.piston_area = SquareMillimetre((constants.cylinder.area_m2() * 1e6).round() as i32);
    let relief_bar = bar_from_pa(constants.relief_valve.set_pressure_pa);
    hydraulics.relief_pressure = MilliBar((relief_bar * 1e3).round() as i32);
    if constants.dynamics == Dynamics::Dynamic {
        // A quasi-static model knows nothing of the lag; then the default stays.
        hydraulics.spool_lag = Millisecond((constants.spool_time_constant_s * 1e3).round() as i32);
    }
    // What was identified of coil and spool; a model without it says nothing about it.
    if let Some(lag_s) = found(model, "spool-lag") {
        let further = Millisecond((lag_s * 1e3).round() as i32);
        hydraulics.spool_lag = hydraulics.spool_lag + further;
    }
    if let Some(width_a) = found(model, "solenoid-hysteresis") {
        hydraulics.hysteresis = MilliAmp((width_a * 1e3).round() as i32);
    }
    calibration
        .sealed()
        .validate()
        .map_err(CalibrateError::Refused)
}

/// First value of an effect that the model has.
fn found(model: &Model, id: &str) -> Option<f64> {
    let added = model.effects.iter().find(|added| added.effect.id() == id)?;
    added.values.first().copied()
}

/// A controller for `model`, straight from power-up.
///
/// # Errors
/// See [`CalibrateError`].
pub fn controller_for(model: &Model) -> Result<Controller, CalibrateError> {
    calibrate(model, &Calibration::nominal()).map(Controller::new)
}

/// The linkage table over the model's swing, and the limits of travel inside it.
fn linkage(model: &Model, calibration: &mut Calibration) {
    let (low_rad, high_rad) = model.linkage().swing_rad();
    let milli = |degree: f64| MilliDegree((degree * 1e3).round() as i32);
    let (low, high) = (milli(low_rad.to_degrees()), milli(high_rad.to_degrees()));
    let pieces = LINKAGE_POINTS as i32 - 1;
    // Rounded up, so that the table covers the whole swing.
    let step = MilliDegree(((high - low).0 + pieces - 1) / pieces);
    let table = &mut calibration.linkage;
    (table.first_angle, table.angle_step) = (low, step);
    for (index, travel) in (0..).zip(&mut table.travel) {
        let angle_deg = f64::from(low.0 + index * step.0) * 1e-3;
        let piston_m = model.linkage().piston_m(angle_deg.to_radians());
        *travel = Micrometre((piston_m * 1e6).round() as i32);
    }
    calibration.position.lower_limit = low + END_DISTANCE;
    calibration.position.upper_limit = high - END_DISTANCE;
}

/// The table of a surveyed curve with as few points as its tolerance needs and as fit.
fn valve_table(valve: &'static str, curve: &[CurvePoint]) -> Result<ValveTable, CalibrateError> {
    let mut tolerance_a = TOLERANCE_A;
    let mut points = thinned(curve, tolerance_a);
    while points.len() > VALVE_POINTS {
        tolerance_a *= 1.25;
        points = thinned(curve, tolerance_a);
    }
    if points.len() < 2 {
        return Err(CalibrateError::Shut { valve });
    }
    let mut table = ValveTable {
        count: points.len() as u32,
        points: [ValvePoint::default(); VALVE_POINTS],
    };
    for (target, point) in table.points.iter_mut().zip(&points) {
        *target = ValvePoint {
            flow: MicroLitrePerSecond((m3_s_from_lpm(point.flow_lpm) * 1e9).round() as i32),
            current: MilliAmp((point.current_a * 1e3).round() as i32),
        };
    }
    Ok(table)
}

/// Douglas and Peucker: the curve's ends, and where the straight line between two kept points is furthest off, until it
/// is within the tolerance everywhere.
fn thinned(curve: &[CurvePoint], tolerance_a: f64) -> Vec<CurvePoint> {
    let (Some(first), Some(last)) = (curve.first(), curve.last()) else {
        return Vec::new();
    };
    let off_a = |point: &CurvePoint| {
        let share = (point.flow_lpm - first.flow_lpm) / (last.flow_lpm - first.flow_lpm);
        (first.current_a + share * (last.current_a - first.current_a) - point.current_a).abs()
    };
    let furthest = (1..curve.len().saturating_sub(1))
        .max_by(|&a, &b| off_a(&curve[a]).total_cmp(&off_a(&curve[b])));
    match furthest {
        Some(at) if off_a(&curve[at]) > tolerance_a => {
            let mut points = thinned(&curve[..=at], tolerance_a);
            points.pop();
            points.extend(thinned(&curve[at..], tolerance_a));
            points
        }
        _ => vec![*first, *last],
    }
}
