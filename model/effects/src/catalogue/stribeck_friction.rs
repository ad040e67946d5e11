//! `stribeck-friction`: breakaway friction larger than sliding friction.
//!
//! `F = F_C [1 + (k - 1) exp(-|v| / v_s)] tanh(v / 3 mm/s)`: the breakaway force is k times the sliding friction F_C,
//! which is reached within a few mm/s (Simscape's cylinder friction; Jelali & Kroll 4.3). k is 1.2 to 1.6, v_s 5 to 20
//! mm/s.

use hitch_plant::hooks::effect_hooks::{EffectHooks, RunConditions};
use hitch_plant::{Channel, Parameter};

use crate::catalogue::coulomb_friction::TRANSITION_SPEED_M_S;
use crate::described::Described;

/// Stribeck friction at the piston.
pub static STRIBECK_FRICTION: Described = Described {
    id: "stribeck-friction",
    title: "Stribeck friction at the piston",
    equation: "F = force [1 + (breakaway - 1) exp(-|v| / speed)] tanh(v / 3 mm/s)",
    source: "Simscape cylinder friction; Jelali & Kroll 4.3; breakaway 20 to 60 % over Coulomb \
         friction, 5 to 20 mm/s",
    shows: "cylinder pressure at creeping speed: higher steps at every start and stop than at speed",
    parameters: &[
        Parameter {
            meaning: "friction while sliding",
            typical: 200.0,
            low: 0.0,
            high: 5000.0,
            ..Parameter::quantity("force", "N", "force_n")
        },
        Parameter {
            meaning: "breakaway friction relative to sliding friction",
            null: 1.0,
            typical: 1.6,
            low: 1.0,
            high: 20.0,
            ..Parameter::ratio("breakaway")
        },
        Parameter {
            meaning: "speed over which it decreases to sliding friction",
            typical: 10.0,
            low: 2.0,
            high: 60.0,
            ..Parameter::quantity("speed", "mm/s", "speed_mm_s")
        },
    ],
    channels: &[Channel::CylinderPressure, Channel::RockerAngle],
    attach,
    ..Described::USUAL
};

fn attach(values: &[f64], _: RunConditions<'_>, hooks: &mut EffectHooks) {
    let (force_n, breakaway, speed_m_s) = (values[0], values[1], values[2] * 1e-3);
    hooks.friction.push(Box::new(move |state, _| {
        let v_m_s = state.speed_m_s;
        let factor = 1.0 + (breakaway - 1.0) * (-v_m_s.abs() / speed_m_s).exp();
        force_n * factor * (v_m_s / TRANSITION_SPEED_M_S).tanh()
    }));
}
