//! What the page needs to draw the closed loop: linkage, ranges and valve maps.

use hitch_plant::{LinkageError, Model};
use hitch_quantities::ValidCalibration;
use hitch_quantities::calibration::valve_table::ValveTable;
use hitch_quantities::units::MilliAmp;
use serde_json::{Value, json};

use super::machine::Machine;
use super::orders::{LOADS_KG, LONGEST_MS, OILS_C};

/// Drawn positions of the linkage over its swing; the page interpolates between them with less than 0.2 mm of error.
const POSITIONS: u32 = 64;

/// The description of a machine whose hitches begin at an angle, degree. `source` names what runs the controller: `host`, `ecu`
/// or `bus`; the page may write a calibration to it if `may_write`.
///
/// # Errors
/// If the linkage cannot be assembled.
pub fn described(
    machine: &Machine,
    angle_deg: f64,
    source: &str,
    may_write: bool,
) -> Result<Value, LinkageError> {
    let (low_rad, high_rad) = machine.plant.linkage().swing_rad();
    let (initial, rebuilt) = (&machine.initial, &machine.rebuilt);
    Ok(json!({
        "source": source,
        "may_write": may_write,
        "angle_deg": angle_deg,
        "swing_deg": [low_rad.to_degrees(), high_rad.to_degrees()],
        "loads_kg": [LOADS_KG.start(), LOADS_KG.end()],
        "oils_c": [OILS_C.start(), OILS_C.end()],
        "longest_ms": LONGEST_MS,
        "linkage": linkage(&machine.plant)?,
        "equal": initial == rebuilt,
        "maps": [valve_maps(initial), valve_maps(rebuilt)],
    }))
}

/// Joints at equally spaced angles, in m; x to the rear, y up.
fn linkage(model: &Model) -> Result<Value, LinkageError> {
    let (low_rad, high_rad) = model.linkage().swing_rad();
    let position = |index: u32| {
        let angle_rad = low_rad + (high_rad - low_rad) * f64::from(index) / f64::from(POSITIONS);
        let joints = model.joints(angle_rad)?;
        let points = [
            joints.piston_pin,
            joints.rocker_end,
            joints.lift_arm_end,
            joints.rod_joint,
            joints.pivot,
            joints.hitch_point,
        ];
        Ok(json!({
            "angle_deg": angle_rad.to_degrees(),
            "joints": points.map(|point| [point.x, point.y]),
        }))
    };
    let positions = (0..=POSITIONS)
        .map(position)
        .collect::<Result<Vec<_>, _>>()?;
    Ok(json!({
        "joints": ["A", "B", "D", "E", "F", "G"],
        "stroke_m": model.constants().cylinder.stroke_m,
        "positions": positions,
    }))
}

/// Flow over current of both valves, up to the largest current of each.
fn valve_maps(calibration: &ValidCalibration) -> Value {
    let map = |table: &ValveTable, limit: MilliAmp| {
        let points = table.used().iter();
        let pairs = points.map(|point| {
            let flow_lpm = f64::from(point.flow.0) * 60e-6;
            [f64::from(point.current.0) * 1e-3, flow_lpm]
        });
        let saturated_lpm = f64::from(table.saturation().0) * 60e-6;
        let last = table
            .used()
            .last()
            .map_or(limit, |last| limit.max(last.current));
        let ends = [[f64::from(last.0) * 1e-3, saturated_lpm]];
        let threshold_a = f64::from(table.threshold().0) * 1e-3;
        let all: Vec<[f64; 2]> = std::iter::once([0.0, 0.0])
            .chain(pairs)
            .chain(ends)
            .collect();
        json!({
            "current_a": all.iter().map(|pair| pair[0]).collect::<Vec<_>>(),
            "flow_lpm": all.iter().map(|pair| pair[1]).collect::<Vec<_>>(),
            "threshold_a": threshold_a,
            "saturation_lpm": saturated_lpm,
        })
    };
    let safety = &calibration.safety;
    json!({
        "lift": map(&calibration.lift, safety.lift_current_limit),
        "lower": map(&calibration.lower, safety.lower_current_limit),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitch_plant::LinkageTable;

    #[test]
    fn a_valve_map_ends_at_the_largest_current_of_its_valve() {
        let mut calibration = hitch_quantities::Calibration::nominal();
        let last_a = |calibration: &hitch_quantities::Calibration, valve: &str| {
            let valid = calibration.clone().sealed().validate().expect("valid");
            let maps = valve_maps(&valid);
            let currents = maps[valve]["current_a"].as_array().expect("currents");
            currents[currents.len() - 1].as_f64().expect("a current")
        };
        assert_eq!(last_a(&calibration, "lift"), 3.5);
        calibration.safety.lower_current_limit = MilliAmp(4_000);
        assert_eq!(last_a(&calibration, "lower"), 4.0);
        for point in &mut calibration.lift.points {
            point.current = MilliAmp(point.current.0 * 2 / 5);
        }
        calibration.safety.lift_current_limit = MilliAmp(1_600);
        assert_eq!(last_a(&calibration, "lift"), 1.6);
    }

    #[test]
    fn a_measured_linkage_is_sketched_with_its_heights() {
        let nominal = hitch_model_file::nominal();
        let mut constants = nominal.constants().clone();
        let travel_m = vec![0.0, 0.08, constants.cylinder.stroke_m];
        let table = LinkageTable::new(travel_m, vec![0.5, 1.5, 2.2], vec![0.1, 0.6, 1.2]);
        constants.linkage_table = Some(table.expect("a table"));
        let model = nominal.with_constants(constants).expect("a linkage");
        let drawn = linkage(&model).expect("a sketch");
        let positions = drawn["positions"].as_array().expect("positions");
        let height_m = |at: usize| positions[at]["joints"][5][1].as_f64().expect("a height");
        let risen_m = height_m(positions.len() - 1) - height_m(0);
        assert!((risen_m - 1.1).abs() < 1e-6, "{risen_m}");
    }
}
