//! Safety values of the running application: what a tool can do to them without the key, and with it.

use hitch_ecu::Contact;
use hitch_protocols::can::Frame;
use hitch_protocols::j1939::{Id, Pgn};
use hitch_protocols::key::{SEED_BYTES, Secret};
use hitch_protocols::xcp::TOOL_ADDRESS;
use hitch_protocols::xcp::map::CALIBRATION_BASE;
use hitch_quantities::State;
use hitch_quantities::calibration::calibration_words::{GROUPS, SCALARS_WORD, word_range};
use hitch_quantities::calibration::class::{Class, Tightening};

use crate::bench::{Bench, Flash};

const ECU: u8 = 0x80;
const ACCESS_LOCKED: u8 = 0x25;
const OPEN_TIME: (&str, &str) = ("safety", "open_time");

fn secret() -> Secret {
    Secret::new(std::array::from_fn(|index| index as u8)).unwrap()
}

/// A tool that is connected while the lock is on and service is closed.
fn serviced(flash: Flash) -> Bench {
    let mut bench = Bench::start(flash);
    bench.panel = bench.panel.with(Contact::FieldMode, false);
    bench.panel = bench.panel.with(Contact::Service, true);
    bench.run(400);
    ask(&mut bench, &[0xFF, 0]).unwrap();
    bench
}

/// The next packet to the tool.
fn packet(bench: &mut Bench) -> Option<Vec<u8>> {
    let from = bench.sent.len();
    for _ in 0..3_000 {
        bench.run(1);
        let packet = bench.sent[from..].iter().find_map(|(_, frame)| {
            let id = frame.extended_data_id().map(Id::unpack)?;
            let ours = id.pgn == Pgn::PROPRIETARY_A && id.destination == TOOL_ADDRESS;
            ours.then(|| frame.data().to_vec())
        });
        if packet.is_some() {
            return packet;
        }
    }
    None
}

fn ask(bench: &mut Bench, command: &[u8]) -> Result<Vec<u8>, u8> {
    let id = Id {
        priority: 6,
        pgn: Pgn::PROPRIETARY_A,
        destination: ECU,
        source: TOOL_ADDRESS,
    };
    let frame = Frame::data_frame(id.pack().into(), command).unwrap();
    bench.received.push(frame);
    let answer = packet(bench).expect("an answer");
    match answer.split_first() {
        Some((0xFF, rest)) => Ok(rest.to_vec()),
        Some((0xFE, rest)) => Err(rest[0]),
        other => panic!("{command:02X?}: {other:02X?}"),
    }
}

fn write(bench: &mut Bench, word: usize, value: i32) -> Result<(), u8> {
    let [a, b, c, d] = (CALIBRATION_BASE + 4 * word as u32).to_le_bytes();
    ask(bench, &[0xF6, 0, 0, 0, a, b, c, d])?;
    let [a, b, c, d] = value.to_le_bytes();
    ask(bench, &[0xF0, 4, a, b, c, d]).map(drop)
}

fn read(bench: &mut Bench, word: usize) -> i32 {
    let [a, b, c, d] = (CALIBRATION_BASE + 4 * word as u32).to_le_bytes();
    let bytes = ask(bench, &[0xF4, 4, 0, 0, a, b, c, d]).unwrap();
    i32::from_le_bytes(bytes.try_into().unwrap())
}

fn challenge(bench: &mut Bench) -> [u8; SEED_BYTES] {
    let mut bytes = Vec::new();
    for mode in [0, 1, 1] {
        bytes.extend(&ask(bench, &[0xF8, mode, 1]).unwrap()[1..]);
    }
    bytes.try_into().unwrap()
}

fn respond(bench: &mut Bench, response: [u8; 32]) -> Result<(), u8> {
    let pieces = response.chunks(6).zip([32, 26, 20, 14, 8, 2]);
    pieces
        .into_iter()
        .try_for_each(|(piece, left)| ask(bench, &[&[0xF7, left], piece].concat()).map(drop))
}

fn unlock(bench: &mut Bench) {
    let challenge = challenge(bench);
    respond(bench, secret().response(&challenge)).unwrap();
}

/// Asks for the working page to be stored, and waits for it.
fn store(bench: &mut Bench) {
    ask(bench, &[0xF9, 1, 0, 0]).unwrap();
    assert_eq!(packet(bench).unwrap()[..2], [0xFD, 0x03], "stored");
    bench.run(10);
}

fn word(of: (&str, &str)) -> usize {
    let mut names = GROUPS.iter().flat_map(|group| {
        let parameters = group.parameters.iter();
        parameters.map(|parameter| (group.name, parameter.name))
    });
    SCALARS_WORD + names.position(|name| name == of).unwrap()
}

/// Longest lag of the angle sensor that goes with the fastest onset, 48 mm/s: 9.6 mm.
const LAG_WITH_FASTEST_ONSET_MS: i32 = 200;

/// The loosest end of each value of the envelope and the sensors that has one looser than the default. All of them
/// together are a valid calibration.
fn loosest() -> Vec<(String, usize, i32)> {
    let scalars = GROUPS.iter().flat_map(|group| {
        let parameters = group.parameters.iter();
        parameters.map(move |parameter| (group.name, parameter))
    });
    scalars
        .zip(SCALARS_WORD..)
        .filter(|((group, _), _)| ["safety", "sensors"].contains(group))
        .filter_map(|((group, parameter), word)| {
            let end = match word_range(word).unwrap().class {
                Class::Safety(Tightening::Up) => parameter.min,
                Class::Safety(_) if parameter.name == "angle_lag" => LAG_WITH_FASTEST_ONSET_MS,
                Class::Safety(Tightening::Down | Tightening::None) => parameter.max,
                Class::Live | Class::Machine => panic!("{group}.{}", parameter.name),
            };
            (end != parameter.nominal).then(|| (format!("{group}.{}", parameter.name), word, end))
        })
        .collect()
}

/// Whether DM1 contains a code within 3 s, in one frame or in a message of several frames.
pub fn has_code(bench: &mut Bench, spn: u32, fmi: u8) -> bool {
    let from = bench.sent.len();
    bench.run(3_000);
    let expected = [spn as u8, (spn >> 8) as u8, ((spn >> 16) as u8) << 5 | fmi];
    let mut alone = false;
    let mut message: Vec<u8> = Vec::new();
    for (_, frame) in &bench.sent[from..] {
        let id = frame.extended_data_id().map(Id::unpack).unwrap();
        match id.pgn {
            Pgn::DM1 => alone |= frame.data()[2..5] == expected,
            Pgn::TRANSPORT_DATA => message.extend(&frame.data()[1..]),
            _ => {}
        }
    }
    alone || message.windows(3).any(|window| window == expected)
}

const SAFETY_VALUES: u32 = 520_192 + 14;

#[test]
fn without_the_key_no_safety_value_goes_to_its_loosest_end() {
    for flash in [Flash::blank(), Flash::blank().with_secret(&secret())] {
        let mut bench = serviced(flash);
        let before = bench.machine.ecu().calibration().clone();
        let all = loosest();
        assert!(all.len() >= 43, "{}", all.len());
        let accepted: Vec<_> = all
            .iter()
            .filter(|(_, word, end)| write(&mut bench, *word, *end) != Err(ACCESS_LOCKED))
            .collect();
        assert!(accepted.is_empty(), "{accepted:?}");
        println!("{} of {} accepted", accepted.len(), all.len());
        store(&mut bench);
        assert_eq!(*bench.machine.ecu().calibration(), before);
        assert!(!has_code(&mut bench, SAFETY_VALUES, 31));
    }
}

#[test]
fn with_the_key_each_safety_value_goes_there_is_stored_and_reported() {
    let flash = Flash::blank().with_secret(&secret());
    let mut bench = serviced(flash.clone());
    unlock(&mut bench);
    for (name, word, end) in loosest() {
        assert_eq!(write(&mut bench, word, end), Ok(()), "{name}");
    }
    store(&mut bench);
    let mut restarted = serviced(flash);
    for (name, word, end) in loosest() {
        assert_eq!(read(&mut restarted, word), end, "{name}");
        assert_eq!(restarted.machine.ecu().calibration().word(word), Some(end));
    }
    assert!(has_code(&mut restarted, SAFETY_VALUES, 31), "DM1");
}

#[test]
fn a_lag_too_long_for_the_onset_is_not_stored() {
    let flash = Flash::blank().with_secret(&secret());
    let mut bench = serviced(flash);
    unlock(&mut bench);
    for (_, word, end) in loosest() {
        write(&mut bench, word, end).unwrap();
    }
    let lag = word(("sensors", "angle_lag"));
    write(&mut bench, lag, LAG_WITH_FASTEST_ONSET_MS + 1).unwrap();
    let from = bench.sent.len();
    ask(&mut bench, &[0xF9, 1, 0, 0]).unwrap();
    bench.run(3_000);
    let said = |event: [u8; 2]| {
        bench.sent[from..]
            .iter()
            .any(|(_, f)| f.data().starts_with(&event))
    };
    assert!(said([0xFD, 0xFE]), "not stored");
    assert!(!said([0xFD, 0x03]), "stored");
}

#[test]
fn tightening_needs_no_key_and_what_is_stored_stays_tight() {
    let flash = Flash::blank();
    let mut bench = serviced(flash.clone());
    write(&mut bench, word(OPEN_TIME), 30).unwrap();
    store(&mut bench);
    assert!(has_code(&mut bench, SAFETY_VALUES, 31), "it differs");
    let mut restarted = serviced(flash);
    assert_eq!(read(&mut restarted, word(OPEN_TIME)), 30);
    assert_eq!(
        write(&mut restarted, word(OPEN_TIME), 40),
        Err(ACCESS_LOCKED),
        "the default is looser now"
    );
}

#[test]
fn a_response_of_one_start_opens_nothing_in_the_next() {
    let flash = Flash::blank().with_secret(&secret());
    let mut bench = serviced(flash.clone());
    let first = challenge(&mut bench);
    let recorded = secret().response(&first);
    respond(&mut bench, recorded).unwrap();
    write(&mut bench, word(OPEN_TIME), 44).unwrap();
    store(&mut bench);
    let mut next = serviced(flash);
    assert_ne!(challenge(&mut next), first, "the same millisecond");
    assert_eq!(respond(&mut next, recorded), Err(ACCESS_LOCKED));
}

#[test]
fn what_the_key_allowed_ends_with_the_session_unless_it_was_stored() {
    let mut bench = serviced(Flash::blank().with_secret(&secret()));
    unlock(&mut bench);
    write(&mut bench, word(OPEN_TIME), 44).unwrap();
    bench.run(5);
    let in_use = |bench: &Bench| bench.machine.ecu().calibration().safety.open_time.0;
    assert_eq!(in_use(&bench), 44);
    ask(&mut bench, &[0xFE]).unwrap();
    bench.run(5);
    assert_eq!(in_use(&bench), 40);
}

#[test]
fn damaged_safety_values_lock_the_hitch_until_they_are_stored_with_the_key() {
    let flash = Flash::blank().with_secret(&secret());
    let mut bench = serviced(flash.clone());
    write(&mut bench, word(OPEN_TIME), 30).unwrap();
    store(&mut bench);
    // The first copy is the only one; its first block has the safety values.
    flash.flip(100);
    let mut bench = Bench::start(flash.clone());
    bench.run(500);
    bench.pick_up(110_000);
    assert!(bench.is_still(2_000), "locked");
    assert_eq!(bench.state(), State::TransportLock);
    assert!(has_code(&mut bench, SAFETY_VALUES, 12), "DM1");
    let mut bench = serviced(flash.clone());
    assert_eq!(ask(&mut bench, &[0xF9, 1, 0, 0]), Err(ACCESS_LOCKED));
    unlock(&mut bench);
    store(&mut bench);
    let mut bench = Bench::start(flash);
    bench.run(500);
    bench.pick_up(110_000);
    assert!(!bench.is_still(2_000), "in operation again");
}
