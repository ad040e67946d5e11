//! The flashed images on models of the boards with the plant attached: each scenario of
//! [`board_emulator::scenarios`], in a separate process.
//!
//! They need images for ARM: `cargo xtask test` builds them and runs these tests. `HITCH_BOARD_MINUTES` makes the random
//! operation longer, for a release.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use host_tests::instruction_counts;
use host_tests::python::{environment, run};

/// Names the folder with the images.
const IMAGES_VARIABLE: &str = "HITCH_BOARD_IMAGES";

/// The emulator's shared library, from its pinned Python package.
fn library() -> &'static Path {
    static LIBRARY: OnceLock<PathBuf> = OnceLock::new();
    LIBRARY.get_or_init(|| {
        let requirements = Path::new(env!("CARGO_MANIFEST_DIR")).join("python/unicorn.txt");
        let python = environment(&requirements, Path::new(env!("CARGO_TARGET_TMPDIR"))).unwrap();
        let script = "import os, unicorn; print(os.path.dirname(unicorn.__file__))";
        let folder = run(Command::new(python).args(["-c", script])).unwrap();
        Path::new(folder.trim()).join("lib/libunicorn.so.2")
    })
}

/// Runs a scenario; returns its output.
fn scenario(board: &str, name: &str) -> String {
    let folder = std::env::var_os(IMAGES_VARIABLE).expect("the folder with the images");
    let image = PathBuf::from(folder).join(format!("ecu-{board}"));
    let mut command = Command::new(env!("CARGO_BIN_EXE_board-bench"));
    command.arg(library()).arg(board).arg(image).arg(name);
    match run(&mut command) {
        Ok(said) => {
            println!("{said}");
            said
        }
        Err(error) => panic!("{error:#}"),
    }
}

/// A test a scenario of a board, and the names of these scenarios.
macro_rules! on_board {
    ($module:ident, $board:literal, $($function:ident: $name:literal,)*) => {
        mod $module {
            pub const NAMES: &[&str] = &[$($name),*];

            $(#[test]
            #[ignore = "needs the ARM images: run by `cargo xtask test`"]
            fn $function() {
                super::scenario($board, $name);
            })*
        }
    };
}

/// Scenarios on both boards of the ECU.
macro_rules! scenarios {
    ($($function:ident: $name:literal,)*) => {
        on_board!(stm32f405, "stm32f405", $($function: $name,)*);
        on_board!(stm32g474, "stm32g474", $($function: $name,)*);
    };
}

// What differs from the ECU's board with the same part, crystal, pins and dividers, and the bring-up on a desk.
on_board! {
    nucleo_g474re, "nucleo-g474re",
    boot: "boot",
    wrong_crystal: "wrong-crystal",
    lift_hold_lower: "lift-hold-lower",
    desk: "desk",
}

scenarios! {
    boot: "boot",
    factory_fresh: "factory-fresh",
    slow_crystal: "slow-crystal",
    dead_crystal: "dead-crystal",
    slow_clock_tolerance: "slow-clock-tolerance",
    wrong_crystal: "wrong-crystal",
    unsealed_image: "unsealed-image",
    lift_hold_lower: "lift-hold-lower",
    store_and_read_back: "store-and-read-back",
    power_cuts: "power-cuts",
    fault_history: "fault-history",
    log_compaction: "log-compaction",
    electrical_faults: "electrical-faults",
    frozen_track: "frozen-track",
    enable_line: "enable-line",
    crystal_failure: "crystal-failure",
    debugger_halt: "debugger-halt",
    stuck_program: "stuck-program",
    stack_overflow: "stack-overflow",
    flipped_registers: "flipped-registers",
    flipped_code: "flipped-code",
    wrong_clock: "wrong-clock",
    damaged_ram: "damaged-ram",
    bus_off: "bus-off",
    flooded_bus: "flooded-bus",
    remote_control: "remote-control",
    button_travel: "button-travel",
    button_contacts: "button-contacts",
    draft_and_depth: "draft-and-depth",
    stuck_conversions: "stuck-conversions",
    random_operation: "random-operation",
}

#[test]
#[ignore = "needs the ARM images: run by `cargo xtask test`"]
fn instructions_from_samples_to_pulses_are_those_that_are_written_down() {
    let counted = |part| {
        let said = scenario(part, "lift-hold-lower");
        let number = said
            .split_once("at most ")
            .and_then(|(_, rest)| rest.split_once(" instructions"))
            .and_then(|(number, _)| number.parse().ok());
        (part, number.expect("the scenario counts instructions"))
    };
    let counts = ["stm32f405", "stm32g474"].map(counted);
    instruction_counts::check_images(&counts).unwrap();
}

#[test]
fn no_scenario_is_left_out() {
    for (name, _) in board_emulator::scenarios::ALL {
        let on_both = stm32f405::NAMES.contains(&name) && stm32g474::NAMES.contains(&name);
        assert!(on_both || nucleo_g474re::NAMES.contains(&name), "{name}");
    }
}
