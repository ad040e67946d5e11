//! `compensator-droop`: decrease of the compensator's margin with its load pressure.
//!
//! Force balance of its spool, `A_c (p_P - p_C) = F_0 + k x + 0.43 w x p_P`: the margin decreases with the closing
//! travel and with the pressure. Linearised at no load: `margin = 4 bar - c p_C`. The drop of the lift orifice
//! decreases from 1.5 bar, so the lift flow falls with its square root. The spool closes further if less flow bypasses,
//! so the margin also decreases with the lift flow: by a share `d` of the 4 bar from zero to the pump's full flow. A
//! restrictor in its load-sensing line, or its own mass, delays it by 5 to 20 ms. During the delay the lift orifice
//! sees the changes of the cylinder pressure, which damps its ringing.

use hitch_plant::hooks::effect_hooks::{EffectHooks, RunConditions};
use hitch_plant::{Channel, Parameter};

use crate::described::Described;

/// Lag, s, below which a compensator counts as immediate: it is shorter than all other time constants of the plant.
const SHORTEST_LAG_S: f64 = 1e-4;

/// Longest step of the quasi-static plant that resolves a lagging compensator, s.
const STEP_S: f64 = 0.002;

const SLOPE: Parameter = Parameter {
    meaning: "margin lost per bar of cylinder pressure",
    typical: 0.005,
    low: -0.02,
    high: 0.05,
    ..Parameter::quantity("slope", "bar/bar", "slope")
};

const FLOW: Parameter = Parameter {
    meaning: "share of the margin lost from zero lift flow to the pump's full flow",
    typical: 0.1,
    low: 0.0,
    high: 0.3,
    ..Parameter::ratio("flow")
};

/// Droop with the load pressure.
pub static WITH_LOAD: Described = Described {
    id: "compensator-droop",
    title: "Droop of the pressure compensator",
    equation: "p_P - p_C = margin - slope p_C; Q = Q_table(I) sqrt((p_P - p_C - p_crack) / dp_ref)",
    source: "spool force balance of a three-way compensator; up to 0.02 bar/bar either way",
    shows: "heavy loads lift slower than light ones, and the pump pressure stands less than its margin \
         over the load",
    parameters: &[SLOPE],
    channels: &[Channel::PumpPressure, Channel::Flow, Channel::RockerAngle],
    attach: |values, _, hooks| fall_with_load(values[0], hooks),
    ..Described::USUAL
};

/// Droop with the load pressure and the flow.
pub static WITH_FLOW: Described = Described {
    form: Some("flow"),
    title: "Droop of the pressure compensator with flow and load",
    equation: "p_P - p_C = margin (1 - flow Q / Q_pump) - slope p_C",
    source: "spool force balance of a three-way compensator; 0.05 to 0.2 of the margin over the \
         pump's flow",
    shows: "slow lifts are relatively faster than fast ones, and the pump pressure stands the less \
         over the load the more flows",
    parameters: &[
        FLOW,
        Parameter {
            typical: 0.0,
            ..SLOPE
        },
    ],
    attach: |values, conditions, hooks| {
        fall_with_flow(values[0], conditions, hooks);
        fall_with_load(values[1], hooks);
    },
    ..WITH_LOAD
};

/// Droop of a lagging compensator.
pub static LAGGING: Described = Described {
    form: Some("lagging"),
    title: "Lag of the pressure compensator, with droop over load and flow",
    equation: "lag p_P' = p_C + margin (1 - flow Q / Q_pump) - slope p_C - p_P",
    source: "spool behind the orifice of its load-sensing line: 5 to 20 ms",
    shows: "the pump pressure follows every start and stop of a lift late; the lift flow gives way to a cylinder \
         pressure that rings, which dies away the faster for it",
    parameters: &[
        Parameter {
            meaning: "time constant of the pump pressure",
            typical: 0.01,
            low: 0.0,
            high: 0.1,
            ..Parameter::time("lag", "lag_s")
        },
        Parameter {
            typical: 0.0,
            ..SLOPE
        },
        Parameter {
            typical: 0.0,
            ..FLOW
        },
    ],
    refines: true,
    attach: |values, conditions, hooks| {
        if values[0] >= SHORTEST_LAG_S {
            hooks.compensator_lag_s += values[0];
            hooks.limit_step(STEP_S);
        }
        fall_with_load(values[1], hooks);
        fall_with_flow(values[2], conditions, hooks);
    },
    ..WITH_LOAD
};

fn fall_with_flow(
    share: f64,
    RunConditions { constants, .. }: RunConditions,
    hooks: &mut EffectHooks,
) {
    let lost_pa = share * constants.compensator.margin_pa;
    hooks.margin_lost_to_flow_pa_s_m3 += lost_pa / constants.pump.flow_m3_s();
}

fn fall_with_load(slope: f64, hooks: &mut EffectHooks) {
    if slope == 0.0 {
        return;
    }
    hooks.margin.push(Box::new(move |cylinder_pressure_pa| {
        -slope * cylinder_pressure_pa
    }));
}
