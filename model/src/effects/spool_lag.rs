//! `spool-lag`: the spools follow their currents late.
//!
//! Coil and spool together behave like a second-order, well damped system: 40 to 100 ms to 90 % of a step for valves of
//! this class (Merritt, ch. 6; data sheets). Written as two first-order lags in series so that it stays stable and
//! exact at any step: `share` moves part of the lag into the second one; none is a plain first-order lag, a half is
//! critical damping. On the dynamic starting point it comes on top of the 45 ms that are declared there.

use super::Parameter;
use super::described::Described;
use crate::campaign::Channel;

use crate::plant::lag::Lag;
use crate::plant::sites::{CurrentStage, Currents};
use crate::plant::sites::{RunConditions, Sites};

/// Lag of the spools.
pub static SPOOL_LAG: Described = Described {
    id: "spool-lag",
    form: None,
    title: "Lag of the spools",
    equation: "(1 - share) lag w1' + w1 = I; share lag w' + w = w1; Q = Q_table(w)",
    source: "second-order spool, Merritt ch. 6; data sheets of proportional valves: 40 to 100 ms to \
         90 % of a step",
    shows: "flow and pump pressure follow every edge of a current late, by the same time at any \
         load; a shifted clock shifts every channel alike",
    parameters: &[
        Parameter {
            name: "lag",
            unit: "s",
            key: "lag_s",
            meaning: "sum of the two time constants",
            null: 0.0,
            typical: 0.05,
            low: 0.0,
            high: 1.0,
        },
        Parameter {
            name: "share",
            unit: "",
            key: "share",
            meaning: "share of the lag in the second stage",
            null: 0.0,
            typical: 0.25,
            low: 0.0,
            high: 0.5,
        },
    ],
    channels: &[Channel::PumpPressure, Channel::Flow, Channel::RockerAngle],
    needs: None,
    erratic: false,
    attach,
};

fn attach(values: &[f64], _: RunConditions<'_>, sites: &mut Sites) {
    let second_s = values[0] * values[1];
    for time_constant_s in [values[0] - second_s, second_s] {
        sites.currents.push(Box::new(SpoolLag {
            time_constant_s,
            spools: [Lag::at_rest(time_constant_s, 0.0); 2],
        }));
    }
}

/// First-order lag of both spools.
#[derive(Debug)]
struct SpoolLag {
    time_constant_s: f64,
    spools: [Lag; 2],
}

impl CurrentStage for SpoolLag {
    fn rest(&mut self, currents: Currents) -> Currents {
        self.spools = [currents.lift_a, currents.lower_a]
            .map(|current_a| Lag::at_rest(self.time_constant_s, current_a));
        currents
    }

    fn advance(&mut self, currents: Currents, dt_s: f64) -> Currents {
        Currents {
            lift_a: self.spools[0].advance(currents.lift_a, dt_s),
            lower_a: self.spools[1].advance(currents.lower_a, dt_s),
        }
    }
}
