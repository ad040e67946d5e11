//! Runs the firmware's image on an emulated Cortex-M4, with files as input and output.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use std::{env, fs};

use anyhow::{Context, Result, bail, ensure};
use hitch_ecu_host::ecu::{IMAGE_VARIABLE, Mode, emulator_command};
use hitch_quantities::signals::{INPUT_BYTES, OUTPUT_BYTES};

/// Far longer than any trace takes; an image that hangs must not hang the tests.
const PATIENCE: Duration = Duration::from_secs(900);

const TICK_BYTES: usize = size_of::<u32>();

/// Result of the image.
pub struct EmulatedRun {
    /// Image of the outputs of each step.
    pub outputs: Vec<[u8; OUTPUT_BYTES]>,
    /// Processor instructions that each step took.
    pub instructions: Vec<u64>,
    /// Stack used from reset to the end, the image's own frame and file handling included.
    pub stack_bytes: u64,
}

/// The image that [`IMAGE_VARIABLE`] names.
pub fn image() -> Result<PathBuf> {
    let path = env::var_os(IMAGE_VARIABLE).map(PathBuf::from).with_context(|| {
        format!("{IMAGE_VARIABLE} names no image: run `cargo xtask test`, which builds one and sets it")
    })?;
    ensure!(
        path.is_file(),
        "{IMAGE_VARIABLE}: file {} does not exist; build it with `cargo xtask arm`",
        path.display()
    );
    Ok(path)
}

/// Bytes of stack that the image needs at most, as `cargo xtask` finds them in its instructions.
pub fn stack_bound() -> Result<u64> {
    const VARIABLE: &str = "HITCH_STACK_BOUND";
    let bound = env::var(VARIABLE).ok().and_then(|bytes| bytes.parse().ok());
    bound.with_context(|| format!("{VARIABLE} is no number: run `cargo xtask test`, which sets it"))
}

/// Boots the image, steps it through `inputs`, and returns its output.
pub fn run(image: &Path, inputs: &[[u8; INPUT_BYTES]]) -> Result<EmulatedRun> {
    let folder = tempfile::tempdir()?;
    let console = boot(image, folder.path(), Mode::Steps, inputs.as_flattened())?;
    let steps = said(&console.text, "steps")?;
    let (outputs, instructions) = parse_records(&console.outputs)?;
    ensure!(
        steps == outputs.len() as u64,
        "the image counted {steps} steps and wrote {}",
        outputs.len()
    );
    Ok(EmulatedRun {
        outputs,
        instructions,
        stack_bytes: said(&console.text, "stack_bytes")?,
    })
}

/// Output of the emulator.
pub struct Console {
    /// Messages of the image.
    pub text: String,
    /// Data written by the image.
    pub outputs: Vec<u8>,
}

/// Runs the emulator in `folder` on `input`.
pub fn boot(image: &Path, folder: &Path, mode: Mode, input: &[u8]) -> Result<Console> {
    let (inputs, outputs) = (folder.join("inputs"), folder.join("outputs"));
    fs::write(&inputs, input)?;
    let mut emulator = emulator_command(image, folder, mode)
        .stdin(File::open(&inputs)?)
        .stdout(File::create(&outputs)?)
        .stderr(Stdio::piped())
        .spawn()
        .context("can't start qemu-system-arm: `cargo xtask setup` installs it")?;
    let status = wait(&mut emulator)?;
    let mut text = String::new();
    if let Some(mut said) = emulator.stderr.take() {
        said.read_to_string(&mut text)?;
    }
    ensure!(
        status.success(),
        "the image ended with {status} and said: {text}"
    );
    Ok(Console {
        text,
        outputs: fs::read(&outputs)?,
    })
}

fn wait(emulator: &mut Child) -> Result<ExitStatus> {
    let deadline = Instant::now() + PATIENCE;
    while Instant::now() < deadline {
        if let Some(status) = emulator.try_wait()? {
            return Ok(status);
        }
        sleep(Duration::from_millis(5));
    }
    emulator.kill()?;
    emulator.wait()?;
    bail!("the image did not end within {PATIENCE:?}")
}

/// The number in the console's line `key=number`.
pub fn said(console: &str, key: &str) -> Result<u64> {
    let value = console
        .lines()
        .find_map(|line| line.strip_prefix(key)?.strip_prefix('='));
    let number = value.and_then(|value| value.trim().parse().ok());
    number.with_context(|| format!("the image said no `{key}=...`, but: {console}"))
}

/// The timer runs at 25 MHz: 40 ns a tick against 64 ns an instruction.
#[must_use]
pub const fn instructions(ticks: u64) -> u64 {
    ticks * 5 / 8
}

/// Outputs and instructions of each step.
fn parse_records(bytes: &[u8]) -> Result<(Vec<[u8; OUTPUT_BYTES]>, Vec<u64>)> {
    let (records, rest) = bytes.as_chunks::<{ OUTPUT_BYTES + TICK_BYTES }>();
    ensure!(
        rest.is_empty(),
        "the image wrote {} bytes beyond the last whole record",
        rest.len()
    );
    let split = |record: &[u8; OUTPUT_BYTES + TICK_BYTES]| {
        let (outputs, ticks) = record
            .split_first_chunk()
            .context("a record holds outputs")?;
        let ticks = u32::from_le_bytes(ticks.try_into()?);
        Ok((*outputs, instructions(ticks.into())))
    };
    records
        .iter()
        .map(split)
        .collect::<Result<Vec<_>>>()
        .map(|pairs| pairs.into_iter().unzip())
}
