//! Finds or builds the emulated ECU's image.

use std::env;
use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread;
use std::time::Duration;

use hitch_output::error::Error;
use hitch_output::progress::Progress;

/// Environment variable with the path of the image.
pub const IMAGE_VARIABLE: &str = "HITCH_EMULATED_IMAGE";

/// Suggested correction if there is no image.
const HINT: &str = "run hitch from a clone of its sources, which builds the image; or name one with --image; \
    or take --host, which runs the same application without an emulator";

/// The image: `given`, else the one named by the environment, else built from the sources.
///
/// # Errors
/// If there is none, with a suggested correction.
pub fn find(given: Option<&Path>) -> Result<PathBuf, Error> {
    let named = env::var_os(IMAGE_VARIABLE).map(PathBuf::from);
    match given.map(Path::to_path_buf).or(named) {
        Some(image) if image.is_file() => Ok(image),
        Some(image) => Err(Error::Usage(format!(
            "image {} does not exist; omit --image to build it, or use --host",
            image.display()
        ))),
        None => build(),
    }
}

/// Announces a long build where no progress line is visible; silent if the returned value is dropped within a moment.
fn patience() -> Option<Sender<()>> {
    const MOMENT: Duration = Duration::from_secs(2);
    if io::stderr().is_terminal() {
        return None;
    }
    let (waiting, over) = mpsc::channel();
    thread::spawn(move || {
        if over.recv_timeout(MOMENT) == Err(RecvTimeoutError::Timeout) {
            eprintln!("building the ECU's image; the first build takes minutes");
        }
    });
    Some(waiting)
}

/// Builds the image from the sources of this program.
fn build() -> Result<PathBuf, Error> {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    if !sources.join("xtask").is_dir() {
        return Err(Error::Usage(format!(
            "there is no image of the ECU: {HINT}"
        )));
    }
    let progress = Progress::start("building the ECU's image");
    let patience = patience();
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let built = Command::new(cargo)
        .args(["run", "--quiet", "--locked", "--package", "arm-build"])
        .current_dir(&sources)
        .stdin(Stdio::null())
        .output()
        .map_err(|error| Error::Usage(format!("cargo can't be started ({error}): {HINT}")))?;
    drop((progress, patience));
    let text = String::from_utf8_lossy(&built.stdout);
    match (built.status.success(), text.trim_end().lines().last()) {
        (true, Some(path)) => Ok(PathBuf::from(path)),
        _ => {
            let reason = String::from_utf8_lossy(&built.stderr);
            let reason = reason.trim_end().lines().last().unwrap_or("no message");
            Err(Error::Usage(format!(
                "`cargo run --package arm-build` failed ({reason}): {HINT}"
            )))
        }
    }
}
