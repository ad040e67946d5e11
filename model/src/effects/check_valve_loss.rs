//! `check-valve-loss`: the open check valve throttles.
//!
//! Beyond its cracking pressure the poppet takes `loss (Q / 40 l/min)^2`. The compensator holds the sum of both drops, so
//! the lift orifice keeps `1.5 bar - loss (Q / 40 l/min)^2`: lift flow falls short the more, the larger it is.

use super::Parameter;
use super::described::Described;
use crate::campaign::Channel;

use crate::plant::sites::{RunConditions, Sites};
use crate::units::{m3_s_from_lpm, pa_from_bar};
/// Flow at which the loss is stated, l/min.
const RATED_LPM: f64 = 40.0;

/// Pressure loss of the check valve.
pub static CHECK_VALVE_LOSS: Described = Described {
    id: "check-valve-loss",
    title: "Pressure loss of the check valve",
    equation: "dp_orifice = p_P - p_C - 2.5 bar - loss (Q / 40 l/min)^2; Q = Q_table(I) sqrt(dp_orifice \
         / 1.5 bar)",
    source: "orifice law of an open poppet; 0.3 to 1 bar at rated flow in data sheets of cartridge \
         check valves",
    shows: "large lift flows fall short while small ones fit, at every load alike; the pump pressure \
         does not change",
    parameters: &[Parameter {
        name: "loss",
        unit: "bar",
        key: "loss_bar",
        meaning: "pressure that it takes at 40 l/min beyond 2.5 bar",
        null: 0.0,
        typical: 0.4,
        low: 0.0,
        high: 10.0,
    }],
    channels: &[Channel::Flow, Channel::RockerAngle],
    needs: None,
    attach,
};

fn attach(values: &[f64], _: RunConditions<'_>, sites: &mut Sites) {
    let rated_m3_s = m3_s_from_lpm(RATED_LPM);
    sites.check_valve_loss_pa_s2_m6 += pa_from_bar(values[0]) / (rated_m3_s * rated_m3_s);
}
