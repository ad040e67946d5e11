//! `entrained-air`: undissolved air that reduces the bulk modulus at low pressure.
//!
//! `E = E_l [1 + a (pa/(pa+p))^(1/n)] / [1 + a pa^(1/n) E_l / (n (pa+p)^((n+1)/n))]` (Simscape's mixture). `a` is the
//! volume of air at atmospheric pressure relative to that of the oil: c / (1 - c) for a volume share c of air. The
//! change of state is between isothermal, n = 1, and adiabatic, n = 1.4.

use hitch_plant::hooks::effect_hooks::{EffectHooks, RunConditions};
use hitch_plant::{Channel, Dynamics, Parameter};

use crate::described::Described;

/// Atmospheric pressure, Pa.
const ATMOSPHERE_PA: f64 = 101_325.0;
/// Absolute pressure below which the mixture's bulk modulus is constant, Pa.
const LOWEST_PA: f64 = 2e4;

/// Entrained air in the oil.
pub static ENTRAINED_AIR: Described = Described {
    id: "entrained-air",
    title: "Entrained air in the oil",
    equation: "E = E_l [1 + a (pa/(pa+p))^(1/n)] / [1 + a pa^(1/n) E_l / (n (pa+p)^((n+1)/n))], a = \
         share / (1 - share)",
    source: "Simscape isothermal liquid with entrained air; 0.5 to 2 % by volume, foaming oil up to 5 \
         %",
    shows: "slower ringing of the cylinder pressure and softer starts and stops, the more the \
         lighter the load",
    parameters: &[
        Parameter {
            meaning: "volume of air at atmospheric pressure relative to the whole volume",
            typical: 0.01,
            low: 0.0,
            high: 0.2,
            ..Parameter::ratio("share")
        },
        Parameter {
            meaning: "polytropic exponent n of the air",
            null: 1.0,
            typical: 1.2,
            low: 1.0,
            high: 1.4,
            ..Parameter::ratio("polytropic")
        },
    ],
    channels: &[Channel::CylinderPressure],
    needs: Some(Dynamics::Dynamic),
    attach,
    ..Described::USUAL
};

fn attach(values: &[f64], conditions: RunConditions<'_>, hooks: &mut EffectHooks) {
    let (ratio, polytropic) = (values[0] / (1.0 - values[0]), values[1]);
    let liquid_pa = conditions.constants.oil.bulk_modulus_pa;
    let exponent = 1.0 / polytropic;
    hooks.stiffness_factor.push(Box::new(move |pressure_pa| {
        let absolute_pa = (ATMOSPHERE_PA + pressure_pa).max(LOWEST_PA);
        let squeezed = ratio * (ATMOSPHERE_PA / absolute_pa).powf(exponent);
        (1.0 + squeezed) / (1.0 + squeezed * liquid_pa / (polytropic * absolute_pa))
    }));
}
