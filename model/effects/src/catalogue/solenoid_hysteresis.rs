//! `solenoid-hysteresis`: hysteresis of spool position over current (magnetic hysteresis and friction of the armature).
//!
//! Play operator on each current, `w = clamp(w_before, I - H/2, I + H/2)`, `Q = Q_table(w)`: over a slow triangular
//! current the flow follows two branches at a distance H, with the data sheet's curve midway (Visintin; Jelali & Kroll,
//! ch. 4). H is 3 to 6 % of 3.3 A with dither, 8 to 12 % on plain direct current.

use hitch_plant::hooks::effect_hooks::CurrentStage;
use hitch_plant::{Channel, Currents, Parameter};

use crate::described::Described;

/// Hysteresis of both solenoids.
pub static SOLENOID_HYSTERESIS: Described = Described {
    id: "solenoid-hysteresis",
    title: "Hysteresis of the solenoids",
    equation: "w = clamp(w_before, I - width/2, I + width/2); Q = Q_table(w)",
    source: "play operator, Visintin; Jelali & Kroll ch. 4; 0.10 to 0.20 A with dither, 0.25 to 0.4 A on plain DC",
    shows: "a loop in flow over a triangular current; after a step down more flow than after a step up; with steps from \
         zero alone easily taken for a shifted threshold",
    parameters: &[Parameter {
        meaning: "distance of the rising from the falling branch",
        typical: 0.12,
        low: 0.0,
        high: 0.8,
        ..Parameter::current("width", "width_a")
    }],
    channels: &[Channel::PumpPressure, Channel::Flow, Channel::RockerAngle],
    attach: |values, _, hooks| {
        hooks.currents.push(Box::new(Play {
            half_width_a: 0.5 * values[0],
            spool: Currents::default(),
        }));
    },
    ..Described::USUAL
};

/// Play operator on both currents.
#[derive(Debug, Clone)]
struct Play {
    half_width_a: f64,
    spool: Currents,
}

impl CurrentStage for Play {
    /// Starting from zero current, the spool is at the upper end of the play.
    fn rest(&mut self, currents: Currents) -> Currents {
        self.spool = Currents::default();
        self.advance(currents, 0.0)
    }

    fn advance(&mut self, currents: Currents, _: f64) -> Currents {
        let half_a = self.half_width_a;
        let before = self.spool;
        self.spool = currents.map(|valve, current_a| {
            let spool_a = before.of(valve);
            spool_a.max(current_a - half_a).min(current_a + half_a)
        });
        self.spool
    }
}
