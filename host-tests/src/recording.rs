//! Records the controller's inputs during a minute of moves and faults.
//!
//! The plant is the dynamic one, with noisy sensors. The script contains moves in both directions, reversals, both ends
//! of the stroke, the button, and missing and implausible values of every signal.

use hitch_closed_loop::Coil;
use hitch_plant::{Currents, HitchRig, Plant, Rig};
use hitch_quantities::signals::INPUT_BYTES;
use hitch_quantities::units::{
    Duty, Microsecond, MilliAmp, MilliBar, MilliCelsius, MilliDegree, MilliDegreePerSecond,
    MilliVolt,
};
use hitch_quantities::{Inputs, Outputs};

use crate::replay;
use crate::trace::Trace;

/// A step of the controller, s.
const STEP_S: f64 = 1e-3;
/// How far a hand moves the lever in a step: 0.12 degree, so the whole range takes most of a second.
const LEVER_STEP_MILLIDEGREE: i32 = 120;
const OIL_TEMPERATURE_C: f64 = 40.0;
/// Noise of the instruments: half the width of an even distribution.
const ANGLE_NOISE_MILLIDEGREE: i32 = 80;
const PRESSURE_NOISE_MILLIBAR: i32 = 150;
const CURRENT_NOISE_MILLIAMPERE: i32 = 5;
const SUPPLY_V: f64 = 13.8;

/// What a fault of the signals may draw on.
struct Spoils<'r> {
    /// The inputs of the step before.
    last: Inputs,
    /// The largest or the smallest number.
    extreme: i32,
    random: &'r mut fastrand::Rng,
}

/// A modification of the signals between hitch and controller.
type Fault = fn(&mut Inputs, Spoils<'_>);

/// A piece of the script.
struct Scene {
    steps: u32,
    lever_degree: i32,
    jog_degree_per_second: Option<i32>,
    fault: Fault,
}

const fn scene(steps: u32, lever_degree: i32) -> Scene {
    Scene {
        steps,
        lever_degree,
        jog_degree_per_second: None,
        fault: |_, _| {},
    }
}

impl Scene {
    const fn jog(self, degree_per_second: i32) -> Self {
        Self {
            jog_degree_per_second: Some(degree_per_second),
            ..self
        }
    }

    const fn with(self, fault: Fault) -> Self {
        Self { fault, ..self }
    }
}

/// The hitch starts at 60 degrees, the lever elsewhere.
const START_DEGREE: f64 = 60.0;
const SCRIPT: &[Scene] = &[
    // Locked until the lever comes through the hitch's position; then long and short moves.
    scene(400, 120),
    scene(1_800, 50),
    scene(2_500, 120),
    scene(1_000, 115),
    scene(600, 60),
    scene(1_500, 100),
    scene(1_200, 101),
    // Both ends of the stroke.
    scene(2_500, 149),
    scene(3_000, 31),
    scene(1_800, 90),
    // The button, and the lock behind it.
    scene(1_200, 90).jog(12),
    scene(1_000, 90).jog(-12),
    scene(700, 90).jog(40),
    scene(500, 90),
    scene(800, 130),
    scene(1_500, 70),
    // Dropouts: bridged, then too long, during motion.
    scene(300, 125),
    scene(4, 125).with(|inputs, _| inputs.rocker_angle = None),
    scene(300, 125),
    scene(30, 125).with(|inputs, _| inputs.rocker_angle = None),
    scene(900, 125),
    scene(900, 60),
    scene(900, 130),
    // A frozen angle while lifting, and one that jumps while lowering.
    scene(200, 60).with(|inputs, spoils| inputs.rocker_angle = spoils.last.rocker_angle),
    scene(900, 60),
    scene(900, 130),
    scene(900, 50),
    scene(900, 130),
    scene(100, 70),
    scene(20, 70).with(|inputs, spoils| {
        inputs.rocker_angle = Some(MilliDegree(spoils.random.i32(45_000..135_000)));
    }),
    scene(900, 130),
    scene(900, 50),
    scene(900, 120),
    // Pressure sensors come and go: the controller has to do without them.
    scene(900, 80).with(|inputs, _| set_pressures(inputs, None)),
    scene(700, 110).with(|inputs, spoils| set_pressures(inputs, Some(spoils.extreme))),
    scene(700, 80),
    // The lever is lost, then absurd.
    scene(300, 110).with(|inputs, _| inputs.lever = None),
    scene(900, 50),
    scene(900, 130),
    scene(50, 70).with(|inputs, spoils| inputs.lever = Some(MilliDegree(spoils.extreme))),
    scene(900, 50),
    scene(900, 130),
    // Everything at once.
    scene(20, 90).with(|inputs, spoils| inputs.rocker_angle = Some(MilliDegree(spoils.extreme))),
    scene(800, 50),
    scene(200, 90).with(|inputs, spoils| *inputs = all_extreme(spoils.extreme)),
    scene(200, 90).with(|inputs, _| *inputs = Inputs::default()),
    scene(900, 50),
    scene(900, 130),
    scene(1_500, 90),
];

/// The inputs of every step of the script, with the controller's own outputs moving the plant.
pub fn record() -> Trace {
    let model = hitch_model_file::dynamic();
    let rig = HitchRig {
        load_kg: 150.0,
        start_angle_rad: START_DEGREE.to_radians(),
    };
    let mut plant = Plant::new(
        &model,
        Rig::Hitch(rig),
        OIL_TEMPERATURE_C,
        Currents::default(),
    );
    let mut controller = replay::controller();
    let mut sensors = Sensors::default();
    let mut coils = [Coil::of(&model.constants().solenoid); 2];
    let mut currents = Currents::default();
    let mut trace = Trace::new();
    for scene in SCRIPT {
        for _ in 0..scene.steps {
            let inputs = sensors.read(scene, &plant, currents);
            currents = driven(&mut coils, &controller.step(&inputs));
            plant.step(currents, STEP_S);
            trace.push(inputs.to_bytes());
        }
    }
    trace
}

/// The currents of a millisecond.
fn driven(coils: &mut [Coil; 2], outputs: &Outputs) -> Currents {
    let [lift, lower] = coils;
    let share = |duty: Duty| f64::from(duty.0) * 1e-5;
    Currents {
        lift_a: lift.step(share(outputs.lift_duty), SUPPLY_V),
        lower_a: lower.step(share(outputs.lower_duty), SUPPLY_V),
    }
}

/// Lever and instruments.
struct Sensors {
    lever: i32,
    last: Inputs,
    random: fastrand::Rng,
}

impl Default for Sensors {
    fn default() -> Self {
        Self {
            lever: 90_000,
            last: Inputs::default(),
            random: fastrand::Rng::with_seed(1),
        }
    }
}

impl Sensors {
    fn read(&mut self, scene: &Scene, plant: &Plant<'_>, currents: Currents) -> Inputs {
        let way = scene.lever_degree * 1_000 - self.lever;
        self.lever += way.clamp(-LEVER_STEP_MILLIDEGREE, LEVER_STEP_MILLIDEGREE);
        let reading = plant.reading();
        let mut noisy =
            |value: f64, noise: i32| (value * 1e3).round() as i32 + self.random.i32(-noise..=noise);
        let mut inputs = Inputs {
            lever: Some(MilliDegree(self.lever)),
            jog: scene
                .jog_degree_per_second
                .map(|speed| MilliDegreePerSecond(speed * 1_000)),
            rocker_angle: Some(MilliDegree(noisy(
                reading.rocker_angle_deg,
                ANGLE_NOISE_MILLIDEGREE,
            ))),
            cylinder_pressure: Some(MilliBar(noisy(
                reading.cylinder_pressure_bar,
                PRESSURE_NOISE_MILLIBAR,
            ))),
            pump_pressure: Some(MilliBar(noisy(
                reading.pump_pressure_bar,
                PRESSURE_NOISE_MILLIBAR,
            ))),
            oil_temperature: Some(MilliCelsius(noisy(OIL_TEMPERATURE_C, 0))),
            supply: Some(MilliVolt(noisy(SUPPLY_V, 20))),
            lift_current: Some(MilliAmp(noisy(currents.lift_a, CURRENT_NOISE_MILLIAMPERE))),
            lower_current: Some(MilliAmp(noisy(currents.lower_a, CURRENT_NOISE_MILLIAMPERE))),
            step_time: Some(Microsecond(noisy(1.0, 20))),
            ..Inputs::default()
        };
        let extreme = if self.random.bool() {
            i32::MAX
        } else {
            i32::MIN
        };
        (scene.fault)(
            &mut inputs,
            Spoils {
                last: self.last,
                extreme,
                random: &mut self.random,
            },
        );
        self.last = inputs;
        inputs
    }
}

/// Both pressures with this number, or none.
fn set_pressures(inputs: &mut Inputs, millibar: Option<i32>) {
    inputs.cylinder_pressure = millibar.map(MilliBar);
    inputs.pump_pressure = millibar.map(MilliBar);
}

/// Every signal valid, and as far out as it can be coded. The enable line is healthy: its fault lasts until restart.
fn all_extreme(extreme: i32) -> Inputs {
    let mut record = [0; INPUT_BYTES];
    record.as_chunks_mut::<4>().0.fill(extreme.to_le_bytes());
    record[..4].copy_from_slice(&u32::MAX.to_le_bytes());
    Inputs {
        enable_line_fault: false,
        ..Inputs::from_bytes(&record)
    }
}
