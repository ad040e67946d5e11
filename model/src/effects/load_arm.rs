//! `load-arm`: the load's centre of gravity stands behind the hitch point.
//!
//! A mast that pitches with the lift lifts an overhanging load more, or less, than the hitch point:
//! `F_weight = m g (dh/dx + d cos(pitch) dpitch/dx)`. With the top link's pitch growing evenly over the stroke that is
//! `F_weight (1 + s (2 x / stroke - 1))`: `s` is the change at the ends of the stroke. An overhang of 0.3 to 0.6 m and 5 to
//! 12 degrees of pitch make 5 to 15 %.

use super::Parameter;
use super::described::Described;
use crate::campaign::Channel;

use crate::plant::sites::{RunConditions, Sites};

/// Arm of the load behind the hitch point.
pub static LOAD_ARM: Described = Described {
    id: "load-arm",
    title: "Arm of the load behind the hitch point",
    equation: "F = F_weight (1 + share (2 x / stroke - 1))",
    source: "virtual work with a pitching mast; overhang 0.61 m (OECD frame), pitch 5 to 12 degrees: \
         5 to 15 %",
    shows: "the shape of the cylinder pressure over the stroke, at every load alike, while lifting, \
         holding and lowering",
    parameters: &[Parameter {
        name: "share",
        unit: "",
        key: "share",
        meaning: "change of the weight's force at the ends of the stroke",
        null: 0.0,
        typical: 0.1,
        low: -0.5,
        high: 0.5,
    }],
    channels: &[
        Channel::PumpPressure,
        Channel::CylinderPressure,
        Channel::Flow,
        Channel::RockerAngle,
    ],
    needs: None,
    attach,
};

fn attach(values: &[f64], conditions: RunConditions<'_>, sites: &mut Sites) {
    let share = values[0];
    let stroke_m = conditions.constants.cylinder.stroke_m;
    sites.weight_factor.push(Box::new(move |piston_m| {
        1.0 + share * (2.0 * piston_m / stroke_m - 1.0)
    }));
}
