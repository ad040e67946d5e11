//! `load-arm`: the load's centre of gravity is behind the hitch point.
//!
//! A mast that pitches with the lift moves an overhanging load by more, or less, than the hitch point:
//! `F_weight = m g (dh/dx + d cos(pitch) dpitch/dx)`. With a pitch rate that varies linearly over the stroke that is
//! `F_weight (1 + s (m + (1 - |m|) (2 x / stroke - 1)))`: `s` is the relative change at the end of the stroke with the
//! larger change, `m` the share of it that is constant over the stroke. An overhang of 0.3 to 0.6 m and 5 to 12 degrees
//! of pitch give 5 to 15 %.
//!
//! In more detail, only the load pitches, not the links, and a top link that is shorter than the lower links turns it
//! fastest at both ends of the stroke: a curvature of a quarter of the share, with a slope that depends on where the
//! load is level.

use hitch_plant::hooks::effect_hooks::{EffectHooks, RunConditions};
use hitch_plant::{Channel, Parameter};

use crate::catalogue::over_the_stroke;
use crate::described::Described;

/// Arm of the load behind the hitch point.
pub static WITH_WEIGHT: Described = Described {
    id: "load-arm",
    title: "Arm of the load behind the hitch point",
    equation: "F = F_weight (1 + share [even + (1 - |even|) (2 x / stroke - 1)])",
    source: "virtual work with a pitching mast; overhang 0.61 m (OECD frame), pitch 5 to 12 degrees: \
         5 to 15 %",
    shows: "the shape of the cylinder pressure over the stroke, at every load alike, while lifting, \
         holding and lowering",
    parameters: &[
        Parameter {
            meaning: "change of the weight's force at the end of the stroke",
            typical: 0.1,
            low: -0.5,
            high: 0.5,
            ..Parameter::ratio("share")
        },
        Parameter {
            meaning: "part of it that is constant over the stroke; negative: more at the low end",
            null: 0.5,
            typical: 0.0,
            low: -1.0,
            high: 1.0,
            ..Parameter::ratio("even")
        },
    ],
    channels: &Channel::ALL,
    attach: with_weight,
    ..Described::USUAL
};

/// Arm of the load behind the hitch point, with a pitch that differs from that of the links.
pub static WITH_LOAD: Described = Described {
    form: Some("load-only"),
    title: "Arm of the load behind the hitch point, without the links",
    equation: "F = F_weight (1 + share (1 + slope z + bow (3 z^2 - 1) / 2) load / (load + dead weight)), \
         z = 2 x / stroke - 1",
    parameters: &[
        Parameter {
            meaning: "change of the load's force, mean over the stroke",
            typical: 0.1,
            low: -0.5,
            high: 0.5,
            ..Parameter::ratio("share")
        },
        over_the_stroke::shape(
            "slope",
            "growth of the share from mid stroke to the upper end",
            2.0,
        ),
        over_the_stroke::shape(
            "bow",
            "growth of the share towards both ends of the stroke",
            2.0,
        ),
    ],
    refines: true,
    attach: with_load,
    ..WITH_WEIGHT
};

fn with_load(values: &[f64], conditions: RunConditions<'_>, hooks: &mut EffectHooks) {
    let (share, shape) = (values[0], [values[1], values[2]]);
    let stroke_m = conditions.constants.cylinder.stroke_m;
    hooks
        .weight_factor
        .push(Box::new(move |piston_m, load_share| {
            1.0 + share * over_the_stroke::over_mean(shape, piston_m, stroke_m) * load_share
        }));
}

fn with_weight(values: &[f64], conditions: RunConditions<'_>, hooks: &mut EffectHooks) {
    let (share, even) = (values[0], values[1]);
    let stroke_m = conditions.constants.cylinder.stroke_m;
    hooks.weight_factor.push(Box::new(move |piston_m, _| {
        let tilted = 2.0 * piston_m / stroke_m - 1.0;
        1.0 + share * (even + (1.0 - even.abs()) * tilted)
    }));
}
