//! Row 23: a current that control claims for ride damping keeps to travel band, ground speed and lever.

use hitch_quantities::calibration::field_parameters::RideParameters;
use hitch_quantities::units::{Count, MillimetrePerSecond};

use super::*;

const RIDE: RideParameters = RideParameters {
    fitted: Count(1),
    ..RideParameters::NOMINAL
};
/// Currents at the thresholds, which require no travel.
const SLOW_LIFT: Order = Order::Lift(1_200);
const SLOW_LOWER: Order = Order::Lower(1_100);
const PLACE: i32 = 90_000;
/// Beyond noise of the rig's sensor.
const CLEAR: i32 = 100;
/// The current of the first step is judged in the second.
const TIME: i32 = SAFETY.limit_time.0 + 1;

/// A hitch that rides at its place.
struct Riding {
    rig: Rig,
    limits: Limits<'static>,
}

impl Riding {
    fn new() -> Self {
        let limits = Limits {
            ride: &RIDE,
            ..limits()
        };
        let mut riding = Self {
            rig: Rig::armed_at(PLACE),
            limits,
        };
        riding.run(300, |_| {});
        assert_eq!(riding.rig.envelope.tripped(), None);
        riding
    }

    /// A claimed step at an angle, with a swing of the sensor for the watch of a frozen one.
    fn step(&mut self, order: Order, angle: i32, alter: impl FnOnce(&mut Inputs)) -> CoilCurrents {
        self.rig.envelope.claim_ride();
        self.rig.angle = angle;
        self.rig.step_within(self.limits, order, |inputs| {
            inputs.ground_speed = Some(MillimetrePerSecond(3_000));
            alter(inputs);
        })
    }

    /// Claimed steps that lift and lower in turn at the place.
    fn run(&mut self, steps: i32, alter: impl Fn(&mut Inputs)) {
        for step in 0..steps {
            let order = if step / 20 % 2 == 0 {
                SLOW_LIFT
            } else {
                SLOW_LOWER
            };
            self.step(order, PLACE + step % 7 * 10, &alter);
        }
    }

    /// Steps until the row trips, at an angle that is reached at no more than 30 degrees a second.
    fn trips(&mut self, order: Order, angle: i32, alter: impl Fn(&mut Inputs)) -> Option<i32> {
        let way = (angle - PLACE).signum();
        for step in 1..=(angle - PLACE).abs() / 30 {
            self.step(Order::Rest, PLACE + way * 30 * step, |_| {});
        }
        let tripped = (1..400).find(|step| {
            self.step(order, angle + step % 5 * 10, &alter);
            self.rig.envelope.tripped().is_some()
        });
        assert!(tripped.is_none() || self.rig.envelope.tripped() == Some(Trip::Ride));
        tripped
    }
}

// REQ-SAFE-17
#[test]
fn a_current_that_drives_the_hitch_out_of_the_band_trips() {
    let limit = RIDE.band.0 + SAFETY.limit_margin.0;
    for (order, off, time) in [
        (SLOW_LIFT, limit + CLEAR, Some(TIME)),
        (SLOW_LIFT, limit - CLEAR, None),
        (SLOW_LIFT, -limit - CLEAR, None),
        (SLOW_LOWER, -limit - CLEAR, Some(TIME)),
        (SLOW_LOWER, -limit + CLEAR, None),
        (SLOW_LOWER, limit + CLEAR, None),
        (Order::Rest, limit + CLEAR, None),
    ] {
        let tripped = Riding::new().trips(order, PLACE + off, |_| {});
        assert_eq!(tripped, time, "{order:?} at {off}");
    }
}

#[test]
fn a_new_claim_does_not_move_the_band() {
    let mut riding = Riding::new();
    let beyond = PLACE + RIDE.band.0 + SAFETY.limit_margin.0 + CLEAR;
    for step in 0..200 {
        riding.rig.angle = PLACE + (beyond - PLACE) * step / 200;
        riding
            .rig
            .step_within(riding.limits, Order::Rest, |inputs| {
                inputs.ground_speed = Some(MillimetrePerSecond(3_000));
            });
    }
    let tripped = (1..400).find(|step| {
        riding.step(SLOW_LIFT, beyond + step % 5 * 10, |_| {});
        riding.rig.envelope.tripped().is_some()
    });
    assert_eq!(
        (tripped, riding.rig.envelope.tripped()),
        (Some(TIME), Some(Trip::Ride))
    );
}

#[test]
fn the_lever_begins_another_band() {
    let mut riding = Riding::new();
    let there = PLACE + RIDE.band.0 + SAFETY.limit_margin.0 + CLEAR;
    let lever = Some(MilliDegree(there));
    for step in 0..200 {
        riding.rig.angle = PLACE + (there - PLACE) * step / 200;
        riding
            .rig
            .step_within(riding.limits, Order::Rest, |inputs| {
                inputs.ground_speed = Some(MillimetrePerSecond(3_000));
                inputs.lever = lever;
            });
    }
    for step in 0..400 {
        riding.step(SLOW_LIFT, there + step % 5 * 10, |inputs| {
            inputs.lever = lever
        });
    }
    assert_eq!(riding.rig.envelope.tripped(), None);
}

#[test]
fn a_move_of_another_kind_begins_another_band() {
    let mut riding = Riding::new();
    let there = PLACE + RIDE.band.0 + SAFETY.limit_margin.0 + CLEAR;
    for step in 0..400 {
        riding.rig.angle = PLACE + (there - PLACE) * step / 400;
        riding.rig.step_within(riding.limits, SLOW_LIFT, |inputs| {
            inputs.ground_speed = Some(MillimetrePerSecond(3_000));
        });
    }
    for step in 0..400 {
        riding.step(SLOW_LIFT, there + step % 5 * 10, |_| {});
    }
    assert_eq!(riding.rig.envelope.tripped(), None);
}

// REQ-SAFE-17
#[test]
fn a_slow_or_unknown_ground_speed_trips() {
    for (speed, time) in [
        (Some(RIDE.end_speed), None),
        (
            Some(RIDE.end_speed - MillimetrePerSecond(1)),
            Some(TIME - 1),
        ),
        // The step after the time-out is the first without a speed.
        (None, Some(TIME - 1 + RIDE.time_out.0)),
    ] {
        let mut riding = Riding::new();
        let tripped = (1..900).find(|step| {
            let order = if step / 20 % 2 == 0 {
                SLOW_LIFT
            } else {
                SLOW_LOWER
            };
            riding.step(order, PLACE + step % 7 * 10, |inputs| {
                inputs.ground_speed = speed
            });
            riding.rig.envelope.tripped().is_some()
        });
        // Of the steps in which the coils change over none has a current; each sets the count back by half.
        let late = tripped.zip(time).map(|(tripped, time)| tripped - time);
        assert_eq!(tripped.is_some(), time.is_some(), "{speed:?}");
        assert!(
            late.is_none_or(|late| (0..=12).contains(&late)),
            "{speed:?}: {tripped:?}"
        );
        assert!(tripped.is_none() || riding.rig.envelope.tripped() == Some(Trip::Ride));
    }
}

// REQ-SAFE-17
#[test]
fn the_operator_ends_it() {
    type Touch = fn(&mut Inputs);
    let touches: [(Touch, bool); 4] = [
        (
            |inputs| inputs.lever = Some(MilliDegree(90_000 + 1_501)),
            true,
        ),
        (
            |inputs| inputs.lever = Some(MilliDegree(90_000 + 1_500)),
            false,
        ),
        (
            |inputs| inputs.lever = Some(MilliDegree(90_000 - 1_501)),
            true,
        ),
        (
            |inputs| inputs.jog = Some(MilliDegreePerSecond(1_000)),
            true,
        ),
    ];
    for (touch, trips) in touches {
        let tripped = Riding::new().trips(SLOW_LIFT, PLACE, touch);
        assert_eq!(tripped.is_some(), trips);
        assert!(tripped.is_none_or(|tripped| tripped <= TIME));
    }
}

#[test]
fn a_machine_without_it_bears_no_claim_and_a_step_without_a_claim_is_free() {
    let mut riding = Riding::new();
    riding.limits.ride = &RideParameters::NOMINAL;
    assert!(riding.trips(SLOW_LIFT, PLACE, |_| {}).is_some());
    let mut rig = Rig::armed_at(PLACE);
    for step in 0..400 {
        rig.angle = PLACE + step % 5 * 10;
        rig.step_with(SLOW_LIFT, |_| {});
    }
    assert_eq!(rig.envelope.tripped(), None);
}

#[test]
fn both_coils_together_trip_as_anywhere() {
    let mut riding = Riding::new();
    riding.rig.envelope.claim_ride();
    let inputs = riding.rig.inputs();
    let both = CoilCurrents {
        lift: MilliAmp(1_000),
        lower: MilliAmp(1_000),
    };
    let passed = pass(&mut riding.rig.envelope, Some(both), &inputs, riding.limits);
    assert_eq!(passed, CoilCurrents::OFF);
    assert_eq!(riding.rig.envelope.tripped(), Some(Trip::BothCoils));
}
