//! `viscous-friction`: friction proportional to speed.
//!
//! `F = f v`, shear of oil in seals and guides; 500 to 5000 N s/m, several times that when cold. In the gap of a guide
//! it is proportional to the viscosity; under a seal, whose oil film thickness also increases with the viscosity, it is
//! roughly proportional to its square root (Jelali & Kroll 4.3). In the dynamic model it is added to the declared 12
//! 000 N s/m, and may be negative; the sum is never less than zero.

use hitch_plant::components::oil::viscosity_m2_s;
use hitch_plant::hooks::effect_hooks::EffectHooks;
use hitch_plant::{Channel, Dynamics, Parameter};

use crate::described::Described;

/// Temperature at which the coefficient is specified, degree Celsius.
const SPECIFIED_AT_C: f64 = 40.0;

const COEFFICIENT: Parameter = Parameter {
    meaning: "force per speed, with oil at 40 degC",
    typical: 3000.0,
    low: 0.0,
    high: 100000.0,
    ..Parameter::quantity("coefficient", "N s/m", "coefficient_n_s_m")
};

/// Viscous friction independent of temperature.
pub static EVEN: Described = Described {
    id: "viscous-friction",
    title: "Viscous friction at the piston",
    equation: "F = coefficient v",
    source: "Jelali & Kroll 4.3; 500 to 5000 N s/m for seals of a 76 mm cylinder",
    shows: "cylinder pressure higher while lifting and lower while lowering, the more the faster; \
         slower lowering at high currents",
    parameters: &[Parameter {
        low: -100000.0,
        ..COEFFICIENT
    }],
    channels: &Channel::ALL,
    attach: |values, conditions, hooks| {
        let declared_n_s_m = match conditions.constants.dynamics {
            Dynamics::Steady => 0.0,
            Dynamics::Dynamic => conditions.constants.cylinder.viscous_friction_n_s_m,
        };
        oppose(values[0].max(-declared_n_s_m), hooks);
    },
    ..Described::USUAL
};

/// Viscous friction that depends on the oil's viscosity.
pub static THICKENING: Described = Described {
    form: Some("thickening"),
    title: "Viscous friction at the piston, viscosity-dependent",
    equation: "F = coefficient (nu(T) / nu(40 C))^exponent v",
    source: "Jelali & Kroll 4.3; 3 to 5 times as much when cold",
    shows: "cylinder pressure higher while lifting and lower while lowering, the more the faster and the \
         colder the oil",
    parameters: &[
        COEFFICIENT,
        Parameter {
            meaning: "exponent of its dependence on viscosity",
            typical: 0.7,
            low: 0.0,
            high: 1.5,
            ..Parameter::ratio("exponent")
        },
    ],
    attach: |values, conditions, hooks| {
        let thickness =
            viscosity_m2_s(conditions.oil_temperature_c) / viscosity_m2_s(SPECIFIED_AT_C);
        oppose(values[0] * thickness.powf(values[1]), hooks);
    },
    ..EVEN
};

fn oppose(coefficient_n_s_m: f64, hooks: &mut EffectHooks) {
    hooks.friction.push(Box::new(move |state, _| {
        coefficient_n_s_m * state.speed_m_s
    }));
}
