//! The application on an emulated Cortex-M4, in lock step.

use std::io::{BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStderr, ChildStdin, ChildStdout, Command, Stdio};
use std::thread;
use std::time::Duration;

use hitch_ecu::Contacts;
use hitch_ecu::link::{
    FRAME_BYTES, MOST_FRAMES, REPLY_BYTES, Reply, Request, frame_from_bytes, frame_to_bytes,
};
use hitch_protocols::can::Frame;

use super::machine::{EcuMachine, MachineError};

/// The emulator executable.
pub const QEMU: &str = "qemu-system-arm";

/// Operating mode of the image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// Steps the controller only.
    Steps,
    /// Runs as ECU; its flash is the file `flash` in the emulator's folder.
    Ecu,
    /// Measures the execution times of the parts of a step.
    Parts,
}

/// The command that boots `image` in `folder`; the caller sets the standard streams.
pub fn command(image: &Path, folder: &Path, mode: Mode) -> Command {
    let told = match mode {
        Mode::Steps => "enable=on,target=native,arg=steps",
        Mode::Ecu => "enable=on,target=native,arg=ecu",
        Mode::Parts => "enable=on,target=native,arg=parts",
    };
    let mut command = Command::new(QEMU);
    command
        .args(["-machine", "mps2-an386", "-display", "none"])
        .args(["-monitor", "none", "-serial", "none"])
        // An instruction takes 64 ns of emulated time independent of the host: counts are reproducible.
        .args(["-icount", "shift=6", "-semihosting-config", told, "-kernel"])
        .arg(image)
        .current_dir(folder);
    command
}

/// The running emulator; it is ended on drop. If this program is killed, the image ends with its requests.
#[derive(Debug)]
pub struct Emulator {
    child: Child,
    requests: ChildStdin,
    replies: BufReader<ChildStdout>,
    complaints: ChildStderr,
    /// Request buffer with frames, written at once.
    request: Vec<u8>,
}

impl Emulator {
    /// Boots `image`, with its flash in the file `flash` in `folder`.
    ///
    /// # Errors
    /// If the emulator cannot be started.
    pub fn start(image: &Path, folder: &Path) -> Result<Self, MachineError> {
        let image = image.canonicalize()?;
        let mut child = command(&image, folder, Mode::Ecu)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()?;
        let gone = || MachineError::Ended("it has no standard streams".to_owned());
        Ok(Self {
            requests: child.stdin.take().ok_or_else(gone)?,
            replies: BufReader::new(child.stdout.take().ok_or_else(gone)?),
            complaints: child.stderr.take().ok_or_else(gone)?,
            child,
            request: Vec::new(),
        })
    }

    /// Cuts the power at this time after the start of a millisecond: the emulator is killed.
    ///
    /// # Errors
    /// If the machine has ended already.
    pub fn cut_power(mut self, contacts: &Contacts, after: Duration) -> Result<(), MachineError> {
        self.ask(contacts, &[]);
        self.requests.write_all(&self.request)?;
        thread::sleep(after);
        Ok(self.child.kill()?)
    }

    fn ask(&mut self, contacts: &Contacts, heard: &[Frame]) {
        let heard = &heard[..heard.len().min(MOST_FRAMES)];
        let request = Request::Tick {
            contacts: *contacts,
            frames: heard.len(),
        };
        self.request.clear();
        self.request.extend(request.to_bytes());
        self.request.extend(heard.iter().flat_map(frame_to_bytes));
    }

    fn exchange(&mut self, said: &mut Vec<Frame>) -> std::io::Result<Reply> {
        self.requests.write_all(&self.request)?;
        let mut bytes = [0; REPLY_BYTES];
        self.replies.read_exact(&mut bytes)?;
        let reply = Reply::from_bytes(&bytes);
        for _ in 0..reply.frames {
            let mut frame = [0; FRAME_BYTES];
            self.replies.read_exact(&mut frame)?;
            said.extend(frame_from_bytes(&frame));
        }
        Ok(reply)
    }

    /// The emulator's last message.
    fn last_words(&mut self) -> MachineError {
        let _ = self.child.kill();
        let mut words = String::new();
        let _ = self.complaints.read_to_string(&mut words);
        MachineError::Ended(words.trim().replace('\n', "; "))
    }
}

impl EcuMachine for Emulator {
    fn tick(
        &mut self,
        contacts: &Contacts,
        heard: &[Frame],
        said: &mut Vec<Frame>,
    ) -> Result<Reply, MachineError> {
        self.ask(contacts, heard);
        self.exchange(said).map_err(|_| self.last_words())
    }

    fn power_cycle(&mut self) -> Result<(), MachineError> {
        Ok(self.requests.write_all(&Request::PowerCycle.to_bytes())?)
    }
}

impl Drop for Emulator {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
