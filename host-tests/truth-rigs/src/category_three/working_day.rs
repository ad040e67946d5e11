//! Moves of an operator with one load, sampled by the instruments of a logger.

use rand::{Rng, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

use super::machine::{BAR, STROKE_M, Wear, angle_deg};
use super::motion::Motion;

/// Samples per second.
pub const RATE_HZ: f64 = 100.0;
/// Steps of [`STEP_S`](super::motion::STEP_S) in a sample.
const STEPS_A_SAMPLE: usize = 40;

/// Noise of the instruments, one sigma: A, bar, bar, degree.
const NOISE: [f64; 4] = [0.002, 0.15, 0.3, 0.03];

/// Currents of the moves in turn, A: a lift, then a lowering.
const LEVELS_A: [(f64, f64); 7] = [
    (0.60, 0.65),
    (0.90, 0.85),
    (0.75, 0.70),
    (1.30, 1.10),
    (0.55, 0.60),
    (1.58, 1.40),
    (0.80, 0.95),
];
/// Ramp of a current, s.
const RAMP_S: f64 = 0.15;
/// Rest between two moves, s.
const REST_S: f64 = 0.8;
/// Longest move, s.
const LONGEST_S: f64 = 3.0;
/// Shares of the stroke between which the operator moves.
const RANGE: (f64, f64) = (0.06, 0.94);

/// A sample: time, s; currents of lift and lowering coil, A; pressure of cylinders and pump, bar; angle, degree.
pub type Sample = [f64; 6];

/// Logs moves with a load, kg; the same seed gives the same log.
#[must_use]
pub fn log(load_kg: f64, wear: Wear, seed: u64) -> Vec<Sample> {
    let mut day = Day {
        motion: Motion::at_rest(load_kg, wear, 0.3 * STROKE_M),
        random: Pcg64::seed_from_u64(seed),
        currents_a: [0.0; 2],
        samples: Vec::new(),
    };
    day.stay(2.0);
    for (lift_a, lower_a) in LEVELS_A {
        day.go([lift_a, 0.0], |share| share > RANGE.1);
        day.go([0.0, lower_a], |share| share < RANGE.0);
    }
    day.stay(1.0);
    day.samples
}

struct Day {
    motion: Motion,
    random: Pcg64,
    currents_a: [f64; 2],
    samples: Vec<Sample>,
}

impl Day {
    /// Moves with a current until the end of the range or the longest time, then rests.
    fn go(&mut self, to_a: [f64; 2], is_far: impl Fn(f64) -> bool) {
        self.ramp(to_a);
        let longest_s = LONGEST_S * self.random.random_range(0.6..1.0);
        for _ in 0..(longest_s * RATE_HZ) as usize {
            if is_far(self.motion.travel_m() / STROKE_M) {
                break;
            }
            self.sample(to_a);
        }
        self.ramp([0.0; 2]);
        self.stay(REST_S);
    }

    fn ramp(&mut self, to_a: [f64; 2]) {
        let from_a = self.currents_a;
        let pieces = (RAMP_S * RATE_HZ) as usize;
        for piece in 1..=pieces {
            let share = piece as f64 / pieces as f64;
            self.sample([0, 1].map(|k| from_a[k] + share * (to_a[k] - from_a[k])));
        }
    }

    fn stay(&mut self, time_s: f64) {
        for _ in 0..(time_s * RATE_HZ) as usize {
            self.sample(self.currents_a);
        }
    }

    /// Logs a sample, then goes on to the next one with currents that change linearly.
    fn sample(&mut self, to_a: [f64; 2]) {
        let mut noisy = |value: f64, sigma: f64| {
            let noise: f64 = StandardNormal.sample(&mut self.random);
            value + sigma * noise
        };
        let [cylinder_pa, pump_pa] = self.motion.pressures_pa();
        let from_a = self.currents_a;
        self.samples.push([
            self.samples.len() as f64 / RATE_HZ,
            noisy(from_a[0], NOISE[0]).max(0.0),
            noisy(from_a[1], NOISE[0]).max(0.0),
            noisy(cylinder_pa / BAR, NOISE[1]),
            noisy(pump_pa / BAR, NOISE[2]),
            noisy(angle_deg(self.motion.travel_m() / STROKE_M), NOISE[3]),
        ]);
        for step in 1..=STEPS_A_SAMPLE {
            let share = step as f64 / STEPS_A_SAMPLE as f64;
            self.motion
                .step([0, 1].map(|k| from_a[k] + share * (to_a[k] - from_a[k])));
        }
        self.currents_a = to_a;
    }
}
