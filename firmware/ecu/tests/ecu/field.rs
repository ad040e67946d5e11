//! Speeds, draft and their troubles, from frames to the controller and back.

use hitch_protocols::j1939::{Id, Pgn};
use hitch_quantities::Inputs;
use hitch_quantities::units::{Count, MillimetrePerSecond, PerMille};

use crate::bench::{Bench, Flash};
use crate::engine::{of_the_board, stored};

/// A calibration with draft pins and slip guard.
fn fitted() -> Flash {
    let mut block = of_the_board();
    block.draft.fitted = Count(1);
    block.slip.highest_limit = PerMille(300);
    stored(block)
}

/// The data of the last message of a group.
fn last(bench: &Bench, pgn: Pgn) -> [u8; 8] {
    let data = bench.sent.iter().rev().find_map(|(_, frame)| {
        let id = frame.extended_data_id().map(Id::unpack)?;
        (id.pgn == pgn).then(|| frame.eight().copied())
    });
    data.flatten().unwrap()
}

#[test]
fn a_speed_reaches_the_controller_in_the_next_millisecond_and_only_then() {
    let mut bench = Bench::start(Flash::blank());
    let speeds = |inputs: &Inputs| (inputs.ground_speed, inputs.wheel_speed);
    for (pgn, raw, expected) in [
        (
            Pgn::GROUND_SPEED,
            1_800_u16,
            (Some(MillimetrePerSecond(1_800)), None),
        ),
        (
            Pgn::WHEEL_SPEED,
            2_000,
            (None, Some(MillimetrePerSecond(2_000))),
        ),
    ] {
        let [low, high] = raw.to_le_bytes();
        bench.receive(pgn, 240, [low, high, 0, 0, 0, 0, 0xFF, 0xFD]);
        // Frames are received at the end of a millisecond.
        bench.run(1);
        assert_eq!(speeds(bench.machine.ecu().inputs()), (None, None));
        bench.run(1);
        assert_eq!(speeds(bench.machine.ecu().inputs()), expected);
        bench.run(1);
        assert_eq!(speeds(bench.machine.ecu().inputs()), (None, None));
    }
}

#[test]
fn without_draft_pins_there_is_no_draft_and_no_trouble() {
    let mut bench = Bench::start(stored(of_the_board()));
    bench.run(3_000);
    assert_eq!(last(&bench, Pgn::REAR_HITCH_STATUS)[3..5], [0xFF, 0xFF]);
    assert_eq!(last(&bench, Pgn::DM1)[2..5], [0, 0, 0]);
}

#[test]
fn pins_that_are_fitted_and_not_there_are_a_trouble_in_any_state() {
    let mut bench = Bench::start(fitted());
    bench.run(3_000);
    // 0xFE00: error. SPN 1879 = 0x757, FMI 31.
    assert_eq!(last(&bench, Pgn::REAR_HITCH_STATUS)[3..5], [0x00, 0xFE]);
    assert_eq!(last(&bench, Pgn::DM1)[2..5], [0x57, 0x07, 31]);
    bench.pick_up(110_000);
    bench.run(2_000);
    assert!(bench.angle() > 100_000, "position control goes on");
    assert_eq!(last(&bench, Pgn::DM1)[2..5], [0x57, 0x07, 31]);
}
