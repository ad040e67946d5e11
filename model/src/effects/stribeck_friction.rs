//! `stribeck-friction`: breaking loose takes more force than sliding.
//!
//! `F = F_s exp(-|v| / v_s) tanh(v / 3 mm/s)`: what static friction has over Coulomb friction, lost within a few
//! millimetres a second (Simscape's cylinder friction; Jelali & Kroll 4.3). K = 1.2 to 1.6, v_s = 5 to 20 mm/s.

use super::Parameter;
use super::described::Described;
use crate::campaign::Channel;

use super::coulomb_friction::TRANSITION_SPEED_M_S;
use crate::plant::sites::{RunConditions, Sites};

/// Stribeck friction at the piston.
pub static STRIBECK_FRICTION: Described = Described {
    id: "stribeck-friction",
    title: "Stribeck friction at the piston",
    equation: "F = force exp(-|v| / speed) tanh(v / 3 mm/s)",
    source: "Simscape cylinder friction; Jelali & Kroll 4.3; breakaway 20 to 60 % over Coulomb \
         friction, 5 to 20 mm/s",
    shows: "cylinder pressure at creeping speed only: steps at every start and stop that vanish at \
         speed",
    parameters: &[
        Parameter {
            name: "force",
            unit: "N",
            key: "force_n",
            meaning: "what breaking loose takes more than sliding",
            null: 0.0,
            typical: 300.0,
            low: 0.0,
            high: 5000.0,
        },
        Parameter {
            name: "speed",
            unit: "mm/s",
            key: "speed_mm_s",
            meaning: "speed over which it is lost",
            null: 0.0,
            typical: 10.0,
            low: 2.0,
            high: 60.0,
        },
    ],
    channels: &[Channel::CylinderPressure, Channel::RockerAngle],
    needs: None,
    attach,
};

fn attach(values: &[f64], _: RunConditions<'_>, sites: &mut Sites) {
    let (force_n, speed_m_s) = (values[0], values[1] * 1e-3);
    sites.friction.push(Box::new(move |v_m_s, _| {
        force_n * (-v_m_s.abs() / speed_m_s).exp() * (v_m_s / TRANSITION_SPEED_M_S).tanh()
    }));
}
