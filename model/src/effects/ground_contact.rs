//! `ground-contact`: the implement comes to rest on the ground before the end of the stroke.
//!
//! `F = k z (1 + c z')` upwards at the hitch point, never pulling, where z is how deep it has sunk below the height at
//! which the implement touches (Bekker with n = 1, damped as by Hunt & Crossley). Floors have 1e6 to 1e7 N/m, soil 5e4
//! to 5e5 N/m.

use super::described::Described;
use super::{Parameter, Search};
use crate::campaign::Channel;

use crate::plant::sites::Ground;
use crate::plant::sites::{RunConditions, Sites};
/// Damping of the contact, s/m.
const DAMPING_S_M: f64 = 1.5;

/// Contact with the ground.
pub static GROUND_CONTACT: Described = Described {
    id: "ground-contact",
    form: None,
    title: "Contact with the ground",
    equation: "F = stiffness (h_ground - h), upwards; h_ground = lowest point of the stroke + height",
    source: "Bekker with exponent one; floor 1e6 to 1e7 N/m, soil 5e4 to 5e5 N/m",
    shows: "lowering ends early and the cylinder pressure falls to nothing while the angle stands",
    parameters: &[
        Parameter {
            name: "height",
            unit: "m",
            key: "height_m",
            meaning: "height of the ground over the lowest point of the stroke",
            null: 0.0,
            typical: 0.1,
            low: 0.0,
            high: 0.65,
        },
        Parameter {
            name: "stiffness",
            unit: "kN/m",
            key: "stiffness_kn_m",
            meaning: "stiffness of the ground",
            null: 0.0,
            typical: 500.0,
            low: 50.0,
            high: 5000.0,
        },
    ],
    channels: &[
        Channel::CylinderPressure,
        Channel::Flow,
        Channel::RockerAngle,
    ],
    needs: None,
    search: Search::Places,
    attach,
};

fn attach(values: &[f64], conditions: RunConditions<'_>, sites: &mut Sites) {
    sites.ground = Some(Ground {
        height_m: conditions.linkage.at(0.0).height_m + values[0],
        stiffness_n_m: values[1] * 1e3,
        damping_s_m: DAMPING_S_M,
    });
}
