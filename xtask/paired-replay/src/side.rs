//! One of the two commits, as a process.

use std::io::{BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use anyhow::{Context, Result};

use super::interface::Interface;

/// A side.
pub trait Side {
    /// What it takes and answers.
    fn interface(&self) -> &Interface;

    /// Sends it the steps of a round.
    ///
    /// # Errors
    /// If it has ended.
    fn send(&mut self, steps: &[i32]) -> Result<()>;

    /// Its answers to the last round, of `machines`.
    ///
    /// # Errors
    /// If it has ended.
    fn receive(&mut self, machines: usize) -> Result<Vec<i32>>;
}

/// A process with the code of a commit.
pub struct Program {
    name: String,
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    interface: Interface,
    bytes: Vec<u8>,
}

impl Program {
    /// Starts it.
    ///
    /// # Errors
    /// If it cannot be started, or does not write its interface.
    pub fn start(name: &str, program: &Path) -> Result<Self> {
        let mut child = Command::new(program)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .with_context(|| format!("can't start {}", program.display()))?;
        let input = child.stdin.take().context("it has no input")?;
        let mut output = BufReader::new(child.stdout.take().context("it has no output")?);
        let interface = Interface::read(&mut output).with_context(|| format!("side {name}"))?;
        Ok(Self {
            name: name.to_owned(),
            child,
            input,
            output,
            interface,
            bytes: Vec::new(),
        })
    }

    fn ended(&mut self) -> String {
        let status = self
            .child
            .wait()
            .map_or_else(|error| error.to_string(), |status| status.to_string());
        format!(
            "the side of {} has ended ({status}); its message is above",
            self.name
        )
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        // It ends by itself at the end of its input; this is for one that hangs.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Side for Program {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn send(&mut self, steps: &[i32]) -> Result<()> {
        let width = self.interface.inputs.len() + replay_side::HEAD_WORDS;
        let machines = u32::try_from(steps.len() / width)?;
        self.bytes.clear();
        self.bytes.extend(machines.to_le_bytes());
        self.bytes
            .extend(steps.iter().flat_map(|word| word.to_le_bytes()));
        let sent = self
            .input
            .write_all(&self.bytes)
            .and_then(|()| self.input.flush());
        sent.with_context(|| self.ended())
    }

    fn receive(&mut self, machines: usize) -> Result<Vec<i32>> {
        self.bytes
            .resize(4 * machines * self.interface.outputs.len(), 0);
        let received = self.output.read_exact(&mut self.bytes);
        received.with_context(|| self.ended())?;
        let (words, _) = self.bytes.as_chunks::<4>();
        Ok(words.iter().map(|word| i32::from_le_bytes(*word)).collect())
    }
}
