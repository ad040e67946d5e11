//! The shared library of the units: where it is, and what the standard calls this machine.

use std::env::consts::{ARCH, DLL_PREFIX, DLL_SUFFIX, OS};
use std::path::{Path, PathBuf};

use hitch_output::error::Error;
use hitch_output::text::joined;

/// The library's file beside the program, or where `cargo` or an installation puts it.
///
/// # Errors
/// If it is in none of these folders.
pub fn find(program: &Path) -> Result<PathBuf, Error> {
    let name = format!("{DLL_PREFIX}hitch_fmu{DLL_SUFFIX}");
    let folders = folders(program);
    let mut files = folders.iter().map(|folder| folder.join(&name));
    files.find(|file| file.is_file()).ok_or_else(|| {
        let shown = folders.iter().map(|folder| folder.display());
        Error::Usage(format!(
            "{name}: the library of the units is in none of {}; build it with `cargo build --release`, or put it \
             beside the program",
            joined(shown, ", ")
        ))
    })
}

/// The folders in which it may be, the first one first. `cargo` builds it into `deps`; a copy beside the program may be
/// older.
fn folders(program: &Path) -> Vec<PathBuf> {
    let beside = program.parent().unwrap_or(Path::new("."));
    vec![
        beside.join("deps"),
        beside.to_path_buf(),
        beside.join("..").join("lib"),
    ]
}

/// Name of this machine's folder below `binaries`, and the ending of a library there.
///
/// # Errors
/// If the standard has no name for this machine.
pub fn platform() -> Result<(&'static str, &'static str), Error> {
    match folder(OS, ARCH) {
        Some(folder) => Ok((folder, DLL_SUFFIX)),
        None => Err(Error::Usage(format!(
            "FMI 2.0 has no name for {OS} on {ARCH}; export on Linux, Windows or macOS"
        ))),
    }
}

fn folder(os: &str, arch: &str) -> Option<&'static str> {
    Some(match (os, arch) {
        ("linux", "x86_64") => "linux64",
        ("linux", "x86") => "linux32",
        ("linux", "aarch64") => "aarch64-linux",
        ("windows", "x86_64") => "win64",
        ("windows", "x86") => "win32",
        // One library for both processors, as far as importers know.
        ("macos", _) => "darwin64",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn machines_have_the_names_of_the_standard() {
        for (os, arch, expected) in [
            ("linux", "x86_64", Some("linux64")),
            ("linux", "aarch64", Some("aarch64-linux")),
            ("windows", "x86_64", Some("win64")),
            ("macos", "aarch64", Some("darwin64")),
            ("plan9", "x86_64", None),
        ] {
            assert_eq!(folder(os, arch), expected, "{os}, {arch}");
        }
    }

    #[test]
    fn a_missing_library_is_named_with_its_places() {
        let folder = tempfile::tempdir().unwrap();
        let program = folder.path().join("bin").join("hitch");
        let said = find(&program).unwrap_err().to_string();
        assert!(
            said.contains("hitch_fmu") && said.contains("deps"),
            "{said}"
        );
        let lib = folder.path().join("bin").join("deps");
        std::fs::create_dir_all(&lib).unwrap();
        let file = lib.join(format!("{DLL_PREFIX}hitch_fmu{DLL_SUFFIX}"));
        std::fs::write(&file, "").unwrap();
        assert_eq!(find(&program).unwrap(), file);
    }
}
