//! Writing parameters: ranges, what may change when, pages, and storing.

use hitch_protocols::xcp::Access;
use hitch_protocols::xcp::pages::Applied;
use hitch_quantities::calibration::calibration_words::{CALIBRATION_WORDS, LIFT_WORD};
use hitch_quantities::units::MicrometrePerSecond;
use hitch_quantities::{Calibration, CalibrationError, ValidCalibration};

use crate::client::{
    ACCESS_DENIED, ACCESS_LOCKED, Desk, OUT_OF_RANGE, WRITE_PROTECTED, scalar, scalars,
    word_address,
};
use crate::key::unlocked;

// REQ-SAFE-11
#[test]
fn every_parameter_takes_what_is_in_its_range_and_nothing_else() {
    let mut desk = unlocked();
    for (group, parameter, address, _) in scalars() {
        let name = format!("{group}.{}", parameter.name);
        assert_eq!(desk.read(address), Ok(parameter.nominal), "{name}");
        for outside in [parameter.min - 1, parameter.max + 1, i32::MIN, i32::MAX] {
            assert_eq!(desk.write(address, outside), Err(OUT_OF_RANGE), "{name}");
            assert_eq!(
                desk.read(address),
                Ok(parameter.nominal),
                "{name}: unchanged"
            );
        }
        for inside in [parameter.min, parameter.max, parameter.nominal] {
            assert_eq!(desk.write(address, inside), Ok(()), "{name}");
            assert_eq!(desk.read(address), Ok(inside), "{name}");
        }
    }
}

// REQ-SAFE-11
#[test]
fn while_the_hitch_moves_only_what_is_harmless_can_be_changed() {
    let mut desk = Desk::connected();
    desk.access = Access::Moving;
    let mut live_ones = 0;
    for (group, parameter, address, live) in scalars() {
        let expected = if live { Ok(()) } else { Err(ACCESS_DENIED) };
        assert_eq!(
            desk.write(address, parameter.max),
            expected,
            "{group}.{}",
            parameter.name
        );
        live_ones += usize::from(live);
    }
    assert!(live_ones > 5 && live_ones < scalars().len() / 2);
    assert_eq!(
        desk.write(word_address(LIFT_WORD + 2), 1),
        Err(ACCESS_DENIED),
        "the valve's curve"
    );
    assert!(
        scalars()
            .iter()
            .all(|(group, .., live)| !(*live && *group == "safety"))
    );
}

// REQ-SAFE-11
// REQ-SAFE-14
#[test]
fn limits_are_no_lever() {
    let mut desk = Desk::connected();
    for limit in ["lower_limit", "upper_limit"] {
        let address = scalar("position", limit);
        let present = desk.read(address).unwrap();
        desk.access = Access::Moving;
        assert_eq!(desk.write(address, 110_000), Err(ACCESS_DENIED), "{limit}");
        assert_eq!(desk.read(address), Ok(present));
        desk.access = Access::AtRest;
        assert_eq!(desk.write(address, 110_000), Ok(()), "{limit}");
        assert_eq!(desk.write(address, present), Ok(()), "{limit}");
    }
}

// REQ-SAFE-11
#[test]
fn without_tuning_enabled_nothing_is_written() {
    let mut desk = Desk::connected();
    desk.access = Access::Locked;
    for (_, parameter, address, _) in scalars() {
        assert_eq!(desk.write(address, parameter.max), Err(ACCESS_LOCKED));
        assert_eq!(desk.read(address), Ok(parameter.nominal), "reading is free");
    }
    assert_eq!(
        desk.ask(&[0xEB, 1, 0, 1]),
        Err(ACCESS_LOCKED),
        "nor are pages chosen for the controller"
    );
    assert_eq!(
        desk.ask(&[0xE4, 0, 1, 0, 0]),
        Err(ACCESS_LOCKED),
        "or copied"
    );
    assert_eq!(desk.ask(&[0xF9, 1, 0, 0]), Err(ACCESS_LOCKED), "or stored");
    assert_eq!(desk.pages.take_change(), None);
}

#[test]
fn version_and_checksum_are_nobodys_business() {
    let mut desk = Desk::connected();
    for word in [0, CALIBRATION_WORDS - 1] {
        assert_eq!(desk.write(word_address(word), 2), Err(WRITE_PROTECTED));
    }
    assert_eq!(
        desk.write(0x2000_0000, 0),
        Err(ACCESS_DENIED),
        "measurements are measured"
    );
}

#[test]
fn a_curve_is_written_in_pieces_that_cut_words_in_two() {
    let mut desk = Desk::connected();
    let curve: Vec<i32> = (0..8).map(|point| 600 * point + 7).collect();
    let bytes: Vec<u8> = curve.iter().flat_map(|value| value.to_le_bytes()).collect();
    // Flow and current of the first points: any value of both ranges.
    let address = word_address(LIFT_WORD + 1);
    for piece in [6, 7] {
        desk.set_address(address);
        for part in bytes.chunks(piece) {
            let length = u8::try_from(part.len()).unwrap();
            let command = match part.len() {
                7 => [&[0xEE], part].concat(),
                _ => [&[0xF0, length], part].concat(),
            };
            desk.obeyed(&command);
        }
        for (word, value) in (LIFT_WORD + 1..).zip(&curve[..]) {
            assert_eq!(desk.read(word_address(word)), Ok(*value));
        }
    }
}

#[test]
fn half_a_word_changes_nothing_until_the_other_half_comes() {
    let mut desk = Desk::connected();
    let address = scalar("position", "approach_gain");
    let before = desk.read(address).unwrap();
    desk.set_address(address);
    desk.obeyed(&[0xF0, 2, 100, 0]);
    assert_eq!(desk.read(address), Ok(before));
    desk.set_address(address + 2);
    desk.obeyed(&[0xF0, 2, 0, 0]);
    assert_eq!(desk.read(address), Ok(100));
    // The second half alone, or behind something else, is refused.
    desk.set_address(address + 2);
    assert_eq!(desk.ask(&[0xF0, 2, 0, 0]), Err(ACCESS_DENIED));
    desk.set_address(address);
    desk.obeyed(&[0xF0, 2, 50, 0]);
    desk.write(scalar("rate", "rate_limit"), 10_000).unwrap();
    desk.set_address(address + 2);
    assert_eq!(desk.ask(&[0xF0, 2, 0, 0]), Err(ACCESS_DENIED));
    assert_eq!(desk.read(address), Ok(100));
}

#[test]
fn a_piece_with_one_bad_word_writes_none_of_it() {
    let mut desk = Desk::connected();
    let address = scalar("position", "approach_gain");
    desk.set_address(address);
    desk.obeyed(&[0xF0, 3, 50, 0, 0]);
    // Its last byte, and a whole next word that is out of range.
    let next = desk.read(address + 4).unwrap();
    desk.set_address(address);
    desk.obeyed(&[0xF0, 3, 50, 0, 0]);
    assert_eq!(
        desk.ask(&[0xF0, 5, 0, 0xFF, 0xFF, 0xFF, 0x7F]),
        Err(OUT_OF_RANGE)
    );
    assert_eq!(desk.read(address + 4), Ok(next));
    assert_ne!(desk.read(address), Ok(50));
}

#[test]
fn the_controller_gets_a_page_when_it_is_consistent() {
    let mut desk = Desk::connected();
    let (lower, upper) = (
        scalar("position", "lower_limit"),
        scalar("position", "upper_limit"),
    );
    assert!(desk.pages.take_change().is_none(), "nothing has changed");
    let high = desk.read(upper).unwrap();
    desk.write(lower, high).unwrap();
    assert!(matches!(
        desk.pages.take_change(),
        Some(Err(CalibrationError::Crossed { .. }))
    ));
    assert!(desk.pages.take_change().is_none(), "said once");
    assert_eq!(desk.pages.applied(), Applied::Inconsistent);
    desk.write(lower, high - 20_000).unwrap();
    let taken = desk.pages.take_change().unwrap().unwrap();
    assert_eq!(taken.position.lower_limit.0, high - 20_000);
    assert_eq!(desk.pages.applied(), Applied::InUse);
}

#[test]
fn the_reference_page_is_what_is_stored_and_comes_back_when_asked() {
    let mut desk = Desk::connected();
    let address = scalar("position", "lift_speed");
    let stored = desk.read(address).unwrap();
    desk.write(address, stored - 1_000).unwrap();
    // The tool looks at the reference page; the controller stays.
    desk.obeyed(&[0xEB, 2, 0, 1]);
    assert_eq!(desk.obeyed(&[0xEA, 2, 0]), [0, 0, 1]);
    assert_eq!(desk.obeyed(&[0xEA, 1, 0]), [0, 0, 0]);
    assert_eq!(desk.read(address), Ok(stored));
    assert_eq!(desk.write(address, stored - 2_000), Err(WRITE_PROTECTED));
    // The controller runs on it too, and back.
    desk.pages.take_change();
    desk.obeyed(&[0xEB, 1, 0, 1]);
    let taken = desk.pages.take_change().unwrap().unwrap();
    assert_eq!(taken.position.lift_speed, MicrometrePerSecond(stored));
    desk.obeyed(&[0xEB, 3, 0, 0]);
    let taken = desk.pages.take_change().unwrap().unwrap();
    assert_eq!(
        taken.position.lift_speed,
        MicrometrePerSecond(stored - 1_000)
    );
    // Copied over the working page.
    desk.obeyed(&[0xE4, 0, 1, 0, 0]);
    assert_eq!(desk.read(address), Ok(stored));
    assert_eq!(
        desk.ask(&[0xE4, 0, 0, 0, 1]),
        Err(WRITE_PROTECTED),
        "not the other way"
    );
    for (command, error) in [
        ([0xEB, 2, 0, 2], 0x26),
        ([0xEB, 2, 1, 0], 0x28),
        ([0xEB, 0, 0, 0], 0x27),
        ([0xEA, 2, 1, 0], 0x28),
    ] {
        assert_eq!(desk.ask(&command), Err(error), "{command:02X?}");
    }
}

#[test]
fn the_segment_and_its_pages_are_described() {
    let mut desk = Desk::connected();
    assert_eq!(desk.obeyed(&[0xE9]), [1, 0], "one segment");
    assert_eq!(
        desk.obeyed(&[0xE8, 1, 0, 0, 0]),
        [2, 0, 0, 0, 0],
        "two pages"
    );
    assert_eq!(
        desk.obeyed(&[0xE8, 0, 0, 0, 0])[3..],
        word_address(0).to_le_bytes()
    );
    let length = u32::try_from(4 * CALIBRATION_WORDS).unwrap();
    assert_eq!(desk.obeyed(&[0xE8, 0, 0, 1, 0])[3..], length.to_le_bytes());
    assert_eq!(
        desk.obeyed(&[0xE7, 0, 0, 0])[0],
        0x3F,
        "the working page is written"
    );
    assert_eq!(
        desk.obeyed(&[0xE7, 0, 0, 1])[0],
        0x0F,
        "the reference page is not"
    );
    assert_eq!(desk.ask(&[0xE8, 0, 1, 0, 0]), Err(0x28));
}

#[test]
fn while_the_hitch_moves_pages_are_not_switched_under_it() {
    let mut desk = Desk::connected();
    desk.access = Access::Moving;
    assert_eq!(desk.ask(&[0xEB, 3, 0, 1]), Err(ACCESS_DENIED));
    assert_eq!(
        desk.obeyed(&[0xEA, 2, 0]),
        [0, 0, 0],
        "not for the tool either: all or nothing"
    );
    assert_eq!(desk.ask(&[0xE4, 0, 1, 0, 0]), Err(ACCESS_DENIED));
    assert_eq!(desk.ask(&[0xF9, 1, 0, 0]), Err(ACCESS_DENIED), "nor stored");
}

#[test]
fn storing_is_asked_for_done_by_the_application_and_reported() {
    let mut desk = Desk::connected();
    let address = scalar("position", "lift_speed");
    desk.write(address, 99_000).unwrap();
    assert!(!desk.slave.take_store_request());
    desk.obeyed(&[0xF9, 1, 0, 0]);
    assert_eq!(desk.obeyed(&[0xFD])[0] & 1, 1, "asked for");
    assert!(desk.slave.take_store_request());
    assert!(!desk.slave.take_store_request(), "once");
    let stored: ValidCalibration = desk.pages.to_store().unwrap();
    desk.pages.stored(&stored);
    desk.slave.stored(true);
    assert_eq!(desk.packets(), [[0xFD, 0x03]]);
    assert_eq!(desk.obeyed(&[0xFD])[0] & 1, 0, "done");
    desk.obeyed(&[0xEB, 2, 0, 1]);
    assert_eq!(desk.read(address), Ok(99_000), "the reference page has it");
    desk.slave.stored(false);
    assert!(desk.packets().is_empty(), "nobody asked");
}

#[test]
fn what_was_taught_replaces_the_working_page() {
    let mut desk = Desk::connected();
    let mut block = Calibration::nominal();
    block.position.lift_speed = MicrometrePerSecond(77_000);
    desk.pages
        .replace_working(&block.sealed().validate().unwrap());
    assert_eq!(desk.read(scalar("position", "lift_speed")), Ok(77_000));
    assert!(desk.pages.take_change().is_some());
}

#[test]
fn the_beginning_of_a_word_is_refused_where_the_word_would_be() {
    let mut desk = Desk::connected();
    desk.access = Access::Moving;
    desk.set_address(scalar("safety", "decay_time"));
    assert_eq!(desk.ask(&[0xF0, 2, 30, 0]), Err(ACCESS_DENIED));
    desk.set_address(word_address(0));
    assert_eq!(desk.ask(&[0xF0, 2, 30, 0]), Err(WRITE_PROTECTED));
}

#[test]
fn a_controller_on_the_reference_page_gets_what_was_stored() {
    let mut desk = Desk::connected();
    desk.obeyed(&[0xEB, 1, 0, 1]);
    assert!(desk.pages.take_change().is_some());
    desk.write(scalar("position", "lift_speed"), 77_000)
        .unwrap();
    assert!(
        desk.pages.take_change().is_none(),
        "that was on the working page"
    );
    let stored = desk.pages.to_store().unwrap();
    desk.pages.stored(&stored);
    let taken = desk.pages.take_change().unwrap().unwrap();
    assert_eq!(taken.position.lift_speed, MicrometrePerSecond(77_000));
}
