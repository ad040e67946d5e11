//! Rows 9 and 11: an angle that is too noisy, or goes the wrong way.

use super::*;

// REQ-SAFE-05
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
    assert_eq!(noisy_after(400), Some(12));
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

// REQ-SAFE-05
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

/// At first it followed its coil, so neither coils nor sensor are swapped.
#[test]
fn a_lowered_hitch_that_bounces_off_the_ground_is_cut_off_without_a_fault() {
    for (way_down, bounced) in [(4_000, false), (4_020, true)] {
        let mut rig = Rig::armed();
        let mut at = |order, angle| {
            rig.step_with(order, |inputs| {
                inputs.rocker_angle = Some(MilliDegree(angle))
            })
        };
        let lowest = 90_000 - way_down;
        (0..20).for_each(|_| _ = at(Order::Lower(1_100), 90_000));
        for angle in (lowest..90_000).rev().step_by(20) {
            at(Order::Lower(1_100), angle);
        }
        for angle in (lowest..=lowest + 4_000).step_by(20) {
            assert_ne!(at(Order::Lower(1_100), angle), CoilCurrents::OFF, "{angle}");
        }
        assert_eq!(at(Order::Lower(1_100), lowest + 4_001), CoilCurrents::OFF);
        assert_eq!(rig.envelope.has_ground_contact(), bounced, "{way_down}");
        let trip = (!bounced).then_some(Trip::Against);
        assert_eq!(rig.envelope.tripped(), trip, "{way_down}");
    }
}
