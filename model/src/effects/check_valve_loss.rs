//! `check-valve-loss`: the open check valve throttles.
//!
//! Beyond its nominal cracking pressure the poppet takes `loss (steady + (1 - steady) (Q / 40 l/min)^2)`: a throttling
//! seat, and with the share `steady` a spring that is stiffer than its data sheet. The compensator holds the sum of all
//! drops, so the lift orifice keeps what is left of 1.5 bar. Throttling makes large flows fall short the more; the
//! spring alone takes the same share of every flow and is `lift-flow-scale` by another name.

use super::described::Described;
use super::{Parameter, Search};
use crate::campaign::Channel;

use crate::plant::sites::{RunConditions, Sites};
use crate::units::{m3_s_from_lpm, pa_from_bar};

/// Flow at which the loss is stated, l/min.
const RATED_LPM: f64 = 40.0;

/// Pressure loss of the check valve.
pub static CHECK_VALVE_LOSS: Described = Described {
    id: "check-valve-loss",
    form: None,
    title: "Pressure loss of the check valve",
    equation: "dp_orifice = p_P - p_C - 2.5 bar - loss [steady + (1 - steady) (Q / 40 l/min)^2]; Q = \
         Q_table(I) sqrt(dp_orifice / 1.5 bar)",
    source: "orifice law of an open poppet; 0.3 to 1 bar at rated flow in data sheets of cartridge \
         check valves",
    shows: "large lift flows fall short while small ones fit, at every load alike; the pump pressure \
         does not change",
    parameters: &[
        Parameter {
            name: "loss",
            unit: "bar",
            key: "loss_bar",
            meaning: "pressure that it takes at 40 l/min beyond 2.5 bar",
            null: 0.0,
            typical: 0.4,
            low: 0.0,
            high: 10.0,
        },
        Parameter {
            name: "steady",
            unit: "",
            key: "steady",
            meaning: "share of it that does not change with the flow",
            null: 0.5,
            typical: 0.0,
            low: 0.0,
            high: 1.0,
        },
    ],
    channels: &[Channel::Flow, Channel::RockerAngle],
    needs: None,
    search: Search::Secants,
    refines: false,
    attach,
};

fn attach(values: &[f64], _: RunConditions<'_>, sites: &mut Sites) {
    let rated_m3_s = m3_s_from_lpm(RATED_LPM);
    let (loss_pa, steady) = (pa_from_bar(values[0]), values[1]);
    sites.cracking_extra_pa += steady * loss_pa;
    sites.check_valve_loss_pa_s2_m6 += (1.0 - steady) * loss_pa / (rated_m3_s * rated_m3_s);
}
