//! `return-line-loss`: pressure loss of filter and line between lowering valve and tank.
//!
//! `p_T = loss (Q / 40 l/min)^2`, turbulent: `dp = (lambda L/d + zeta) rho v^2 / 2`. It reduces the drop of the
//! lowering valve. Typical is 1 bar at 60 l/min, several bar with a clogged filter or a thin hose. Part of it may be
//! laminar: `K mu Q` with `K = 128 L / (pi d^4)` (Hagen & Poiseuille), larger when cold.

use hitch_plant::components::oil::viscosity_m2_s;
use hitch_plant::hooks::effect_hooks::EffectHooks;
use hitch_plant::{Channel, Parameter, units};

use crate::described::Described;

/// Flow at which the loss is specified, l/min.
const REFERENCE_FLOW_LPM: f64 = 40.0;

/// Temperature at which the loss is specified, degree Celsius.
const REFERENCE_C: f64 = 40.0;

const LOSS: Parameter = Parameter {
    meaning: "back pressure at 40 l/min and 40 degC",
    typical: 1.0,
    low: 0.0,
    high: 20.0,
    ..Parameter::quantity("loss", "bar", "loss_bar")
};

/// Turbulent back pressure of the return line.
pub static TURBULENT: Described = Described {
    id: "return-line-loss",
    title: "Back pressure of the return line",
    equation: "p_T = loss * (Q_lower / 40 l/min)^2",
    source: "turbulent pipe and filter loss; filter 0.3 to 1 bar and 2 m of hose 0.5 bar at 60 l/min",
    shows: "lowering at high current and light load is slower; no change at low flow",
    parameters: &[LOSS],
    channels: &[Channel::Flow, Channel::RockerAngle],
    attach: |values, _, hooks| hold_back(values[0], 0.0, hooks),
    ..Described::USUAL
};

/// Back pressure of the return line with a laminar part.
pub static LAMINAR: Described = Described {
    form: Some("laminar"),
    title: "Back pressure of the return line, partly laminar",
    equation: "p_T = loss ((1 - share) q^2 + share nu(T) / nu(40 C) q), q = Q_lower / 40 l/min",
    source: "Hagen & Poiseuille: 2 m of 12.7 mm pipe 2.6 bar at 40 C and 60 l/min, 8.7 bar at 20 C",
    shows: "lowering at high current and light load is slower, the more the colder the oil",
    parameters: &[
        LOSS,
        Parameter {
            meaning: "share of it that is laminar, at 40 l/min and 40 degC",
            typical: 0.2,
            low: 0.0,
            high: 1.0,
            ..Parameter::ratio("share")
        },
    ],
    refines: true,
    attach: |values, conditions, hooks| {
        let thickness = viscosity_m2_s(conditions.oil_temperature_c) / viscosity_m2_s(REFERENCE_C);
        let laminar_bar = values[0] * values[1];
        hold_back(values[0] - laminar_bar, laminar_bar * thickness, hooks);
    },
    ..TURBULENT
};

/// Adds a turbulent and a laminar back pressure, given at the reference flow, bar.
fn hold_back(turbulent_bar: f64, laminar_bar: f64, hooks: &mut EffectHooks) {
    let reference_m3_s = units::m3_s_from_lpm(REFERENCE_FLOW_LPM);
    let turbulent_pa = units::pa_from_bar(turbulent_bar);
    hooks.return_line.turbulent_pa_s2_m6 += turbulent_pa / (reference_m3_s * reference_m3_s);
    hooks.return_line.laminar_pa_s_m3 += units::pa_from_bar(laminar_bar) / reference_m3_s;
}
