//! Finds the ARM tools, a browser and Node.js, and installs missing ones if this is possible without interaction.

use std::path::Path;

use anyhow::{Context, Result, bail};

use crate::process;
use crate::toolchain::{ARM, Target, Way};

/// The emulator executable.
pub const EMULATOR: &str = "qemu-system-arm";

/// The browser for the tests of the page of `hitch serve`.
pub const BROWSER: &str = "chromium";

/// Node.js and its package manager: programs, and Debian's packages.
const NODE: [(&str, &str); 2] = [("node", "nodejs"), ("npm", "npm")];

const DEBIAN_TOOLCHAIN: [&str; 3] = ["rustc-web", "cargo-web", "rust-web-src"];

/// Finds or installs everything.
pub fn run(way: Option<Way>) -> Result<()> {
    toolchain(way, ARM)?;
    emulator()?;
    browser()
}

/// Finds or installs a compiler for a target: `wanted`, or else the first source that works.
///
/// # Errors
/// If there is none, and none can be installed.
pub fn toolchain(wanted: Option<Way>, target: Target) -> Result<Way> {
    let ways = wanted.map_or_else(|| vec![Way::Rustup, Way::Debian], |way| vec![way]);
    let name = target.name;
    let found = ways.iter().copied().find(|way| way.is_there(target));
    let way = found.or_else(|| ways.iter().copied().find(|way| install(*way, target))).with_context(|| {
        format!(
            "no compiler for {name}; install one of\n  rustup target add {name}\n  apt-get install {}\n\
             or run this task as root on Debian, which does the latter",
            DEBIAN_TOOLCHAIN.join(" ")
        )
    })?;
    println!("compiler for {name}: {}", way.description());
    Ok(way)
}

/// Finds or installs the emulator.
pub fn emulator() -> Result<()> {
    if version_of(EMULATOR).is_none() {
        install_packages(&[EMULATOR]).with_context(|| {
            format!("no {EMULATOR}: install QEMU for ARM (Debian's package has the same name)")
        })?;
    }
    let version = version_of(EMULATOR)
        .with_context(|| format!("{EMULATOR} is installed, but does not run"))?;
    println!("ARM emulator: {version}");
    Ok(())
}

/// Finds or installs the browser.
pub fn browser() -> Result<()> {
    if version_of(BROWSER).is_none() {
        install_packages(&[BROWSER])
            .with_context(|| format!("no {BROWSER}: install Debian's package of that name"))?;
    }
    let version =
        version_of(BROWSER).with_context(|| format!("{BROWSER} is installed, but does not run"))?;
    println!("browser: {version}");
    Ok(())
}

/// Finds or installs Node.js, which the TypeScript compiler runs on, with its package manager.
pub fn node() -> Result<()> {
    for (program, package) in NODE {
        if version_of(program).is_none() {
            install_packages(&[package])
                .with_context(|| format!("no {program}: install Debian's package {package}"))?;
        }
        let version = version_of(program)
            .with_context(|| format!("{program} is installed, but does not run"))?;
        println!("{program}: {version}");
    }
    Ok(())
}

fn version_of(program: &str) -> Option<String> {
    let version = process::output(&mut process::command(program, &["--version"]))?;
    version.lines().next().map(str::to_owned)
}

/// Tries to install the packages of `way`; returns the reason for a failure.
fn install(way: Way, target: Target) -> bool {
    let result = match way {
        Way::Rustup => process::run(&mut process::command(
            "rustup",
            &["target", "add", target.name],
        )),
        Way::Debian => install_packages(&DEBIAN_TOOLCHAIN),
    };
    if let Err(error) = result {
        println!("not by {}: {error:#}", way.name());
        return false;
    }
    way.is_there(target)
}

fn install_packages(packages: &[&str]) -> Result<()> {
    if !Path::new("/usr/bin/apt-get").exists() {
        bail!("this is not Debian (no apt-get)");
    }
    if process::output(&mut process::command("id", &["-u"])).as_deref() != Some("0") {
        bail!("only root can run `apt-get install {}`", packages.join(" "));
    }
    // Another package manager may be running; wait for it.
    let apt = |arguments: &[&str]| {
        let mut command = process::command("apt-get", &["-qq", "-o", "DPkg::Lock::Timeout=300"]);
        command
            .args(arguments)
            .env("DEBIAN_FRONTEND", "noninteractive");
        process::run(&mut command)
    };
    apt(&["update"])?;
    apt(&[&["install", "--yes", "--no-install-recommends"], packages].concat())
}
