//! `coulomb-friction`: dry friction of the cylinder's seals and of the links.
//!
//! `F = F_C tanh(v / 3 mm/s)`, against the motion: pressure is higher while lifting and lower while lowering by
//! `F_C / A`. The hyperbolic tangent stands for the transition through rest (Simscape's cylinder friction; Jelali &
//! Kroll 4.3). 100 to 300 N and 1 to 4 % of the pressure force are usual for a 76 mm cylinder.

use super::{Effect, Parameter};
use crate::campaign::Channel;
use crate::plant::sites::{RunConditions, Sites};

/// Speed at which the friction has reached three quarters of its full value, m/s.
pub(super) const TRANSITION_SPEED_M_S: f64 = 0.003;

/// Coulomb friction at the piston.
#[derive(Debug)]
pub struct CoulombFriction;

static PARAMETERS: [Parameter; 1] = [Parameter {
    name: "force",
    unit: "N",
    key: "force_n",
    meaning: "friction force at the piston",
    null: 0.0,
    typical: 400.0,
    low: 0.0,
    high: 5000.0,
}];

impl Effect for CoulombFriction {
    fn id(&self) -> &'static str {
        "coulomb-friction"
    }

    fn title(&self) -> &'static str {
        "Coulomb friction at the piston"
    }

    fn equation(&self) -> &'static str {
        "F = force * tanh(v / 3 mm/s)"
    }

    fn source(&self) -> &'static str {
        "Simscape cylinder friction; Jelali & Kroll 4.3; 100 to 800 N for seals of a 76 mm cylinder and links"
    }

    fn shows(&self) -> &'static str {
        "cylinder pressure steps down from lifting to holding and again to lowering, by the same at every load; slower \
         lowering of light loads"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn channels(&self) -> &'static [Channel] {
        &[
            Channel::PumpPressure,
            Channel::CylinderPressure,
            Channel::Flow,
            Channel::RockerAngle,
        ]
    }

    fn attach(&self, values: &[f64], _: RunConditions<'_>, sites: &mut Sites) {
        let force_n = values[0];
        sites.friction.push(Box::new(move |speed_m_s, _| {
            force_n * (speed_m_s / TRANSITION_SPEED_M_S).tanh()
        }));
    }
}
