//! Draws a machine from a seed: part-to-part variation, oil temperature and load.

use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

use crate::second_rig::driven_hitch::Conditions;
use crate::second_rig::hidden::Fidelity;
use crate::second_rig::hideable::find;
use crate::second_rig::physics::{Physics, SpoolMotion, Stiction};

/// Furthest that a threshold is off the data sheet, A.
const MOST_SHIFT_A: f64 = 0.1;
/// Lowest and highest commanded angle, degree.
const RANGE_DEG: (f64, f64) = (47.0, 133.0);
/// Shortest and longest move, degree.
const MOVE_DEG: (f64, f64) = (2.0, 80.0);

/// Sensors of a machine, as an ECU reads them.
#[derive(Debug, Clone, Copy)]
pub struct Readings {
    /// One sigma of the angle, degree.
    pub angle_noise_deg: f64,
    /// Last digit of the angle, degree.
    pub angle_digit_deg: f64,
    /// Whether there are pressure sensors.
    pub pressures: bool,
}

/// A machine and its moves.
#[derive(Debug, Clone)]
pub struct Drawn {
    /// Seed.
    pub seed: u64,
    /// Whether its effects have more structure than textbooks give them.
    pub structured: bool,
    /// Its physics beyond the data sheet.
    pub physics: Physics,
    /// Load, oil and lag.
    pub conditions: Conditions,
    /// Its sensors.
    pub readings: Readings,
    /// Where it rests first, and where the lever is moved to then, degree.
    pub angles_deg: Vec<f64>,
}

impl Readings {
    /// What an angle sensor shows at an angle, degree, with noise of one sigma times `noise`.
    #[must_use]
    pub fn shown_deg(&self, angle_deg: f64, noise: f64) -> f64 {
        let digit_deg = self.angle_digit_deg;
        ((angle_deg + self.angle_noise_deg * noise) / digit_deg).round() * digit_deg
    }
}

impl Drawn {
    /// Other sensors and, of a textbook machine, another lag: a quarter of the sensors is free of noise.
    pub(crate) fn redraw_angle_and_lag(&mut self, random: &mut Pcg64) {
        self.readings.angle_noise_deg = random.random_range(-0.033_f64..0.1).max(0.0);
        self.readings.angle_digit_deg = 1e-3 * 100.0_f64.powf(random.random::<f64>());
        if !self.structured {
            self.conditions.spool_lag_s = random.random_range(0.020..0.055);
        }
    }

    /// The same machine with spools that move like this and next to no other lag.
    #[must_use]
    pub fn with_spool(mut self, motion: SpoolMotion) -> Self {
        self.physics.spool = motion;
        self.conditions.spool_lag_s = 0.002;
        self
    }
}

/// The machine of a seed with as many moves.
#[must_use]
pub fn draw(seed: u64, moves: usize) -> Drawn {
    let mut random = Pcg64::seed_from_u64(seed);
    let structured = random.random::<bool>();
    let mut physics = Physics {
        lift_shift_a: random.random_range(-MOST_SHIFT_A..MOST_SHIFT_A),
        lower_shift_a: random.random_range(-MOST_SHIFT_A..MOST_SHIFT_A),
        ..Physics::default()
    };
    let fidelity = Fidelity::of(structured);
    let sizes = [
        ("solenoid-hysteresis", random.random_range(0.05..0.2)),
        ("coulomb-friction", random.random_range(100.0..500.0)),
        ("entrained-air", random.random_range(0.002..0.02)),
        ("pin-friction", random.random_range(0.005..0.05)),
        ("oil-viscosity", random.random_range(5.0..60.0)),
        ("return-line-loss", random.random_range(0.1..2.0)),
        ("compensator-droop", random.random_range(0.001..0.005)),
    ];
    for (id, size) in sizes {
        let hideable = find(id).unwrap_or_else(|| panic!("the second rig has no {id}"));
        hideable.put(&mut physics, size, fidelity, &mut random);
    }
    physics.sensors.angle_lag_s = random.random_range(0.0..0.01);
    if structured {
        physics.spool = SpoolMotion::Swinging {
            frequency_rad_s: random.random_range(150.0..400.0),
            damping: random.random_range(0.7..1.0),
            dead_time_s: random.random_range(0.0..0.005),
        };
        physics.stiction = random.random::<bool>().then(|| Stiction {
            band_a: random.random_range(0.01..0.04),
            jump_a: 0.01,
            follows: true,
        });
    }
    Drawn {
        seed,
        structured,
        physics,
        conditions: Conditions {
            load_kg: random.random_range(50.0..250.0),
            oil_temperature_c: random.random_range(10.0..70.0),
            spool_lag_s: random.random_range(0.020..0.045),
        },
        readings: Readings {
            angle_noise_deg: random.random_range(0.01..0.05),
            angle_digit_deg: random.random_range(0.01..0.05),
            pressures: random.random::<bool>(),
        },
        angles_deg: angles_deg(moves, &mut random),
    }
}

/// Rests far enough from the ends, and apart by a move of evenly drawn logarithm.
fn angles_deg(moves: usize, random: &mut Pcg64) -> Vec<f64> {
    let (low, high) = RANGE_DEG;
    let mut angles = vec![random.random_range(low..high)];
    while angles.len() <= moves {
        let here = angles[angles.len() - 1];
        let way = MOVE_DEG.0 * (MOVE_DEG.1 / MOVE_DEG.0).powf(random.random::<f64>());
        let way = if random.random::<bool>() { way } else { -way };
        if (low..=high).contains(&(here + way)) {
            angles.push(here + way);
        }
    }
    angles
}
