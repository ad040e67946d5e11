//! `compensator-margin`: deviation of the compensator's margin from the declared value.
//!
//! `p_P - p_C = margin + excess` while lifting. The preload of the spring is set by shims and settles with age; 10 to 30
//! % deviation from the data sheet is typical. The margin less the check valve's 2.5 bar drives the lift orifice, so
//! one bar more on 1.5 bar gives 29 % more lift flow. The same spring sets the idle pressure. In blocks with a bypass
//! orifice, the idle pressure is the drop of that orifice at the pump's flow: the form `bypass` has a separate
//! parameter for it.

use hitch_plant::hooks::effect_hooks::EffectHooks;
use hitch_plant::units::pa_from_bar;
use hitch_plant::{Channel, Parameter};

use crate::described::Described;

/// Flow and angle change as well, but the lift valve's flow scale changes them alike: without a pump pressure the two
/// are confounded.
const CHANNELS: &[Channel] = &[Channel::PumpPressure];

const EXCESS: Parameter = Parameter {
    meaning: "difference of the margin from the declared one",
    typical: 0.5,
    low: -1.4,
    high: 10.0,
    ..Parameter::quantity("excess", "bar", "excess_bar")
};

/// Another preload of the spring: margin and idle pressure change by the same amount.
pub static PRELOAD: Described = Described {
    id: "compensator-margin",
    title: "Deviation of the compensator margin",
    equation: "p_P - p_C = margin + excess; p_idle = p_0 + excess; Q = Q_table(I) sqrt((p_P - p_C - p_crack) / dp_ref)",
    source: "preload of the compensator's spring: 10 to 30 % off the data sheet",
    shows: "the pump pressure is higher or lower than declared by the same amount at idle and over every load, and the lift \
         flow with it; without a pump pressure it is the lift valve's flow scale",
    parameters: &[EXCESS],
    channels: CHANNELS,
    attach: |values, _, hooks| exceed(values[0], values[0], hooks),
    ..Described::USUAL
};

/// Margin and idle pressure change by different amounts.
pub static BYPASS: Described = Described {
    form: Some("bypass"),
    title: "Deviation of the compensator margin and the idle pressure",
    equation: "p_P - p_C = margin + excess; p_idle = p_0 + idle excess",
    source: "drop of the bypass at the pump's flow: 2 to 15 bar",
    shows: "the deviations of the pump pressure at idle and under load differ",
    parameters: &[
        EXCESS,
        Parameter {
            name: "idle excess",
            key: "idle_excess_bar",
            meaning: "difference of the idle pressure from the declared one",
            low: -4.0,
            high: 30.0,
            ..EXCESS
        },
    ],
    attach: |values, _, hooks| exceed(values[0], values[1], hooks),
    ..PRELOAD
};

fn exceed(margin_bar: f64, idle_bar: f64, hooks: &mut EffectHooks) {
    let margin_pa = pa_from_bar(margin_bar);
    hooks.margin.push(Box::new(move |_| margin_pa));
    hooks.idle_extra_pa += pa_from_bar(idle_bar);
}
