//! `pump-leakage`: internal leakage (slip) of the pump.
//!
//! Wilson's laminar slip, `Q = Q_0 - k p` (Merritt 4.2). The compensator returns excess flow to tank, so a smaller
//! delivery shows only if the lift valve demands more than that.

use hitch_plant::hooks::effect_hooks::{EffectHooks, RunConditions};
use hitch_plant::units::{m3_s_from_lpm, pa_from_bar};
use hitch_plant::{Channel, Parameter};

use crate::described::Described;

/// Slip of the pump.
pub static PUMP_LEAKAGE: Described = Described {
    id: "pump-leakage",
    title: "Slip of the pump",
    equation: "Q_pump = Q_max - slip p_P",
    source: "Wilson's slip flow, Merritt 4.2: efficiency 0.88 at 150 bar is 0.044 l/min/bar",
    shows: "lifting fast against high pressure, where demand exceeds delivery; invisible while the \
         compensator has flow to spare",
    parameters: &[Parameter {
        meaning: "flow lost per bar of pump pressure",
        typical: 0.1,
        low: 0.0,
        high: 0.5,
        ..Parameter::quantity("slip", "l/min/bar", "slip_lpm_bar")
    }],
    channels: &[Channel::PumpPressure, Channel::Flow],
    attach,
    ..Described::USUAL
};

fn attach(values: &[f64], _: RunConditions<'_>, hooks: &mut EffectHooks) {
    let slip_m3_s_pa = m3_s_from_lpm(values[0]) / pa_from_bar(1.0);
    hooks.pump_slip.push(Box::new(move |pump_pressure_pa| {
        slip_m3_s_pa * pump_pressure_pa
    }));
}
