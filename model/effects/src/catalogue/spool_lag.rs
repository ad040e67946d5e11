//! `spool-lag`: lag of the spools behind their currents.
//!
//! Coil and spool form a well-damped second-order system: 40 to 100 ms to 90 % of a step for valves of this class
//! (Merritt, ch. 6; data sheets). The usual form is two first-order lags in series: `share` is the part of the lag in
//! the second one; zero is a plain first-order lag, a half is critical damping. An underdamped spool overshoots: 5 to
//! 15 Hz and a damping of 0.7 to 1 are typical. Both forms are exact at any step size for a linear current. In the
//! dynamic model the lag is added to the declared 45 ms; a negative lag is subtracted from them, down to zero.

use hitch_plant::components::lag::Lag;
use hitch_plant::hooks::effect_hooks::{CurrentStage, EffectHooks, RunConditions};
use hitch_plant::{Channel, Currents, Parameter};

use crate::described::Described;

/// Spools without overshoot.
pub static CREEPING: Described = Described {
    id: "spool-lag",
    title: "Lag of the spools",
    equation: "(1 - share) lag w1' + w1 = I; share lag w' + w = w1; Q = Q_table(w)",
    source: "second-order spool, Merritt ch. 6; data sheets of proportional valves: 40 to 100 ms to \
         90 % of a step",
    shows: "flow and pump pressure follow every edge of a current late, by the same time at any \
         load; a shifted clock shifts every channel alike",
    parameters: &[
        Parameter {
            meaning: "sum of the two time constants",
            typical: 0.05,
            low: -0.1,
            high: 1.0,
            ..Parameter::time("lag", "lag_s")
        },
        Parameter {
            meaning: "share of the lag in the second stage",
            typical: 0.25,
            low: 0.0,
            high: 0.5,
            ..Parameter::ratio("share")
        },
    ],
    channels: &[Channel::PumpPressure, Channel::Flow, Channel::RockerAngle],
    attach: attach_creeping,
    ..Described::USUAL
};

/// Spools with overshoot.
pub static SWINGING: Described = Described {
    form: Some("swinging"),
    title: "Lag of the spools, underdamped",
    equation: "(lag / 2 damping)^2 w'' + lag w' + w = I; Q = Q_table(w)",
    source: "second-order spool, Merritt ch. 6; data sheets of proportional valves: 5 to 15 Hz, damping \
         0.7 to 1",
    shows: "flow and pump pressure follow every edge of a current late, by the same time at any \
         load, and overshoot a little",
    parameters: &[
        Parameter {
            meaning: "delay behind a ramp of the current",
            typical: 0.05,
            low: 0.0,
            high: 1.0,
            ..Parameter::time("lag", "lag_s")
        },
        Parameter {
            meaning: "damping ratio of the spool",
            null: 1.0,
            typical: 0.8,
            low: 0.3,
            high: 0.99,
            ..Parameter::ratio("damping")
        },
    ],
    attach: attach_swinging,
    ..CREEPING
};

fn attach_swinging(values: &[f64], _: RunConditions<'_>, hooks: &mut EffectHooks) {
    let (lag_s, damping) = (values[0], values[1]);
    hooks.currents.push(Box::new(SwingingSpools {
        frequency_rad_s: 2.0 * damping / lag_s,
        damping,
        free: Free::default(),
        spools: [Swinging::default(); 2],
    }));
}

fn attach_creeping(values: &[f64], _: RunConditions<'_>, hooks: &mut EffectHooks) {
    if values[0] < 0.0 {
        hooks.spool_lag_extra_s += values[0];
        return;
    }
    let second_s = values[0] * values[1];
    for time_constant_s in [values[0] - second_s, second_s] {
        hooks.currents.push(Box::new(SpoolLag {
            time_constant_s,
            spools: [Lag::at_rest(time_constant_s, 0.0); 2],
        }));
    }
}

/// First-order lag of both spools.
#[derive(Debug, Clone)]
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

/// Second-order lag of both spools.
#[derive(Debug, Clone)]
struct SwingingSpools {
    frequency_rad_s: f64,
    damping: f64,
    /// Coefficients of the last step: steps are mostly equal, and sine and `exp` are expensive.
    free: Free,
    spools: [Swinging; 2],
}

/// Free oscillation of a spool over one step, the same for both spools.
#[derive(Debug, Clone, Copy, Default)]
struct Free {
    dt_s: f64,
    /// Decay rate and damped angular frequency, 1/s.
    decay: f64,
    swing: f64,
    /// Decay factor and phase angle over the step.
    left: f64,
    sine: f64,
    cosine: f64,
}

impl Free {
    fn new(frequency_rad_s: f64, damping: f64, dt_s: f64) -> Self {
        let decay = damping * frequency_rad_s;
        let swing = frequency_rad_s * (1.0 - damping * damping).sqrt();
        let (sine, cosine) = (swing * dt_s).sin_cos();
        Self {
            dt_s,
            decay,
            swing,
            left: (-decay * dt_s).exp(),
            sine,
            cosine,
        }
    }
}

/// State of one spool, in terms of the current.
#[derive(Debug, Clone, Copy, Default)]
struct Swinging {
    input_a: f64,
    place_a: f64,
    speed_a_s: f64,
}

impl Swinging {
    /// Advances while the current changes linearly to `input_a`; the steady response lags by `late_s`, and the
    /// deviation from it is a decaying oscillation.
    fn advance(&mut self, free: &Free, late_s: f64, input_a: f64) {
        let rate_a_s = (input_a - self.input_a) / free.dt_s;
        let behind_a = late_s * rate_a_s;
        let away_a = self.place_a - self.input_a + behind_a;
        let away_a_s = self.speed_a_s - rate_a_s;
        let quadrature_a = (away_a_s + free.decay * away_a) / free.swing;
        let left_a = free.left * (away_a * free.cosine + quadrature_a * free.sine);
        let turning_a = free.left * (quadrature_a * free.cosine - away_a * free.sine);
        self.place_a = input_a - behind_a + left_a;
        self.speed_a_s = rate_a_s + free.swing * turning_a - free.decay * left_a;
        self.input_a = input_a;
    }
}

impl CurrentStage for SwingingSpools {
    fn rest(&mut self, currents: Currents) -> Currents {
        self.spools = [currents.lift_a, currents.lower_a].map(|current_a| Swinging {
            input_a: current_a,
            place_a: current_a,
            speed_a_s: 0.0,
        });
        currents
    }

    fn advance(&mut self, currents: Currents, dt_s: f64) -> Currents {
        if dt_s > 0.0 {
            if self.free.dt_s != dt_s {
                self.free = Free::new(self.frequency_rad_s, self.damping, dt_s);
            }
            let late_s = 2.0 * self.damping / self.frequency_rad_s;
            let inputs_a = [currents.lift_a, currents.lower_a];
            for (spool, input_a) in self.spools.iter_mut().zip(inputs_a) {
                spool.advance(&self.free, late_s, input_a);
            }
        }
        let [lift_a, lower_a] = self.spools.map(|spool| spool.place_a);
        Currents { lift_a, lower_a }
    }
}
