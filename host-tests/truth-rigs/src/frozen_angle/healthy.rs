//! Machines with healthy sensors in conditions that resemble a frozen one: stick-slip, creep, corrections, ground
//! contact and end stops.

use hitch_quantities::units::{MilliDegree, PerMille};
use hitch_quantities::{Fault, Trip, ValidCalibration};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

use crate::drawn_hitches::draw::{Drawn, draw};
use crate::drawn_hitches::session::{Instant, Session};
use crate::second_rig::hidden::Fidelity;
use crate::second_rig::hideable::HIDEABLE;
use crate::second_rig::linkage;
use crate::second_rig::physics::{Ground, Stiction};

/// How long a machine is driven, ms.
pub const MACHINE_MS: usize = 60_000;

/// A fault of a healthy machine.
#[derive(Debug, Clone, Copy)]
pub struct FalseTrip {
    /// Seed of the machine.
    pub seed: u64,
    /// Whether its effects have more structure than textbooks give them.
    pub structured: bool,
    /// When, ms.
    pub at_ms: usize,
    /// Where the hitch was and the lever, degree.
    pub place_deg: [f64; 2],
    /// The reported fault; `None` if the hitch rests far from its lever without a reason.
    pub fault: Option<(Fault, Option<Trip>)>,
}

/// A hitch that has rested for this long, ms, this far from its lever, degree, won't go on by itself.
const RESTED_MS: usize = 3_000;
const FAR_DEG: f64 = 1.0;

/// A machine and its conditions.
struct Surroundings {
    drawn: Drawn,
    /// How far the sensor is turned on its shaft, degree.
    turned_deg: f64,
    /// Where the ground is, degree.
    ground_deg: Option<f64>,
    /// Lowering-rate dial.
    dial: Option<PerMille>,
}

impl Surroundings {
    /// True if ground or an end stop is in the way from a place, degree, towards a lever that far away.
    fn holds(&self, rocker_deg: f64, far_deg: f64) -> bool {
        if far_deg > 0.0 {
            rocker_deg > 135.0
        } else {
            rocker_deg < 45.0
                || self
                    .ground_deg
                    .is_some_and(|ground| rocker_deg < ground + 0.5)
        }
    }
}

fn surroundings(seed: u64, random: &mut Pcg64) -> Surroundings {
    let mut drawn = draw(seed, 1);
    drawn.redraw_angle_and_lag(random);
    let physics = &mut drawn.physics;
    // A third of the machines in the cold.
    if random.random_bool(0.3) {
        drawn.conditions.oil_temperature_c = random.random_range(0.0..15.0);
    }
    if random.random_bool(0.3) {
        physics.stiction = Some(Stiction {
            band_a: random.random_range(0.01..0.05),
            jump_a: 0.01,
            follows: random.random::<bool>(),
        });
    }
    // Some leak, so that they are corrected.
    if random.random_bool(0.3) {
        let leak = HIDEABLE.iter().find(|what| what.id.contains("leak"));
        if let Some(what) = leak {
            let size = what.draw_size(random);
            what.put(physics, size, Fidelity::Faithful, random);
        }
    }
    let ground_deg = random
        .random_bool(0.5)
        .then(|| random.random_range(46.0..100.0));
    if let Some(ground_deg) = ground_deg {
        let lowest_m = linkage::at(0.0).height_m;
        physics.ground = Some(Ground {
            height_m: linkage::at(linkage::travel_m(ground_deg)).height_m - lowest_m,
            stiffness_n_m: 2e5 * 10.0_f64.powf(random.random::<f64>()),
            damping_n_s_m: random.random_range(0.0..1e4),
        });
    }
    if let Some(ground_deg) = ground_deg {
        drawn.angles_deg[0] = random.random_range(ground_deg + 5.0..133.0);
    }
    Surroundings {
        drawn,
        turned_deg: random.random_range(-1.0..1.0),
        ground_deg,
        dial: random
            .random_bool(0.4)
            .then(|| PerMille(random.random_range(140..1_000))),
    }
}

/// The next place of the lever, degree: anywhere, close by, or at an end.
fn next_lever_deg(lever_deg: f64, random: &mut Pcg64) -> f64 {
    match random.random_range(0..10) {
        0..4 => random.random_range(44.0..136.0),
        4..7 => lever_deg + random.random_range(-3.0..3.0),
        7 => 44.0,
        8 => 136.0,
        _ => lever_deg + random.random_range(-0.5..0.5),
    }
    .clamp(44.0, 136.0)
}

/// Drives the machine of a seed; returns its first report.
#[must_use]
pub fn first_fault(seed: u64, calibration: &ValidCalibration) -> Option<FalseTrip> {
    first_fault_watched(seed, calibration, |_, _| {})
}

/// The same; `watch` sees every millisecond, with the lever's angle, degree.
#[must_use]
pub fn first_fault_watched(
    seed: u64,
    calibration: &ValidCalibration,
    mut watch: impl FnMut(f64, &Instant),
) -> Option<FalseTrip> {
    let mut random = Pcg64::seed_from_u64(seed ^ 0x0BAD_7219);
    let surroundings = surroundings(seed, &mut random);
    let turned = MilliDegree((surroundings.turned_deg * 1e3) as i32);
    let mut session = Session::new(&surroundings.drawn, calibration);
    session.pick_up_with(|inputs| {
        inputs.rocker_angle = inputs.rocker_angle.map(|angle| angle + turned);
    });
    let mut lever_deg = surroundings.drawn.angles_deg[0] + surroundings.turned_deg;
    // A lever that is let go by hand, at up to 400 degrees a second.
    let mut target_deg = lever_deg;
    let mut stays_ms = 0_usize;
    let mut slope_deg = 0.1;
    let mut rested_ms = 0;
    for at_ms in 0..MACHINE_MS {
        if stays_ms == 0 {
            target_deg = next_lever_deg(lever_deg, &mut random);
            slope_deg = [0.4, 0.05, 0.01, 10.0][random.random_range(0..4)];
            stays_ms = random.random_range(100..6_000);
        }
        stays_ms -= 1;
        let step_deg = (target_deg - lever_deg).clamp(-slope_deg, slope_deg);
        lever_deg += step_deg;
        let instant = session.step_with(lever_deg, |inputs| {
            inputs.rocker_angle = inputs.rocker_angle.map(|angle| angle + turned);
            inputs.lowering_dial = surroundings.dial;
        });
        watch(lever_deg, &instant);
        let shown_deg = instant.rocker_deg + surroundings.turned_deg;
        let far_deg = lever_deg.clamp(44.6, 135.4) - shown_deg;
        let rests = instant.currents_a == [0.0; 2] && step_deg == 0.0;
        rested_ms = if rests { rested_ms + 1 } else { 0 };
        let stops_short = rested_ms > RESTED_MS
            && far_deg.abs() > FAR_DEG
            && !surroundings.holds(instant.rocker_deg, far_deg);
        if instant.fault.is_some() || stops_short {
            return Some(FalseTrip {
                seed,
                structured: surroundings.drawn.structured,
                at_ms,
                place_deg: [instant.rocker_deg, lever_deg],
                fault: instant.fault,
            });
        }
    }
    None
}
