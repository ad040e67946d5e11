//! The calibration block: images, checksum and what validation refuses.

use hitch_quantities::calibration::CALIBRATION_BYTES;
use hitch_quantities::calibration::parameter::ParameterGroup;
use hitch_quantities::units::{MicroLitrePerSecond, Micrometre, MilliDegree, Millisecond};
use hitch_quantities::{Calibration, CalibrationError};

fn refused(change: impl FnOnce(&mut Calibration)) -> CalibrationError {
    let mut calibration = Calibration::nominal();
    change(&mut calibration);
    calibration.sealed().validate().unwrap_err()
}

#[test]
fn the_nominal_calibration_is_valid_and_survives_its_image() {
    let nominal = Calibration::nominal();
    let bytes = nominal.to_bytes();
    assert_eq!(Calibration::from_bytes(&bytes), nominal);
    assert!(nominal.validate().is_ok());
}

#[test]
fn every_flipped_bit_is_noticed() {
    let good = Calibration::nominal().to_bytes();
    for bit in 0..8 * CALIBRATION_BYTES {
        let mut bytes = good;
        bytes[bit / 8] ^= 1 << (bit % 8);
        assert!(
            Calibration::from_bytes(&bytes).validate().is_err(),
            "bit {bit}"
        );
    }
}

#[test]
fn a_block_that_was_never_written_is_refused() {
    for erased in [0x00, 0xFF] {
        let calibration = Calibration::from_bytes(&[erased; CALIBRATION_BYTES]);
        assert!(matches!(
            calibration.validate(),
            Err(CalibrationError::Version { .. })
        ));
    }
}

#[test]
fn curves_that_make_no_map_are_refused() {
    assert!(matches!(
        refused(|c| c.lift.count = 1),
        CalibrationError::ValveSize { valve: "lift" }
    ));
    assert!(matches!(
        refused(|c| c.lower.count = 33),
        CalibrationError::ValveSize { valve: "lower" }
    ));
    let falls = refused(|c| c.lift.points[3].flow = MicroLitrePerSecond(0));
    assert!(matches!(
        falls,
        CalibrationError::ValvePoint {
            valve: "lift",
            index: 3
        }
    ));
    let leaks = refused(|c| c.lower.points[0].flow = MicroLitrePerSecond(1));
    assert!(matches!(
        leaks,
        CalibrationError::ValvePoint {
            valve: "lower",
            index: 0
        }
    ));
    let crowds = refused(|c| {
        let second = c.lift.points[1].flow;
        c.lift.points[2].flow = second + c.lift.least_gap() - MicroLitrePerSecond(1);
    });
    assert!(matches!(
        crowds,
        CalibrationError::ValveGap {
            valve: "lift",
            index: 2
        }
    ));
    let turns = refused(|c| c.linkage.travel[7] = Micrometre(0));
    assert!(matches!(turns, CalibrationError::Linkage { index: 7 }));
    assert!(matches!(
        refused(|c| c.linkage.angle_step = MilliDegree(0)),
        CalibrationError::Linkage { .. }
    ));
}

#[test]
fn points_may_be_a_quarter_of_a_percent_apart() {
    let mut calibration = Calibration::nominal();
    let table = &mut calibration.lift;
    assert_eq!(
        table.least_gap(),
        MicroLitrePerSecond(665_483_i32.div_euclid(400) + 1)
    );
    table.points[2].flow = table.points[1].flow + table.least_gap();
    assert!(calibration.sealed().validate().is_ok());
}

#[test]
fn crossed_limits_and_other_layouts_are_refused() {
    let crossed = refused(|c| c.position.lower_limit = c.position.upper_limit);
    assert!(matches!(
        crossed,
        CalibrationError::Crossed {
            group: "position",
            ..
        }
    ));
    assert!(matches!(
        refused(|c| c.sensors.angle_lag = Millisecond(481)),
        CalibrationError::AngleLag {
            found: Millisecond(481),
            most: Millisecond(480)
        }
    ));
    assert!(matches!(
        refused(|c| c.version = 1),
        CalibrationError::Version { found: 1 }
    ));
}

/// Every scalar is checked at both ends of its range.
fn check_ranges<G: ParameterGroup>(group: impl Fn(&mut Calibration) -> &mut G) {
    for (index, info) in G::INFO.iter().enumerate() {
        assert!(
            info.min <= info.nominal && info.nominal <= info.max,
            "{} of {}",
            info.name,
            G::NAME
        );
        assert!(
            info.reason.len() > 20,
            "{} of {} has no reason",
            info.name,
            G::NAME
        );
        for outside in [info.min.checked_sub(1), info.max.checked_add(1)]
            .into_iter()
            .flatten()
        {
            let error = refused(|calibration| group(calibration).set(index, outside));
            let CalibrationError::Parameter { group, what } = error else {
                panic!("{} = {outside}: {error:?}", info.name);
            };
            assert_eq!(
                (group, what.parameter.name, what.found),
                (G::NAME, info.name, outside)
            );
        }
    }
}

#[test]
fn every_scalar_outside_its_range_is_refused_by_name() {
    check_ranges(|c| &mut c.hydraulics);
    check_ranges(|c| &mut c.sensors);
    check_ranges(|c| &mut c.lock);
    check_ranges(|c| &mut c.operator);
    check_ranges(|c| &mut c.motion);
    check_ranges(|c| &mut c.position);
    check_ranges(|c| &mut c.rate);
    check_ranges(|c| &mut c.hold);
    check_ranges(|c| &mut c.saturation);
    check_ranges(|c| &mut c.teach);
    check_ranges(|c| &mut c.current);
    check_ranges(|c| &mut c.safety);
}

#[test]
fn words_are_sealed_as_their_block_is() {
    let mut block = Calibration::nominal();
    block.draft.length.0 += 1;
    let mut words = block.to_words();
    // Neither version nor checksum of the words count.
    words[0] = 1;
    let sealed = Calibration::seal_words(&words).unwrap();
    assert_eq!(*sealed, block.clone().sealed());
    assert!((*sealed).clone().validate().is_ok());
    block.draft.length.0 = -1;
    assert!(Calibration::seal_words(&block.to_words()).is_err());
}
