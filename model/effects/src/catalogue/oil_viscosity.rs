//! `oil-viscosity`: laminar share of the flow through the valves.
//!
//! A series of the laminar-turbulent transition (McCloy & Martin) about the reference point of the lowering valve's
//! table: `Q = Q_table(I) [(1 - s) sqrt(dp/dp_ref) + s (dp/dp_ref) nu(40 C)/nu(T)]`, where `s` is the laminar share of
//! the flow at the reference drop and 40 degrees. The viscosity decreases by 4 to 6 % per kelvin:
//! `nu = nu(40 C) exp(-fall (T - 40 C))`, a local form of Walther's equation.
//!
//! The transition itself, in both valves: `Q = Q_table(I) tanh(2 lambda / lambda_c)` with the flow number
//! `lambda = D_h sqrt(2 dp / rho) / nu(T)`. The hydraulic diameter is twice the gap, which opens by 4 mm/A, so this
//! form shows at the lowest currents.

use hitch_plant::components::oil::viscosity_m2_s;
use hitch_plant::hooks::effect_hooks::{EffectHooks, RunConditions};
use hitch_plant::{Channel, Parameter, ParameterKind};

use crate::described::Described;

/// Temperature at which the valve's table holds, degree Celsius.
const REFERENCE_C: f64 = 40.0;

/// Hydraulic diameter of a valve's gap per ampere beyond the threshold, m/A: twice its opening, 4 mm/A.
const DIAMETER_M_A: f64 = 2.0 * 0.004;

/// Laminar share of the flow through the lowering valve.
pub static SERIES: Described = Described {
    id: "oil-viscosity",
    title: "Laminar flow in the lowering valve",
    equation: "Q = Q_table(I) [(1 - share) sqrt(r) + share r exp(fall (T - 40 C))], r = dp / dp_ref",
    source: "laminar-turbulent transition, McCloy & Martin; SAE 30 loses 4 to 6 % of its viscosity a \
         kelvin",
    shows: "lowering slower when cold and faster when warm, and more than with the square root of \
         the pressure; at one temperature the opposite of a flow force",
    parameters: &[
        Parameter {
            meaning: "laminar share of the flow at the drop of its curve and 40 C",
            typical: 0.2,
            low: 0.0,
            high: 1.0,
            ..Parameter::ratio("share")
        },
        Parameter {
            meaning: "relative decrease of the viscosity with temperature",
            typical: 0.042,
            low: 0.02,
            high: 0.08,
            ..Parameter::quantity("fall", "1/K", "fall_1_k")
        },
    ],
    channels: &[Channel::Flow, Channel::RockerAngle],
    attach: attach_series,
    ..Described::USUAL
};

fn attach_series(values: &[f64], conditions: RunConditions<'_>, hooks: &mut EffectHooks) {
    let share = values[0];
    let thinner = (values[1] * (conditions.oil_temperature_c - REFERENCE_C)).exp();
    let reference_pa = conditions.constants.lower_valve.reference_drop_pa;
    hooks.lower_drop_factor.push(Box::new(move |drop_pa| {
        1.0 - share + share * thinner * (drop_pa.max(0.0) / reference_pa).sqrt()
    }));
}

/// Transition from laminar to turbulent flow in both valves.
pub static FLOW_NUMBER: Described = Described {
    form: Some("flow-number"),
    title: "Transition from laminar to turbulent flow in both valves",
    equation: "Q = Q_table(I) tanh(2 lambda / critical), lambda = 2 (4 mm/A) (I - I_0) sqrt(2 dp / rho) / nu(T)",
    source: "McCloy & Martin, Control of Fluid Power, 2nd ed. 1980; critical flow number 100 to 250 for spools; \
         viscosity of SAE 30 by Walther's equation",
    shows: "less flow at the lowest currents, by far more when cold; at one temperature indistinguishable \
         from a threshold shift",
    parameters: &[Parameter {
        name: "critical",
        unit: "",
        kind: ParameterKind::Ratio,
        key: "critical_flow_number",
        meaning: "flow number at which the flow turns turbulent",
        null: 0.0,
        typical: 100.0,
        low: 0.0,
        high: 1000.0,
    }],
    attach: attach_flow_number,
    ..SERIES
};

fn attach_flow_number(values: &[f64], conditions: RunConditions<'_>, hooks: &mut EffectHooks) {
    let per_root_pa = (2.0 / conditions.constants.oil.density_kg_m3).sqrt();
    let viscosity = viscosity_m2_s(conditions.oil_temperature_c);
    hooks.flow_number_1_a_sqrt_pa =
        Some(2.0 * DIAMETER_M_A * per_root_pa / (viscosity * values[0]));
}
