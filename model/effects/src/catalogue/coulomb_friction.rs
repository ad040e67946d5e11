//! `coulomb-friction`: dry friction of the cylinder's seals and of the links.
//!
//! The pressure is higher while lifting and lower while lowering by `F_C / A`. Two forms differ at rest. With a
//! hyperbolic tangent, `F = F_C tanh(v / 3 mm/s)`, the friction vanishes (Simscape's cylinder friction; Jelali & Kroll
//! 4.3). Bristles that deflect before they slip keep the force at which the piston stopped (Dahl 1968; LuGre, Canudas
//! de Wit 1995), until vibration of the running machine has relaxed them. Typical values are 100 to 300 N plus 1 to 4 %
//! of the pressure force for a 76 mm cylinder, and some tenths of a millimetre of deflection.

use hitch_plant::hooks::elements::Bristles;
use hitch_plant::{Channel, Parameter};

use crate::described::Described;

/// Speed at which the friction reaches three quarters of its full value, m/s.
pub(crate) const TRANSITION_SPEED_M_S: f64 = 0.003;

const FORCE: Parameter = Parameter {
    meaning: "friction force at the piston",
    typical: 400.0,
    low: 0.0,
    high: 5000.0,
    ..Parameter::quantity("force", "N", "force_n")
};

/// Friction that vanishes at rest.
pub static SMOOTH: Described = Described {
    id: "coulomb-friction",
    title: "Coulomb friction at the piston",
    equation: "F = force * tanh(v / 3 mm/s)",
    source: "Simscape cylinder friction; Jelali & Kroll 4.3; 100 to 800 N for seals of a 76 mm cylinder and links",
    shows: "cylinder pressure steps down from lifting to holding and again to lowering, by the same at every load; slower \
            lowering of light loads",
    parameters: &[FORCE],
    channels: &Channel::ALL,
    attach: |values, _, hooks| {
        let force_n = values[0];
        hooks.friction.push(Box::new(move |state, _| {
            force_n * (state.speed_m_s / TRANSITION_SPEED_M_S).tanh()
        }));
    },
    ..Described::USUAL
};

/// Longest step that resolves the deflection of the bristles, s.
const STEP_S: f64 = 0.01;

/// Friction that persists at rest.
pub static BRISTLES: Described = Described {
    form: Some("bristles"),
    title: "Coulomb friction at the piston, with friction force at rest",
    equation: "F = force * z / bending, z' = v - (|v| + creep) z / bending",
    source: "Dahl 1968; Canudas de Wit et al. 1995 (LuGre with a speed-independent level); Jelali & Kroll 4.3",
    shows: "cylinder pressure at rest lies higher after lifting than after lowering, by the same at every load; slower \
            lowering of light loads",
    parameters: &[
        FORCE,
        Parameter {
            meaning: "travel of the piston before the seal slips",
            typical: 0.3,
            low: 0.02,
            high: 5.0,
            ..Parameter::quantity("bending", "mm", "bending_mm")
        },
        Parameter {
            meaning: "creep speed of the seal at full force due to vibration; 0: no creep",
            typical: 0.0,
            low: 0.0,
            high: 8.0,
            ..Parameter::quantity("creep", "mm/s", "creep_mm_per_s")
        },
    ],
    attach: |values, _, hooks| {
        hooks.bristles = Some(Bristles {
            force_n: values[0],
            reach_m: 1e-3 * values[1],
            creep_m_s: 1e-3 * values[2],
        });
        hooks.limit_step(STEP_S);
    },
    ..SMOOTH
};
