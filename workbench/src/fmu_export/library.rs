//! The shared library of the units: where it is, and what the standard calls this machine.

use std::env::consts::{ARCH, DLL_PREFIX, DLL_SUFFIX, OS};
use std::path::{Path, PathBuf};

use hitch_fmu::version::Version;

use crate::error::Error;

/// The library's file beside the program, or where `cargo` or an installation puts it.
///
/// # Errors
/// If it is in none of these folders.
pub fn find(program: &Path) -> Result<PathBuf, Error> {
    let name = format!("{DLL_PREFIX}hitch_fmu{DLL_SUFFIX}");
    let folders = folders(program);
    let mut files = folders.iter().map(|folder| folder.join(&name));
    files.find(|file| file.is_file()).ok_or_else(|| {
        let shown: Vec<String> = folders.iter().map(|folder| folder.display().to_string()).collect();
        Error::Usage(format!(
            "{name}: the library of the units is in none of {}; build it with `cargo build --release`, or put it \
             beside the program",
            shown.join(", ")
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

/// Name of this machine's folder below `binaries` in a version of the standard, and the ending of a library there.
///
/// # Errors
/// If the standard has no name for this machine.
pub fn platform(version: Version) -> Result<(&'static str, &'static str), Error> {
    match folder(version, OS, ARCH) {
        Some(folder) => Ok((folder, DLL_SUFFIX)),
        None => Err(Error::Usage(format!(
            "FMI {} has no name for {OS} on {ARCH}; export on Linux, Windows or macOS",
            version.number()
        ))),
    }
}

fn folder(version: Version, os: &str, arch: &str) -> Option<&'static str> {
    Some(match (version, os, arch) {
        (Version::Two, "linux", "x86_64") => "linux64",
        (Version::Two, "linux", "x86") => "linux32",
        (Version::Two, "windows", "x86_64") => "win64",
        (Version::Two, "windows", "x86") => "win32",
        // One library for both processors, as far as importers of FMI 2.0 know.
        (Version::Two, "macos", _) => "darwin64",
        (Version::Three, "linux", "x86_64") => "x86_64-linux",
        (Version::Three, "linux", "x86") => "x86-linux",
        (_, "linux", "aarch64") => "aarch64-linux",
        (Version::Three, "windows", "x86_64") => "x86_64-windows",
        (Version::Three, "windows", "x86") => "x86-windows",
        (Version::Three, "windows", "aarch64") => "aarch64-windows",
        (Version::Three, "macos", "x86_64") => "x86_64-darwin",
        (Version::Three, "macos", "aarch64") => "aarch64-darwin",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn machines_have_the_names_of_the_version() {
        for (os, arch, two, three) in [
            ("linux", "x86_64", Some("linux64"), Some("x86_64-linux")),
            (
                "linux",
                "aarch64",
                Some("aarch64-linux"),
                Some("aarch64-linux"),
            ),
            ("windows", "x86_64", Some("win64"), Some("x86_64-windows")),
            ("macos", "aarch64", Some("darwin64"), Some("aarch64-darwin")),
            ("plan9", "x86_64", None, None),
        ] {
            let names = Version::ALL.map(|version| folder(version, os, arch));
            assert_eq!(names, [two, three], "{os}, {arch}");
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
