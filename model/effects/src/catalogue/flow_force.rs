//! `flow-force`: steady flow force that closes the lowering valve against its solenoid.
//!
//! Steady flow force `F = 0.43 w x dp` (Merritt 5.2) on a spool with a spring k_s: `x = x_c / (1 + K dp)` with `K =
//! 0.43 w / k_s`. The data sheet's curve holds at 15 bar, so the opening is multiplied by `(1 + s) / (1 + s dp / 15
//! bar)`, where `s` is the ratio of flow force to spring force at 15 bar. The usual form applies this factor to the
//! flow of the table, as if it were proportional to the opening. The other form applies it to the spool travel and
//! evaluates the table there, so the force has no effect in flat parts of the table. The compensator keeps the lift
//! valve's drop constant, so its flow force does not show.

use hitch_plant::hooks::effect_hooks::{EffectHooks, Law, RunConditions};
use hitch_plant::{Channel, Parameter};

use crate::described::Described;

/// Flow force on the lowering spool, as a factor on the flow.
pub static ON_FLOW: Described = Described {
    id: "flow-force",
    title: "Flow force on the lowering spool",
    equation: "Q = Q_table(I) sqrt(dp/dp_ref) (1 + s) / (1 + s dp/dp_ref), dp_ref: that of the valve's curve",
    source: "Merritt 5.2: F = 2 Cd Cv A dp cos 69 deg; springs of 8 to 20 N/mm give 0.12 to 0.30 at \
         15 bar",
    shows: "lowering flow increases less than with the square root of the pressure: light loads sink \
         faster and heavy ones slower than by the table",
    parameters: &[Parameter {
        meaning: "flow force over spring force at the reference drop",
        typical: 0.2,
        low: 0.0,
        high: 3.0,
        ..Parameter::ratio("ratio")
    }],
    channels: &[Channel::Flow, Channel::RockerAngle],
    attach: attach_to_flow,
    ..Described::USUAL
};

/// Flow force on the lowering spool, as a factor on its travel.
pub static ON_TRAVEL: Described = Described {
    form: Some("travel"),
    title: "Flow force on the travel of the lowering spool",
    equation: "Q = Q_table(I_0 + (I - I_0) (1 + s) / (1 + s dp/dp_ref)) sqrt(dp/dp_ref), dp_ref: that of the valve's curve",
    attach: attach_to_travel,
    ..ON_FLOW
};

fn attach_to_flow(values: &[f64], conditions: RunConditions<'_>, hooks: &mut EffectHooks) {
    hooks.lower_drop_factor.push(opening(values, conditions));
}

fn attach_to_travel(values: &[f64], conditions: RunConditions<'_>, hooks: &mut EffectHooks) {
    hooks.lower_travel_factor.push(opening(values, conditions));
}

/// Factor of the flow force on the opening, from the drop, Pa.
fn opening(values: &[f64], conditions: RunConditions<'_>) -> Law {
    let ratio = values[0];
    let reference_pa = conditions.constants.lower_valve.reference_drop_pa;
    Box::new(move |drop_pa| (1.0 + ratio) / (1.0 + ratio * drop_pa.max(0.0) / reference_pa))
}
