//! From coil current to spool: hysteresis, stiction, lag.

use std::collections::VecDeque;

use super::physics::{Physics, Play, SpoolMotion, Stiction};

/// One solenoid with its spool; the spool position is in amperes.
#[derive(Debug, Clone)]
pub struct CurrentPath {
    plays: Vec<(Play, f64)>,
    stiction: Option<Stuck>,
    motions: Vec<Motion>,
    shift_a: f64,
}

impl CurrentPath {
    /// A path at rest without current. `known_lag_s` is the lag that the family is known for.
    fn new(physics: &Physics, shift_a: f64, known_lag_s: f64) -> Self {
        Self {
            plays: physics.plays.iter().map(|play| (*play, 0.0)).collect(),
            stiction: physics.stiction.map(Stuck::new),
            motions: [SpoolMotion::Lagging(known_lag_s), physics.spool]
                .map(Motion::new)
                .into(),
            shift_a,
        }
    }

    /// The paths of lift and lowering coil.
    #[must_use]
    pub fn both(physics: &Physics, known_lag_s: f64) -> [Self; 2] {
        [physics.lift_shift_a, physics.lower_shift_a]
            .map(|shift_a| Self::new(physics, shift_a, known_lag_s))
    }

    /// Goes on by `dt_s` under a coil current; returns the current that the valve's table is read at.
    pub fn advance(&mut self, current_a: f64, dt_s: f64) -> f64 {
        let magnetised_a = self.magnetised_a(current_a);
        let loose_a = match &mut self.stiction {
            Some(stuck) => stuck.advance(magnetised_a),
            None => magnetised_a,
        };
        let spool_a = self
            .motions
            .iter_mut()
            .fold(loose_a, |input_a, motion| motion.advance(input_a, dt_s));
        spool_a - self.shift_a
    }

    /// Prandtl-Ishlinskii operator: a weighted sum of plays (Visintin).
    fn magnetised_a(&mut self, current_a: f64) -> f64 {
        if self.plays.is_empty() {
            return current_a;
        }
        self.plays
            .iter_mut()
            .map(|(play, at_a)| {
                *at_a = at_a
                    .max(current_a - play.half_width_a)
                    .min(current_a + play.half_width_a);
                play.share * *at_a
            })
            .sum()
    }
}

/// A sticking spool and where it stuck.
#[derive(Debug, Clone)]
struct Stuck {
    stiction: Stiction,
    /// Current at which it stuck, A.
    stuck_a: f64,
    /// Place, A.
    place_a: f64,
    /// Direction while loose, zero while stuck.
    direction: f64,
    before_a: f64,
    still_s: u32,
}

/// Steps without change of current after which a loose spool sticks again.
const STILL_STEPS: u32 = 20;

impl Stuck {
    fn new(stiction: Stiction) -> Self {
        Self {
            stiction,
            stuck_a: 0.0,
            place_a: 0.0,
            direction: 0.0,
            before_a: 0.0,
            still_s: 0,
        }
    }

    fn advance(&mut self, current_a: f64) -> f64 {
        if self.stiction.follows {
            self.advance_following(current_a);
        } else {
            self.advance_jumping(current_a);
        }
        self.before_a = current_a;
        self.place_a
    }

    /// Stays until the current is a band away, then jumps towards it.
    fn advance_jumping(&mut self, current_a: f64) {
        let ahead_a = current_a - self.place_a;
        if ahead_a.abs() > self.stiction.band_a {
            self.place_a += self.stiction.jump_a.min(ahead_a.abs()) * ahead_a.signum();
        }
    }

    /// Choudhury's two-parameter model: stuck until the current has changed by the band, then `(band - jump) / 2`
    /// behind it until it turns or stands still.
    fn advance_following(&mut self, current_a: f64) {
        let change_a = current_a - self.before_a;
        self.still_s = if change_a.abs() < 1e-9 {
            self.still_s + 1
        } else {
            0
        };
        if self.direction != 0.0 && (change_a * self.direction < 0.0 || self.still_s > STILL_STEPS)
        {
            self.direction = 0.0;
            self.stuck_a = self.before_a;
        }
        let away_a = current_a - self.stuck_a;
        if self.direction == 0.0 && away_a.abs() > self.stiction.band_a {
            self.direction = away_a.signum();
        }
        if self.direction != 0.0 {
            let behind_a = 0.5 * (self.stiction.band_a - self.stiction.jump_a);
            self.place_a = current_a - self.direction * behind_a;
        }
    }
}

/// A spool in motion.
#[derive(Debug, Clone)]
struct Motion {
    motion: SpoolMotion,
    input_a: f64,
    place_a: f64,
    speed_a_s: f64,
    delayed: VecDeque<f64>,
}

impl Motion {
    fn new(motion: SpoolMotion) -> Self {
        Self {
            motion,
            input_a: 0.0,
            place_a: 0.0,
            speed_a_s: 0.0,
            delayed: VecDeque::new(),
        }
    }

    fn advance(&mut self, input_a: f64, dt_s: f64) -> f64 {
        match self.motion {
            SpoolMotion::Immediate => self.place_a = input_a,
            SpoolMotion::Lagging(0.0) => self.place_a = input_a,
            SpoolMotion::Lagging(tau_s) => {
                // The mean of the step: an input held at its end would be half a step early.
                let mean_a = 0.5 * (self.input_a + input_a);
                self.place_a -= (-dt_s / tau_s).exp_m1() * (mean_a - self.place_a);
            }
            SpoolMotion::Swinging {
                frequency_rad_s,
                damping,
                dead_time_s,
            } => {
                self.delayed.push_back(input_a);
                let late_a = if self.delayed.len() as f64 * dt_s > dead_time_s {
                    self.delayed.pop_front().unwrap_or(input_a)
                } else {
                    0.0
                };
                // Semi-implicit Euler: stable far beyond the 15 Hz of such spools at these steps.
                let pull = frequency_rad_s * frequency_rad_s * (late_a - self.place_a)
                    - 2.0 * damping * frequency_rad_s * self.speed_a_s;
                self.speed_a_s += dt_s * pull;
                self.place_a += dt_s * self.speed_a_s;
            }
        }
        self.input_a = input_a;
        self.place_a
    }
}
