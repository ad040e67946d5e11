//! `hitch ecu` as a running program.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Output, Stdio};

use host_tests::program::hitch;

/// A running ECU, which ends with the test.
pub struct RunningEcu {
    child: Child,
    orders: ChildStdin,
    /// HOST:PORT of its bus.
    pub bus: String,
}

impl RunningEcu {
    /// Starts the application on the host, with its flash in `flash.bin`.
    pub fn start(folder: &Path) -> Self {
        Self::start_with(folder, &[])
    }

    /// The same with further arguments.
    pub fn start_with(folder: &Path, arguments: &[&str]) -> Self {
        let mut command = hitch();
        command
            .args(["ecu", "--host", "--can", "127.0.0.1:0", "--seconds", "60"])
            .args(["--flash", "flash.bin"])
            .args(arguments)
            .current_dir(folder);
        let (mut child, line) = started(&mut command);
        let bus = line.split_whitespace().last().unwrap().to_owned();
        Self {
            orders: child.stdin.take().unwrap(),
            child,
            bus,
        }
    }

    /// Gives the operator a command.
    pub fn order(&mut self, order: &str) {
        writeln!(self.orders, "{order}").unwrap();
    }

    /// Ends it as an operator does, so that it keeps its flash.
    pub fn quit(&mut self) {
        self.order("quit");
        assert!(self.child.wait().unwrap().success());
    }
}

impl Drop for RunningEcu {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Starts a command, and waits for the first line of its standard error.
pub fn started(command: &mut Command) -> (Child, String) {
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut line = String::new();
    let said = child.stderr.take().unwrap();
    BufReader::new(said).read_line(&mut line).unwrap();
    (child, line)
}

/// Both outputs of a command.
pub fn said(output: &Output) -> String {
    let text = [output.stdout.clone(), output.stderr.clone()].concat();
    String::from_utf8(text).unwrap()
}
