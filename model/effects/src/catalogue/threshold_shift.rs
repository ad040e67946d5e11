//! `lift-threshold-shift`, `lower-threshold-shift`: shift of a valve's threshold current.
//!
//! `Q = Q_table(I - dI)`, per valve; equivalent to a spool overlap of 4 mm/A times dI. It varies by 0.03 to 0.10 A
//! between units, and by more after wear or a changed spring; the paper's lowering valve opens at 1.25 A instead of the
//! data sheet's 0.999 A.

use hitch_plant::hooks::effect_hooks::{CurrentStage, EffectHooks};
use hitch_plant::{Channel, Currents, Parameter, Valve};

use crate::described::Described;

/// Threshold shift of the lift valve.
pub static LIFT: Described = Described {
    id: "lift-threshold-shift",
    title: "Shifted threshold of the lift valve",
    equation: "Q = Q_table(I - shift)",
    source: "spool overlap; unit spread of mobile proportional valves 0.03 to 0.10 A; paper, Table 5",
    shows: "lifting at low currents: flow, speed, and the current at which the pump pressure rises; on rising \
            currents alone easily confused with hysteresis",
    parameters: &[Parameter {
        meaning: "shift of the whole characteristic to higher currents",
        typical: 0.05,
        low: -0.6,
        high: 0.6,
        ..Parameter::current("shift", "shift_a")
    }],
    channels: &[Channel::PumpPressure, Channel::Flow, Channel::RockerAngle],
    attach: |values, _, hooks| shift(Valve::Lift, values[0], hooks),
    ..Described::USUAL
};

/// Threshold shift of the lowering valve.
pub static LOWERING: Described = Described {
    id: "lower-threshold-shift",
    title: "Shifted threshold of the lowering valve",
    shows: "lowering at low currents: flow and speed; on rising currents alone easily confused with hysteresis",
    channels: &[Channel::Flow, Channel::RockerAngle],
    attach: |values, _, hooks| shift(Valve::Lower, values[0], hooks),
    ..LIFT
};

fn shift(valve: Valve, shift_a: f64, hooks: &mut EffectHooks) {
    hooks.currents.push(Box::new(Shift { valve, shift_a }));
}

#[derive(Debug, Clone)]
struct Shift {
    valve: Valve,
    shift_a: f64,
}

impl CurrentStage for Shift {
    fn rest(&mut self, currents: Currents) -> Currents {
        currents.map(|valve, current_a| {
            if valve == self.valve {
                current_a - self.shift_a
            } else {
                current_a
            }
        })
    }

    fn advance(&mut self, currents: Currents, _: f64) -> Currents {
        self.rest(currents)
    }
}
