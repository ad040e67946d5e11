//! `hose-compliance`: compliance of hoses and fittings.
//!
//! `dp/dt = (sum Q - A v) / (V/E + C)`. Two metres of half-inch two-wire hose have 3 to 6e-13 m3/Pa, as much as 0.6 l
//! of oil; in cm3/bar, 0.03 to 0.06. Rubber is viscoelastic: a share of the compliance creeps (Kelvin-Voigt), which
//! reduces the frequency of a fast oscillation less than that of a slow one and damps both.

use hitch_plant::hooks::elements::Hose;
use hitch_plant::units::pa_from_bar;
use hitch_plant::{Channel, Dynamics, Parameter};

use crate::described::Described;

const COMPLIANCE: Parameter = Parameter {
    meaning: "volume of the hoses' expansion per pressure",
    typical: 0.04,
    low: 0.0,
    high: 1.0,
    ..Parameter::quantity("compliance", "cm3/bar", "compliance_cm3_bar")
};

fn m3_pa(cm3_bar: f64) -> f64 {
    cm3_bar * 1e-6 / pa_from_bar(1.0)
}

/// Compliance without creep.
pub static ELASTIC: Described = Described {
    id: "hose-compliance",
    title: "Compliance of hoses",
    equation: "dp/dt = (sum Q - A v) / (V/E + C)",
    source: "two-wire hose, 0.25 l at 0.4 to 0.8e9 Pa: 0.03 to 0.06 cm3/bar",
    shows: "slower ringing of the cylinder pressure at every load alike; entrained air softens light \
         loads more",
    parameters: &[COMPLIANCE],
    channels: &[Channel::CylinderPressure],
    needs: Some(Dynamics::Dynamic),
    attach: |values, _, hooks| {
        hooks.hose = Hose {
            at_once_m3_pa: m3_pa(values[0]),
            ..Hose::default()
        };
    },
    ..Described::USUAL
};

/// Compliance with creep.
pub static CREEPING: Described = Described {
    form: Some("creeping"),
    title: "Compliance of hoses with wall creep",
    equation: "dp/dt = (sum Q - A v - W') / (V/E + (1 - share) C), W' = (share C p - W) / creep",
    source: "Kelvin-Voigt in series with a spring, the standard linear solid (Ferry 1980, ch. 1); size as of hoses that \
         swell at once",
    shows: "slower ringing of the cylinder pressure that decays faster, most if its period is close to the creep \
         time of the wall",
    parameters: &[
        COMPLIANCE,
        Parameter {
            meaning: "share of it that creeps",
            typical: 0.5,
            low: 0.0,
            high: 1.0,
            ..Parameter::ratio("share")
        },
        Parameter {
            meaning: "retardation time of the wall",
            typical: 0.05,
            low: 0.005,
            high: 1.0,
            ..Parameter::time("creep", "creep_s")
        },
    ],
    attach: |values, _, hooks| {
        let whole_m3_pa = m3_pa(values[0]);
        hooks.hose = Hose {
            at_once_m3_pa: (1.0 - values[1]) * whole_m3_pa,
            creeping_m3_pa: values[1] * whole_m3_pa,
            catching_up_1_s: 1.0 / values[2],
        };
    },
    ..ELASTIC
};
