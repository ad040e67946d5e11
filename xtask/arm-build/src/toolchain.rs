//! The compilers for the ECU's processor and for WebAssembly, from rustup or Debian.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::str::FromStr;

use anyhow::{Context, Error, Result, bail};

use crate::{process, workspace};

/// What is compiled for.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its name.
    pub name: &'static str,
    /// The libraries that Debian's compiler has to build.
    libraries: &'static str,
    /// Folder of its builds.
    folder: &'static str,
}

/// The ECU's processor: Cortex-M4 with a single-precision floating-point unit.
pub const ARM: Target = Target {
    name: "thumbv7em-none-eabihf",
    libraries: "core",
    folder: "arm",
};

/// A web page.
pub const WASM: Target = Target {
    name: "wasm32-unknown-unknown",
    libraries: "std,panic_abort",
    folder: "wasm",
};

/// Location of the sources of `core` in Debian's packages.
const DEBIAN_SOURCES: &str = "/usr/lib/rustlib/src/rust/library/core/src/lib.rs";

/// Source of a compiler for the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// The toolchain in use, with the target's `core` from rustup.
    Rustup,
    /// Debian's newer compiler, which builds `core` from the matching sources.
    Debian,
}

impl FromStr for Way {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self> {
        match name {
            "rustup" => Ok(Self::Rustup),
            "debian" => Ok(Self::Debian),
            _ => bail!("`--arm {name}`: there is no such way; take `rustup` or `debian`"),
        }
    }
}

impl Way {
    /// Short name, as on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rustup => "rustup",
            Self::Debian => "debian",
        }
    }

    /// Whether it is completely installed for a target.
    pub fn is_there(self, target: Target) -> bool {
        match self {
            Self::Rustup => {
                sysroot().is_some_and(|root| root.join("lib/rustlib").join(target.name).is_dir())
            }
            Self::Debian => {
                let programs = ["/usr/bin/cargo", "/usr/bin/rustc", DEBIAN_SOURCES];
                programs.iter().all(|path| Path::new(path).exists()) && debian_rustc_is_new()
            }
        }
    }

    /// Description of this source.
    pub fn description(self) -> &'static str {
        match self {
            Self::Rustup => "the toolchain in use, with this target",
            Self::Debian => {
                "Debian's /usr/bin/cargo and rustc, building the library from rust-web-src"
            }
        }
    }

    /// Starts a cargo command for the target.
    ///
    /// # Errors
    /// Debian's compiler has no linker.
    pub fn cargo(self, target: Target, subcommand: &str) -> Result<Command> {
        let mut command = match self {
            Self::Rustup => process::command(workspace::cargo(), &[subcommand]),
            Self::Debian => debian_cargo(target, subcommand)?,
        };
        command
            .args(["--locked", "--target", target.name, "--target-dir"])
            .arg(self.target_dir(target));
        Ok(command)
    }

    /// Each source has its own build folder: two compilers in one would rebuild each other's output.
    pub fn target_dir(self, target: Target) -> PathBuf {
        workspace::target().join(target.folder).join(self.name())
    }
}

fn debian_cargo(target: Target, subcommand: &str) -> Result<Command> {
    let libraries = format!("-Zbuild-std={}", target.libraries);
    let linker = target.name.replace('-', "_").to_uppercase();
    let mut command = process::command("/usr/bin/cargo", &[subcommand, &libraries]);
    command
        .env("RUSTC", "/usr/bin/rustc")
        // Building a library is unstable, but the sources match this compiler exactly.
        .env("RUSTC_BOOTSTRAP", "1")
        .env(format!("CARGO_TARGET_{linker}_LINKER"), rust_lld()?)
        .env_remove("RUSTUP_TOOLCHAIN")
        // Cargo sets these to the toolchain that runs xtask.
        .env_remove("RUSTDOC")
        .env_remove("LD_LIBRARY_PATH");
    Ok(command)
}

/// The linker of the ordinary toolchain; Debian's packages have none.
fn rust_lld() -> Result<PathBuf> {
    let root = sysroot().context("`rustc --print sysroot` says nothing: is rustc on the path?")?;
    let version = process::output(&mut process::command("rustc", &["-vV"])).unwrap_or_default();
    let host = version
        .lines()
        .find_map(|line| line.strip_prefix("host: "))
        .context("`rustc -vV` names no host")?;
    let linker = root.join("lib/rustlib").join(host).join("bin/rust-lld");
    if !linker.exists() {
        bail!(
            "no linker at {}: install Rust by rustup, which ships rust-lld there",
            linker.display()
        );
    }
    Ok(linker)
}

fn sysroot() -> Option<PathBuf> {
    process::output(&mut process::command("rustc", &["--print", "sysroot"])).map(PathBuf::from)
}

/// Debian also has an older compiler of the same name, which cannot build the workspace.
fn debian_rustc_is_new() -> bool {
    let version =
        process::output(Command::new("/usr/bin/rustc").arg("--version")).unwrap_or_default();
    let mut numbers = version
        .split([' ', '.'])
        .skip(1)
        .map_while(|number| number.parse::<u32>().ok());
    (numbers.next(), numbers.next()) >= (Some(1), Some(90))
}
