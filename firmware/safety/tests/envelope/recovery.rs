//! Every fault that isn't final clears within a second of health, whatever the sensor's noise.

use hitch_quantities::units::{Count, MilliBar, PerMille};

use super::*;

/// Where the hitch stands, thousandths of a degree.
const PLACE: i32 = 90_000;

/// How long a cause lasts, ms.
const LASTING: [i32; 4] = [5, 20, 60, 500];

/// Noise of a healthy sensor at rest, a sample a step.
const NOISES: [[i32; 4]; 4] = [
    [0; 4],
    [0, 34, 0, 0],
    [0, 40, 20, -40],
    [0, 250, -100, -200],
];

/// Two tracks, so that they can disagree.
const TWO_TRACKS: SensorParameters = SensorParameters {
    second_track: Count(1),
    ..SENSORS
};

/// A number between -10 and 10 degrees that looks random.
fn scattered(step: i32) -> MilliDegree {
    MilliDegree(fastrand::Rng::with_seed(step.unsigned_abs().into()).i32(-10_000..=10_000))
}

/// What is wrong with the inputs of a step.
type Wrong = fn(&mut Inputs, i32);

fn shift(inputs: &mut Inputs, by: MilliDegree) {
    inputs.rocker_angle = inputs.rocker_angle.map(|angle| angle + by);
}

/// Causes with a row that they trip, at one of the orders and times at least.
const CAUSES: [(&str, Trip, Wrong); 22] = [
    ("no command", Trip::Stale, |_, _| {}),
    ("both coils", Trip::BothCoils, |_, _| {}),
    ("late", Trip::Overrun, |inputs, _| {
        inputs.step_time = Some(Microsecond(4_000));
    }),
    ("supply", Trip::Supply, |inputs, _| {
        inputs.supply = Some(MilliVolt(5_000));
    }),
    ("lever", Trip::Lever, |inputs, _| inputs.lever = None),
    ("missing", Trip::AngleMissing, |inputs, _| {
        inputs.rocker_angle = None;
    }),
    ("both sensors missing", Trip::Lever, |inputs, _| {
        (inputs.lever, inputs.rocker_angle) = (None, None);
    }),
    ("jumps", Trip::AngleJumps, |inputs, _| {
        shift(inputs, MilliDegree(8_000));
    }),
    ("erratic", Trip::AngleJumps, |inputs, step| {
        shift(inputs, scattered(step));
    }),
    ("frozen", Trip::AngleFrozen, |inputs, _| {
        inputs.rocker_angle = Some(MilliDegree(PLACE));
    }),
    ("vibrates", Trip::AngleNoisy, |inputs, step| {
        shift(inputs, MilliDegree(step % 2 * 600 - 300));
    }),
    ("sticks", Trip::NotFollowing, |inputs, step| {
        shift(inputs, MilliDegree(step % 2 * 20));
    }),
    ("rises", Trip::Against, |inputs, step| {
        shift(inputs, MilliDegree(step * 20));
    }),
    ("falls", Trip::Against, |inputs, step| {
        shift(inputs, MilliDegree(step * -20));
    }),
    ("open coil", Trip::CoilOpen, |inputs, _| {
        (inputs.lift_current, inputs.lower_current) = (Some(MilliAmp(0)), Some(MilliAmp(0)));
    }),
    ("reference", Trip::Reference, |inputs, _| {
        inputs.reference = Some(PerMille(900));
    }),
    ("sensor supply", Trip::SensorSupply, |inputs, _| {
        inputs.sensor_supply = Some(MilliVolt(4_000));
    }),
    ("tracks", Trip::AngleTracks, |inputs, _| {
        inputs.second_angle = Some(MilliDegree(PLACE + 5_000));
    }),
    ("clock", Trip::Clock, |inputs, _| {
        inputs.clock_ratio = Some(PerMille(500));
    }),
    ("dial shut", Trip::BeyondLimit, |inputs, _| {
        inputs.lowering_dial = Some(PerMille(0));
    }),
    ("ride without a speed", Trip::Ride, |_, _| {}),
    ("no consent", Trip::NoConsent, |inputs, _| {
        inputs.set_point = Some(MilliDegree(PLACE));
    }),
];

/// A hitch that hangs at its place and doesn't move.
struct Bench {
    rig: Rig,
    limits: Limits<'static>,
    noise: [i32; 4],
}

impl Bench {
    fn new(trip: Trip, noise: [i32; 4]) -> Self {
        let sensors = match trip {
            Trip::AngleTracks => &TWO_TRACKS,
            _ => &SENSORS,
        };
        Self {
            rig: Rig::armed_at(PLACE),
            limits: Limits {
                sensors,
                ..limits()
            },
            noise,
        }
    }

    fn inputs(&self, step: i32) -> Inputs {
        let noise = self.noise[step.unsigned_abs() as usize % 4];
        let angle = Some(MilliDegree(PLACE + noise));
        Inputs {
            rocker_angle: angle,
            second_angle: angle,
            cylinder_pressure: Some(MilliBar(15_000)),
            ..self.rig.inputs()
        }
    }

    fn step(&mut self, currents: Option<CoilCurrents>, inputs: &Inputs) {
        self.rig.passed = pass(&mut self.rig.envelope, currents, inputs, self.limits);
    }

    /// The cause lasts for some steps.
    fn suffer(&mut self, trip: Trip, wrong: Wrong, order: Order, lasts: i32) {
        for step in 0..lasts {
            let mut inputs = self.inputs(step);
            wrong(&mut inputs, step);
            let currents = match trip {
                Trip::Stale => None,
                Trip::BothCoils => Some(CoilCurrents {
                    lift: MilliAmp(1_500),
                    lower: MilliAmp(1_500),
                }),
                _ => Some(order.currents()),
            };
            if trip == Trip::Ride {
                self.rig.envelope.claim_ride();
            }
            self.step(currents, &inputs);
        }
    }

    fn rest(&mut self, step: i32) {
        let inputs = self.inputs(step);
        self.step(Some(CoilCurrents::OFF), &inputs);
    }
}

#[test]
fn every_row_that_is_not_final_has_a_cause() {
    for trip in Trip::ALL {
        let listed = CAUSES.iter().any(|(_, row, _)| *row == trip);
        assert_eq!(listed, !trip.is_final(), "{trip:?}");
    }
}

#[test]
fn a_fault_is_over_within_a_second_of_health() {
    for (name, trip, wrong) in CAUSES {
        let mut tripped = false;
        for noise in NOISES {
            for order in [Order::Rest, LIFT, LOWER] {
                for lasts in LASTING {
                    let mut bench = Bench::new(trip, noise);
                    bench.suffer(trip, wrong, order, lasts);
                    tripped |= bench.rig.envelope.tripped() == Some(trip);
                    let case = format!("{name} for {lasts} ms at {order:?} with {noise:?}");
                    (0..1_000).for_each(|step| bench.rest(step));
                    assert_eq!(bench.rig.envelope.objection(), None, "{case}");
                    for step in 0..1_000 {
                        bench.rig.envelope.reset();
                        bench.rest(step);
                        assert_eq!(
                            bench.rig.envelope.tripped(),
                            None,
                            "{case}, {step} ms later"
                        );
                    }
                }
            }
        }
        assert!(tripped, "{name} trips {trip:?}");
    }
}
