//! `spool-stiction`: the spools stick, then jump.
//!
//! Two-parameter stick-slip (Choudhury, Thornhill and Shah 2005; Kano 2004): a spool stays until the current has gone
//! `band` away from where it stuck, then jumps after it by the share `jump` of the band and sticks again. 0.5 to
//! 2 % of the current range with dither, 3 to 6 % on plain direct current.

use super::Parameter;
use super::described::Described;
use crate::campaign::Channel;

use crate::plant::sites::{CurrentStage, Currents, Valve};
use crate::plant::sites::{RunConditions, Sites};

/// Longest step that follows a jump, s.
const STEP_S: f64 = 0.004;

/// Stiction of the spools.
pub static SPOOL_STICTION: Described = Described {
    id: "spool-stiction",
    title: "Stiction of the spools",
    equation: "|I - w| > band: w = w + sign(I - w) jump band; else w stays; Q = Q_table(w)",
    source: "Choudhury et al. 2005, Kano et al. 2004; 0.5 to 2 % of 3.3 A with dither, 3 to 6 % on \
         plain DC",
    shows: "a slow ramp of current gives plateaus and jumps of flow; small reversals change nothing; \
         on steps alone a twin of hysteresis",
    parameters: &[
        Parameter {
            name: "band",
            unit: "A",
            key: "band_a",
            meaning: "change of current that a resting spool does not follow",
            null: 0.0,
            typical: 0.08,
            low: 0.0,
            high: 0.5,
        },
        Parameter {
            name: "jump",
            unit: "",
            key: "jump",
            meaning: "share of the band that it makes good in one jump",
            null: 0.5,
            typical: 0.9,
            low: 0.6,
            high: 1.0,
        },
    ],
    channels: &[Channel::PumpPressure, Channel::Flow, Channel::RockerAngle],
    needs: None,
    erratic: true,
    attach,
};

fn attach(values: &[f64], _: RunConditions<'_>, sites: &mut Sites) {
    sites.longest_step_s = sites.longest_step_s.min(STEP_S);
    sites.currents.push(Box::new(StickSlip {
        band_a: values[0],
        jump_a: values[0] * values[1],
        spool: Currents::default(),
    }));
}

/// Stick-slip of both spools.
#[derive(Debug)]
struct StickSlip {
    band_a: f64,
    jump_a: f64,
    spool: Currents,
}

impl CurrentStage for StickSlip {
    /// Coming from zero, a spool that had to move has just jumped.
    fn rest(&mut self, currents: Currents) -> Currents {
        self.spool = Currents::default();
        self.advance(currents, 0.0)
    }

    /// Every jump starts where the current was just a band away, whenever the step notices.
    fn advance(&mut self, currents: Currents, _: f64) -> Currents {
        let before = self.spool;
        self.spool = currents.map(|valve, current_a| {
            let spool_a = match valve {
                Valve::Lift => before.lift_a,
                Valve::Lowering => before.lower_a,
            };
            let away_a = current_a - spool_a;
            let jumps = ((away_a.abs() - self.band_a) / self.jump_a).ceil().max(0.0);
            spool_a + (jumps * self.jump_a).copysign(away_a)
        });
        self.spool
    }
}
