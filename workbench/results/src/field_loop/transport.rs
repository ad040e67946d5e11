//! A tractor on a rough road with a carried implement: its body, the hitch and the controller in one loop.
//!
//! * The body accelerates the hitch: to the hitch the weight of the implement grows by the vertical acceleration of the body at
//!   the implement's centre.
//! * The hitch loads the body with the force that carries the implement, `(p A - c v) / (dh/dx)` by virtual work, at that
//!   centre: the links move the implement in parallel to the tractor. The weight of the links is part of it.
//!
//! Each gets the other's last value, extrapolated to the step it is used in: the plain values would be 1.5 ms late, and a light
//! body on the stiff oil would swing by itself.
//!
//! The implement's inertia is in that force, and not in the body; its own pitch inertia is left out.

use super::figures::activations;
use crate::closed_loop::OIL_TEMPERATURE_C;
use hitch_closed_loop::{ClosedLoop, Sample};
use hitch_field::body::{Body, BodyConstants, GRAVITY_M_S2, Ground, HitchLoad};
use hitch_field::noise::Noise;
use hitch_field::terrain::{RoughnessConstants, Terrain};
use hitch_plant::Model;
use hitch_quantities::units::{Count, MillimetrePerSecond};
use hitch_quantities::{Calibration, Inputs, ValidCalibration};
use rayon::prelude::*;

use hitch_closed_loop::field::RAISED_DEG;
use std::fmt::{self, Display, Formatter};
use std::ops::RangeInclusive;

/// Mass of the implement, kg.
pub const IMPLEMENT_KG: f64 = 600.0;
/// Its centre behind the rear axle, m: that of the three-furrow plough.
pub const BEHIND_AXLE_M: f64 = 1.9;
/// Period in which the bus tells the ground speed, ms.
const BUS_PERIOD_MS: u64 = 100;
const STEP_S: f64 = 1e-3;

/// A millisecond of the ride.
#[derive(Debug, Clone, Copy)]
pub struct RideSample {
    /// Hitch and controller.
    pub hitch: Sample,
    /// Pitch acceleration, rad/s².
    pub pitch_rad_s2: f64,
    /// Vertical acceleration at the centre of the tractor, m/s².
    pub heave_m_s2: f64,
}

/// Tractor, hitch and controller on a road.
pub struct TransportRig<'m> {
    model: &'m Model,
    hitch: ClosedLoop<'m>,
    body: Body,
    terrain: Terrain,
    angle_deg: f64,
    carried_n: f64,
    there_m_s2: f64,
    distance_m: f64,
    step: u64,
}

impl<'m> TransportRig<'m> {
    /// A tractor that stands, its lever at the raised hitch. The seed determines road and noise.
    #[must_use]
    pub fn new(
        model: &'m Model,
        calibration: &ValidCalibration,
        constants: BodyConstants,
        roughness: &RoughnessConstants,
        seed: u64,
    ) -> Self {
        let mut hitch = ClosedLoop::new(
            model,
            calibration,
            IMPLEMENT_KG,
            OIL_TEMPERATURE_C,
            RAISED_DEG,
            seed,
        );
        hitch.pick_up();
        let terrain = Terrain::flat().with_roughness(roughness, &mut Noise::new(seed, 0));
        let weight_n = -IMPLEMENT_KG * GRAVITY_M_S2;
        let load = HitchLoad::default().with_force(weight_n, BEHIND_AXLE_M);
        let ground = ground(&terrain, 0.0, &constants);
        Self {
            model,
            hitch,
            body: Body::at_rest(constants, ground, load),
            terrain,
            angle_deg: RAISED_DEG,
            carried_n: -weight_n,
            there_m_s2: 0.0,
            distance_m: 0.0,
            step: 0,
        }
    }

    /// One millisecond; `tell` can modify the inputs of the controller.
    pub fn step(
        &mut self,
        lever_deg: f64,
        speed_m_s: f64,
        tell: impl FnOnce(&mut Inputs),
    ) -> RideSample {
        let is_told = self.step.is_multiple_of(BUS_PERIOD_MS);
        let hitch = self.hitch.step_with(
            lever_deg,
            |inputs| {
                let speed = MillimetrePerSecond((speed_m_s * 1e3).round() as i32);
                inputs.ground_speed = is_told.then_some(speed);
                tell(inputs);
            },
            |_, _| {},
        );
        let carried_n = self.carried_n(&hitch);
        self.angle_deg = hitch.angle_deg;
        self.distance_m += speed_m_s * STEP_S;
        let constants = self.body.constants().clone();
        self.body.step(
            ground(&self.terrain, self.distance_m, &constants),
            HitchLoad::default().with_force(self.carried_n - 2.0 * carried_n, BEHIND_AXLE_M),
            STEP_S,
        );
        let motion = *self.body.motion();
        let there_m = -(constants.centre_before_rear_m() + BEHIND_AXLE_M);
        let there_m_s2 = motion.vertical_m_s2(there_m);
        let middle_m_s2 = 1.5 * there_m_s2 - 0.5 * self.there_m_s2;
        let heavier = 1.0 + middle_m_s2 / GRAVITY_M_S2;
        self.hitch.set_load_kg((IMPLEMENT_KG * heavier).max(0.0));
        (self.carried_n, self.there_m_s2) = (carried_n, there_m_s2);
        self.step += 1;
        RideSample {
            hitch,
            pitch_rad_s2: motion.pitch_rad_s2,
            heave_m_s2: motion.heave_m_s2,
        }
    }

    /// Force of the hitch on the implement, N.
    fn carried_n(&self, hitch: &Sample) -> f64 {
        let (linkage, constants) = (self.model.linkage(), self.model.constants());
        let piston_m = |angle_deg: f64| linkage.piston_m(angle_deg.to_radians());
        let here_m = piston_m(hitch.angle_deg);
        let speed_m_s = (here_m - piston_m(self.angle_deg)) / STEP_S;
        let oil_n = hitch.cylinder_pressure_bar * 1e5 * constants.cylinder.area_m2();
        let friction_n = constants.cylinder.viscous_friction_n_s_m * speed_m_s;
        (oil_n - friction_n) / linkage.at(here_m).dh_dx
    }
}

/// Ground under both axles, with the front axle at a distance, m.
fn ground(terrain: &Terrain, distance_m: f64, constants: &BodyConstants) -> Ground {
    Ground {
        front_m: terrain.height_m(distance_m),
        rear_m: terrain.height_m(distance_m - constants.wheelbase_m),
    }
}

/// Figures of a stretch of a ride.
#[derive(Debug, Clone, Copy)]
pub struct RideFigures {
    /// Root mean square of the pitch acceleration, rad/s².
    pub pitch_rad_s2: f64,
    /// The same of the vertical acceleration of the centre, m/s².
    pub heave_m_s2: f64,
    /// Largest cylinder pressure above its mean, bar.
    pub peak_bar: f64,
    /// Largest angle from the lever, degree.
    pub off_deg: f64,
    /// Mean square of the currents of both coils, A²: the heat of a coil of 1 ohm, W.
    pub coil_a2: f64,
    /// Number of times that a coil was switched on, per minute.
    pub activations_per_min: f64,
}

impl RideFigures {
    /// Means of figures; of the largest angle, the largest.
    fn mean(figures: &[Self]) -> Self {
        let mean =
            |of: fn(&Self) -> f64| figures.iter().map(of).sum::<f64>() / figures.len() as f64;
        Self {
            pitch_rad_s2: mean(|one| one.pitch_rad_s2),
            heave_m_s2: mean(|one| one.heave_m_s2),
            peak_bar: mean(|one| one.peak_bar),
            off_deg: figures.iter().map(|one| one.off_deg).fold(0.0, f64::max),
            coil_a2: mean(|one| one.coil_a2),
            activations_per_min: mean(|one| one.activations_per_min),
        }
    }

    /// Of samples of a millisecond.
    #[must_use]
    pub fn of(samples: &[RideSample]) -> Self {
        let count = samples.len() as f64;
        let mean = |of: &dyn Fn(&RideSample) -> f64| samples.iter().map(of).sum::<f64>() / count;
        let most =
            |of: &dyn Fn(&RideSample) -> f64| samples.iter().map(of).fold(f64::MIN, f64::max);
        let pressure_bar = mean(&|sample| sample.hitch.cylinder_pressure_bar);
        let currents = |sample: &RideSample| {
            let outputs = &sample.hitch.outputs;
            [outputs.lift_current.0, outputs.lower_current.0]
        };
        let activations = activations(samples.iter().map(|sample| &sample.hitch)) as f64;
        Self {
            pitch_rad_s2: mean(&|sample| sample.pitch_rad_s2.powi(2)).sqrt(),
            heave_m_s2: mean(&|sample| sample.heave_m_s2.powi(2)).sqrt(),
            peak_bar: most(&|sample| sample.hitch.cylinder_pressure_bar) - pressure_bar,
            off_deg: most(&|sample| (sample.hitch.angle_deg - sample.hitch.lever_deg).abs()),
            coil_a2: mean(&|sample| {
                let amperes = currents(sample).map(|current| f64::from(current) * 1e-3);
                amperes.iter().map(|current| current * current).sum()
            }),
            activations_per_min: activations / (count * STEP_S / 60.0),
        }
    }
}

/// The calibration of a machine with ride damping, with changes.
///
/// # Panics
/// If it is not valid.
#[must_use]
pub fn damping_with(change: impl FnOnce(&mut Calibration)) -> ValidCalibration {
    let mut calibration = Calibration::nominal();
    calibration.ride.fitted = Count(1);
    change(&mut calibration);
    calibration.sealed().validate().expect("is valid")
}

/// Class C of ISO 8608: a quarter of the density of class D.
#[must_use]
pub fn class_c() -> RoughnessConstants {
    RoughnessConstants {
        density_m3: 256e-6,
        ..RoughnessConstants::class_d()
    }
}

/// A ride.
#[derive(Debug, Clone)]
pub struct Ride {
    /// Tractor.
    pub body: BodyConstants,
    /// Road.
    pub roughness: RoughnessConstants,
    /// Speed, m/s.
    pub speed_m_s: f64,
}

impl Ride {
    /// Time until the swings have settled, s.
    const SETTLING_S: f64 = 10.0;
    /// Judged time, s.
    const JUDGED_S: f64 = 60.0;

    /// Drives the ride.
    #[must_use]
    pub fn drive(&self, model: &Model, calibration: &ValidCalibration, seed: u64) -> RideFigures {
        RideFigures::of(&self.samples(model, calibration, seed))
    }

    /// Hitch and controller over the judged time.
    #[must_use]
    pub fn course(&self, model: &Model, calibration: &ValidCalibration, seed: u64) -> Vec<Sample> {
        let samples = self.samples(model, calibration, seed);
        samples.iter().map(|sample| sample.hitch).collect()
    }

    fn samples(&self, model: &Model, calibration: &ValidCalibration, seed: u64) -> Vec<RideSample> {
        let body = self.body.clone();
        let mut rig = TransportRig::new(model, calibration, body, &self.roughness, seed);
        let mut stretch = |time_s: f64| -> Vec<RideSample> {
            (0..(time_s / STEP_S) as u64)
                .map(|_| rig.step(RAISED_DEG, self.speed_m_s, |_| {}))
                .collect()
        };
        stretch(Self::SETTLING_S);
        stretch(Self::JUDGED_S)
    }
}

/// A ride with damping against the same ride with a hitch that holds: means over seeds.
#[derive(Debug, Clone, Copy)]
pub struct RideComparison {
    /// With a hitch that holds.
    pub held: RideFigures,
    /// With damping.
    pub damped: RideFigures,
}

impl RideComparison {
    /// Drives all rides.
    #[must_use]
    pub fn of(
        model: &Model,
        ride: &Ride,
        calibration: &ValidCalibration,
        seeds: RangeInclusive<u64>,
    ) -> Self {
        let held = ValidCalibration::nominal();
        let [held, damped] = [&held, calibration].map(|calibration| {
            let figures: Vec<RideFigures> = seeds
                .clone()
                .into_par_iter()
                .map(|seed| ride.drive(model, calibration, seed))
                .collect();
            RideFigures::mean(&figures)
        });
        Self { held, damped }
    }

    /// Pitch acceleration over that of the held hitch.
    #[must_use]
    pub fn pitch_ratio(&self) -> f64 {
        self.damped.pitch_rad_s2 / self.held.pitch_rad_s2
    }

    /// Pressure peak over that of the held hitch.
    #[must_use]
    pub fn peak_ratio(&self) -> f64 {
        self.damped.peak_bar / self.held.peak_bar
    }
}

impl Display for RideComparison {
    fn fmt(&self, out: &mut Formatter<'_>) -> fmt::Result {
        let Self { held, damped } = self;
        write!(
            out,
            "pitch {:.2} rad/s2, damped {:.2} of it; heave {:.2}; pressure peak {:.1} bar, damped {:.2}; angle within {:.2} deg; \
             {:.2} A2 in the coils; {:.0} activations a minute",
            held.pitch_rad_s2,
            self.pitch_ratio(),
            damped.heave_m_s2 / held.heave_m_s2,
            held.peak_bar,
            self.peak_ratio(),
            damped.off_deg,
            damped.coil_a2,
            damped.activations_per_min,
        )
    }
}
