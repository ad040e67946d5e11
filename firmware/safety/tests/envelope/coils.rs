//! Rows 12 to 14: what flows in the coils.

use super::*;

// REQ-SAFE-06
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

// REQ-SAFE-06
#[test]
fn row_13_a_shorted_coil() {
    let more = |current: Option<MilliAmp>, by| {
        current
            .filter(|asked| asked.0 > 0)
            .map(|asked| MilliAmp(asked.0 + by))
    };
    assert_row(Trip::CoilShort, 8, |inputs, _| {
        inputs.lift_current = more(inputs.lift_current, 501);
        inputs.lower_current = more(inputs.lower_current, 501);
    });
    assert_bears(500, |inputs| {
        inputs.lift_current = more(inputs.lift_current, 500);
        inputs.lower_current = more(inputs.lower_current, 500);
    });
    assert_bears(7, |inputs| {
        inputs.lift_current = more(inputs.lift_current, 2_000);
        inputs.lower_current = more(inputs.lower_current, 2_000);
    });
}

// REQ-SAFE-06
#[test]
fn row_14_a_stuck_driver() {
    for order in [LIFT, LOWER] {
        for (left, expected) in [(200, None), (201, Some(38))] {
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
            // 30 ms for the current to decay, and 8 to be sure; the first of both is one step.
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
    assert_eq!(after, Some(8));
}
