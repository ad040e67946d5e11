//! Remote control, from frames and contacts to pulse widths.

use hitch_ecu::Contact;
use hitch_protocols::j1939::hitch::StatusMessage;
use hitch_protocols::j1939::{ExitCode, HitchCommand, Id, Name, NameFields, Pgn};
use hitch_quantities::units::{Count, MicrometrePerSecond};
use hitch_quantities::{Calibration, State, Trip};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::bench::{Bench, Flash};
use crate::engine::{of_the_board, stored};

/// The address of the implement.
const IMPLEMENT: u8 = 0x26;

fn implement() -> Name {
    let fields = NameFields {
        function: 128,
        device_class: 6,
        ..NameFields::rear_hitch(77)
    };
    fields.into()
}

/// A hitch that rests at 90 degrees and has been captured by the lever.
fn in_operation_with(block: Calibration) -> Bench {
    let mut bench = Bench::start(stored(block));
    bench.run(300);
    bench.pick_up(90_000);
    bench.run(1_500);
    assert_eq!(bench.state(), State::Holding);
    bench
}

fn in_operation() -> Bench {
    in_operation_with(of_the_board())
}

fn status(bench: &Bench) -> StatusMessage {
    let last = bench.sent.iter().rev().find_map(|(_, frame)| {
        let id = frame.extended_data_id().map(Id::unpack)?;
        (id.pgn == Pgn::REAR_HITCH_STATUS)
            .then(|| StatusMessage::from_bytes(frame.eight().unwrap()))
    });
    last.unwrap()
}

/// Commands from an address every 100 ms; `None`: the reported position. True if no coil was on.
fn commanded(bench: &mut Bench, source: u8, raw: Option<u8>, ms: u32) -> bool {
    let mut still = true;
    for _ in 0..ms / 100 {
        let raw = raw.unwrap_or_else(|| status(bench).position);
        let bytes = HitchCommand::Position(raw).to_bytes();
        bench.receive(Pgn::HITCH_COMMANDS, source, bytes);
        for _ in 0..100 {
            still &= bench.is_still(1);
        }
    }
    still
}

fn claims(bench: &mut Bench, source: u8, name: Name) {
    bench.receive(Pgn::ADDRESS_CLAIMED, source, name.to_bytes());
    bench.run(1);
}

fn contact(bench: &mut Bench, closed: bool) {
    bench.panel = bench.panel.with(Contact::Consent, closed);
}

/// An implement that claims its address has asked, and the operator presses the button.
fn active() -> Bench {
    active_with(of_the_board())
}

fn active_with(block: Calibration) -> Bench {
    let mut bench = in_operation_with(block);
    claims(&mut bench, IMPLEMENT, implement());
    assert!(commanded(&mut bench, IMPLEMENT, None, 500));
    assert_eq!(status(&bench).exit, ExitCode::NoOperator);
    contact(&mut bench, true);
    assert!(commanded(&mut bench, IMPLEMENT, None, 300));
    contact(&mut bench, false);
    assert_eq!(status(&bench).exit, ExitCode::Clear);
    bench
}

// REQ-MODE-11
#[test]
fn with_consent_an_implement_moves_the_hitch() {
    let mut bench = active();
    assert!(!commanded(&mut bench, IMPLEMENT, Some(200), 3_000));
    assert_eq!((bench.reply.trip, bench.state()), (0, State::Holding));
    assert!((199..=201).contains(&status(&bench).position));
    assert!(!commanded(&mut bench, IMPLEMENT, Some(30), 4_000));
    assert!((29..=31).contains(&status(&bench).position));
    // It falls silent: locked.
    assert!(bench.is_still(400));
    assert_eq!(bench.state(), State::Locked);
    assert_eq!(status(&bench).exit, ExitCode::Timeout);
}

// REQ-MODE-11
#[test]
fn without_an_address_claim_nobody_commands_the_hitch() {
    for pressed in [false, true] {
        let mut bench = in_operation();
        assert!(commanded(&mut bench, IMPLEMENT, None, 700));
        contact(&mut bench, pressed);
        assert!(commanded(&mut bench, IMPLEMENT, None, 300));
        assert!(commanded(&mut bench, IMPLEMENT, Some(200), 2_000));
        assert_eq!(bench.state(), State::Holding);
    }
}

// REQ-MODE-11
#[test]
fn without_an_address_of_its_own_the_hitch_is_not_commanded() {
    let mut bench = active();
    for address in 128..=247 {
        claims(&mut bench, address, Name(u64::from(address)));
    }
    bench.run(300);
    assert_eq!(bench.state(), State::Locked, "lost while it was commanded");
    bench.pick_up(90_000);
    bench.run(1_000);
    contact(&mut bench, false);
    assert!(commanded(&mut bench, IMPLEMENT, Some(138), 500));
    contact(&mut bench, true);
    assert!(commanded(&mut bench, IMPLEMENT, Some(138), 500));
    assert!(commanded(&mut bench, IMPLEMENT, Some(200), 2_000));
    assert_eq!(bench.state(), State::Holding);
}

// REQ-MODE-11
#[test]
fn a_contact_that_stays_closed_consents_once() {
    let mut bench = in_operation();
    claims(&mut bench, IMPLEMENT, implement());
    contact(&mut bench, true);
    bench.run(1_000);
    assert!(commanded(&mut bench, IMPLEMENT, None, 1_000));
    assert!(commanded(&mut bench, IMPLEMENT, Some(200), 2_000));
    assert_eq!(status(&bench).exit, ExitCode::NoOperator);
}

/// What the operator does, and the exit code that the implement receives.
type End = (&'static str, fn(&mut Bench), ExitCode);

// REQ-MODE-11
#[test]
fn whatever_the_operator_does_ends_it_in_the_same_step() {
    let ends: [End; 4] = [
        (
            "lever",
            |bench| bench.lever += 1_000,
            ExitCode::OperatorOverride,
        ),
        (
            "hold",
            |bench| bench.panel = bench.panel.with(Contact::Hold, true),
            ExitCode::OperatorOverride,
        ),
        (
            "transport lock",
            |bench| bench.panel = bench.panel.with(Contact::FieldMode, false),
            ExitCode::LockedOut,
        ),
        (
            "button",
            |bench| {
                bench.panel = bench.panel.with_buttons(false, true);
                bench.run(100);
                bench.panel = bench.panel.with_buttons(false, false);
                // The ramp down is the button's.
                bench.run(400);
            },
            ExitCode::OperatorOverride,
        ),
    ];
    for (name, act, exit) in ends {
        let mut bench = active();
        assert!(!commanded(&mut bench, IMPLEMENT, Some(220), 500), "{name}");
        act(&mut bench);
        bench.run(1);
        assert!(bench.is_still(50), "{name}");
        assert_eq!(status(&bench).exit, exit, "{name}");
        assert!(commanded(&mut bench, IMPLEMENT, Some(220), 1_000), "{name}");
        assert_eq!(bench.reply.trip, 0, "{name}: the envelope agrees");
    }
}

/// Moves the lever there and back twice, 200 ms each way, while an implement asks.
fn gesture(bench: &mut Bench) {
    for stroke in 0..4 {
        for _ in 0..2 {
            for _ in 0..100 {
                bench.lever += if stroke % 2 == 0 { 15 } else { -15 };
                bench.run(1);
            }
            let raw = status(bench).position;
            bench.receive(
                Pgn::HITCH_COMMANDS,
                IMPLEMENT,
                HitchCommand::Position(raw).to_bytes(),
            );
        }
    }
}

// REQ-MODE-11
#[test]
fn without_a_contact_the_lever_consents_where_the_calibration_says_so() {
    for (kind, moves) in [(2, true), (1, false), (0, false)] {
        let mut block = of_the_board();
        block.remote.consent = Count(kind);
        let mut bench = in_operation_with(block);
        claims(&mut bench, IMPLEMENT, implement());
        assert!(commanded(&mut bench, IMPLEMENT, None, 500));
        gesture(&mut bench);
        commanded(&mut bench, IMPLEMENT, None, 1_200);
        let still = commanded(&mut bench, IMPLEMENT, Some(200), 3_000);
        assert_eq!(!still, moves, "{kind}");
        assert_eq!(bench.reply.trip, 0, "{kind}");
    }
}

// REQ-MODE-11
#[test]
fn an_implement_moves_the_hitch_no_faster_than_its_calibration_says() {
    let most = |speed| {
        let mut block = of_the_board();
        block.remote.speed = MicrometrePerSecond(speed);
        let mut bench = active_with(block);
        let mut most = 0;
        for step in 0..1_000 {
            if step % 100 == 0 {
                let bytes = HitchCommand::Position(215).to_bytes();
                bench.receive(Pgn::HITCH_COMMANDS, IMPLEMENT, bytes);
            }
            bench.run(1);
            let outputs = bench.machine.ecu().outputs();
            most = most.max(outputs.demanded_speed.0);
        }
        most
    };
    // Damping adds a little.
    assert!((9_000..=12_000).contains(&most(10_000)), "{}", most(10_000));
    assert!(
        (35_000..=44_000).contains(&most(40_000)),
        "{}",
        most(40_000)
    );
}

/// A frame of anybody, mostly one that matters for remote control.
fn frame() -> impl Strategy<Value = (Pgn, u8, [u8; 8])> {
    let sources = prop::sample::select(vec![IMPLEMENT, 0x27, 0x80, 0x81, 0xFE, 3]);
    let raws = prop::sample::select(vec![136_u8, 137, 138, 139, 140, 200, 0, 255]);
    let command =
        raws.prop_map(|raw| (Pgn::HITCH_COMMANDS, HitchCommand::Position(raw).to_bytes()));
    let names = prop::sample::select(vec![implement(), Name(7), Name(implement().0 + 1)]);
    let claim = names.prop_map(|name| (Pgn::ADDRESS_CLAIMED, name.to_bytes()));
    let other = (0..0x3_FFFF_u32, any::<[u8; 8]>())
        .prop_filter("an engine may lock the hitch", |(pgn, _)| {
            *pgn != Pgn::ENGINE.0
        })
        .prop_map(|(pgn, bytes)| (Pgn(pgn), bytes));
    let kinds = prop_oneof![6 => command, 1 => claim, 2 => other];
    (kinds, sources).prop_map(|((pgn, bytes), source)| (pgn, source, bytes))
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(3), ..ProptestConfig::with_cases(30) })]

    // REQ-MODE-11
    #[test]
    fn no_frames_without_an_edge_of_the_contact_lead_to_a_coil_current(
        frames in prop::collection::vec((frame(), 1..100_u32), 100), closed in any::<bool>()
    ) {
        let mut bench = Bench::start(Flash::blank());
        contact(&mut bench, closed);
        bench.run(300);
        bench.pick_up(90_000);
        bench.run(1_500);
        claims(&mut bench, IMPLEMENT, implement());
        for ((pgn, source, bytes), wait_ms) in frames {
            bench.receive(pgn, source, bytes);
            prop_assert!(bench.is_still(wait_ms));
        }
        prop_assert_eq!(bench.reply.trip, 0);
    }

    // REQ-SAFE-15
    #[test]
    fn control_and_envelope_agree_on_the_lever_s_consent(
        places in prop::collection::vec((-4_000..4_000_i32, 20..400_u32), 40)
    ) {
        let mut block = of_the_board();
        block.remote.consent = Count(2);
        let mut bench = in_operation_with(block);
        claims(&mut bench, IMPLEMENT, implement());
        for (place, ms) in places {
            let from = bench.lever;
            for step in 1..=ms as i32 {
                bench.lever = from + (90_000 + place - from) * step / ms as i32;
                if bench.now_ms.is_multiple_of(100) {
                    let raw = status(&bench).position;
                    bench.receive(Pgn::HITCH_COMMANDS, IMPLEMENT, HitchCommand::Position(raw).to_bytes());
                }
                bench.run(1);
            }
            prop_assert_ne!(bench.reply.trip, Trip::NoConsent as u8);
        }
    }
}
