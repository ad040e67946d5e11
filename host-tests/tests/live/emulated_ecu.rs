//! The whole application on the emulated ECU behaves exactly as on the host, within its memory.
//!
//! These tests require QEMU and an image for ARM, which `cargo xtask test` provides.

use std::time::{Duration, Instant};

use board_emulator::ecu_tool;
use hitch_ecu::link::{FRAME_BYTES, REPLY_BYTES, Reply};
use hitch_ecu_host::ecu::{Bench, CALIBRATION_BYTES, CutFlash, Emulator, Mode, delivered};
use hitch_protocols::storage::{CalibrationStore, Source};
use hitch_quantities::ValidCalibration;
use host_tests::seeds::cases;
use host_tests::{ecu_day, emulator};

const SEED: u64 = 20_260_101;
/// Minutes of work; `HITCH_EMULATED_MINUTES` makes it longer or shorter.
const MINUTES: u64 = 10;
/// The same with `HITCH_THOROUGH`.
const THOROUGH_MINUTES: u64 = 60;
/// Instructions from the converters' codes to the drivers' pulses, whatever happens: 4 % of a millisecond at 168 MHz
/// and two clocks an instruction.
const MOST_INSTRUCTIONS: u64 = 12_000;
/// Instructions of a whole millisecond without storing: the limit at 168 MHz and two cycles per instruction.
const MOST_OF_MILLISECOND: u64 = 84_000;
/// RAM of the ECU that the application may take, its stack included.
const MOST_RAM_BYTES: u64 = 48 * 1024;

#[test]
#[ignore = "needs the ARM image: run by `cargo xtask test`"]
fn work_with_faults_is_byte_identical() {
    let minutes = std::env::var("HITCH_EMULATED_MINUTES").map_or_else(
        |_| cases(MINUTES, THOROUGH_MINUTES),
        |minutes| minutes.parse().expect("a number of minutes"),
    );
    let flash = delivered(&ValidCalibration::nominal());
    let started = Instant::now();
    let day = ecu_day::live(SEED, minutes * 60_000, flash.clone()).unwrap();
    let here_s = started.elapsed().as_secs_f64();
    println!(
        "seed {SEED}, {minutes} minutes: coils on for {:.0} s, {} frames said; states {:?}, faults {:?}",
        day.moving_ms as f64 * 1e-3,
        day.frames,
        day.states,
        day.faults
    );
    assert!(
        day.moving_ms > minutes * 2_000,
        "a run without work proves nothing"
    );
    assert!(
        day.flash[..CALIBRATION_BYTES] != flash[..CALIBRATION_BYTES],
        "nothing was ever stored: a run without tuning proves nothing"
    );

    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("flash"), &flash).unwrap();
    let started = Instant::now();
    let image = emulator::image().unwrap();
    let console = emulator::boot(&image, folder.path(), Mode::Ecu, &day.requests).unwrap();
    let there_s = started.elapsed().as_secs_f64();
    let ram_bytes = emulator::said(&console.text, "stack_bytes").unwrap();
    let instructions = |key| emulator::said(&console.text, key).unwrap() * 5 / 8;
    let control = instructions("longest_control_ticks");
    let [working, resting] = ["longest_working_ticks", "longest_ticks"].map(instructions);
    println!(
        "{here_s:.1} s here, {there_s:.1} s there; instructions, at most: {control} from samples to pulses, a millisecond \
         {working} with a coil on, {resting} at rest and {} while storing; {ram_bytes} bytes of RAM",
        instructions("longest_storing_ticks")
    );
    if let Some(millisecond) = first_difference(&day.replies, &console.outputs) {
        panic!("the target does not do what the host does from millisecond {millisecond} on");
    }
    let there = std::fs::read(folder.path().join("flash")).unwrap();
    assert!(
        there == day.flash,
        "the flash differs at the end of the day"
    );
    assert!(
        (1..=MOST_INSTRUCTIONS).contains(&control),
        "{control} instructions from samples to pulses, more than {MOST_INSTRUCTIONS}"
    );
    assert!(
        working.max(resting) <= MOST_OF_MILLISECOND,
        "{} instructions in a millisecond have no room in it",
        working.max(resting)
    );
    assert!(ram_bytes <= MOST_RAM_BYTES, "{ram_bytes} bytes of RAM");
    let bound = emulator::stack_bound().unwrap();
    assert!(
        ram_bytes <= bound,
        "{ram_bytes} bytes of stack were used, and {bound} were said to do"
    );
}

/// The first millisecond whose reply or frames differ.
fn first_difference(here: &[u8], there: &[u8]) -> Option<usize> {
    let (mut at, mut millisecond) = (0, 0);
    while at < here.len().max(there.len()) {
        let head = here.get(at..at + REPLY_BYTES)?.first_chunk()?;
        let end = at + REPLY_BYTES + usize::from(Reply::from_bytes(head).frames) * FRAME_BYTES;
        if here.get(at..end) != there.get(at..end) {
            return Some(millisecond);
        }
        at = end;
        millisecond += 1;
    }
    None
}

#[test]
#[ignore = "needs the ARM image: run by `cargo xtask test`"]
fn a_killed_emulator_finds_its_calibration_again_and_stays_locked() {
    const KILLS: i32 = 12;
    /// Storing takes 46 milliseconds, one erased page or programmed chunk each.
    const LATEST_MS: u32 = 55;
    let model = hitch_model_file::named("nominal").unwrap();
    let image = emulator::image().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("flash");
    let nominal = ValidCalibration::nominal();
    std::fs::write(&file, delivered(&nominal)).unwrap();
    let word = ecu_tool::word("position", "approach_gain").unwrap();
    let mut random = fastrand::Rng::with_seed(3);
    let (mut present, mut changed) = (nominal.position.approach_gain.0, 0);
    for kill in 0..KILLS {
        let mut machine = Emulator::start(&image, folder.path()).unwrap();
        let mut bench = Bench::new(&model, 200.0, 40.0, 90.0, kill as u64);
        let mut last = None;
        for _ in 0..200 {
            let moment = bench.tick(&mut machine, &[], &mut Vec::new()).unwrap();
            assert!(
                !moment.reply.enable,
                "kill {kill}: a coil is on after the restart"
            );
            last = Some(moment.contacts);
        }
        let wanted = 20 + kill;
        ecu_tool::begin_service(&mut bench, &mut machine).unwrap();
        ecu_tool::change(&mut bench, &mut machine, word, wanted).unwrap();
        ecu_tool::store(&mut bench, &mut machine).unwrap();
        for _ in 0..random.u32(0..LATEST_MS) {
            bench.tick(&mut machine, &[], &mut Vec::new()).unwrap();
        }
        let after = Duration::from_micros(random.u64(0..200));
        machine.cut_power(&last.unwrap(), after).unwrap();

        let flash = CutFlash::holding(std::fs::read(&file).unwrap());
        let loaded = CalibrationStore::new(flash).load();
        let gain = loaded.calibration.position.approach_gain.0;
        assert!(
            matches!(loaded.source, Source::Stored { .. }) && [present, wanted].contains(&gain),
            "kill {kill}: {gain} from {:?}",
            loaded.source
        );
        changed += i32::from(gain == wanted);
        present = gain;
    }
    println!("{KILLS} kills while storing; {changed} came after the end");
    assert!(changed < KILLS, "no kill came in time");
}
