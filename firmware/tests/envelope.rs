//! The safety envelope alone: every row of its table, its bounds, and what holds for any inputs whatever.
//!
//! `cargo xtask mutants` changes the envelope's code in every way it knows; each change has to fail here.

use hitch_firmware::control::design_parameters::{SafetyParameters, SensorParameters};
use hitch_firmware::control::safety::{CoilCurrents, Envelope, Limits, Trip};
use hitch_firmware::control::units::{
    Microsecond, MilliAmp, MilliDegree, MilliDegreePerSecond, MilliVolt,
};
use hitch_firmware::control::{Fault, Inputs};

const SAFETY: SafetyParameters = SafetyParameters::NOMINAL;
const SENSORS: SensorParameters = SensorParameters::NOMINAL;
const LIMITS: Limits<'static> = Limits {
    safety: &SAFETY,
    sensors: &SENSORS,
};
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
        self.angle += self.speed;
        self.steps += 1;
        let mut inputs = self.inputs();
        alter(&mut inputs);
        self.passed = self.envelope.pass(Some(order.currents()), &inputs, LIMITS);
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
        let is_final = matches!(trip, Trip::CoilShort | Trip::CoilStuck);
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

#[test]
fn row_1_a_stale_command() {
    let mut rig = Rig::moving(LIFT);
    let silent = |rig: &mut Rig| {
        let inputs = rig.inputs();
        rig.envelope.pass(None, &inputs, LIMITS)
    };
    for step in 1..SAFETY.command_age.0 {
        assert_eq!(
            silent(&mut rig),
            CoilCurrents::OFF,
            "no command, no current"
        );
        assert_eq!(rig.envelope.tripped(), None, "step {step}");
    }
    silent(&mut rig);
    assert_eq!(rig.envelope.tripped(), Some(Trip::Stale));
    assert_eq!(rig.run(LIFT, 5), CoilCurrents::OFF);
}

#[test]
fn row_2_both_coils() {
    for (lift, lower, trips) in [
        (1, 1, true),
        (1, 0, false),
        (0, 1, false),
        (2_500, 2_500, true),
        (-1, 1, false),
    ] {
        let mut rig = Rig::armed();
        let command = CoilCurrents {
            lift: MilliAmp(lift),
            lower: MilliAmp(lower),
        };
        let passed = rig.envelope.pass(Some(command), &rig.inputs(), LIMITS);
        assert_eq!(
            rig.envelope.tripped(),
            trips.then_some(Trip::BothCoils),
            "{command:?}"
        );
        assert_eq!(passed == CoilCurrents::OFF, trips, "{command:?}");
    }
}

#[test]
fn row_3_overrun() {
    assert_row(Trip::Overrun, 2, |inputs, _| {
        inputs.step_time = Some(Microsecond(1_501))
    });
    assert_bears(500, |inputs| inputs.step_time = Some(Microsecond(1_500)));
    assert_bears(500, |inputs| inputs.step_time = None);
}

#[test]
fn row_4_supply() {
    for volt in [7_999, 16_801, i32::MIN, i32::MAX] {
        assert_row(Trip::Supply, 10, |inputs, _| {
            inputs.supply = Some(MilliVolt(volt))
        });
    }
    for volt in [8_000, 16_800] {
        assert_bears(500, |inputs| inputs.supply = Some(MilliVolt(volt)));
    }
    assert_bears(9, |inputs| inputs.supply = Some(MilliVolt(6_000)));
    assert_bears(500, |inputs| inputs.supply = None);
}

#[test]
fn row_5_lever() {
    for lever in [
        None,
        Some(29_999),
        Some(150_001),
        Some(i32::MIN),
        Some(i32::MAX),
    ] {
        assert_row(Trip::Lever, 5, |inputs, _| {
            inputs.lever = lever.map(MilliDegree)
        });
    }
    for lever in [30_000, 150_000] {
        assert_bears(500, |inputs| inputs.lever = Some(MilliDegree(lever)));
    }
    assert_bears(4, |inputs| inputs.lever = None);
}

#[test]
fn row_6_angle_missing_or_out_of_range() {
    for angle in [
        None,
        Some(39_999),
        Some(140_001),
        Some(i32::MIN),
        Some(i32::MAX),
    ] {
        assert_row(Trip::AngleMissing, 5, |inputs, _| {
            inputs.rocker_angle = angle.map(MilliDegree)
        });
    }
    assert_bears(4, |inputs| inputs.rocker_angle = None);
}

#[test]
fn the_range_of_the_angle_includes_its_ends() {
    for (end, speed) in [(40_000, 0), (140_000, 0)] {
        let mut rig = Rig::armed();
        rig.envelope = Envelope::default();
        rig.speed = speed;
        for _ in 0..100 {
            rig.step_with(Order::Rest, |inputs| {
                inputs.rocker_angle = Some(MilliDegree(end))
            });
        }
        assert_eq!(rig.envelope.tripped(), None, "{end}");
    }
}

#[test]
fn row_7_angle_jumps() {
    for jump in [5_000, -5_000, 30_000, -30_000, 1_500, -1_500] {
        assert_row(Trip::AngleJumps, 5, |inputs, _| {
            inputs.rocker_angle = inputs.rocker_angle.map(|angle| angle + MilliDegree(jump));
        });
    }
    assert_bears(4, |inputs| {
        inputs.rocker_angle = inputs.rocker_angle.map(|angle| angle + MilliDegree(5_000));
    });
}

#[test]
fn a_jump_is_more_than_a_degree_from_the_last_good_sample() {
    for (jump, trips) in [
        (1_000, false),
        (1_001, true),
        (-1_000, false),
        (-1_001, true),
    ] {
        let mut rig = Rig::new();
        let mut at = |angle| {
            rig.step_with(Order::Rest, |inputs| {
                inputs.rocker_angle = Some(MilliDegree(angle))
            });
        };
        (0..20).for_each(|_| at(90_000));
        (0..6).for_each(|_| at(90_000 + jump));
        assert_eq!(
            rig.envelope.tripped(),
            trips.then_some(Trip::AngleJumps),
            "{jump}"
        );
    }
}

#[test]
fn what_comes_and_goes_trips_too() {
    let mut rig = Rig::moving(LIFT);
    let cut = rig.cut_after(LIFT, |inputs, step| {
        if step % 2 == 1 {
            inputs.rocker_angle = None;
        }
    });
    // One up and, net, one more every two steps: 2 + 8 * 1 counts to ten.
    assert_eq!(
        (cut, rig.envelope.tripped()),
        (Some(17), Some(Trip::AngleMissing))
    );
    let mut rig = Rig::moving(LIFT);
    let cut = rig.cut_after(LIFT, |inputs, step| {
        if step % 3 == 0 {
            inputs.rocker_angle = None;
        }
    });
    assert_eq!(cut, None, "a third of the samples may be missing");
}

#[test]
fn row_8_a_frozen_angle() {
    let held = std::cell::Cell::new(None);
    for (order, speed) in [
        (LIFT, 100),
        (LOWER, 100),
        (LIFT, 50),
        (LOWER, 50),
        (LIFT, 25),
    ] {
        let mut rig = Rig::moving(order);
        rig.speed = speed * rig.speed.signum();
        rig.run(order, 40);
        held.set(None);
        let cut = rig.cut_after(order, |inputs, _| {
            held.set(held.get().or(inputs.rocker_angle));
            inputs.rocker_angle = held.get();
        });
        assert_eq!(
            rig.envelope.tripped(),
            Some(Trip::AngleFrozen),
            "{order:?} at {speed}"
        );
        // The first frozen sample is a true one.
        let travel = (cut.unwrap_or(1_000) - 1) * speed;
        assert!(
            (700..=1_100).contains(&travel),
            "{order:?} at {speed}: {travel} mdeg in {cut:?}"
        );
    }
}

#[test]
fn a_frozen_angle_takes_its_time_and_its_travel() {
    let frozen_after = |speed: i32| {
        let mut rig = Rig::moving(LIFT);
        // Without noise, so that the speed is exactly known.
        let mut angle = rig.angle;
        for _ in 0..40 {
            angle += speed;
            rig.step_with(LIFT, |inputs| {
                inputs.rocker_angle = Some(MilliDegree(angle))
            });
        }
        (1..=200).find(|_| {
            rig.step_with(LIFT, |inputs| {
                inputs.rocker_angle = Some(MilliDegree(angle))
            }) == CoilCurrents::OFF
        })
    };
    assert_eq!(frozen_after(200), Some(8), "time decides");
    assert_eq!(frozen_after(75), Some(10), "travel decides");
    assert_eq!(frozen_after(30), Some(25));
}

#[test]
fn a_slow_hitch_may_stick_and_a_slowed_one_may_stop() {
    let freezes = |make: fn(i32) -> Order, way: i32, speed: i32, current: i32| {
        let mut rig = Rig::armed();
        let mut angle = rig.angle;
        for step in 0..300 {
            angle += if step < 200 { speed * way } else { 0 };
            let order = make(if step < 200 { 2_500 } else { current });
            rig.step_with(order, |inputs| {
                inputs.rocker_angle = Some(MilliDegree(angle));
            });
        }
        rig.envelope.tripped() == Some(Trip::AngleFrozen)
    };
    for (make, way) in [(Order::Lift as fn(i32) -> Order, 1), (Order::Lower, -1)] {
        assert!(freezes(make, way, 15, 2_500) && freezes(make, way, 15, 2_450));
        assert!(!freezes(make, way, 14, 2_500), "sticks");
        assert!(!freezes(make, way, 15, 2_449), "was slowed down");
    }
}

#[test]
fn a_resting_sensor_may_be_as_still_as_it_likes() {
    let mut rig = Rig::moving(LIFT);
    let angle = rig.angle;
    let mut still = |order| {
        rig.step_with(order, |inputs| {
            inputs.rocker_angle = Some(MilliDegree(angle))
        })
    };
    (0..2_000).for_each(|_| {
        still(Order::Rest);
    });
    // ... and a stop that was abrupt is no reason to refuse the next start.
    for _ in 0..2_000 {
        still(LIFT);
    }
    assert_eq!(rig.envelope.tripped(), None);
}

#[test]
fn row_9_a_noisy_angle() {
    let noisy_after = |noise: i32| {
        let mut rig = Rig::moving(LIFT);
        rig.cut_after(LIFT, |inputs, step| {
            let sign = if step % 2 == 0 { noise } else { -noise };
            inputs.rocker_angle = inputs.rocker_angle.map(|angle| angle + MilliDegree(sign));
        })
    };
    // The second difference is four times the amplitude, and the rig has noise of its own.
    assert_eq!(noisy_after(125), None);
    assert_eq!(noisy_after(400), Some(23));
    let mut rig = Rig::moving(LIFT);
    let _ = rig.cut_after(LIFT, |inputs, step| {
        let sign = if step % 2 == 0 { 300 } else { -300 };
        inputs.rocker_angle = inputs.rocker_angle.map(|angle| angle + MilliDegree(sign));
    });
    assert_eq!(rig.envelope.tripped(), Some(Trip::AngleNoisy));
}

#[test]
fn noise_at_its_limit_is_borne() {
    for (amplitude, trips) in [(150, false), (151, true)] {
        let mut rig = Rig::new();
        for step in 0..2_000 {
            rig.step_with(Order::Rest, |inputs| {
                inputs.rocker_angle = Some(MilliDegree(90_000 + (step % 2 * 2 - 1) * amplitude));
            });
        }
        let trip = trips.then_some(Trip::AngleNoisy);
        assert_eq!(rig.envelope.tripped(), trip, "{amplitude}");
    }
}

#[test]
fn row_10_a_hitch_that_stops_at_an_unchanged_current() {
    for order in [LIFT, LOWER] {
        let mut rig = Rig::moving(order);
        rig.speed = 0;
        let cut = rig.cut_after(order, |_, _| {});
        assert_eq!(rig.envelope.tripped(), Some(Trip::NotFollowing));
        // 50 ms, and as long as the measured speed takes to fall to an eighth; noise makes a step of difference.
        assert!(matches!(cut, Some(60..=64)), "{order:?}: {cut:?}");
    }
}

#[test]
fn a_hitch_may_get_slower_for_less_current_or_by_less_than_seven_eighths() {
    let stops = |speed: i32, current: i32| {
        let mut rig = Rig::moving(LIFT);
        rig.speed = speed;
        rig.cut_after(Order::Lift(current), |_, _| {}).is_some()
    };
    assert!(stops(0, 2_500) && stops(0, 2_400) && stops(5, 2_500));
    assert!(
        !stops(20, 2_500),
        "more than a quarter of the speed is left"
    );
    assert!(!stops(0, 2_399), "the current was reduced");
}

/// Without noise: `fast` steps at 80 mdeg/ms, of which the first `before` at a larger current, then at `slow`.
fn slowed(before: i32, fast: i32, slow: i32) -> Option<Trip> {
    let mut rig = Rig::armed_at(60_000);
    let mut angle = rig.angle;
    for step in 0..fast + 300 {
        angle += if step < fast { 80 } else { slow };
        let order = Order::Lift(if step < before { 2_601 } else { 2_500 });
        rig.step_with(order, |inputs| {
            inputs.rocker_angle = Some(MilliDegree(angle));
        });
    }
    rig.envelope.tripped()
}

#[test]
fn an_eighth_of_the_speed_is_enough() {
    assert_eq!(slowed(0, 450, 10), None);
    assert_eq!(slowed(0, 450, 9), Some(Trip::NotFollowing));
}

#[test]
fn a_hitch_has_its_time_to_follow_a_reduced_current() {
    let unnoticed = (200..400).filter(|&after| slowed(150, 150 + after, 5).is_none());
    // 300 ms, less half of the span over which the speed is measured.
    assert_eq!(unnoticed.max(), Some(293));
}

#[test]
fn a_hitch_that_never_moved_has_not_stopped() {
    let slow = |speed: i32| {
        let mut rig = Rig::armed();
        rig.speed = speed;
        rig.run(LIFT, 450);
        rig.speed = 0;
        rig.run(LIFT, 300);
        rig.envelope.tripped()
    };
    assert_eq!(
        slow(0),
        None,
        "stuck: that is for the controller to try again"
    );
    assert_eq!(slow(30), None, "too slow to tell");
    assert_eq!(slow(45), Some(Trip::NotFollowing));
}

#[test]
fn row_11_movement_against_the_coil() {
    for (order, way) in [(LIFT, -1), (LOWER, 1)] {
        let mut rig = Rig::armed();
        rig.speed = 0;
        rig.run(order, 1);
        let start = rig.angle;
        rig.speed = 20 * way;
        let _ = rig.cut_after(order, |_, _| {});
        let back = (rig.angle - start).abs();
        assert_eq!(rig.envelope.tripped(), Some(Trip::Against));
        assert!((3_900..=4_100).contains(&back), "{order:?}: {back} mdeg");
    }
}

#[test]
fn against_is_counted_from_the_furthest_point_of_one_stroke() {
    let mut rig = Rig::armed();
    let mut at = |order, angle| {
        rig.step_with(order, |inputs| {
            inputs.rocker_angle = Some(MilliDegree(angle))
        })
    };
    for angle in (90_000..100_000).step_by(20) {
        at(Order::Lift(1_200), angle);
    }
    for angle in (95_980..=99_960).rev().step_by(20) {
        assert_ne!(at(Order::Lift(1_200), angle), CoilCurrents::OFF, "{angle}");
    }
    // 4 degrees back are allowed; a rest, and they are allowed anew.
    at(Order::Rest, 95_980);
    for angle in (91_960..=95_960).rev().step_by(20) {
        assert_ne!(at(Order::Lift(1_200), angle), CoilCurrents::OFF, "{angle}");
    }
    assert_eq!(at(Order::Lift(1_200), 91_939), CoilCurrents::OFF);
    assert_eq!(rig.envelope.tripped(), Some(Trip::Against));
}

#[test]
fn row_12_an_open_coil() {
    let half_less = |current: Option<MilliAmp>, by| current.map(|asked| MilliAmp(asked.0 / 2 - by));
    assert_row(Trip::CoilOpen, 40, |inputs, _| {
        inputs.lift_current = half_less(inputs.lift_current, 1);
        inputs.lower_current = half_less(inputs.lower_current, 1);
    });
    assert_bears(500, |inputs| {
        inputs.lift_current = half_less(inputs.lift_current, 0);
        inputs.lower_current = half_less(inputs.lower_current, 0);
    });
    assert_bears(39, |inputs| {
        inputs.lift_current = Some(MilliAmp(0));
        inputs.lower_current = Some(MilliAmp(0));
    });
    for (asked, trips) in [(500, true), (499, false)] {
        let mut rig = Rig::armed();
        let cut = rig.cut_after(Order::Lift(asked), |inputs, _| {
            inputs.lift_current = Some(MilliAmp(0))
        });
        assert_eq!(cut.is_some(), trips, "{asked} mA");
    }
}

#[test]
fn row_13_a_shorted_coil() {
    let more = |current: Option<MilliAmp>, by| {
        current
            .filter(|asked| asked.0 > 0)
            .map(|asked| MilliAmp(asked.0 + by))
    };
    assert_row(Trip::CoilShort, 10, |inputs, _| {
        inputs.lift_current = more(inputs.lift_current, 501);
        inputs.lower_current = more(inputs.lower_current, 501);
    });
    assert_bears(500, |inputs| {
        inputs.lift_current = more(inputs.lift_current, 500);
        inputs.lower_current = more(inputs.lower_current, 500);
    });
    assert_bears(9, |inputs| {
        inputs.lift_current = more(inputs.lift_current, 2_000);
        inputs.lower_current = more(inputs.lower_current, 2_000);
    });
}

#[test]
fn row_14_a_stuck_driver() {
    for order in [LIFT, LOWER] {
        for (left, expected) in [(200, None), (201, Some(40))] {
            let mut rig = Rig::moving(order);
            rig.speed = 0;
            // The current of the last step is still the one that was asked for.
            rig.step_with(Order::Rest, |_| {});
            let after = (1..=500).find(|_| {
                rig.step_with(Order::Rest, |inputs| match order {
                    Order::Lower(_) => inputs.lower_current = Some(MilliAmp(left)),
                    _ => inputs.lift_current = Some(MilliAmp(left)),
                });
                rig.envelope.tripped() == Some(Trip::CoilStuck)
            });
            // 30 ms for the current to decay, and 10 to be sure; the first of both is one step.
            assert_eq!(after, expected.map(|steps| steps - 1), "{order:?}");
            rig.run(Order::Rest, 1_000);
            rig.envelope.reset();
            let objection = expected.map(|_| Trip::CoilStuck);
            assert_eq!(
                rig.envelope.objection(),
                objection,
                "only a restart clears it"
            );
        }
    }
}

#[test]
fn a_driver_that_switches_itself_on_is_noticed_sooner() {
    let mut rig = Rig::armed();
    rig.run(Order::Rest, 100);
    let after = (1..=500).find(|_| {
        rig.step_with(Order::Rest, |inputs| {
            inputs.lower_current = Some(MilliAmp(3_000))
        });
        rig.envelope.tripped() == Some(Trip::CoilStuck)
    });
    assert_eq!(after, Some(10));
}

#[test]
fn a_trembling_sensor_that_falls_still_is_frozen_also_at_rest() {
    let still_after = |noise: [i32; 4]| {
        let mut rig = Rig::armed();
        for step in 0..2_000 {
            rig.step_with(Order::Rest, |inputs| {
                inputs.rocker_angle = Some(MilliDegree(90_000 + noise[step % 4]));
            });
        }
        (1..=500).find(|_| {
            rig.step_with(Order::Rest, |inputs| {
                inputs.rocker_angle = Some(MilliDegree(91_000))
            });
            rig.envelope.tripped() == Some(Trip::AngleFrozen)
        })
    };
    assert_eq!(
        still_after([0, 40, -20, 20]),
        Some(21),
        "the first one is a step"
    );
    assert_eq!(still_after([0; 4]), None, "it never trembled");
    assert_eq!(
        still_after([0, 20, 40, 60]),
        None,
        "two steps on for one back is motion"
    );
}

#[test]
fn a_sensor_is_known_to_tremble_after_so_many_steps() {
    let mut known_after = None;
    for steps in (0..400).step_by(10) {
        let mut rig = Rig::armed();
        rig.envelope = Envelope::default();
        let mut at = |angle| {
            rig.step_with(Order::Rest, |inputs| {
                inputs.rocker_angle = Some(MilliDegree(angle))
            });
        };
        (0..steps).for_each(|step| at(90_000 + step % 2 * 20));
        (0..30).for_each(|_| at(90_500));
        if rig.envelope.tripped() == Some(Trip::AngleFrozen) {
            known_after = known_after.or(Some(steps));
        }
    }
    assert_eq!(known_after, Some(60));
}

#[test]
fn a_sensor_coarser_than_its_noise_may_stand_still() {
    // Trembles wherever it rests near a step of the converter: every other sample is like the last one.
    let mut rig = Rig::armed();
    for step in 0..20_000 {
        rig.step_with(Order::Rest, |inputs| {
            inputs.rocker_angle = Some(MilliDegree(90_000 + step / 2 % 2 * 50));
        });
    }
    // ... and not between two steps.
    for _ in 0..20_000 {
        rig.step_with(Order::Rest, |inputs| {
            inputs.rocker_angle = Some(MilliDegree(90_100));
        });
    }
    assert_eq!(rig.envelope.tripped(), None);
}

#[test]
fn a_worse_trip_replaces_the_first_and_no_other_does() {
    let mut rig = Rig::moving(LIFT);
    rig.cut_after(LIFT, |inputs, _| inputs.lever = None);
    rig.cut_after(LIFT, |inputs, _| inputs.supply = Some(MilliVolt(0)));
    (0..30).for_each(|_| {
        rig.step_with(LIFT, |inputs| inputs.supply = Some(MilliVolt(0)));
    });
    assert_eq!(rig.envelope.tripped(), Some(Trip::Lever));
    for _ in 0..100 {
        rig.step_with(LIFT, |inputs| inputs.lower_current = Some(MilliAmp(1_000)));
    }
    assert_eq!(rig.envelope.tripped(), Some(Trip::CoilStuck));
    for _ in 0..100 {
        rig.step_with(LIFT, |inputs| inputs.lever = None);
    }
    assert_eq!(rig.envelope.tripped(), Some(Trip::CoilStuck));
}

#[test]
fn every_trip_is_reported_as_a_fault_of_its_kind() {
    let faults = Trip::ALL.map(Trip::fault);
    assert_eq!(
        faults,
        [
            Fault::Envelope,
            Fault::Envelope,
            Fault::Overrun,
            Fault::Supply,
            Fault::Lever,
            Fault::Angle,
            Fault::Angle,
            Fault::Angle,
            Fault::Angle,
            Fault::NotFollowing,
            Fault::Envelope,
            Fault::Coil,
            Fault::Coil,
            Fault::Coil,
        ]
    );
    assert_eq!(
        Trip::ALL.map(|trip| trip as usize),
        [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14]
    );
}

#[test]
fn nothing_passes_until_lever_or_button_is_touched() {
    let mut rig = Rig::new();
    assert_eq!(rig.run(LIFT, 5_000), CoilCurrents::OFF);
    let with_lever = |rig: &mut Rig, lever: i32| {
        rig.step_with(LIFT, |inputs| inputs.lever = Some(MilliDegree(lever)))
    };
    assert_eq!(with_lever(&mut rig, 90_349), CoilCurrents::OFF, "noise");
    assert_eq!(with_lever(&mut rig, 89_651), CoilCurrents::OFF, "noise");
    assert_ne!(with_lever(&mut rig, 89_650), CoilCurrents::OFF);
    assert_ne!(rig.run(LIFT, 100), CoilCurrents::OFF, "once is enough");
    let mut rig = Rig::new();
    let pressed = |inputs: &mut Inputs| inputs.jog = Some(MilliDegreePerSecond(1));
    for _ in 0..100 {
        assert_eq!(
            rig.step_with(LIFT, pressed),
            CoilCurrents::OFF,
            "pressed since power-up"
        );
    }
    assert_eq!(rig.run(LIFT, 10), CoilCurrents::OFF, "released");
    assert_ne!(rig.step_with(LIFT, pressed), CoilCurrents::OFF);
}

#[test]
fn currents_rise_along_the_slope_and_fall_at_once() {
    for full in [Order::Lift(3_500), Order::Lower(3_500)] {
        let mut rig = Rig::armed();
        let sum = |passed: CoilCurrents| passed.lift.0 + passed.lower.0;
        let rise: Vec<i32> = (0..60).map(|_| sum(rig.run(full, 1))).collect();
        assert_eq!(rise[..3], [1_540, 1_580, 1_620]);
        assert_eq!(rise[59], 3_500);
        assert_eq!(rig.run(Order::Rest, 1), CoilCurrents::OFF);
    }
}

#[test]
fn limits_bound_each_coil_by_its_own() {
    let safety = SafetyParameters {
        lift_current_limit: MilliAmp(1_000),
        lower_current_limit: MilliAmp(900),
        ..SAFETY
    };
    let limits = Limits {
        safety: &safety,
        sensors: &SENSORS,
    };
    for (order, most) in [
        (Order::Lift(i32::MAX), (1_000, 0)),
        (Order::Lower(i32::MAX), (0, 900)),
        (Order::Lift(i32::MIN), (0, 0)),
    ] {
        let mut rig = Rig::armed();
        let passed = rig
            .envelope
            .pass(Some(order.currents()), &rig.inputs(), limits);
        assert_eq!((passed.lift.0, passed.lower.0), most);
    }
}

#[test]
fn a_change_of_coil_takes_a_step_with_both_off() {
    for (one, other) in [(LIFT, LOWER), (LOWER, LIFT)] {
        let mut rig = Rig::armed();
        assert_ne!(rig.run(one, 3), CoilCurrents::OFF);
        assert_eq!(rig.run(other, 1), CoilCurrents::OFF);
        assert_ne!(rig.run(other, 1), CoilCurrents::OFF);
    }
}

/// Signals that stay, wander, jump, stop or go missing at random.
fn random_inputs(random: &mut Random, inputs: &mut Inputs) {
    fn changed<T>(
        random: &mut Random,
        value: &mut Option<T>,
        low: i32,
        high: i32,
        make: fn(i32) -> T,
    ) {
        match random.below(6_000) {
            0 => *value = None,
            1 => *value = Some(make(random.any())),
            2..=5 => *value = Some(make(low + random.below(high - low))),
            _ => {}
        }
    }
    changed(random, &mut inputs.lever, 40_000, 140_000, MilliDegree);
    changed(
        random,
        &mut inputs.rocker_angle,
        44_000,
        136_000,
        MilliDegree,
    );
    changed(random, &mut inputs.supply, 8_000, 16_000, MilliVolt);
    changed(random, &mut inputs.step_time, 900, 1_100, Microsecond);
    changed(random, &mut inputs.lift_current, 0, 3_500, MilliAmp);
    changed(random, &mut inputs.lower_current, 0, 3_500, MilliAmp);
    changed(
        random,
        &mut inputs.jog,
        -10_000,
        10_000,
        MilliDegreePerSecond,
    );
    if random.below(100) == 0 {
        inputs.lever = inputs
            .lever
            .map(|_| MilliDegree(40_000 + random.below(100_000)));
    }
    let wander = MilliDegree(random.below(101) - 50);
    inputs.rocker_angle = inputs.rocker_angle.map(|angle| angle + wander);
}

/// Xorshift: the same sequence everywhere.
struct Random(u64);

impl Random {
    fn any(&mut self) -> i32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 32) as i32
    }

    fn below(&mut self, limit: i32) -> i32 {
        self.any().rem_euclid(limit.max(1))
    }

    fn command(&mut self) -> Option<CoilCurrents> {
        let current =
            |random: &mut Self| [0, 0, random.below(4_000), random.any()][random.below(4) as usize];
        match self.below(400) {
            0 => None,
            1..=199 => Some(Order::Lift(self.below(3_500)).currents()),
            200..=398 => Some(Order::Lower(self.below(3_500)).currents()),
            _ => Some(CoilCurrents {
                lift: MilliAmp(current(self)),
                lower: MilliAmp(current(self)),
            }),
        }
    }
}

#[test]
fn whatever_happens_no_current_passes_that_must_not() {
    const SEQUENCES: u64 = 4_000;
    const STEPS: usize = 1_500;
    let mut on = 0_u64;
    for seed in 1..=SEQUENCES {
        let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15));
        let (mut rig, mut last) = (Rig::new(), CoilCurrents::OFF);
        let mut inputs = rig.inputs();
        let first_lever = inputs.lever;
        let (mut touched, mut command) = (false, None);
        let (mut no_angle, mut no_lever) = (0, 0);
        for _ in 0..STEPS {
            random_inputs(&mut random, &mut inputs);
            if random.below(8) == 0 {
                command = random.command();
            }
            let was_tripped = rig.envelope.tripped().is_some();
            let passed = rig.envelope.pass(command, &inputs, LIMITS);
            touched |= inputs.lever != first_lever || inputs.jog.is_some();
            let both = passed.lift > MilliAmp(0) && passed.lower > MilliAmp(0);
            assert!(
                !both && passed.lift >= MilliAmp(0) && passed.lower >= MilliAmp(0),
                "seed {seed}: {passed:?}"
            );
            assert!(
                passed.lift <= SAFETY.lift_current_limit
                    && passed.lower <= SAFETY.lower_current_limit
            );
            let count = |missing: bool, count: i32| if missing { count + 1 } else { 0 };
            no_angle = count(inputs.rocker_angle.is_none(), no_angle);
            no_lever = count(inputs.lever.is_none(), no_lever);
            let sensed = no_angle < 5 && no_lever < 5;
            let may = command.is_some() && touched && rig.envelope.tripped().is_none() && sensed;
            assert!(
                may || passed == CoilCurrents::OFF,
                "seed {seed}: {passed:?} of {command:?} with {inputs:?}"
            );
            assert!(
                !was_tripped || rig.envelope.tripped().is_some(),
                "seed {seed}: cleared by itself"
            );
            let asked = command.unwrap_or_default();
            assert!(
                passed.lift <= asked.lift.max(MilliAmp(0))
                    && passed.lower <= asked.lower.max(MilliAmp(0))
            );
            let crossed =
                (last.lift.0 > 0 && passed.lower.0 > 0) || (last.lower.0 > 0 && passed.lift.0 > 0);
            assert!(!crossed, "seed {seed}: from {last:?} to {passed:?}");
            on += u64::from(passed != CoilCurrents::OFF);
            last = passed;
            if random.below(10) == 0 && was_tripped {
                rig.envelope.reset();
                if rig.envelope.tripped().is_none() && was_tripped {
                    touched = false;
                    inputs.jog = None;
                    // Armed anew by a movement from where the lever is now.
                    touched |= inputs.lever != first_lever;
                }
            }
        }
    }
    println!(
        "{} steps, a coil on in {on} of them",
        SEQUENCES * STEPS as u64
    );
    assert!(
        on > SEQUENCES * STEPS as u64 / 100,
        "coils on in {on} steps: too few to say anything"
    );
}
