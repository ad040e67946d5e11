//! `compensator-droop`: the compensator's margin falls with the pressure that it works at.
//!
//! Force balance of its spool, `A_c (p_P - p_C) = F_0 + k x + 0.43 w x p_P`: the further it has to close and the higher
//! the pressure, the smaller the margin. Linear about no load: `margin = 4 bar - c p_C`. What the lift orifice keeps
//! shrinks from 1.5 bar, so the lift flow falls with its square root.

use super::Parameter;
use super::described::Described;
use crate::campaign::Channel;

use crate::plant::sites::{RunConditions, Sites};

/// Droop of the pressure compensator.
pub static COMPENSATOR_DROOP: Described = Described {
    id: "compensator-droop",
    form: None,
    title: "Droop of the pressure compensator",
    equation: "p_P - p_C = 4 bar - slope p_C; Q = Q_table(I) sqrt((p_P - p_C - 2.5 bar) / 1.5 bar)",
    source: "spool force balance of a three-way compensator; up to 0.02 bar/bar either way",
    shows: "heavy loads lift slower than light ones, and the pump pressure stands less than 4 bar \
         over the load",
    parameters: &[Parameter {
        name: "slope",
        unit: "bar/bar",
        key: "slope",
        meaning: "margin lost for each bar of cylinder pressure",
        null: 0.0,
        typical: 0.005,
        low: -0.02,
        high: 0.05,
    }],
    channels: &[Channel::PumpPressure, Channel::Flow, Channel::RockerAngle],
    needs: None,
    erratic: false,
    attach,
};

fn attach(values: &[f64], _: RunConditions<'_>, sites: &mut Sites) {
    let slope = values[0];
    sites.margin.push(Box::new(move |cylinder_pressure_pa| {
        -slope * cylinder_pressure_pa
    }));
}
