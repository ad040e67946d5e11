//! The safety envelope alone: every row of its table, its bounds, and what holds for any inputs whatever.
//!
//! `cargo xtask mutants` changes the envelope's code in every way it knows; each change has to fail here.

mod angle;
mod any_inputs;
mod bounds;
mod button;
mod coils;
mod consent;
mod locks;
mod measuring;
mod noise_detector;
mod onset;
mod recovery;
mod release;
mod ride;
mod rows;
mod sensor_lag;
mod signals;
mod standstill;
mod travel_deficit;
mod travel_limits;

use std::sync::LazyLock;

use hitch_quantities::calibration::design_parameters::{
    LockParameters, OperatorParameters, RateParameters, RemoteParameters, SafetyParameters,
    SensorParameters,
};
use hitch_quantities::calibration::field_parameters::RideParameters;
use hitch_quantities::units::{
    Microsecond, MilliAmp, MilliDegree, MilliDegreePerSecond, MilliVolt,
};
use hitch_quantities::{Calibration, CoilCurrents, Fault, Inputs, Trip};
use hitch_safety::{Command, Envelope, Limits, MachineModel, Step};

const SAFETY: SafetyParameters = SafetyParameters::NOMINAL;
const SENSORS: SensorParameters = SensorParameters::NOMINAL;
static NOMINAL: LazyLock<Calibration> = LazyLock::new(Calibration::nominal);

fn limits() -> Limits<'static> {
    Limits {
        safety: &SAFETY,
        sensors: &SENSORS,
        lock: &LockParameters::NOMINAL,
        remote: &RemoteParameters::NOMINAL,
        ride: &RideParameters::NOMINAL,
        operator: &OperatorParameters::NOMINAL,
        rate: &RateParameters::NOMINAL,
        damaged: false,
        machine: MachineModel::of(&NOMINAL),
    }
}

/// Rocker speed of the rig below, in thousandths of a degree a millisecond: 60 degrees a second.
const FULL_SPEED: i32 = 60;

/// What is asked of the envelope.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Order {
    Rest,
    Lift(i32),
    Lower(i32),
}

impl Order {
    fn currents(self) -> CoilCurrents {
        let (lift, lower) = match self {
            Self::Rest => (0, 0),
            Self::Lift(lift) => (lift, 0),
            Self::Lower(lower) => (0, lower),
        };
        CoilCurrents {
            lift: MilliAmp(lift),
            lower: MilliAmp(lower),
        }
    }
}

/// A hitch whose coils have just what was passed, and whose angle moves as fast as told.
struct Rig {
    envelope: Envelope,
    angle: i32,
    speed: i32,
    passed: CoilCurrents,
    steps: i32,
}

impl Rig {
    /// Touched by nobody yet, at 90 degrees.
    fn new() -> Self {
        Self {
            envelope: Envelope::default(),
            angle: 90_000,
            speed: 0,
            passed: CoilCurrents::OFF,
            steps: 0,
        }
    }

    /// The lever has been moved.
    fn armed() -> Self {
        Self::armed_at(90_000)
    }

    fn armed_at(angle: i32) -> Self {
        let mut rig = Self::new();
        rig.angle = angle;
        rig.step_with(Order::Rest, |inputs| {
            inputs.lever = Some(MilliDegree(80_000))
        });
        rig.run(Order::Rest, 20);
        rig
    }

    /// At 90 degrees and full speed, with `order` on for long enough that every watch has settled.
    fn moving(order: Order) -> Self {
        const STEPS: i32 = 420;
        let speed = match order {
            Order::Lower(_) => -FULL_SPEED,
            _ => FULL_SPEED,
        };
        let mut rig = Self::armed_at(90_000 - STEPS * speed);
        rig.speed = speed;
        rig.run(order, STEPS as usize);
        assert_eq!(rig.passed, order.currents(), "full current by now");
        rig
    }

    fn inputs(&self) -> Inputs {
        // A sensor is noisy: two converter steps, to and fro.
        let noise = [0, 40, 20, -40][(self.steps % 4) as usize];
        Inputs {
            lever: Some(MilliDegree(90_000)),
            rocker_angle: Some(MilliDegree(self.angle + noise)),
            supply: Some(MilliVolt(13_800)),
            lift_current: Some(self.passed.lift),
            lower_current: Some(self.passed.lower),
            step_time: Some(Microsecond(1_000)),
            ..Inputs::default()
        }
    }

    fn step_with(&mut self, order: Order, alter: impl FnOnce(&mut Inputs)) -> CoilCurrents {
        self.step_within(limits(), order, alter)
    }

    /// One step with other limits than the nominal ones.
    fn step_within(
        &mut self,
        limits: Limits<'_>,
        order: Order,
        alter: impl FnOnce(&mut Inputs),
    ) -> CoilCurrents {
        self.angle += self.speed;
        self.steps += 1;
        let mut inputs = self.inputs();
        alter(&mut inputs);
        self.passed = pass(&mut self.envelope, Some(order.currents()), &inputs, limits);
        self.passed
    }

    fn run(&mut self, order: Order, steps: usize) -> CoilCurrents {
        (0..steps)
            .map(|_| self.step_with(order, |_| {}))
            .last()
            .unwrap_or_default()
    }

    /// Steps with a fault until both coils are off: how many, the last one included.
    fn cut_after(&mut self, order: Order, mut fault: impl FnMut(&mut Inputs, i32)) -> Option<i32> {
        let cut = (1..=500)
            .find(|&step| self.step_with(order, |inputs| fault(inputs, step)) == CoilCurrents::OFF);
        assert!(cut.is_none() || self.envelope.tripped().is_some());
        cut
    }
}

/// A step of the envelope with a command of this step, or with an old one.
fn pass(
    envelope: &mut Envelope,
    currents: Option<CoilCurrents>,
    inputs: &Inputs,
    limits: Limits<'_>,
) -> CoilCurrents {
    let command = Command {
        currents: currents.unwrap_or(LIFT.currents()),
        step: match currents {
            Some(_) => envelope.step(),
            None => Step::default(),
        },
    };
    envelope.pass(command, inputs, limits)
}

impl Rig {
    /// Steps without any fault until both coils are off.
    fn cut_after_landing(&mut self, order: Order) -> Option<i32> {
        (1..=500).find(|_| self.step_with(order, |_| {}) == CoilCurrents::OFF)
    }
}

const LIFT: Order = Order::Lift(2_500);
const LOWER: Order = Order::Lower(2_500);

/// A row: both ways, it trips after just its time; not a step earlier.
fn assert_row(trip: Trip, time: i32, fault: impl Fn(&mut Inputs, i32)) {
    for order in [LIFT, LOWER] {
        let mut rig = Rig::moving(order);
        let cut = rig.cut_after(order, &fault);
        assert_eq!(
            (cut, rig.envelope.tripped()),
            (Some(time), Some(trip)),
            "{order:?}"
        );
        assert_eq!(rig.envelope.objection(), Some(trip));
        assert_eq!(rig.run(order, 1), CoilCurrents::OFF, "stays off");
        rig.envelope.reset();
        assert_eq!(rig.envelope.tripped(), Some(trip), "still holds");
        rig.speed = 0;
        rig.run(Order::Rest, 1_000);
        let is_final = matches!(
            trip,
            Trip::CoilShort | Trip::CoilStuck | Trip::EnableLine | Trip::Memory
        );
        assert_eq!(rig.envelope.objection(), Some(trip).filter(|_| is_final));
        rig.envelope.reset();
        assert_eq!(rig.envelope.tripped(), Some(trip).filter(|_| is_final));
        assert_eq!(
            rig.run(order, 100),
            CoilCurrents::OFF,
            "nobody touched the lever"
        );
        rig.step_with(order, |inputs| inputs.lever = Some(MilliDegree(91_000)));
        assert_eq!(rig.run(order, 100) == CoilCurrents::OFF, is_final);
    }
}

/// A fault that lasts one step less than its row's time does nothing.
fn assert_bears(steps: i32, fault: impl Fn(&mut Inputs)) {
    for order in [LIFT, LOWER] {
        let mut rig = Rig::moving(order);
        for _ in 0..steps {
            assert_ne!(rig.step_with(order, &fault), CoilCurrents::OFF);
        }
        assert_ne!(rig.run(order, 100), CoilCurrents::OFF);
        assert_eq!(rig.envelope.tripped(), None);
    }
}
