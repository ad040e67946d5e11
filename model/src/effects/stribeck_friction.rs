//! `stribeck-friction`: breaking loose takes more force than sliding.
//!
//! `F = F_s [c + (1 - c) exp(-|v| / v_s)] tanh(v / 3 mm/s)`: static friction F_s falls to the sliding share c of it within a
//! few millimetres a second (Simscape's cylinder friction; Jelali & Kroll 4.3). F_s is 1.2 to 1.6 times the sliding
//! friction, v_s 5 to 20 mm/s; with c = 0 it is what comes on top of a Coulomb friction that is there already.

use super::Parameter;
use super::described::Described;
use crate::campaign::Channel;

use super::coulomb_friction::TRANSITION_SPEED_M_S;
use crate::plant::sites::{RunConditions, Sites};

/// Stribeck friction at the piston.
pub static STRIBECK_FRICTION: Described = Described {
    id: "stribeck-friction",
    title: "Stribeck friction at the piston",
    equation: "F = force [sliding + (1 - sliding) exp(-|v| / speed)] tanh(v / 3 mm/s)",
    source: "Simscape cylinder friction; Jelali & Kroll 4.3; breakaway 20 to 60 % over Coulomb \
         friction, 5 to 20 mm/s",
    shows: "cylinder pressure at creeping speed: higher steps at every start and stop than at speed",
    parameters: &[
        Parameter {
            name: "force",
            unit: "N",
            key: "force_n",
            meaning: "friction at the point of breaking loose",
            null: 0.0,
            typical: 300.0,
            low: 0.0,
            high: 5000.0,
        },
        Parameter {
            name: "sliding",
            unit: "",
            key: "sliding",
            meaning: "share of it that is left while sliding",
            null: 0.0,
            typical: 0.3,
            low: 0.0,
            high: 0.9,
        },
        Parameter {
            name: "speed",
            unit: "mm/s",
            key: "speed_mm_s",
            meaning: "speed over which the rest is lost",
            null: 0.0,
            typical: 10.0,
            low: 2.0,
            high: 60.0,
        },
    ],
    channels: &[Channel::CylinderPressure, Channel::RockerAngle],
    needs: None,
    erratic: false,
    attach,
};

fn attach(values: &[f64], _: RunConditions<'_>, sites: &mut Sites) {
    let (force_n, sliding, speed_m_s) = (values[0], values[1], values[2] * 1e-3);
    sites.friction.push(Box::new(move |v_m_s, _| {
        let left = sliding + (1.0 - sliding) * (-v_m_s.abs() / speed_m_s).exp();
        force_n * left * (v_m_s / TRANSITION_SPEED_M_S).tanh()
    }));
}
