//! Rows 15 to 20: what the other rows rely on.

use hitch_quantities::units::{Count, PerMille};

use super::*;

// REQ-SAFE-07
#[test]
fn row_15_the_converters_reference() {
    for reference in [939, 1_061, 0, i32::MIN, i32::MAX] {
        assert_row(Trip::Reference, 20, |inputs, _| {
            inputs.reference = Some(PerMille(reference));
        });
    }
    for reference in [940, 1_060] {
        assert_bears(500, |inputs| {
            inputs.reference = Some(PerMille(reference));
        });
    }
    assert_bears(19, |inputs| inputs.reference = Some(PerMille(0)));
}

// REQ-SAFE-07
#[test]
fn row_16_the_supply_of_the_sensors() {
    for millivolts in [4_749, 5_251, 0, i32::MIN, i32::MAX] {
        assert_row(Trip::SensorSupply, 4, |inputs, _| {
            inputs.sensor_supply = Some(MilliVolt(millivolts));
        });
    }
    for millivolts in [4_750, 5_250] {
        assert_bears(500, |inputs| {
            inputs.sensor_supply = Some(MilliVolt(millivolts));
        });
    }
    assert_bears(3, |inputs| inputs.sensor_supply = Some(MilliVolt(0)));
}

#[test]
fn the_supply_of_the_sensors_is_the_cause_when_all_signals_go_with_it() {
    let mut rig = Rig::moving(LIFT);
    let cut = rig.cut_after(LIFT, |inputs, _| {
        inputs.sensor_supply = Some(MilliVolt(0));
        (inputs.rocker_angle, inputs.lever) = (None, None);
    });
    let found = (cut, rig.envelope.tripped());
    assert_eq!(found, (Some(4), Some(Trip::SensorSupply)));
}

/// Steps until a second track trips, with a sensor that has one.
fn tracks(second: impl Fn(i32) -> Option<i32>) -> (Option<i32>, Option<Trip>) {
    let sensors = SensorParameters {
        second_track: Count(1),
        ..SENSORS
    };
    let limits = Limits {
        sensors: &sensors,
        ..limits()
    };
    let mut rig = Rig::moving(LIFT);
    let cut = (1..=500).find(|_| {
        rig.angle += rig.speed;
        rig.steps += 1;
        let mut inputs = rig.inputs();
        let first = inputs.rocker_angle.map_or(0, |angle| angle.0);
        inputs.second_angle = second(first).map(MilliDegree);
        rig.passed = pass(&mut rig.envelope, Some(LIFT.currents()), &inputs, limits);
        rig.passed == CoilCurrents::OFF
    });
    (cut, rig.envelope.tripped())
}

// REQ-SAFE-04
#[test]
fn row_17_tracks_of_the_angle_that_disagree() {
    let tripped = (Some(5), Some(Trip::AngleTracks));
    for off in [2_001, -2_001, 20_000, i32::MIN, i32::MAX] {
        assert_eq!(tracks(|angle| Some(angle.saturating_add(off))), tripped);
    }
    assert_eq!(tracks(|_| None), tripped, "one is missing");
    for off in [0, 2_000, -2_000] {
        assert_eq!(tracks(|angle| Some(angle + off)).1, None, "{off}");
    }
    assert_bears(500, |inputs| inputs.second_angle = Some(MilliDegree(0)));
}

// REQ-SAFE-04
#[test]
fn row_17_a_track_that_sticks_in_motion() {
    let stuck = std::cell::Cell::new(None);
    let (cut, tripped) = tracks(|angle| {
        let at = stuck.get().unwrap_or(angle);
        stuck.set(Some(at));
        Some(at)
    });
    assert_eq!(tripped, Some(Trip::AngleTracks));
    // 2 degrees at 60 degrees a second, and 5 ms.
    assert!(cut.is_some_and(|ms| (38..=41).contains(&ms)), "{cut:?}");
}

// REQ-SAFE-07
#[test]
fn row_18_a_main_clock_that_changes() {
    for ratio in [799, 1_201, 0, i32::MIN, i32::MAX] {
        assert_row(Trip::Clock, 20, |inputs, _| {
            inputs.clock_ratio = Some(PerMille(ratio));
        });
    }
    for ratio in [800, 1_200] {
        assert_bears(500, |inputs| inputs.clock_ratio = Some(PerMille(ratio)));
    }
}

// REQ-SAFE-07
#[test]
fn row_19_the_enable_line() {
    assert_row(Trip::EnableLine, 1, |inputs, _| {
        inputs.enable_line_fault = true
    });
}

// REQ-SAFE-07
#[test]
fn row_20_a_calibration_that_has_changed_in_memory() {
    for order in [LIFT, LOWER] {
        let mut rig = Rig::moving(order);
        let limits = Limits {
            damaged: true,
            ..limits()
        };
        let inputs = rig.inputs();
        let passed = pass(&mut rig.envelope, Some(order.currents()), &inputs, limits);
        let found = (passed, rig.envelope.tripped());
        assert_eq!(found, (CoilCurrents::OFF, Some(Trip::Memory)));
        rig.speed = 0;
        rig.run(Order::Rest, 1_000);
        rig.envelope.reset();
        assert_eq!(rig.envelope.tripped(), Some(Trip::Memory), "final");
    }
}
