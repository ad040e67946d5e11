//! `load-inertia`: the moving masses want a force to be accelerated.
//!
//! `p A = F_weight + s M(x) dv/dt` with `M = (load + dead weight) (dh/dx)^2 + 20 kg`. One is the inertia of the weights
//! as they are. On the dynamic starting point, which has that already, it is what comes on top: rocker, arms, mast.

use super::described::Described;
use super::{Parameter, Search};
use crate::campaign::Channel;

use crate::plant::sites::{RunConditions, Sites};

/// Longest step that follows the pressure of an accelerated load, s.
const STEP_S: f64 = 0.005;

/// Inertia of load and linkage.
pub static LOAD_INERTIA: Described = Described {
    id: "load-inertia",
    form: None,
    title: "Inertia of load and linkage",
    equation: "p A = F_weight + share M(x) dv/dt, M = m (dh/dx)^2 + 20 kg",
    source: "Lagrange's equation of the linkage; rocker and arms of 0.3 to 0.8 kg m2 add 30 to 80 kg \
         at the piston",
    shows: "peaks of cylinder pressure when a movement starts or stops, in proportion to the load; \
         on the dynamic starting point slower ringing",
    parameters: &[Parameter {
        name: "share",
        unit: "",
        key: "share",
        meaning: "share of the inertia of load and dead weight",
        null: 0.0,
        typical: 0.5,
        low: 0.0,
        high: 5.0,
    }],
    channels: &[Channel::CylinderPressure],
    needs: None,
    search: Search::Secants,
    refines: false,
    attach,
};

fn attach(values: &[f64], _: RunConditions<'_>, sites: &mut Sites) {
    sites.inertia_share += values[0];
    sites.limit_step(STEP_S);
}
