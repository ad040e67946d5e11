//! The engine lock, from frames to pulse widths.

use hitch_ecu::BoardScaling;
use hitch_protocols::j1939::{Id, Pgn};
use hitch_protocols::storage::CalibrationStore;
use hitch_quantities::units::Count;
use hitch_quantities::{Calibration, State};

use crate::bench::{Bench, Flash};

/// A millisecond or more with an engine that says its speed every 20 ms, 1/min; true if no coil was on.
fn still_with_engine(bench: &mut Bench, speed: u16, ms: u32) -> bool {
    (0..ms).fold(true, |still, _| {
        if bench.now_ms.is_multiple_of(20) {
            let [low, high] = (8 * speed).to_le_bytes();
            bench.receive(
                Pgn::ENGINE,
                0,
                [0xFF, 0xFF, 0xFF, low, high, 0xFF, 0xFF, 0xFF],
            );
        }
        bench.is_still(1) && still
    })
}

/// The calibration of the board, untaught.
pub fn of_the_board() -> Calibration {
    let mut block = Calibration::nominal();
    block.monitor(BoardScaling::NOMINAL.fitted);
    block
}

/// Flash in which a calibration is stored.
pub fn stored(block: Calibration) -> Flash {
    let flash = Flash::blank();
    let calibration = block.sealed().validate().unwrap();
    CalibrationStore::new(flash.clone())
        .store(&calibration)
        .unwrap();
    flash
}

/// Moves the lever through the hitch and away from it.
fn lever_moves(bench: &mut Bench, speed: u16) -> bool {
    bench.lever = 80_000;
    let below = still_with_engine(bench, speed, 50);
    bench.lever = 110_000;
    still_with_engine(bench, speed, 300) && below
}

#[test]
fn a_machine_that_never_tells_its_engine_speed_is_not_locked_for_it() {
    let mut bench = Bench::start(Flash::blank());
    bench.run(20);
    bench.pick_up(110_000);
    assert_eq!(bench.run(300), State::Lifting);
}

#[test]
fn the_hitch_is_locked_until_the_engine_has_run_for_half_a_second() {
    let mut bench = Bench::start(Flash::blank());
    for speed in [0, 200, 400] {
        assert!(still_with_engine(&mut bench, speed, 1_000), "{speed} rpm");
        assert!(lever_moves(&mut bench, speed), "{speed} rpm");
    }
    // From the first message on.
    while !bench.now_ms.is_multiple_of(20) {
        bench.run(1);
    }
    assert!(still_with_engine(&mut bench, 401, 440));
    bench.lever = 80_000;
    assert!(still_with_engine(&mut bench, 401, 50));
    bench.lever = 110_000;
    assert!(
        still_with_engine(&mut bench, 401, 10),
        "500 ms are not over"
    );
    bench.lever = 80_000;
    assert!(still_with_engine(&mut bench, 401, 1));
    bench.lever = 110_000;
    assert!(!still_with_engine(&mut bench, 401, 300));
    assert_eq!(bench.state(), State::Lifting);
}

// REQ-MODE-06
#[test]
fn an_engine_that_stops_under_a_moving_hitch_stops_it_at_once() {
    let mut bench = Bench::start(Flash::blank());
    still_with_engine(&mut bench, 800, 600);
    assert!(!lever_moves(&mut bench, 800));
    assert_eq!(bench.state(), State::Lifting);
    while !bench.now_ms.is_multiple_of(20) {
        bench.run(1);
    }
    still_with_engine(&mut bench, 400, 1);
    // The frame is received at the end of its millisecond.
    assert!(still_with_engine(&mut bench, 400, 500));
    assert_eq!(bench.state(), State::Locked);
    assert!(
        still_with_engine(&mut bench, 800, 2_000),
        "nobody has picked it up"
    );
    assert!(!lever_moves(&mut bench, 800));
}

// REQ-MODE-06
#[test]
fn an_engine_that_falls_silent_or_says_that_it_does_not_know_counts_as_stopped() {
    for ending in [
        None,
        Some([0xFF; 8]),
        Some([0xFF, 0xFF, 0xFF, 0, 0xFE, 0xFF, 0xFF, 0xFF]),
    ] {
        let mut bench = Bench::start(Flash::blank());
        still_with_engine(&mut bench, 800, 600);
        assert!(!lever_moves(&mut bench, 800));
        if let Some(bytes) = ending {
            bench.receive(Pgn::ENGINE, 0, bytes);
        }
        let silent_ms = (0..1_000)
            .position(|_| bench.run(1) == State::Locked)
            .unwrap();
        let expected = if ending.is_some() { 1..=2 } else { 280..=302 };
        assert!(expected.contains(&silent_ms), "{ending:?}: {silent_ms} ms");
        bench.pick_up(110_000);
        assert!(bench.is_still(2_000), "{ending:?}");
        assert!(!still_with_engine(&mut bench, 800, 600) || !lever_moves(&mut bench, 800));
    }
}

/// DM1 that the ECU has sent since `since_ms`: the trouble code of the lost engine speed is in the last one.
fn reports_a_lost_speed(bench: &Bench, since_ms: u32) -> bool {
    // SPN 190, FMI 9.
    const CODE: [u8; 3] = [190, 0, 9];
    let dm1 = bench.sent.iter().rev().find_map(|(at_ms, frame)| {
        let id = frame.extended_data_id().map(Id::unpack)?;
        (*at_ms >= since_ms && id.pgn == Pgn::DM1).then(|| frame.data())
    });
    dm1.is_some_and(|data| data[2..5] == CODE)
}

// REQ-SAFE-08
#[test]
fn an_engine_speed_from_a_foreign_address_neither_locks_nor_opens_the_lock() {
    let mut bench = Bench::start(Flash::blank());
    let [low, high] = (8 * 1_600_u16).to_le_bytes();
    let message = [0xFF, 0xFF, 0xFF, low, high, 0xFF, 0xFF, 0xFF];
    bench.run(20);
    bench.receive(Pgn::ENGINE, 0x33, message);
    bench.run(1_000);
    bench.pick_up(110_000);
    assert_eq!(bench.run(300), State::Lifting);
    bench.receive(Pgn::ENGINE, 0, [0xFF, 0xFF, 0xFF, 0, 0, 0xFF, 0xFF, 0xFF]);
    bench.run(2);
    assert_eq!(bench.state(), State::Locked, "the engine stands");
    for _ in 0..1_000 {
        bench.receive(Pgn::ENGINE, 0x33, message);
        bench.run(1);
    }
    bench.pick_up(90_000);
    assert!(bench.is_still(1_000));
}

// REQ-SAFE-08
#[test]
fn a_lost_engine_speed_is_reported_until_it_is_received_again() {
    // With a stored calibration no other code is active.
    let mut bench = Bench::start(stored(of_the_board()));
    still_with_engine(&mut bench, 800, 2_000);
    assert!(!reports_a_lost_speed(&bench, 0), "healthy");
    let lost_ms = bench.now_ms;
    bench.run(4_000);
    assert!(reports_a_lost_speed(&bench, lost_ms));
    let back_ms = bench.now_ms;
    still_with_engine(&mut bench, 800, 4_000);
    assert!(!reports_a_lost_speed(&bench, back_ms + 1_500));
    assert!(!lever_moves(&mut bench, 800), "the lock is open again");
}

#[test]
fn an_engine_that_is_required_has_to_be_heard() {
    let mut block = of_the_board();
    block.lock.engine_required = Count(1);
    let mut bench = Bench::start(stored(block));
    bench.pick_up(110_000);
    assert!(bench.is_still(3_000));
    assert_eq!(bench.state(), State::Locked);
    still_with_engine(&mut bench, 800, 600);
    assert!(!lever_moves(&mut bench, 800));
}
