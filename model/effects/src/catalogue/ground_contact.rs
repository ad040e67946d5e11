//! `ground-contact`: contact of the implement with the ground before the end of the stroke.
//!
//! `F = k z (1 + c z')` upwards at the hitch point, never downwards, where z is the depth below the height of first
//! contact (Bekker with n = 1, damped as by Hunt & Crossley). Floors have 1e6 to 1e7 N/m, soil 5e4 to 5e5 N/m. With
//! viscous damping of the ground, `F = k z + d z'` with 1e3 to 1e4 N s/m.

use hitch_plant::hooks::effect_hooks::RunConditions;
use hitch_plant::hooks::elements::Ground;
use hitch_plant::{Channel, Dynamics, Parameter, SizeResponse};

use crate::described::Described;

/// Depth-proportional damping of the contact in forms without a parameter for it, s/m.
const DAMPING_S_M: f64 = 1.5;

const HEIGHT: Parameter = Parameter {
    meaning: "height of the ground over the lowest point of the stroke",
    typical: 0.1,
    low: 0.0,
    high: 0.65,
    ..Parameter::quantity("height", "m", "height_m")
};

const STIFFNESS: Parameter = Parameter {
    meaning: "stiffness of the ground",
    typical: 500.0,
    low: 50.0,
    high: 5000.0,
    ..Parameter::quantity("stiffness", "kN/m", "stiffness_kn_m")
};

const CHANNELS: &[Channel] = &[
    Channel::CylinderPressure,
    Channel::Flow,
    Channel::RockerAngle,
];

/// Contact with ground of low damping.
pub static SPRINGY: Described = Described {
    id: "ground-contact",
    title: "Contact with the ground",
    equation: "F = stiffness (h_ground - h), upwards; h_ground = lowest point of the stroke + height",
    source: "Bekker with exponent one; floor 1e6 to 1e7 N/m, soil 5e4 to 5e5 N/m",
    shows: "lowering ends early and the cylinder pressure falls to zero at constant angle",
    parameters: &[HEIGHT, STIFFNESS],
    channels: CHANNELS,
    size_response: SizeResponse::Located,
    attach: |values, conditions, hooks| {
        hooks.ground = Some(Ground {
            damping_s_m: DAMPING_S_M,
            ..ground(values, conditions)
        });
    },
    ..Described::USUAL
};

/// Contact with ground with viscous damping.
pub static DAMPED: Described = Described {
    id: "ground-contact",
    form: Some("damped"),
    title: "Contact with viscoelastic ground",
    equation: "F = stiffness (h_ground - h) - damping h', upwards; h_ground = lowest point of the stroke + height",
    source: "Bekker with exponent one; soil 1e3 to 1e4 N s/m",
    shows: "lowering ends early and the cylinder pressure falls to zero at constant angle; oscillation on \
         the ground decays faster",
    parameters: &[
        HEIGHT,
        STIFFNESS,
        Parameter {
            meaning: "damping force per speed of penetration",
            typical: 5.0,
            low: 0.0,
            high: 50.0,
            ..Parameter::quantity("damping", "kN s/m", "damping_kn_s_m")
        },
    ],
    channels: CHANNELS,
    needs: Some(Dynamics::Dynamic),
    size_response: SizeResponse::Located,
    refines: true,
    attach: |values, conditions, hooks| {
        hooks.ground = Some(Ground {
            damping_n_s_m: values[2] * 1e3,
            ..ground(values, conditions)
        });
    },
};

/// Ground with a height, m, and a stiffness, kN/m, without damping.
fn ground(values: &[f64], conditions: RunConditions<'_>) -> Ground {
    Ground {
        height_m: conditions.linkage.at(0.0).height_m + values[0],
        stiffness_n_m: values[1] * 1e3,
        damping_s_m: 0.0,
        damping_n_s_m: 0.0,
    }
}
