//! Project tasks that need more than cargo.

mod a2l;
mod ablation;
mod benchmarks;
mod budget;
mod check;
mod coverage;
mod documents;
mod image;
mod layers;
mod mutants;
mod programming;
mod scripts;
mod seal;
mod size;
mod test;

use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use arm_build::setup;
use arm_build::toolchain::Way;

const USAGE: &str = "\
usage: cargo xtask <task> [--arm rustup|debian]

  test    set up what is missing, build the ARM images, run every test, say how many passed
  check   formatting, the order of folders, types of the scripts, clippy and rustdoc, with warnings denied
  ci      check, coverage, mutants, then test
  arm     build the ARM images, say how large they are, and hold them to their budgets
  sizes   write down how large the images are and how deep their stacks get, in firmware/sizes.txt
  stack   show the calls that make the images' stacks deepest
  coverage run the safety envelope's tests; each piece of its code has to be reached
  mutants [--again]
          change the safety envelope, position control, storage and remote control in every way that cargo-mutants
          knows; their tests have to notice. Only if their code is not the one for which firmware/mutants.txt says
          that they do, or with --again
  ablations identification|control [NAME...]
          remove one heuristic of xtask/ablations.toml at a time and print what the benchmark loses
  benchmarks [NAME...]
          measure the results in docs/BENCHMARKS.md, or those of these names, again and write them into it
  a2l     write firmware/hitch.a2l, the description of parameters and measurements for tuning tools
  setup   find or install the ARM toolchain and the emulator

  --arm   take this ARM toolchain instead of the first that works:
          rustup   the target thumbv7em-none-eabihf of the toolchain in use
          debian   the packages rustc-web, cargo-web and rust-web-src";

fn main() -> ExitCode {
    if let Some(code) = coverage::compile() {
        return code;
    }
    match run(&std::env::args().skip(1).collect::<Vec<_>>()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("xtask: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &[String]) -> Result<()> {
    let (task, options) = arguments.split_first().context(USAGE)?;
    if task == "ablations" {
        return ablation::run(options);
    }
    if task == "benchmarks" {
        return benchmarks::run(options);
    }
    let again = task == "mutants" && options == ["--again"];
    let way = match options {
        [] => None,
        _ if again => None,
        [flag, name] if flag == "--arm" => Some(name.parse::<Way>()?),
        _ => bail!("unknown options {options:?}\n{USAGE}"),
    };
    match task.as_str() {
        "test" => test::run(way),
        "check" => check::run(way),
        "ci" => check::run(way)
            .and_then(|()| coverage::run())
            .and_then(|()| mutants::run(false))
            .and_then(|()| test::run(way)),
        "arm" => image::build_all(setup::toolchain(way)?).map(drop),
        "sizes" => budget::write(&image::sizes(setup::toolchain(way)?)?),
        "stack" => image::show_stacks(setup::toolchain(way)?),
        "coverage" => coverage::run(),
        "mutants" => mutants::run(again),
        "a2l" => a2l::write(),
        "setup" => setup::run(way),
        "help" | "--help" | "-h" => {
            println!("{USAGE}");
            Ok(())
        }
        unknown => bail!("unknown task `{unknown}`\n{USAGE}"),
    }
}
