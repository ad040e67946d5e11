//! The key of the safety values: challenge and response, what it opens, and what does not.

use hitch_protocols::key::{RESPONSE_BYTES, SEED_BYTES, Secret};
use hitch_protocols::xcp::{Access, Event};
use hitch_quantities::calibration::calibration_words::word_range;
use hitch_quantities::calibration::class::{Class, Tightening};

use crate::client::{ACCESS_DENIED, ACCESS_LOCKED, Desk, scalar, scalars};

const SEQUENCE: u8 = 0x29;

fn secret(first: u8) -> Secret {
    let mut bytes = [0x5A; 32];
    bytes[0] = first;
    Secret::new(bytes).unwrap()
}

/// A desk with a secret, connected.
fn with_secret() -> Desk {
    let mut desk = Desk::with_secret(Some(secret(1)));
    desk.obeyed(&[0xFF, 0]);
    desk
}

/// The same after the right response.
pub fn unlocked() -> Desk {
    let mut desk = with_secret();
    let seed = seed(&mut desk);
    answer(&mut desk, &secret(1).response(&seed)).unwrap();
    desk
}

/// Asks for a challenge.
fn seed(desk: &mut Desk) -> [u8; SEED_BYTES] {
    let mut bytes = Vec::new();
    let mut mode = 0;
    while bytes.len() < SEED_BYTES {
        let piece = desk.obeyed(&[0xF8, mode, 1]);
        assert_eq!(usize::from(piece[0]), SEED_BYTES - bytes.len());
        bytes.extend(&piece[1..]);
        mode = 1;
    }
    bytes.try_into().unwrap()
}

/// Sends a response; the last answer.
fn answer(desk: &mut Desk, response: &[u8; RESPONSE_BYTES]) -> Result<(), u8> {
    for (index, piece) in response.chunks(6).enumerate() {
        let left = (RESPONSE_BYTES - 6 * index) as u8;
        desk.ask(&[&[0xF7, left], piece].concat())?;
    }
    Ok(())
}

/// The two ends of each safety value that are looser than `nominal`, or not known to be tighter.
fn loosest() -> Vec<(String, u32, i32)> {
    let mut all = Vec::new();
    for (group, parameter, address, _) in scalars() {
        let word = ((address & 0xFFFF) / 4) as usize;
        let Class::Safety(tightening) = word_range(word).unwrap().class else {
            continue;
        };
        let ends = match tightening {
            Tightening::Up => vec![parameter.min],
            Tightening::Down => vec![parameter.max],
            Tightening::None => vec![parameter.min, parameter.max],
        };
        let name = format!("{group}.{}", parameter.name);
        let ends = ends.into_iter().filter(|&end| end != parameter.nominal);
        all.extend(ends.map(|end| (name.clone(), address, end)));
    }
    all
}

#[test]
fn without_the_key_no_safety_value_is_loosened_and_with_it_each_one() {
    for mut desk in [Desk::connected(), with_secret()] {
        for (name, address, end) in loosest() {
            let before = desk.read(address);
            assert_eq!(desk.write(address, end), Err(ACCESS_LOCKED), "{name}");
            assert_eq!(desk.read(address), before, "{name}");
        }
    }
    assert!(loosest().len() > 43);
    let mut desk = unlocked();
    for (name, address, end) in loosest() {
        assert_eq!(desk.write(address, end), Ok(()), "{name}");
    }
}

#[test]
fn tightening_needs_no_key_and_may_be_taken_back_until_it_is_stored() {
    let mut desk = with_secret();
    let open_time = scalar("safety", "open_time");
    assert_eq!(desk.write(open_time, 30), Ok(()));
    assert_eq!(desk.write(open_time, 35), Ok(()));
    let stored = desk.pages.to_store().unwrap();
    desk.pages.stored(&stored);
    assert_eq!(desk.write(open_time, 40), Err(ACCESS_LOCKED), "stored");
    assert_eq!(desk.write(open_time, 35), Ok(()), "as it is");
}

#[test]
fn the_key_opens_nothing_while_the_hitch_moves() {
    let mut desk = unlocked();
    desk.access = Access::Moving;
    assert_eq!(
        desk.write(scalar("safety", "open_time"), 44),
        Err(ACCESS_DENIED)
    );
}

#[test]
fn a_wrong_key_ends_the_session_and_the_next_challenge_waits_for_ten_seconds() {
    let mut desk = with_secret();
    let given = seed(&mut desk);
    let wrong = secret(2).response(&given);
    assert_eq!(answer(&mut desk, &wrong), Err(ACCESS_LOCKED));
    desk.send(&[0xFD]);
    assert!(desk.packets().is_empty(), "no longer connected");
    desk.obeyed(&[0xFF, 0]);
    for _ in 0..9_999 {
        desk.event(Event::Every1Ms);
    }
    assert_eq!(desk.ask(&[0xF8, 0, 1]), Err(ACCESS_LOCKED));
    desk.event(Event::Every1Ms);
    let given = seed(&mut desk);
    assert_eq!(answer(&mut desk, &secret(1).response(&given)), Ok(()));
    assert_eq!(desk.obeyed(&[0xF8, 0, 1]), [0], "unlocked: no seed");
}

#[test]
fn every_flipped_bit_of_a_response_is_noticed() {
    for bit in 0..8 * RESPONSE_BYTES {
        let mut desk = with_secret();
        let given = seed(&mut desk);
        let mut response = secret(1).response(&given);
        response[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(answer(&mut desk, &response), Err(ACCESS_LOCKED), "{bit}");
        assert!(!desk.slave.is_unlocked());
    }
}

#[test]
fn a_replayed_response_opens_nothing() {
    let mut desk = with_secret();
    let first = seed(&mut desk);
    let recorded = secret(1).response(&first);
    assert_eq!(answer(&mut desk, &recorded), Ok(()));
    desk.obeyed(&[0xFE]);
    assert_eq!(
        answer(&mut with_secret(), &recorded),
        Err(SEQUENCE),
        "no challenge"
    );
    desk.now_us += 1;
    desk.obeyed(&[0xFF, 0]);
    assert_ne!(seed(&mut desk), first);
    assert_eq!(answer(&mut desk, &recorded), Err(ACCESS_LOCKED));
}

#[test]
fn a_challenge_serves_one_attempt_and_depends_on_all_that_makes_it_new() {
    let mut desk = with_secret();
    let first = seed(&mut desk);
    assert_eq!(
        desk.ask(&[0xF7, 5, 0, 0, 0, 0, 0]),
        Err(SEQUENCE),
        "a wrong length"
    );
    let response = secret(1).response(&first);
    assert_eq!(answer(&mut desk, &response), Err(SEQUENCE), "used up");
    let changes: [fn(&mut Desk); 4] = [
        |desk| desk.now_us += 1,
        |desk| desk.nonce.safety_sequence += 1,
        |desk| desk.nonce.serial_number += 1,
        |desk| desk.nonce.stir([1]),
    ];
    let mut seeds = vec![first];
    for change in changes {
        change(&mut desk);
        let next = seed(&mut desk);
        assert!(!seeds.contains(&next));
        seeds.push(next);
    }
}

#[test]
fn pieces_out_of_order_give_nothing() {
    let mut desk = with_secret();
    assert_eq!(
        desk.ask(&[0xF8, 1, 1]),
        Err(SEQUENCE),
        "the rest of no seed"
    );
    assert_eq!(desk.ask(&[0xF7, 32, 1, 2, 3, 4, 5, 6]), Err(SEQUENCE));
    desk.obeyed(&[0xF8, 0, 1]);
    assert_eq!(
        desk.ask(&[0xF7, 32, 1, 2, 3, 4, 5, 6]),
        Err(SEQUENCE),
        "a seed that was read in part"
    );
}

#[test]
fn the_right_ends_with_the_session_and_with_the_service_contact() {
    let address = scalar("safety", "open_time");
    let mut desk = unlocked();
    desk.obeyed(&[0xFF, 0]);
    assert_eq!(
        desk.write(address, 44),
        Err(ACCESS_LOCKED),
        "connected anew"
    );
    let mut desk = unlocked();
    desk.access = Access::Locked;
    desk.event(Event::Every1Ms);
    desk.access = Access::AtRest;
    assert_eq!(desk.write(address, 44), Err(ACCESS_LOCKED));
}

#[test]
fn what_the_key_allowed_and_nobody_stored_is_taken_back() {
    let mut desk = unlocked();
    let (loose, tight) = (
        scalar("safety", "open_time"),
        scalar("safety", "short_time"),
    );
    desk.write(loose, 44).unwrap();
    desk.write(tight, 4).unwrap();
    desk.pages.revert_loosened();
    assert_eq!(desk.read(loose), Ok(40));
    assert_eq!(desk.read(tight), Ok(4), "tighter values stay");
}

#[test]
fn lost_safety_values_are_stored_with_the_key_only() {
    let mut desk = with_secret();
    desk.pages.require_key_to_store();
    assert_eq!(desk.ask(&[0xF9, 1, 0, 0]), Err(ACCESS_LOCKED));
    let mut desk = unlocked();
    desk.pages.require_key_to_store();
    desk.obeyed(&[0xF9, 1, 0, 0]);
}

// RFC 4231 gives keys of up to 131 bytes; this wrapper takes 32. The expected value is that of Python:
// hmac.new(bytes(range(1, 33)), bytes(range(16)), hashlib.sha256).hexdigest()
#[test]
fn the_response_is_hmac_sha_256_of_the_challenge() {
    let key: [u8; 32] = std::array::from_fn(|index| index as u8 + 1);
    let challenge: [u8; SEED_BYTES] = std::array::from_fn(|index| index as u8);
    let expected = "486c4ef49b3080a48142cc198f13e52d49db4cfecece8065124852e4ecf2d749";
    let response = Secret::new(key).unwrap().response(&challenge);
    let found: String = response.iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(found, expected);
}

#[test]
fn a_secret_is_read_from_its_record_and_from_nothing_else() {
    let record = secret(1).to_record();
    assert_eq!(Secret::from_record(&record), Some(secret(1)));
    for bit in 0..8 * record.len() {
        let mut damaged = record;
        damaged[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(Secret::from_record(&damaged), None, "{bit}");
    }
    assert_eq!(Secret::new([0xFF; 32]), None);
    assert_eq!(Secret::new([0; 32]), None);
    assert_eq!(format!("{:?}", secret(1)), "Secret", "it is not shown");
}
