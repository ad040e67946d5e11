//! `pin-friction`: dry friction in the linkage's pins, proportional to the load.
//!
//! `F = e F_weight tanh(v / 3 mm/s)`: each pin has a friction torque `mu r |F_pin|`, and all pin forces are
//! proportional to the load. With mu of 0.10 to 0.20 and radii of 10 to 30 mm, e is 0.03 to 0.08. The contribution of a
//! pin depends on its rotation per piston travel, `e = sum mu r |F_pin| |dphi/dx| / F_weight`, and thus on the stroke,
//! with a linear and a quadratic term.

use hitch_plant::hooks::effect_hooks::{EffectHooks, RunConditions};
use hitch_plant::{Channel, Parameter};

use crate::catalogue::coulomb_friction::TRANSITION_SPEED_M_S;
use crate::catalogue::over_the_stroke;
use crate::described::Described;

const SHARE: Parameter = Parameter {
    meaning: "friction over the weight's force",
    typical: 0.05,
    low: 0.0,
    high: 0.5,
    ..Parameter::ratio("share")
};

/// Friction in the pins of the linkage.
pub static EVEN: Described = Described {
    id: "pin-friction",
    title: "Friction in the pins of the linkage",
    equation: "F = share F_weight tanh(v / 3 mm/s)",
    source: "sum of mu r |F_pin| |dphi/dx| over the pins; 3 to 8 % of the weight's force",
    shows: "cylinder pressure steps down from lifting to holding and again to lowering, in \
         proportion to the load; slower lowering at every load",
    parameters: &[SHARE],
    channels: &Channel::ALL,
    attach: |values, conditions, hooks| rub(values[0], [0.0; 2], conditions, hooks),
    ..Described::USUAL
};

/// Friction in the pins of the linkage that varies over the stroke.
pub static UNEVEN: Described = Described {
    form: Some("uneven"),
    title: "Friction in the pins of the linkage, dependent on the stroke",
    equation: "F = share (1 + slope z + bow (3 z^2 - 1) / 2) F_weight tanh(v / 3 mm/s), z = 2 x / stroke - 1",
    shows: "cylinder pressure steps down from lifting to holding and again to lowering, in proportion to the load and \
         with a share that varies over the stroke",
    parameters: &[
        SHARE,
        over_the_stroke::shape(
            "slope",
            "growth of the share from mid stroke to the upper end",
            1.0,
        ),
        over_the_stroke::shape(
            "bow",
            "growth of the share towards both ends of the stroke",
            1.0,
        ),
    ],
    refines: true,
    attach: |values, conditions, hooks| rub(values[0], [values[1], values[2]], conditions, hooks),
    ..EVEN
};

fn rub(share: f64, shape: [f64; 2], conditions: RunConditions<'_>, hooks: &mut EffectHooks) {
    let stroke_m = conditions.constants.cylinder.stroke_m;
    hooks.friction.push(Box::new(move |state, weight_n| {
        // Friction never drives the motion.
        let there = over_the_stroke::over_mean(shape, state.piston_m, stroke_m).max(0.0);
        share * there * weight_n * (state.speed_m_s / TRANSITION_SPEED_M_S).tanh()
    }));
}
