//! Runs scenarios on the flashed images: `board-bench LIBRARY BOARD IMAGE [SCENARIO...]`.
//!
//! The library is Unicorn, which is GPL: it is loaded in this separate process, and not linked.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use board_emulator::scenarios::{ALL, Scenario, Setup};
use board_emulator::{Image, Layout};
use clap::Parser;

/// Runs scenarios on an image as it is flashed.
#[derive(Debug, Parser)]
struct Arguments {
    /// Shared library of the CPU emulator Unicorn, `libunicorn.so.2`.
    library: PathBuf,
    /// The board: stm32f405, stm32g474 or nucleo-g474re.
    board: Layout,
    /// ELF file of the image.
    image: PathBuf,
    /// Names of scenarios; all of them if there is none.
    scenarios: Vec<String>,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(failed) => {
            eprintln!("{failed} scenarios failed");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("board-bench: {error:#}");
            ExitCode::from(2)
        }
    }
}

/// Runs the scenarios; how many failed.
fn run(arguments: &Arguments) -> Result<usize> {
    let setup = Setup {
        library: arguments.library.clone(),
        layout: arguments.board,
        image: Image::read(Path::new(&arguments.image))?,
        model: hitch_model_file::nominal(),
    };
    let mut failed = 0;
    for (name, scenario) in chosen(&arguments.scenarios)? {
        let started = Instant::now();
        let result = scenario(&setup);
        let took = started.elapsed().as_secs_f64();
        match result {
            Ok(measured) => println!(
                "{} {name} passed in {took:.1} s\n{}",
                setup.layout,
                indented(&measured)
            ),
            Err(error) => {
                failed += 1;
                println!(
                    "{} {name} FAILED in {took:.1} s\n{}",
                    setup.layout,
                    indented(&format!("{error:#}"))
                );
            }
        }
    }
    Ok(failed)
}

fn indented(text: &str) -> String {
    text.lines().map(|line| format!("  {line}\n")).collect()
}

fn chosen(names: &[String]) -> Result<Vec<(&'static str, Scenario)>> {
    if names.is_empty() {
        return Ok(ALL.to_vec());
    }
    let find = |name: &String| {
        let found = ALL.iter().find(|(known, _)| known == name).copied();
        found.with_context(|| {
            let known: Vec<&str> = ALL.iter().map(|(name, _)| *name).collect();
            format!(
                "there is no scenario `{name}`; there are: {}",
                known.join(", ")
            )
        })
    };
    let found = names.iter().map(find).collect::<Result<Vec<_>>>()?;
    if found.is_empty() {
        bail!("no scenario")
    } else {
        Ok(found)
    }
}
