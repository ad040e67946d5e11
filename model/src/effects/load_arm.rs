//! `load-arm`: the load's centre of gravity stands behind the hitch point.
//!
//! A mast that pitches with the lift lifts an overhanging load more, or less, than the hitch point:
//! `F_weight = m g (dh/dx + d cos(pitch) dpitch/dx)`. With a pitch that changes faster and faster over the stroke that is
//! `F_weight (1 + s (m + (1 - |m|) (2 x / stroke - 1)))`: `s` is the change at the end of the stroke that it changes
//! most, `m` tells how much of it is there all over the stroke. An overhang of 0.3 to 0.6 m and 5 to 12 degrees of
//! pitch make 5 to 15 %.

use super::described::Described;
use super::{Parameter, Search};
use crate::campaign::Channel;

use crate::plant::sites::{RunConditions, Sites};

/// Arm of the load behind the hitch point.
pub static LOAD_ARM: Described = Described {
    id: "load-arm",
    form: None,
    title: "Arm of the load behind the hitch point",
    equation: "F = F_weight (1 + share [even + (1 - |even|) (2 x / stroke - 1)])",
    source: "virtual work with a pitching mast; overhang 0.61 m (OECD frame), pitch 5 to 12 degrees: \
         5 to 15 %",
    shows: "the shape of the cylinder pressure over the stroke, at every load alike, while lifting, \
         holding and lowering",
    parameters: &[
        Parameter {
            name: "share",
            unit: "",
            key: "share",
            meaning: "change of the weight's force at the end of the stroke",
            null: 0.0,
            typical: 0.1,
            low: -0.5,
            high: 0.5,
        },
        Parameter {
            name: "even",
            unit: "",
            key: "even",
            meaning: "part of it that is there all over the stroke; negative: more at the low end",
            null: 0.5,
            typical: 0.0,
            low: -1.0,
            high: 1.0,
        },
    ],
    channels: &[
        Channel::PumpPressure,
        Channel::CylinderPressure,
        Channel::Flow,
        Channel::RockerAngle,
    ],
    needs: None,
    search: Search::Secants,
    refines: false,
    attach,
};

fn attach(values: &[f64], conditions: RunConditions<'_>, sites: &mut Sites) {
    let (share, even) = (values[0], values[1]);
    let stroke_m = conditions.constants.cylinder.stroke_m;
    sites.weight_factor.push(Box::new(move |piston_m| {
        let tilted = 2.0 * piston_m / stroke_m - 1.0;
        1.0 + share * (even + (1.0 - even.abs()) * tilted)
    }));
}
