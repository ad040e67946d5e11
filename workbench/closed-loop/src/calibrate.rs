//! Converts an identified model into the firmware's calibration.

use std::f64::consts::TAU;

use hitch_plant::units::{bar_from_pa, lpm_from_m3_s, m3_s_from_lpm};
use hitch_plant::{Constants, Dynamics, Model, OrificeValve, Solenoid, Valve};
use hitch_quantities::calibration::design_parameters::CurrentParameters;
use hitch_quantities::calibration::linkage::{LINKAGE_POINTS, LinkageTable};
use hitch_quantities::calibration::valve_table::{VALVE_POINTS, ValvePoint, ValveTable};
use hitch_quantities::units::{
    AmperePerSecond, MicroLitrePerSecond, Micrometre, MilliAmp, MilliBar, MilliDegree, MilliOhm,
    MilliOhmPerSecond, Millisecond, PerMille, SquareMillimetre,
};
use hitch_quantities::{Calibration, CalibrationError, ValidCalibration};

use crate::valve_survey::{CurvePoint, LOWERING_PORT_BAR, largest_current_a, survey};
use effect_size::found;

pub mod carried;
mod dynamics;
mod effect_size;
mod holding;
pub mod working;

/// Tolerance of a valve table relative to the surveyed curve, A.
const TOLERANCE_A: f64 = 0.5e-3;

/// A current may start at once up to this far beyond the larger threshold.
const FREE_BEYOND_THRESHOLD: MilliAmp = MilliAmp(400);

/// Shortest time for the opening of a valve, ms.
const FULL_OPENING_MS: i32 = 50;

/// Dither over the largest current.
const DITHER_SHARE: f64 = 0.03;

/// Ends of the ranges of the firmware's parameters.
const FASTEST_ADAPTATION: MilliOhmPerSecond = MilliOhmPerSecond(10_000);
const LONGEST_SETTLING: Millisecond = Millisecond(1_000);

/// Distance of the travel limits from the mechanical ends.
const END_DISTANCE: MilliDegree = MilliDegree(500);

/// Tolerance for equal ends of travel: a calibration is rounded.
const SAME_END: MilliDegree = MilliDegree(20);

/// The reason why a model cannot be converted.
#[derive(Debug, thiserror::Error)]
pub enum CalibrateError {
    /// A valve of the model never opens.
    #[error(
        "the {valve} valve of the model never opens up to {largest_a} A, where its curve ends; check its curve and threshold effects"
    )]
    Shut {
        /// `lift` or `lower`.
        valve: &'static str,
        /// Largest current of its curve, A.
        largest_a: f64,
    },
    /// The firmware rejects the result.
    #[error("the firmware refuses the calibration of this model: {0:?}")]
    Refused(CalibrationError),
}

/// The calibration for a machine like `model`: `base` with the model's valves, linkage and circuit.
///
/// # Errors
/// See [`CalibrateError`].
pub fn calibrate(model: &Model, base: &Calibration) -> Result<ValidCalibration, CalibrateError> {
    let constants = model.constants();
    let mut calibration = base.clone();
    for (name, valve, table) in [
        ("lift", Valve::Lift, &mut calibration.lift),
        ("lower", Valve::Lower, &mut calibration.lower),
    ] {
        *table = valve_table(&survey(model, valve)).ok_or_else(|| CalibrateError::Shut {
            valve: name,
            largest_a: largest_current_a(model, valve),
        })?;
    }
    linkage(model, &mut calibration);
    currents(constants, &mut calibration);
    current_regulation(&constants.solenoid, &mut calibration.current);
    let hydraulics = &mut calibration.hydraulics;
    hydraulics.reference_drop = MilliBar((LOWERING_PORT_BAR * 1e3) as i32);
    hydraulics.piston_area = SquareMillimetre((constants.cylinder.area_m2() * 1e6).round() as i32);
    let relief_bar = bar_from_pa(constants.relief_valve.set_pressure_pa);
    hydraulics.relief_pressure = MilliBar((relief_bar * 1e3).round() as i32);
    if constants.dynamics == Dynamics::Dynamic {
        // A quasi-static model has no lag; the default is kept.
        let lag = Millisecond((constants.spool_time_constant_s * 1e3).round() as i32);
        hydraulics.spool_lag = lag;
        hydraulics.lower_spool_lag = lag;
    }
    // Identified properties of coil and spool; kept from the base if the model lacks them.
    if let Some(lag_s) = found(model, "spool-lag") {
        let further = Millisecond((lag_s * 1e3).round() as i32);
        hydraulics.spool_lag = hydraulics.spool_lag + further;
        hydraulics.lower_spool_lag = hydraulics.lower_spool_lag + further;
    }
    if let Some(width_a) = found(model, "solenoid-hysteresis") {
        hydraulics.hysteresis = MilliAmp((width_a * 1e3).round() as i32);
    }
    // The form with dead time as well: its first value is the delay behind a steady motion.
    if let Some(lag_s) = found(model, "angle-sensor-lag") {
        calibration.sensors.angle_lag = Millisecond((lag_s * 1e3).round() as i32);
    }
    if let Some(offset_bar) = found(model, "pressure-sensor-offset") {
        calibration.hydraulics.pressure_offset = MilliBar((offset_bar * 1e3).round() as i32);
    }
    dynamics::adapt(model, &mut calibration);
    holding::adapt(model, &mut calibration);
    calibration
        .sealed()
        .validate()
        .map_err(CalibrateError::Refused)
}

/// Limits of the currents, which the coils and the range of the valves set: those of the base are for valves that open
/// at 1.1 A and end at 3.5 A, and are kept where they are stricter.
fn currents(constants: &Constants, calibration: &mut Calibration) {
    let last_ma = |valve: &OrificeValve| {
        let last_a = valve.curve.currents_a().last().copied();
        MilliAmp((last_a.unwrap_or(0.0) * 1e3).round() as i32)
    };
    let (lift, lower) = (
        last_ma(&constants.lift_valve),
        last_ma(&constants.lower_valve),
    );
    let (lift_table, lower_table) = (&calibration.lift, &calibration.lower);
    let threshold = lift_table.threshold().max(lower_table.threshold());
    let range = (lift.max(lower) - threshold).0.max(1);
    let safety = &mut calibration.safety;
    (safety.lift_current_limit, safety.lower_current_limit) = (lift, lower);
    safety.free_current = safety.free_current.min(threshold + FREE_BEYOND_THRESHOLD);
    let slope = AmperePerSecond((range / FULL_OPENING_MS).max(1));
    safety.current_slope = safety.current_slope.min(slope);
    let dither_ma = (DITHER_SHARE * f64::from(lift.max(lower).0)).min(fastest_dither_ma(
        &constants.solenoid,
        threshold,
        &calibration.current,
    ));
    let current = &mut calibration.current;
    current.dither_amplitude = current
        .dither_amplitude
        .min(MilliAmp(dither_ma.round() as i32));
}

/// Largest amplitude of the dither, mA, whose current falls at the threshold by at most half as fast as it does through
/// the freewheeling diode: a faster one would be cut off below, and shift the mean.
fn fastest_dither_ma(solenoid: &Solenoid, threshold: MilliAmp, current: &CurrentParameters) -> f64 {
    let threshold_a = 1e-3 * f64::from(threshold.0);
    let diode_v = 1e-3 * f64::from(current.freewheel_drop.0);
    let fall_a_s = (solenoid.resistance_ohm * threshold_a + diode_v) / solenoid.inductance_h;
    let per_second = TAU * 1e3 / f64::from(current.dither_period.0);
    0.5e3 * fall_a_s / per_second
}

/// Regulation of the currents for the coils of the model. The range of the resistance keeps its ratio to the resistance
/// at 20 C. The gains are those of the default for its coil: the voltage to close a gap of current in a given time
/// goes with the inductance, and the integral part cancels the time constant of the coil.
fn current_regulation(solenoid: &Solenoid, current: &mut CurrentParameters) {
    let default = Calibration::nominal().current;
    let coil = Solenoid::default();
    let milli_ohm = |ohm: f64| MilliOhm((ohm * 1e3).round() as i32);
    let scaled = |value: MilliOhm, ratio: f64| milli_ohm(1e-3 * f64::from(value.0) * ratio);
    let resistance = solenoid.resistance_ohm / coil.resistance_ohm;
    current.nominal_resistance = milli_ohm(solenoid.resistance_ohm);
    current.lowest_resistance = scaled(default.lowest_resistance, resistance);
    current.highest_resistance = scaled(default.highest_resistance, resistance);
    let adaptation = scaled(MilliOhm(default.adaptation.0), resistance);
    current.adaptation = MilliOhmPerSecond(adaptation.0).min(FASTEST_ADAPTATION);
    let inductance = solenoid.inductance_h / coil.inductance_h;
    current.proportional = scaled(default.proportional, inductance);
    current.integral = scaled(default.integral, resistance);
    let settling_ms = f64::from(default.settling_time.0) * (inductance / resistance).max(1.0);
    current.settling_time = Millisecond(settling_ms.ceil() as i32).min(LONGEST_SETTLING);
}

/// The linkage table over the model's range, and the travel limits inside it. The angles are those that the sensor shows
/// of a hitch at rest.
fn linkage(model: &Model, calibration: &mut Calibration) {
    let (low_rad, high_rad) = model.linkage().swing_rad();
    let shown = 1.0 + found(model, "angle-sensor-gain").unwrap_or(0.0);
    let milli = |angle_rad: f64| MilliDegree((shown * angle_rad.to_degrees() * 1e3).round() as i32);
    let (low, high) = (milli(low_rad), milli(high_rad));
    let pieces = LINKAGE_POINTS as i32 - 1;
    let before_um_mdeg = travel_for_angle(&calibration.linkage);
    // Rounded up, so that the table covers the whole range.
    let step = MilliDegree(((high - low).0 + pieces - 1) / pieces);
    let table = &mut calibration.linkage;
    (table.first_angle, table.angle_step) = (low, step);
    for (index, travel) in (0..).zip(&mut table.travel) {
        let angle_deg = f64::from(low.0 + index * step.0) * 1e-3 / shown;
        let piston_m = model.linkage().piston_m(angle_deg.to_radians());
        *travel = Micrometre((piston_m * 1e6).round() as i32);
    }
    let stretch = travel_for_angle(&calibration.linkage) / before_um_mdeg;
    let position = &mut calibration.position;
    // Angles of the hitch, as distances of the piston.
    for band in [&mut position.stop_band, &mut position.restart_band] {
        *band = Micrometre((stretch * f64::from(band.0)).round() as i32);
    }
    let before = [position.lower_limit, position.upper_limit];
    // The same end keeps its limit: one that is wider by a rounding needs the key of the machine.
    let lower_limit = before[0] + moved_by(before[0], low + END_DISTANCE);
    let upper_limit = before[1] + moved_by(before[1], high - END_DISTANCE);
    (position.lower_limit, position.upper_limit) = (lower_limit, upper_limit);
    follow(calibration, before, [lower_limit, upper_limit]);
    let stroke_m = model.constants().cylinder.stroke_m;
    calibration.teach.stroke = Micrometre((stroke_m * 1e6).round() as i32);
    calibration.hydraulics.load_ratio = load_ratio(model, stroke_m);
}

/// Mean travel for each angle of a table, um/mdeg.
fn travel_for_angle(table: &LinkageTable) -> f64 {
    let [first, .., last] = table.travel;
    let pieces = LINKAGE_POINTS as f64 - 1.0;
    f64::from((last - first).0) / (pieces * f64::from(table.angle_step.0))
}

/// Mean of the load's travel over that of the piston.
fn load_ratio(model: &Model, stroke_m: f64) -> PerMille {
    const PLACES: u32 = 32;
    let places = (0..PLACES).map(|place| (f64::from(place) + 0.5) / f64::from(PLACES) * stroke_m);
    let sum: f64 = places.map(|place_m| model.linkage().dh_dx(place_m)).sum();
    PerMille((1e3 * sum / f64::from(PLACES)).round() as i32)
}

/// Displacement of a travel limit.
fn moved_by(before: MilliDegree, after: MilliDegree) -> MilliDegree {
    let by = after - before;
    if by.magnitude() < SAME_END {
        MilliDegree::ZERO
    } else {
        by
    }
}

/// Shifts values that refer to a travel limit together with it: float range, height of a lift by button, sensor ranges.
fn follow(calibration: &mut Calibration, before: [MilliDegree; 2], after: [MilliDegree; 2]) {
    let (operator, sensors) = (&mut calibration.operator, &mut calibration.sensors);
    let lower = moved_by(before[0], after[0]);
    let upper = moved_by(before[1], after[1]);
    for (angle, by) in [
        (&mut operator.float_lever, lower),
        (&mut operator.float_exit, lower),
        (&mut sensors.angle_min, lower),
        (&mut sensors.lever_min, lower),
        (&mut sensors.angle_max, upper),
        (&mut sensors.lever_max, upper),
    ] {
        *angle = *angle + by;
    }
    // Fractions of the range.
    let range = f64::from((before[1] - before[0]).0);
    let stretch = f64::from((upper - lower).0) / range;
    for angle in [&mut operator.float_angle, &mut operator.quick_lift_angle] {
        let share = f64::from((*angle - before[0]).0);
        *angle = *angle + lower + MilliDegree((stretch * share).round() as i32);
    }
}

/// The table of a surveyed curve with the minimum number of points within its tolerance, limited by the table size;
/// `None` for a valve that never opens.
fn valve_table(curve: &[CurvePoint]) -> Option<ValveTable> {
    let gap_lpm = least_gap_lpm(curve);
    let mut tolerance_a = TOLERANCE_A;
    let mut points = thinned(curve, tolerance_a, gap_lpm);
    while points.len() > VALVE_POINTS {
        tolerance_a *= 1.25;
        points = thinned(curve, tolerance_a, gap_lpm);
    }
    if points.len() < 2 {
        return None;
    }
    let mut table = ValveTable {
        count: points.len() as u32,
        points: [ValvePoint::default(); VALVE_POINTS],
    };
    for (target, point) in table.points.iter_mut().zip(&points) {
        *target = ValvePoint {
            flow: flow(point),
            current: MilliAmp((point.current_a * 1e3).round() as i32),
        };
    }
    Some(table)
}

/// Flow of a surveyed point, rounded to the resolution of the table.
fn flow(point: &CurvePoint) -> MicroLitrePerSecond {
    MicroLitrePerSecond((m3_s_from_lpm(point.flow_lpm) * 1e9).round() as i32)
}

/// Minimum distance in flow between the points of the table, with a margin for rounding.
fn least_gap_lpm(curve: &[CurvePoint]) -> f64 {
    let saturation = curve.last().map_or(MicroLitrePerSecond::ZERO, flow);
    let gap = ValveTable::least_gap_of(saturation) + MicroLitrePerSecond(1);
    lpm_from_m3_s(f64::from(gap.0) * 1e-9)
}

/// Douglas-Peucker: starts with the ends of the curve and adds the point with the largest deviation, until the
/// deviation is within the tolerance, or no further point is `gap_lpm` from its neighbours.
fn thinned(curve: &[CurvePoint], tolerance_a: f64, gap_lpm: f64) -> Vec<CurvePoint> {
    let (Some(first), Some(last)) = (curve.first(), curve.last()) else {
        return Vec::new();
    };
    let off_a = |point: &CurvePoint| {
        let share = (point.flow_lpm - first.flow_lpm) / (last.flow_lpm - first.flow_lpm);
        (first.current_a + share * (last.current_a - first.current_a) - point.current_a).abs()
    };
    let has_room = |point: &CurvePoint| {
        (point.flow_lpm - first.flow_lpm).min(last.flow_lpm - point.flow_lpm) >= gap_lpm
    };
    let furthest = (1..curve.len().saturating_sub(1))
        .filter(|&at| has_room(&curve[at]))
        .max_by(|&a, &b| off_a(&curve[a]).total_cmp(&off_a(&curve[b])));
    match furthest {
        Some(at) if off_a(&curve[at]) > tolerance_a => {
            let mut points = thinned(&curve[..=at], tolerance_a, gap_lpm);
            points.pop();
            points.extend(thinned(&curve[at..], tolerance_a, gap_lpm));
            points
        }
        _ => vec![*first, *last],
    }
}

#[cfg(test)]
mod tests {
    use hitch_plant::AddedEffect;

    use super::*;

    /// A curve in steps of 1 mA with a kink every 7 mA and a flat start: its kinks are closer than table points may be.
    fn bent() -> Vec<CurvePoint> {
        let mut flow_lpm = 0.0;
        let point = |step: u32| {
            let slope = [1.5, 0.5][step as usize / 7 % 2];
            flow_lpm += slope * 0.02 * (f64::from(step) / 1e3).powi(2).min(1.0);
            CurvePoint {
                current_a: 1.0 + f64::from(step) * 1e-3,
                flow_lpm,
            }
        };
        let rising = (1..2_000).map(point);
        let threshold = CurvePoint {
            current_a: 1.0,
            flow_lpm: 0.0,
        };
        std::iter::once(threshold).chain(rising).collect()
    }

    /// The nominal model with a different stroke, calibrated.
    fn with_stroke(stroke_mm: f64) -> ValidCalibration {
        let source = hitch_input::source_file::SourceFile {
            path: "m.toml".into(),
            text: format!("format = 1\nbase = \"nominal\"\n[cylinder]\nstroke_mm = {stroke_mm}\n"),
        };
        let model = hitch_model_file::parse(&source).unwrap();
        calibrate(&model, &Calibration::nominal()).unwrap()
    }

    #[test]
    fn what_lies_near_an_end_follows_it() {
        let nominal = Calibration::nominal();
        let same = with_stroke(158.0);
        assert_eq!(same.operator, nominal.operator);
        assert_eq!(same.sensors, nominal.sensors);
        assert_eq!(same.teach, nominal.teach);
        let bands = |calibration: &Calibration| {
            let position = &calibration.position;
            [position.stop_band, position.restart_band]
        };
        assert_eq!(bands(&same), bands(&nominal));
        let ratio = f64::from(same.hydraulics.load_ratio.0);
        assert!((ratio / 4_300.0 - 1.0).abs() < 0.02, "{ratio}");
        let distances = |calibration: &Calibration| {
            let (position, sensors) = (&calibration.position, &calibration.sensors);
            [
                calibration.operator.float_lever - position.lower_limit,
                calibration.operator.float_exit - position.lower_limit,
                position.lower_limit - sensors.angle_min,
                sensors.angle_max - position.upper_limit,
                sensors.lever_max - position.upper_limit,
            ]
        };
        let shares = |calibration: &Calibration| {
            let (position, operator) = (&calibration.position, &calibration.operator);
            let range = f64::from((position.upper_limit - position.lower_limit).0);
            [operator.float_angle, operator.quick_lift_angle]
                .map(|angle| f64::from((angle - position.lower_limit).0) / range)
        };
        for stroke_mm in [120.0, 180.0] {
            let other = with_stroke(stroke_mm);
            assert_eq!(distances(&other), distances(&nominal), "{stroke_mm} mm");
            for (share, nominal) in shares(&other).into_iter().zip(shares(&nominal)) {
                assert!((share - nominal).abs() < 1e-3, "{stroke_mm} mm: {share}");
            }
            assert_eq!(f64::from(other.teach.stroke.0), stroke_mm * 1e3);
        }
    }

    #[test]
    fn a_valve_that_never_opens_is_named_with_the_end_of_its_curve() {
        let dynamic = hitch_model_file::dynamic();
        let mut constants = dynamic.constants().clone();
        let curve = &mut constants.lift_valve.curve;
        let currents = curve.currents_a().iter().map(|current| 0.04 * current);
        let flows = curve.flows_m3_s().to_vec();
        *curve = hitch_plant::ValveCurve::new(currents.collect(), flows).unwrap();
        let shift = hitch_effects::find("lift-threshold-shift").unwrap();
        let mut shift = AddedEffect::typical(shift);
        shift.values[0] = 0.2;
        let model = dynamic.with_constants(constants).unwrap();
        let shut = calibrate(&model.with_effects(vec![shift]), &Calibration::nominal());
        let said = shut.unwrap_err().to_string();
        assert!(
            said.contains("lift valve") && said.contains("up to 0.14 A"),
            "{said}"
        );
    }

    #[test]
    fn points_are_as_far_apart_as_the_firmware_wants_them() {
        let curve = bent();
        let table = valve_table(&curve).unwrap();
        let points = table.used();
        assert!(points.len() > 10);
        for pair in points.windows(2) {
            assert!(pair[1].flow - pair[0].flow >= table.least_gap());
        }
        let mut calibration = Calibration::nominal();
        calibration.lift = table;
        assert!(calibration.sealed().validate().is_ok());
        let ends = [curve[0], curve[curve.len() - 1]].map(|point| flow(&point));
        assert_eq!([points[0].flow, table.saturation()], ends);
    }
}
