//! Tools for the firmware that need large libraries: finished images, their sizes and stacks, the description file of the
//! parameters, and the coverage of the safety envelope. `cargo xtask` starts them.

mod a2l;
mod branches;
mod budget;
mod coverage;
mod image;
mod programming;
mod seal;
mod size;

use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use arm_build::setup;
use arm_build::toolchain::{ARM, Way};

const USAGE: &str = "\
usage: firmware-tools arm|sizes|stack [rustup|debian]
       firmware-tools a2l|coverage

`cargo xtask help` describes them.";

fn main() -> ExitCode {
    if let Some(code) = coverage::compile() {
        return code;
    }
    match run(&std::env::args().skip(1).collect::<Vec<_>>()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("firmware-tools: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &[String]) -> Result<()> {
    let (task, options) = arguments.split_first().context(USAGE)?;
    let way = match options {
        [] => None,
        [name] => Some(name.parse::<Way>()?),
        _ => bail!("unknown options {options:?}\n{USAGE}"),
    };
    match task.as_str() {
        "arm" => image::build(setup::toolchain(way, ARM)?),
        "sizes" => image::write_sizes(setup::toolchain(way, ARM)?),
        "stack" => image::show_stacks(setup::toolchain(way, ARM)?),
        "a2l" => a2l::write(),
        "coverage" => coverage::run(),
        unknown => bail!("unknown task `{unknown}`\n{USAGE}"),
    }
}
