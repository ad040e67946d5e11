//! Formatting, the order of folders, types of the scripts, lints and documentation, with warnings denied.

use anyhow::Result;
use arm_build::images::BOARDS;
use arm_build::toolchain::{ARM, Way};
use arm_build::{process, setup, workspace};

use crate::timings::Timings;
use crate::{ablation, circles, documents, layers, scripts, sources};

/// Runs all checks; the first that fails ends it.
pub fn run(way: Option<Way>, timings: &mut Timings) -> Result<()> {
    let cargo =
        |arguments: &[&str]| process::run(&mut process::command(workspace::cargo(), arguments));
    timings.measured("format, folders, documents, types of the scripts", || {
        cargo(&["fmt", "--all", "--check"])?;
        let crates = sources::crates()?;
        layers::check(&crates)?;
        circles::check(&crates)?;
        documents::check()?;
        ablation::check()?;
        scripts::check()
    })?;
    timings.measured("clippy", || {
        cargo(&[
            "clippy",
            "--locked",
            "--workspace",
            "--all-targets",
            "--",
            "--deny",
            "warnings",
        ])
    })?;
    timings.measured("doc", || {
        let arguments = ["doc", "--locked", "--workspace", "--no-deps"];
        let mut documentation = process::command(workspace::cargo(), &arguments);
        process::run(documentation.env("RUSTDOCFLAGS", "--deny warnings"))
    })?;
    timings.measured("clippy of the images", || {
        lint_images(setup::toolchain(way, ARM)?)
    })
}

/// The images exist for ARM only. Debian's packages have no clippy, so there the compiler's own lints must do.
fn lint_images(way: Way) -> Result<()> {
    let subcommand = match way {
        Way::Rustup => "clippy",
        Way::Debian => "check",
    };
    for feature in std::iter::once("emulated").chain(BOARDS) {
        let mut command = way.cargo(ARM, subcommand)?;
        command
            .args(["--package", "hitch-ecu", "--lib", "--bins"])
            .args(["--features", feature]);
        process::run(command.env("RUSTFLAGS", "--deny warnings"))?;
    }
    Ok(())
}
