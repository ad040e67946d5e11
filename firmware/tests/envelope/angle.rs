//! Rows 8 to 11: an angle that is there and in range, and can't be right all the same.

use super::*;

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
    for steps in (0..400).step_by(4) {
        let mut rig = Rig::armed();
        rig.envelope = Envelope::default();
        let mut at = |angle| {
            rig.step_with(Order::Rest, |inputs| {
                inputs.rocker_angle = Some(MilliDegree(angle))
            });
        };
        // One digit up, then two or three of them at a time.
        (0..steps).for_each(|step| at(90_000 + [0, 20, -20, 40][step % 4]));
        (0..30).for_each(|_| at(90_500));
        if rig.envelope.tripped() == Some(Trip::AngleFrozen) {
            known_after = known_after.or(Some(steps));
        }
    }
    assert_eq!(known_after, Some(32));
}

#[test]
fn steps_of_up_to_a_digit_and_a_half_are_no_tremble() {
    let is_watched = |back: i32| {
        let mut rig = Rig::armed();
        rig.envelope = Envelope::default();
        let mut at = |angle| {
            rig.step_with(Order::Rest, |inputs| {
                inputs.rocker_angle = Some(MilliDegree(angle))
            });
        };
        // Onwards digit by digit, so that the digit is known; then a digit up, and further back.
        let onwards = (0..100).map(|_| 40);
        let to_and_fro = (0..200).flat_map(|_| [-back, 40]);
        let mut angle = 90_000;
        for step in onwards.chain(to_and_fro) {
            angle += step;
            at(angle);
        }
        (0..30).for_each(|_| at(angle + 500));
        rig.envelope.tripped() == Some(Trip::AngleFrozen)
    };
    assert!(!is_watched(60));
    assert!(is_watched(61));
}

/// White noise and a converter's digit of 0.047 degree, while the hitch sinks by three digits a minute: near a step of the
/// converter the reading trembles, half a digit on it stands still. Nobody may take that for a fault; a sensor whose noise
/// spans more than a digit never stands still for 20 ms, and is known to be frozen when it does.
#[test]
fn a_healthy_sensor_is_not_frozen_whatever_its_digit() {
    const DIGIT: f64 = 47.0;
    for (sigma_in_digits, is_watched) in [
        (0.15, false),
        (0.3, false),
        (0.55, false),
        (0.8, false),
        (1.4, true),
        (3.0, true),
    ] {
        let mut random = fastrand::Rng::with_seed(7);
        let mut rig = Rig::armed();
        let mut at = |angle_mdeg: f64| {
            let read = (angle_mdeg / DIGIT).round() * DIGIT;
            rig.step_with(Order::Rest, |inputs| {
                inputs.rocker_angle = Some(MilliDegree(read.round() as i32));
            });
            rig.envelope.tripped()
        };
        for step in 0..600_000 {
            let sunk_mdeg = f64::from(step) * 3.0 * DIGIT / 60_000.0;
            // A sum of twelve is as good as normal here.
            let normal: f64 = (0..12).map(|_| random.f64()).sum::<f64>() - 6.0;
            let noise_mdeg = sigma_in_digits * DIGIT * normal;
            let tripped = at(90_000.0 - sunk_mdeg + noise_mdeg);
            assert_eq!(tripped, None, "{sigma_in_digits} digits, after {step} ms");
        }
        let still = (0..100).map(|_| at(88_000.0)).last().flatten();
        let frozen = is_watched.then_some(Trip::AngleFrozen);
        assert_eq!(still, frozen, "{sigma_in_digits} digits");
    }
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
