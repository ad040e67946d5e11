//! `relief-override`: pressure override of the relief valve.
//!
//! `p_P = p_crack + override Q_relief / Q_pump`: the pressure increases as the valve opens against its spring (Merritt
//! 5.6). The setting is specified at some flow: `above` is the part of the override above the 154 bar, zero if these
//! hold at the pump's full flow. Typical values are 10 to 25 bar at 48 l/min; valves crack at 0.85 to 0.93 of their
//! setting.

use hitch_plant::hooks::effect_hooks::{EffectHooks, RunConditions};
use hitch_plant::hooks::elements::ReliefOverride;
use hitch_plant::units::pa_from_bar;
use hitch_plant::{Channel, Parameter};

use crate::described::Described;

/// Override of the relief valve.
pub static RELIEF_OVERRIDE: Described = Described {
    id: "relief-override",
    title: "Override of the relief valve",
    equation: "p_P = p_set + override (Q_relief / Q_pump - 1 + above)",
    source: "Merritt 5.6; 10 to 25 bar over the range of a direct-acting valve, Hopsan's example 15 \
         bar at 42 l/min",
    shows: "lifting against a pressure near the setting of the relief valve, and pump pressure at the upper end of the \
         stroke: only there does the relief valve work",
    parameters: &[
        Parameter {
            meaning: "increase of the pump pressure from cracking to the pump's full flow",
            typical: 15.0,
            low: 0.0,
            high: 60.0,
            ..Parameter::quantity("override", "bar", "override_bar")
        },
        Parameter {
            meaning: "share of it above the setting",
            null: 0.2,
            typical: 0.0,
            low: 0.0,
            high: 1.0,
            ..Parameter::ratio("above")
        },
    ],
    channels: &[Channel::PumpPressure, Channel::Flow],
    attach,
    ..Described::USUAL
};

fn attach(values: &[f64], _: RunConditions<'_>, hooks: &mut EffectHooks) {
    let override_pa = pa_from_bar(values[0]);
    hooks.relief = Some(ReliefOverride {
        override_pa,
        below_setting_pa: override_pa * (1.0 - values[1]),
    });
}
