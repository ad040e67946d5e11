//! `viscous-friction`: friction that grows with speed.
//!
//! `F = f v`, oil sheared in seals and guides; 500 to 5000 N s/m, several times that when cold. On the dynamic starting
//! point it comes on top of the 12 000 N s/m declared there.

use super::described::Described;
use super::{Parameter, Search};
use crate::campaign::Channel;

use crate::plant::sites::{RunConditions, Sites};

/// Viscous friction at the piston.
pub static VISCOUS_FRICTION: Described = Described {
    id: "viscous-friction",
    form: None,
    title: "Viscous friction at the piston",
    equation: "F = coefficient v",
    source: "Jelali & Kroll 4.3; 500 to 5000 N s/m for seals of a 76 mm cylinder, 3 to 5 times that \
         when cold",
    shows: "cylinder pressure higher while lifting and lower while lowering, the more the faster; \
         slower lowering at high currents",
    parameters: &[Parameter {
        name: "coefficient",
        unit: "N s/m",
        key: "coefficient_n_s_m",
        meaning: "force over speed",
        null: 0.0,
        typical: 3000.0,
        low: 0.0,
        high: 100000.0,
    }],
    channels: &[
        Channel::PumpPressure,
        Channel::CylinderPressure,
        Channel::Flow,
        Channel::RockerAngle,
    ],
    needs: None,
    search: Search::Secants,
    attach,
};

fn attach(values: &[f64], _: RunConditions<'_>, sites: &mut Sites) {
    let coefficient_n_s_m = values[0];
    sites
        .friction
        .push(Box::new(move |speed_m_s, _| coefficient_n_s_m * speed_m_s));
}
