//! Inputs of the controller, one record per step, for replaying the same steps in several places.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, ensure};
use hitch_quantities::signals::INPUT_BYTES;
use miniz_oxide::deflate::compress_to_vec;
use miniz_oxide::inflate::decompress_to_vec_with_limit;

/// The inputs of consecutive steps, as the controller's link carries them.
pub type Trace = Vec<[u8; INPUT_BYTES]>;

/// Word of the step's time.
const STEP_TIME: usize = 13;
const WORDS: usize = INPUT_BYTES / 4;
/// An hour of steps; a packed trace that claims more is damaged.
const MOST_BYTES: usize = 3_600_000 * INPUT_BYTES;
/// Slow but small: a fixture is packed once.
const LEVEL: u8 = 10;

/// Where the recorded closed loop is kept.
pub fn recorded_path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../host-tests/fixtures/closed_loop.trace")
}

/// The closed loop that `host_tests::recording` once recorded.
pub fn recorded() -> Result<Trace> {
    let path = recorded_path();
    let packed = std::fs::read(&path).with_context(|| format!("can't read {}", path.display()))?;
    unpack(&packed).with_context(|| format!("{} is damaged", path.display()))
}

/// Packs a trace: column by column, as differences from step to step, deflated.
pub fn pack(trace: &[[u8; INPUT_BYTES]]) -> Vec<u8> {
    let column = |word: usize| {
        let values = trace
            .iter()
            .map(move |record| record.as_chunks::<4>().0[word])
            .map(i32::from_le_bytes);
        values.scan(0_i32, |last, value| {
            let difference = value.wrapping_sub(*last);
            *last = value;
            Some(difference)
        })
    };
    let bytes: Vec<u8> = (0..WORDS)
        .flat_map(column)
        .flat_map(i32::to_le_bytes)
        .collect();
    compress_to_vec(&bytes, LEVEL)
}

/// The trace that [`pack`] packed.
pub fn unpack(packed: &[u8]) -> Result<Trace> {
    let bytes = decompress_to_vec_with_limit(packed, MOST_BYTES)
        .map_err(|error| anyhow!("not packed: {error}"))?;
    ensure!(
        bytes.len().is_multiple_of(INPUT_BYTES),
        "{} bytes are no whole number of records",
        bytes.len()
    );
    let steps = bytes.len() / INPUT_BYTES;
    let mut trace = vec![[0; INPUT_BYTES]; steps];
    for (word, column) in bytes.chunks_exact(4 * steps.max(1)).enumerate() {
        let mut value = 0_i32;
        for (record, difference) in trace.iter_mut().zip(column.as_chunks::<4>().0) {
            value = value.wrapping_add(i32::from_le_bytes(*difference));
            record.as_chunks_mut::<4>().0[word] = value.to_le_bytes();
        }
    }
    Ok(trace)
}

/// Random inputs: any bits at all, plausible ones, and plausible ones with one signal spoiled; each held for a while,
/// so that rate limits and time-outs see something too. The same `seed` gives the same trace.
pub fn random(seed: u64, steps: usize) -> Trace {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut record = [0; INPUT_BYTES];
    let mut held = 0_u32;
    (0..steps)
        .map(|step| {
            if held == 0 {
                let is_near_end = step > steps / 5 * 4;
                record = match random.u8(0..4) {
                    0 => any_bits(&mut random, is_near_end),
                    1 => spoiled(&mut random),
                    _ => plausible(&mut random),
                };
                held = [1, random.u32(1..10), random.u32(1..1_000)][random.usize(0..3)];
            }
            held -= 1;
            wander(&mut record, &mut random);
            record
        })
        .collect()
}

/// Any bits. Faults of a coil last until restart, and there is none in a trace: measured currents only come `with_currents`,
/// and a fault of the enable line (bit 30) never.
fn any_bits(random: &mut fastrand::Rng, with_currents: bool) -> [u8; INPUT_BYTES] {
    let mut record = [0; INPUT_BYTES];
    random.fill(&mut record);
    record[3] &= !(1 << 6);
    if !with_currents {
        // Validity of the 11th and 12th field.
        record[1] &= !(0b11 << 2);
    }
    record
}

/// One signal missing, or with any value at all.
fn spoiled(random: &mut fastrand::Rng) -> [u8; INPUT_BYTES] {
    let mut record = plausible(random);
    let word = random.usize(1..WORDS);
    if random.bool() {
        record[(word - 1) / 8] &= !(1 << ((word - 1) % 8));
    } else {
        record.as_chunks_mut::<4>().0[word] = random.i32(..).to_le_bytes();
    }
    record
}

/// All signals valid and in the range of a healthy machine; the button is pressed now and then.
fn plausible(random: &mut fastrand::Rng) -> [u8; INPUT_BYTES] {
    let pressed = random.u8(0..4) == 0;
    // Currents are measured by the board, which isn't here; switches and dials come and go.
    let fitted = 0b1_0000_0111_1101 | (random.i32(0..8) << 7);
    let switches = if random.u8(0..8) == 0 {
        random.i32(0..8) << 24
    } else {
        0
    };
    let valid = fitted | switches | (i32::from(pressed) << 1);
    let words = [
        valid,
        random.i32(40_000..140_000),
        random.i32(-20_000..20_000),
        random.i32(44_000..136_000),
        random.i32(0..160_000),
        random.i32(0..160_000),
        random.i32(-20_000..100_000),
        random.i32(9_000..16_000),
        random.i32(44_000..136_000),
        random.i32(0..1_000),
        random.i32(0..2_500),
        random.i32(0..3_500),
        random.i32(0..3_500),
        1_000,
        random.i32(44_000..136_000),
        random.i32(4_900..5_100),
        random.i32(980..1_020),
        random.i32(40_000..140_000),
        random.i32(900..1_100),
    ];
    let mut record = [0; INPUT_BYTES];
    for (target, word) in record.as_chunks_mut::<4>().0.iter_mut().zip(words) {
        *target = word.to_le_bytes();
    }
    record
}

/// Moves every value a little, as noise and motion do; the step's time, which is the 13th, is no signal and stays.
fn wander(record: &mut [u8; INPUT_BYTES], random: &mut fastrand::Rng) {
    for (index, word) in record.as_chunks_mut::<4>().0.iter_mut().enumerate() {
        if index == 0 || index == STEP_TIME {
            continue;
        }
        *word = i32::from_le_bytes(*word)
            .wrapping_add(random.i32(-100..=100))
            .to_le_bytes();
    }
}
