//! A power cut at any time neither destroys a calibration nor moves the hitch.

use board_emulator::ecu_tool;
use fastrand::Rng;
use hitch_ecu_host::ecu::{Bench, CutFlash, OnHost, delivered};
use hitch_plant::Model;
use hitch_protocols::storage::{CalibrationStore, Source};
use hitch_quantities::{State, ValidCalibration};

const LOAD_KG: f64 = 200.0;
const OIL_TEMPERATURE_C: f64 = 40.0;
const START_DEG: f64 = 90.0;
const SWINGING_MS: u32 = 3_000;
/// The number that is tuned, in raw counts: 1/s.
const GAIN: (&str, &str) = ("position", "approach_gain");
const NEW_GAIN: i32 = 31;

fn bench(model: &Model, seed: u64) -> Bench<'_> {
    Bench::new(model, LOAD_KG, OIL_TEMPERATURE_C, START_DEG, seed)
}

/// The gain in the calibration that `flash` gives, and where that comes from.
fn stored_gain(flash: &CutFlash) -> (i32, Source) {
    let loaded = CalibrationStore::new(flash.clone()).load();
    (loaded.calibration.position.approach_gain.0, loaded.source)
}

/// Starts the ECU again without any operation; no coil may be driven.
fn assert_nothing_moves(bench: &mut Bench<'_>, flash: &CutFlash, milliseconds: u32, when: &str) {
    bench.operator.lever_target_deg = bench.operator.lever_deg;
    // The valves close, and a moving load oscillates on its oil until it rests.
    (0..SWINGING_MS).for_each(|_| bench.tick_without_power());
    let (rest_deg, mut machine) = (bench.angle_deg(), OnHost::start(flash.clone()));
    for millisecond in 0..milliseconds {
        let moment = bench.tick(&mut machine, &[], &mut Vec::new()).unwrap();
        assert!(
            !moment.reply.enable && moment.reply.lift == 0 && moment.reply.lower == 0,
            "{when}: a coil is on {millisecond} ms after the restart"
        );
    }
    let moved_deg = (bench.angle_deg() - rest_deg).abs();
    assert!(
        moved_deg < 0.02,
        "{when}: the hitch moved by {moved_deg} deg"
    );
}

// REQ-SAFE-09
#[test]
fn a_power_cut_at_any_word_of_storing_leaves_the_old_calibration_or_the_new() {
    let model = hitch_model_file::named("nominal").unwrap();
    let nominal = ValidCalibration::nominal();
    let (word, old_gain) = (
        ecu_tool::word(GAIN.0, GAIN.1).unwrap(),
        nominal.position.approach_gain.0,
    );
    assert_ne!(old_gain, NEW_GAIN);
    let (mut cuts, mut new_ones) = (0, 0);
    for words in 0.. {
        let flash = CutFlash::holding(delivered(&nominal));
        let mut bench = bench(&model, words);
        let mut machine = OnHost::start(flash.clone());
        ecu_tool::begin_service(&mut bench, &mut machine).unwrap();
        ecu_tool::change(&mut bench, &mut machine, word, NEW_GAIN).unwrap();
        flash.cut_after(Some(words));
        ecu_tool::store(&mut bench, &mut machine).unwrap();
        let mut stored = false;
        for _ in 0..200 {
            if flash.is_cut() || stored {
                break;
            }
            let mut said = Vec::new();
            bench.tick(&mut machine, &[], &mut said).unwrap();
            stored |= ecu_tool::says_stored(&said);
        }
        let survived = !flash.is_cut();
        flash.cut_after(None);
        let (gain, source) = stored_gain(&flash);
        assert!(
            matches!(source, Source::Stored { .. }) && [old_gain, NEW_GAIN].contains(&gain),
            "cut after {words} words: {gain} from {source:?}"
        );
        assert!(
            !stored || gain == NEW_GAIN,
            "cut after {words} words: said to be stored, and isn't"
        );
        assert_nothing_moves(&mut bench, &flash, 50, &format!("cut after {words} words"));
        cuts += u32::from(!survived);
        new_ones += u32::from(gain == NEW_GAIN);
        if survived {
            assert!(stored, "with power it has to be stored");
            break;
        }
    }
    println!("{cuts} cuts, {new_ones} of them after which the new calibration counts");
    assert!(cuts > 300, "only {cuts} words were written");
}

// REQ-SAFE-09
#[test]
fn a_power_cut_at_any_instant_of_a_move_moves_nothing_afterwards() {
    let model = hitch_model_file::named("dynamic").unwrap();
    let mut random = Rng::with_seed(7);
    let mut cut_while_moving = 0;
    for case in 0..60 {
        let flash = CutFlash::holding(delivered(&ValidCalibration::nominal()));
        let mut bench = bench(&model, case);
        let mut machine = OnHost::start(flash.clone());
        let mut tick = |bench: &mut Bench<'_>| {
            bench
                .tick(&mut machine, &[], &mut Vec::new())
                .unwrap()
                .reply
        };
        bench.operator.lever_target_deg = START_DEG;
        for _ in 0..1_000 {
            tick(&mut bench);
        }
        bench.operator.lever_target_deg = if case % 2 == 0 { 130.0 } else { 50.0 };
        let mut last = None;
        for _ in 0..random.u32(1..1_200) {
            last = Some(tick(&mut bench).state);
        }
        let moving = [State::Lifting, State::Lowering].map(|state| state as u8);
        cut_while_moving += u32::from(last.is_some_and(|state| moving.contains(&state)));
        // The lever stays where the operator left it, far from the hitch.
        assert_nothing_moves(&mut bench, &flash, 2_000, &format!("case {case}"));
    }
    println!("{cut_while_moving} of 60 cuts came while the hitch moved");
    assert!(cut_while_moving > 20, "{cut_while_moving}");
}
