//! `lowering-leakage`: leakage through the closed lowering valve and the check valve.
//!
//! `Q = G p_C`, laminar flow through an annular gap (Merritt 3.3, `G = pi d c^3 / 12 mu l`), out of the cylinder past
//! the flow meter. A seated poppet leaks 5e-6 l/min/bar, a worn one a thousand times that. Thermal expansion of the
//! housing changes the gap, so `G` may be constant over a day's temperatures; with a constant gap it is proportional to
//! the oil's fluidity.

use hitch_plant::components::oil::viscosity_m2_s;
use hitch_plant::hooks::effect_hooks::EffectHooks;
use hitch_plant::{Channel, Parameter, units};

use crate::described::Described;

/// Temperature at which the conductance of a constant gap is specified, degree Celsius.
const SPECIFIED_AT_C: f64 = 40.0;

/// Leakage independent of temperature.
pub static EVEN: Described = Described {
    id: "lowering-leakage",
    title: "Leakage of the load-holding valves",
    equation: "Q_leak = conductance * p_C",
    source: "laminar gap, Merritt 3.3; worn load-holding valves",
    shows: "the hitch sinks while holding, faster under heavy loads; little else",
    parameters: &[Parameter {
        meaning: "leakage flow per cylinder pressure, with oil at 40 degC",
        typical: 0.002,
        low: 0.0,
        high: 0.1,
        ..Parameter::quantity("conductance", "l/min/bar", "conductance_lpm_per_bar")
    }],
    channels: &[Channel::RockerAngle],
    attach: |values, _, hooks| leak(values[0], hooks),
    ..Described::USUAL
};

/// Leakage proportional to the oil's fluidity.
pub static THINNING: Described = Described {
    form: Some("thinning"),
    title: "Leakage of the load-holding valves, viscosity-dependent",
    equation: "Q_leak = conductance nu(40 C) / nu(T) p_C",
    source: "laminar gap of constant width, Merritt 3.3: G is proportional to 1 / mu",
    shows: "the hitch sinks while holding, faster under heavy loads and with hot oil; little else",
    attach: |values, conditions, hooks| {
        let fluidity =
            viscosity_m2_s(SPECIFIED_AT_C) / viscosity_m2_s(conditions.oil_temperature_c);
        leak(values[0] * fluidity, hooks);
    },
    ..EVEN
};

fn leak(conductance_lpm_bar: f64, hooks: &mut EffectHooks) {
    let conductance = units::m3_s_from_lpm(conductance_lpm_bar) / units::PA_PER_BAR;
    hooks.leakage.push(Box::new(move |pressure_pa| {
        conductance * pressure_pa.max(0.0)
    }));
}
