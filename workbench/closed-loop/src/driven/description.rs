//! What the page needs to draw the closed loop: linkage, ranges and valve maps.

use std::ops::RangeInclusive;

use hitch_field::tractor::TractorConstants;
use hitch_plant::{LinkageError, Model};
use hitch_quantities::ValidCalibration;
use hitch_quantities::calibration::valve_table::ValveTable;
use hitch_quantities::units::MilliAmp;
use schemars::JsonSchema;
use serde::Serialize;

use super::field_orders::{DEPTHS_M, DRAFTS_N, SLIP_LIMITS, SPEEDS_M_S};
use super::machine::Machine;
use super::orders::{LOADS_KG, LONGEST_MS, OILS_C};
use crate::field::{Coupling, LINK_DEPTH_M, RAISED_DEG, TOUCH_DEG};

/// Drawn positions of the linkage over its swing; the page interpolates between them with less than 0.2 mm of error.
const POSITIONS: u32 = 64;

/// The description of a machine.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Described {
    /// What runs the controller: `host`, `ecu` or `bus`.
    pub source: &'static str,
    /// Whether the page may write a calibration to it.
    pub may_write: bool,
    /// Angle at which the hitches begin, degree.
    pub angle_deg: f64,
    /// Ends of the swing, degree.
    pub swing_deg: [f64; 2],
    /// Range of loads, kg.
    pub loads_kg: [f64; 2],
    /// Range of oil temperatures, C.
    pub oils_c: [f64; 2],
    /// Longest advance, ms.
    pub longest_ms: u32,
    /// The linkage.
    pub linkage: DrawnLinkage,
    /// Whether both calibrations are equal.
    pub equal: bool,
    /// Maps of the first and of the rebuilt calibration.
    pub maps: [ValveMaps; 2],
    /// Tractor and field, if the hitches can work on one.
    pub field: Option<DescribedField>,
    /// Why they cannot.
    pub no_field: Option<String>,
}

/// Tractor and implement of the work on a field, and the ranges of its controls.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct DescribedField {
    /// Rocker angle at which the share touches level ground, degree.
    pub touch_deg: f64,
    /// Rocker angle of the raised implement, degree.
    pub raised_deg: f64,
    /// Rocker angle at which it works at its usual depth, degree.
    pub working_deg: f64,
    /// Distance of the axles, m.
    pub wheelbase_m: f64,
    /// Radius of the rear wheels, m.
    pub rear_radius_m: f64,
    /// Middle of the shares behind the rear axle, m.
    pub share_m: f64,
    /// Length of the share line, m.
    pub share_line_m: f64,
    /// Range of ground speeds, m/s.
    pub speeds_m_s: [f64; 2],
    /// Range of set points of the draft, N.
    pub drafts_n: [f64; 2],
    /// Range of set points of the depth, m.
    pub depths_m: [f64; 2],
    /// Range of slip limits, 1.
    pub slip_limits: [f64; 2],
}

/// The linkage over its swing.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct DrawnLinkage {
    /// Names of the joints.
    pub joints: [&'static str; 6],
    /// Stroke of the cylinder, m.
    pub stroke_m: f64,
    /// Positions at equally spaced angles.
    pub positions: Vec<DrawnPosition>,
}

/// A position of the linkage.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct DrawnPosition {
    /// Rocker angle, degree.
    pub angle_deg: f64,
    /// Its joints, m; x to the rear, y up.
    pub joints: [[f64; 2]; 6],
}

/// Maps of both valves.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ValveMaps {
    /// Of the lift valve.
    pub lift: ValveMap,
    /// Of the lowering valve.
    pub lower: ValveMap,
}

/// Flow over current of a valve, up to its largest current.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ValveMap {
    /// Currents, A.
    pub current_a: Vec<f64>,
    /// Flows, l/min.
    pub flow_lpm: Vec<f64>,
    /// Current at which it opens, A.
    pub threshold_a: f64,
    /// Largest flow, l/min.
    pub saturation_lpm: f64,
}

impl Described {
    /// The description of a machine whose hitches begin at an angle, degree. `source` names what runs the controller: `host`,
    /// `ecu` or `bus`; the page may write a calibration to it if `may_write`.
    ///
    /// # Errors
    /// If the linkage cannot be assembled.
    pub fn new(
        machine: &Machine,
        angle_deg: f64,
        source: &'static str,
        may_write: bool,
    ) -> Result<Self, LinkageError> {
        let (low_rad, high_rad) = machine.plant.linkage().swing_rad();
        let (initial, rebuilt) = (&machine.initial, &machine.rebuilt);
        let no_field = if source == "host" {
            machine.working.as_ref().err().map(ToString::to_string)
        } else {
            Some(
                "the work on a field needs the controller on this computer, without an ECU"
                    .to_owned(),
            )
        };
        Ok(Self {
            source,
            may_write,
            angle_deg,
            swing_deg: [low_rad.to_degrees(), high_rad.to_degrees()],
            loads_kg: [*LOADS_KG.start(), *LOADS_KG.end()],
            oils_c: [*OILS_C.start(), *OILS_C.end()],
            longest_ms: LONGEST_MS,
            linkage: linkage(&machine.plant)?,
            equal: initial == rebuilt,
            maps: [initial, rebuilt].map(valve_maps),
            field: no_field
                .is_none()
                .then(|| DescribedField::of(&machine.plant)),
            no_field,
        })
    }
}

impl DescribedField {
    fn of(plant: &Model) -> Self {
        let constants = TractorConstants::ploughing();
        let ends = |range: RangeInclusive<f64>| [*range.start(), *range.end()];
        Self {
            touch_deg: TOUCH_DEG,
            raised_deg: RAISED_DEG,
            working_deg: Coupling::new(plant, TOUCH_DEG, 0.0).angle_deg(LINK_DEPTH_M),
            wheelbase_m: constants.body.wheelbase_m,
            rear_radius_m: 0.5 * constants.rear_tyre.diameter_m,
            share_m: constants.implement.share_m,
            share_line_m: constants.implement.length_m,
            speeds_m_s: ends(SPEEDS_M_S),
            drafts_n: ends(DRAFTS_N),
            depths_m: ends(DEPTHS_M),
            slip_limits: ends(SLIP_LIMITS),
        }
    }
}

/// Joints at equally spaced angles, in m; x to the rear, y up.
fn linkage(model: &Model) -> Result<DrawnLinkage, LinkageError> {
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
        Ok(DrawnPosition {
            angle_deg: angle_rad.to_degrees(),
            joints: points.map(|point| [point.x, point.y]),
        })
    };
    let positions = (0..=POSITIONS)
        .map(position)
        .collect::<Result<Vec<_>, _>>()?;
    Ok(DrawnLinkage {
        joints: ["A", "B", "D", "E", "F", "G"],
        stroke_m: model.constants().cylinder.stroke_m,
        positions,
    })
}

/// Flow over current of both valves, up to the largest current of each.
fn valve_maps(calibration: &ValidCalibration) -> ValveMaps {
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
        ValveMap {
            current_a: all.iter().map(|pair| pair[0]).collect(),
            flow_lpm: all.iter().map(|pair| pair[1]).collect(),
            threshold_a,
            saturation_lpm: saturated_lpm,
        }
    };
    let safety = &calibration.safety;
    ValveMaps {
        lift: map(&calibration.lift, safety.lift_current_limit),
        lower: map(&calibration.lower, safety.lower_current_limit),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitch_plant::LinkageTable;

    #[test]
    fn a_valve_map_ends_at_the_largest_current_of_its_valve() {
        let mut calibration = hitch_quantities::Calibration::nominal();
        let last_a = |calibration: &hitch_quantities::Calibration,
                      valve: fn(&ValveMaps) -> &ValveMap| {
            let valid = calibration.clone().sealed().validate().expect("valid");
            let maps = valve_maps(&valid);
            *valve(&maps).current_a.last().expect("currents")
        };
        assert_eq!(last_a(&calibration, |maps| &maps.lift), 3.5);
        calibration.safety.lower_current_limit = MilliAmp(4_000);
        assert_eq!(last_a(&calibration, |maps| &maps.lower), 4.0);
        for point in &mut calibration.lift.points {
            point.current = MilliAmp(point.current.0 * 2 / 5);
        }
        calibration.safety.lift_current_limit = MilliAmp(1_600);
        assert_eq!(last_a(&calibration, |maps| &maps.lift), 1.6);
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
        let positions = drawn.positions;
        let height_m = |at: usize| positions[at].joints[5][1];
        let risen_m = height_m(positions.len() - 1) - height_m(0);
        assert!((risen_m - 1.1).abs() < 1e-6, "{risen_m}");
    }
}
