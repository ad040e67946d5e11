//! Rows 1 to 7: the command, the supply and signals that are missing or out of range.

use super::*;

// REQ-SAFE-02
#[test]
fn row_1_a_stale_command() {
    let mut rig = Rig::moving(LIFT);
    let silent = |rig: &mut Rig| {
        let inputs = rig.inputs();
        pass(&mut rig.envelope, None, &inputs, limits())
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

// REQ-SAFE-02
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
        let inputs = rig.inputs();
        let passed = pass(&mut rig.envelope, Some(command), &inputs, limits());
        assert_eq!(
            rig.envelope.tripped(),
            trips.then_some(Trip::BothCoils),
            "{command:?}"
        );
        assert_eq!(passed == CoilCurrents::OFF, trips, "{command:?}");
    }
}

// REQ-SAFE-02
#[test]
fn row_3_overrun() {
    assert_row(Trip::Overrun, 2, |inputs, _| {
        inputs.step_time = Some(Microsecond(1_501))
    });
    assert_row(Trip::Overrun, 2, |inputs, _| {
        inputs.step_time = Some(Microsecond(499))
    });
    for step_time in [500, 1_500] {
        assert_bears(500, |inputs| {
            inputs.step_time = Some(Microsecond(step_time))
        });
    }
    assert_bears(500, |inputs| inputs.step_time = None);
}

#[test]
fn row_3_counts_the_time_that_a_late_step_has_lost() {
    // A processor that was halted for the row's time or longer: one step is enough.
    for step_time in [3_000, 1_000_000, i32::MAX] {
        assert_row(Trip::Overrun, 1, |inputs, _| {
            inputs.step_time = Some(Microsecond(step_time))
        });
    }
    // Less than the row's time is borne once, not twice in a row.
    let late = |inputs: &mut Inputs| inputs.step_time = Some(Microsecond(2_999));
    assert_bears(1, late);
    assert_row(Trip::Overrun, 2, |inputs, _| late(inputs));
}

// REQ-SAFE-03
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
    // An intermittent supply counts as bad in its gaps, until it has been good for more than 5 ms.
    for (good, after) in [(1, 11), (2, 10), (4, 11), (5, 13)] {
        let mut rig = Rig::moving(LIFT);
        let cut = rig.cut_after(LIFT, |inputs, step| {
            if step % (good + 1) == 1 {
                inputs.supply = Some(MilliVolt(7_000));
            }
        });
        let tripped = (cut, rig.envelope.tripped());
        assert_eq!(tripped, (Some(after), Some(Trip::Supply)), "{good} ms good");
    }
    let mut rig = Rig::moving(LIFT);
    let cut = rig.cut_after(LIFT, |inputs, step| {
        if step % 7 == 1 {
            inputs.supply = Some(MilliVolt(7_000));
        }
    });
    assert_eq!(cut, None, "6 ms good");
    assert_bears(500, |inputs| inputs.supply = None);
}

// REQ-SAFE-03
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

// REQ-SAFE-03
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

// REQ-SAFE-03
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
fn an_implement_does_not_arm() {
    let mut rig = Rig::new();
    for set_point in (50_000..130_000).step_by(100) {
        let passed = rig.step_with(LIFT, |inputs| {
            inputs.set_point = Some(MilliDegree(set_point));
        });
        assert_eq!(passed, CoilCurrents::OFF, "nobody has touched the lever");
    }
}
