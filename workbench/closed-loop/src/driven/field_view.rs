//! What the page shows of tractor and field: samples for the strip charts, forces, speeds, and the ground about the tractor.

use hitch_field::draft::Texture;
use hitch_field::tractor::{Outputs as Field, Tractor};
use hitch_quantities::Outputs;
use schemars::JsonSchema;
use serde::Serialize;

use super::words;

/// Drawn ground behind and in front of the rear axle, m: wide windows show more of it than narrow ones.
const DRAWN_M: [f64; 2] = [-11.0, 10.0];
/// Distance of its points, m.
const POINT_M: f64 = 0.125;

/// Tractor and field since the last answer.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct FieldView {
    /// Draft, kN.
    pub draft_kn: Vec<f64>,
    /// Working depth, cm; negative above ground.
    pub depth_cm: Vec<f64>,
    /// Slip of the rear wheels, percent.
    pub slip_percent: Vec<f64>,
    /// The present state; `null` before the first step.
    pub now: Option<FieldNow>,
}

/// The present state of tractor and field.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct FieldNow {
    /// Draft, kN, positive against the direction of travel.
    pub draft_kn: f64,
    /// Force of the soil on the implement upwards, kN.
    pub vertical_kn: f64,
    /// Working depth, m; negative above ground.
    pub depth_m: f64,
    /// Slip of the rear wheels, 0 to 1.
    pub slip: f64,
    /// Ground speed, m/s.
    pub ground_speed_m_s: f64,
    /// Speed of the rear wheels, m/s.
    pub wheel_speed_m_s: f64,
    /// Distance of the rear axle, m.
    pub distance_m: f64,
    /// Rear and front axle above their height on level ground without an implement, m.
    pub axles_m: [f64; 2],
    /// What determines the set point, in short; `null`: the lever, or quick lift.
    pub reason: Option<&'static str>,
    /// The same in words.
    pub reason_text: &'static str,
    /// Lost sensor of draft, depth or slip control, in words.
    pub trouble_text: Option<&'static str>,
    /// Whether the implement is in work; `null` if the controller does not know.
    pub in_work: Option<bool>,
    /// The ground about the tractor.
    pub ground: DrawnGround,
}

/// The ground about the tractor, at points of equal distance.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct DrawnGround {
    /// The first point, in front of the rear axle, m.
    pub from_m: f64,
    /// Distance of the points, m.
    pub step_m: f64,
    /// Heights, m.
    pub height_m: Vec<f64>,
    /// Textures: `coarse`, `medium` or `fine`.
    pub texture: Vec<&'static str>,
    /// Whether the ground is a soft patch.
    pub soft: Vec<bool>,
}

impl FieldView {
    /// Samples of the strip charts, and the present state.
    pub(super) fn of(samples: &[Field], now: Option<FieldNow>) -> Self {
        let each = |value: fn(&Field) -> f64| -> Vec<f64> { samples.iter().map(value).collect() };
        Self {
            draft_kn: each(|field| field.draft_n * 1e-3),
            depth_cm: each(|field| field.depth_m * 100.0),
            slip_percent: each(|field| field.slip * 100.0),
            now,
        }
    }
}

impl FieldNow {
    /// Present state of a tractor, and of its controller.
    pub(super) fn of(field: &Field, outputs: &Outputs, tractor: &Tractor) -> Self {
        let body = &tractor.constants().body;
        let rear_m = -body.centre_before_rear_m();
        Self {
            draft_kn: field.draft_n * 1e-3,
            vertical_kn: field.vertical_n * 1e-3,
            depth_m: field.depth_m,
            slip: field.slip,
            ground_speed_m_s: field.ground_speed_m_s,
            wheel_speed_m_s: field.wheel_speed_m_s,
            distance_m: field.distance_m,
            axles_m: [rear_m, body.centre_behind_front_m].map(|at_m| field.body.height_m(at_m)),
            reason: outputs.reference.map(hitch_quantities::Reason::name),
            reason_text: words::reason(outputs.reference),
            trouble_text: outputs.trouble.map(words::trouble),
            in_work: outputs.in_work,
            ground: DrawnGround::about(field.distance_m, tractor),
        }
    }
}

impl DrawnGround {
    fn about(distance_m: f64, tractor: &Tractor) -> Self {
        let [from_m, to_m] = DRAWN_M;
        let points = ((to_m - from_m) / POINT_M).round() as u32;
        let at: Vec<f64> = (0..=points)
            .map(|point| distance_m + from_m + f64::from(point) * POINT_M)
            .collect();
        let soil = tractor.soil();
        Self {
            from_m,
            step_m: POINT_M,
            height_m: at
                .iter()
                .map(|at_m| tractor.terrain().height_m(*at_m))
                .collect(),
            texture: at.iter().map(|at_m| name(soil.texture(*at_m))).collect(),
            soft: at.iter().map(|at_m| soil.is_soft(*at_m)).collect(),
        }
    }
}

/// As the orders name it.
const fn name(texture: Texture) -> &'static str {
    match texture {
        Texture::Coarse => "coarse",
        Texture::Medium => "medium",
        Texture::Fine => "fine",
    }
}
