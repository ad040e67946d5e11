//! `pin-friction`: dry friction in the linkage's pins, proportional to the load.
//!
//! `F = e F_weight tanh(v / 3 mm/s)`: each pin resists with `mu r |F_pin|`, and all pin forces grow with the load. With
//! mu 0.10 to 0.20 and radii of 10 to 30 mm, e is 0.03 to 0.08.

use super::described::Described;
use super::{Parameter, Search};
use crate::campaign::Channel;

use super::coulomb_friction::TRANSITION_SPEED_M_S;
use crate::plant::sites::{RunConditions, Sites};

/// Friction in the pins of the linkage.
pub static PIN_FRICTION: Described = Described {
    id: "pin-friction",
    form: None,
    title: "Friction in the pins of the linkage",
    equation: "F = share F_weight tanh(v / 3 mm/s)",
    source: "sum of mu r |F_pin| |dphi/dx| over the pins; 3 to 8 % of the weight's force",
    shows: "cylinder pressure steps down from lifting to holding and again to lowering, in \
         proportion to the load; slower lowering at every load",
    parameters: &[Parameter {
        name: "share",
        unit: "",
        key: "share",
        meaning: "friction over the weight's force",
        null: 0.0,
        typical: 0.05,
        low: 0.0,
        high: 0.5,
    }],
    channels: &[
        Channel::PumpPressure,
        Channel::CylinderPressure,
        Channel::Flow,
        Channel::RockerAngle,
    ],
    needs: None,
    search: Search::Secants,
    refines: false,
    attach,
};

fn attach(values: &[f64], _: RunConditions<'_>, sites: &mut Sites) {
    let share = values[0];
    sites.friction.push(Box::new(move |speed_m_s, weight_n| {
        share * weight_n * (speed_m_s / TRANSITION_SPEED_M_S).tanh()
    }));
}
