//! The controller on the emulated ECU behaves exactly as on the host.
//!
//! These tests require QEMU and an image for ARM, which `cargo xtask test` provides.

use std::sync::LazyLock;

use hitch_ecu_host::ecu::Mode;
use host_tests::emulator::{self, EmulatedRun, instructions};
use host_tests::instruction_counts;
use host_tests::replay;
use host_tests::trace::{self, Trace};

/// Instructions that a step may take on the ECU: at 168 MHz and some two clocks an instruction, 4 % of a millisecond.
const MOST_INSTRUCTIONS: u64 = 12_000;
const RANDOM_SEED: u64 = 20_040_917;
const RANDOM_STEPS: usize = 100_000;

static RECORDED: LazyLock<(Trace, EmulatedRun)> = LazyLock::new(|| run(trace::recorded().unwrap()));

fn run(trace: Trace) -> (Trace, EmulatedRun) {
    let run = emulator::run(&emulator::image().unwrap(), &trace).unwrap();
    (trace, run)
}

fn assert_same(trace: &Trace, run: &EmulatedRun) {
    if let Some(difference) = replay::first_difference(trace, &replay::replay(trace), &run.outputs)
    {
        panic!("the target does not do what the host does: {difference}");
    }
}

fn print_cost(name: &str, run: &EmulatedRun) {
    let worst = run.instructions.iter().max().unwrap();
    let mean = run.instructions.iter().sum::<u64>() as f64 / run.instructions.len() as f64;
    println!(
        "{name}: {} steps, instructions a step: mean {mean:.0}, worst {worst}; stack {} bytes",
        run.outputs.len(),
        run.stack_bytes
    );
}

#[test]
#[ignore = "needs the ARM image: run by `cargo xtask test`"]
fn a_recorded_closed_loop_is_bit_identical() {
    let (trace, run) = &*RECORDED;
    assert!(
        run.outputs.len() >= 10_000,
        "only {} steps",
        run.outputs.len()
    );
    assert_same(trace, run);
}

#[test]
#[ignore = "needs the ARM image: run by `cargo xtask test`"]
fn random_inputs_are_bit_identical() {
    println!("random inputs: seed {RANDOM_SEED}");
    let (trace, run) = run(trace::random(RANDOM_SEED, RANDOM_STEPS));
    assert_eq!(run.outputs.len(), RANDOM_STEPS);
    print_cost("random inputs", &run);
    assert_same(&trace, &run);
}

#[test]
#[ignore = "needs the ARM image: run by `cargo xtask test`"]
fn a_step_fits_the_ecu() {
    let (_, run) = &*RECORDED;
    print_cost("recorded closed loop", run);
    let (step, worst) = run
        .instructions
        .iter()
        .enumerate()
        .max_by_key(|(_, count)| **count)
        .unwrap();
    assert!(*worst > 0, "the emulator counts no instructions");
    assert!(
        *worst <= MOST_INSTRUCTIONS,
        "step {step} takes {worst} instructions, more than {MOST_INSTRUCTIONS}"
    );
}

#[test]
#[ignore = "needs the ARM image: run by `cargo xtask test`"]
fn a_step_and_its_parts_take_the_recorded_instructions() {
    let (_, run) = &*RECORDED;
    let count = run.instructions.len() as u64;
    let folder = tempfile::tempdir().unwrap();
    let parts = emulator::boot(&emulator::image().unwrap(), folder.path(), Mode::Parts, &[]);
    let said = parts.unwrap().text;
    let part = |name| instructions(emulator::said(&said, name).unwrap());
    let counts = [
        ("step-mean", run.instructions.iter().sum::<u64>() / count),
        ("step-worst", *run.instructions.iter().max().unwrap()),
        ("lift-map-worst", part("lift_map")),
        ("lower-map-worst", part("lower_map")),
        (
            "lower-map-of-flow-and-drop-worst",
            part("lower_map_of_flow_and_drop"),
        ),
        ("pi-worst", part("pi")),
        (
            "regulation-of-one-coil-worst",
            part("regulation_of_one_coil"),
        ),
        (
            "regulation-of-both-coils-worst",
            part("regulation_of_both_coils"),
        ),
        // Required are 600; 1 233 were measured, and growth is an error.
        ("reference-layer-worst", part("reference_layer")),
    ];
    instruction_counts::check(&counts).unwrap();
}

#[test]
#[ignore = "needs the ARM image: run by `cargo xtask test`"]
fn a_truncated_trace_is_refused() {
    let image = emulator::image().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let error = emulator::boot(&image, folder.path(), Mode::Steps, &[0; 33])
        .err()
        .expect("33 bytes are no whole record")
        .to_string();
    assert!(error.contains("ends inside a record"), "{error}");
}
