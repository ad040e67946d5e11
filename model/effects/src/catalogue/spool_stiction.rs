//! `spool-stiction`: stick-slip motion of the spools.
//!
//! Two-parameter stick-slip: a spool sticks until the current has changed by `band`, then jumps by the share `jump` of
//! the band. 0.5 to 2 % of the current range with dither, 3 to 6 % on plain direct current. Two forms differ in the
//! friction of a moving spool: it sticks again at once (Kano 2004), or follows the current, lagging by half of the
//! remaining band, until the current reverses or stops (Choudhury, Thornhill and Shah 2005).

use hitch_plant::hooks::effect_hooks::{CurrentStage, EffectHooks};
use hitch_plant::{Channel, Currents, Parameter, SizeResponse, Valve};

use crate::described::Described;

/// Largest change of a current per step, A: a jump is detected at the end of a step, and its delay on a fast ramp would
/// be mistaken for a wider band.
const CHANGE_A: f64 = 0.002;

/// Rate of change below which a current counts as constant, A/s: plateaus of a conditioned record stay below it.
const STILL_A_S: f64 = 0.005;

/// Spools that stick again after every jump.
pub static STICKING: Described = Described {
    id: "spool-stiction",
    title: "Stiction of the spools",
    equation: "|I - w| > band: w = w + sign(I - w) jump band; else w stays; Q = Q_table(w)",
    source: "Kano et al. 2004; 0.5 to 2 % of 3.3 A with dither, 3 to 6 % on plain DC",
    shows: "a slow ramp of current gives plateaus and jumps of flow; small reversals change nothing; \
         with steps alone indistinguishable from hysteresis",
    parameters: &[
        Parameter {
            meaning: "change of current that a sticking spool does not follow",
            typical: 0.08,
            low: 0.0,
            high: 0.5,
            ..Parameter::current("band", "band_a")
        },
        Parameter {
            meaning: "share of the band that it recovers in one jump",
            null: 0.5,
            typical: 0.9,
            low: 0.5,
            high: 1.0,
            ..Parameter::ratio("jump")
        },
    ],
    channels: &[Channel::PumpPressure, Channel::Flow, Channel::RockerAngle],
    size_response: SizeResponse::Switching,
    attach: |values, _, hooks| attach(values, hooks, Jumping::default()),
    ..Described::USUAL
};

/// Spools that follow the current after breaking loose.
pub static FOLLOWING: Described = Described {
    form: Some("following"),
    title: "Stiction of the spools, with free motion after breakaway",
    equation: "stuck at I_0 until |I - I_0| > band; then w = I - sign(dI/dt) (1 - jump) band / 2 until \
         I turns or stands still; Q = Q_table(w)",
    source: "Choudhury, Thornhill & Shah 2005; 0.5 to 2 % of 3.3 A with dither, 3 to 6 % on plain DC",
    shows: "a slow ramp of current starts late and with a jump, a staircase gives plateaus and jumps; \
         small reversals change nothing; with steps alone indistinguishable from hysteresis",
    size_response: SizeResponse::Stepped,
    attach: |values, _, hooks| attach(values, hooks, Following::default()),
    ..STICKING
};

/// Attaches a type of spool to both valves.
fn attach<S: Spool + 'static>(values: &[f64], hooks: &mut EffectHooks, spool: S) {
    hooks.limit_change(CHANGE_A);
    let band_a = values[0];
    hooks.currents.push(Box::new(Sticking {
        friction: Friction {
            band_a,
            jump_a: band_a * values[1],
        },
        lift: spool,
        lowering: spool,
    }));
}

/// Stiction of a spool.
#[derive(Debug, Clone, Copy)]
struct Friction {
    band_a: f64,
    jump_a: f64,
}

/// A sticking spool, in terms of the current.
trait Spool: std::fmt::Debug + Copy + Default + Send + Sync {
    /// Its position, A, after the current has changed to `current_a` within `dt_s`.
    fn advance(&mut self, friction: Friction, current_a: f64, dt_s: f64) -> f64;
}

/// The spools of both valves.
#[derive(Debug, Clone)]
struct Sticking<S> {
    friction: Friction,
    lift: S,
    lowering: S,
}

impl<S: Spool> CurrentStage for Sticking<S> {
    /// Starting from zero current, a spool that moved has just jumped.
    fn rest(&mut self, currents: Currents) -> Currents {
        (self.lift, self.lowering) = (S::default(), S::default());
        self.advance(currents, 0.0)
    }

    fn advance(&mut self, currents: Currents, dt_s: f64) -> Currents {
        let friction = self.friction;
        currents.map(|valve, current_a| {
            let spool = match valve {
                Valve::Lift => &mut self.lift,
                Valve::Lower => &mut self.lowering,
            };
            spool.advance(friction, current_a, dt_s)
        })
    }
}

/// A spool that sticks again after every jump.
#[derive(Debug, Clone, Copy, Default)]
struct Jumping {
    place_a: f64,
}

impl Spool for Jumping {
    /// Every jump starts at a current exactly one band away, regardless of the step in which it is detected.
    fn advance(&mut self, friction: Friction, current_a: f64, _: f64) -> f64 {
        let away_a = current_a - self.place_a;
        let jumps = ((away_a.abs() - friction.band_a) / friction.jump_a)
            .ceil()
            .max(0.0);
        self.place_a += (jumps * friction.jump_a).copysign(away_a);
        self.place_a
    }
}

/// A spool that follows the current after breaking loose.
#[derive(Debug, Clone, Copy, Default)]
struct Following {
    place_a: f64,
    /// The previous current, A.
    before_a: f64,
    /// The current at which it stuck, A.
    stuck_a: f64,
    /// Sign of its motion; zero while it sticks.
    direction: f64,
}

impl Spool for Following {
    fn advance(&mut self, friction: Friction, current_a: f64, dt_s: f64) -> f64 {
        let change_a = current_a - self.before_a;
        if self.direction != 0.0 && change_a * self.direction <= STILL_A_S * dt_s {
            self.direction = 0.0;
            self.stuck_a = self.before_a;
        }
        let away_a = current_a - self.stuck_a;
        if self.direction == 0.0 && away_a.abs() > friction.band_a {
            self.direction = away_a.signum();
        }
        if self.direction != 0.0 {
            let behind_a = 0.5 * (friction.band_a - friction.jump_a);
            self.place_a = current_a - self.direction * behind_a;
        }
        self.before_a = current_a;
        self.place_a
    }
}
