//! Finds the ARM tools, a browser and Node.js, and installs missing ones if this is possible without interaction.

use std::path::Path;

use anyhow::{Context, Result, bail};

use crate::process;
use crate::toolchain::{ARM, Target, Way};

/// A program, and Debian's package of it.
#[derive(Clone, Copy, Debug)]
pub struct Tool {
    program: &'static str,
    package: &'static str,
}

/// The ARM emulator.
pub const EMULATOR: Tool = tool("qemu-system-arm", "qemu-system-arm");
/// The browser for the tests of the page of `hitch serve`.
pub const BROWSER: Tool = tool("chromium", "chromium");
/// What the TypeScript compiler runs on.
pub const NODE: Tool = tool("node", "nodejs");
/// The package manager of [`NODE`].
pub const NPM: Tool = tool("npm", "npm");

const fn tool(program: &'static str, package: &'static str) -> Tool {
    Tool { program, package }
}

const DEBIAN_TOOLCHAIN: [&str; 3] = ["rustc-web", "cargo-web", "rust-web-src"];

/// Finds or installs everything.
pub fn run(way: Option<Way>) -> Result<()> {
    toolchain(way, ARM)?;
    EMULATOR.find()?;
    BROWSER.find()
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

impl Tool {
    /// Finds or installs it.
    ///
    /// # Errors
    /// If it is missing and can't be installed, or does not run.
    pub fn find(self) -> Result<()> {
        let Self { program, package } = self;
        if self.version().is_none() {
            install_packages(&[package])
                .with_context(|| format!("no {program}: install Debian's package {package}"))?;
        }
        let version = self.version();
        let version =
            version.with_context(|| format!("{program} is installed, but does not run"))?;
        println!("{program}: {version}");
        Ok(())
    }

    fn version(self) -> Option<String> {
        let version = process::output(&mut process::command(self.program, &["--version"]))?;
        version.lines().next().map(str::to_owned)
    }
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
