//! A client of an slcan adapter, on a TCP port or on a serial line.

use std::fmt;
use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::Instant;

use hitch_protocols::can::{Frame, slcan};

use super::can_client::{PATIENCE, SENDS_WITHIN, is_timeout};

/// Baud rate of a serial line; adapters on USB ignore it.
const BAUD: u32 = 115_200;
/// Closes a channel that is open, sets 250 kbit/s, and opens it. The first end of line completes a partial command.
const OPEN: &[u8] = b"\rC\rS5\rO\r";
const CLOSE: &[u8] = b"C\r";
/// A line ends with one of these: success, or failure.
const ENDS: [u8; 2] = [b'\r', 0x07];

/// Connection to an adapter; reads return after [`PATIENCE`].
trait Line: Read + Write + Send {}

impl<T: Read + Write + Send> Line for T {}

/// The client. The channel is closed on drop.
pub struct SlcanClient {
    line: Box<dyn Line>,
    /// Received bytes of an incomplete line.
    text: Vec<u8>,
}

impl fmt::Debug for SlcanClient {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SlcanClient")
            .field("text", &self.text)
            .finish_non_exhaustive()
    }
}

impl SlcanClient {
    /// Connects to a TCP port and opens the channel.
    ///
    /// # Errors
    /// If the connection fails.
    pub fn connect(address: &str) -> io::Result<Self> {
        let stream = TcpStream::connect(address)?;
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(PATIENCE))?;
        stream.set_write_timeout(Some(PATIENCE))?;
        Self::open(Box::new(stream))
    }

    /// Opens a serial port, and the channel.
    ///
    /// # Errors
    /// If the port does not exist, is in use, or is not a serial port.
    pub fn open_serial(port: &str) -> io::Result<Self> {
        let port = serialport::new(port, BAUD).timeout(PATIENCE).open()?;
        Self::open(Box::new(port))
    }

    fn open(line: Box<dyn Line>) -> io::Result<Self> {
        let mut client = Self {
            line,
            text: Vec::new(),
        };
        client.write(OPEN)?;
        Ok(client)
    }

    /// Sends a frame.
    ///
    /// # Errors
    /// If the connection is closed, or does not accept the frame in time.
    pub fn send(&mut self, frame: &Frame) -> io::Result<()> {
        self.write(&slcan::encode(frame))
    }

    fn write(&mut self, mut bytes: &[u8]) -> io::Result<()> {
        let deadline = Instant::now() + SENDS_WITHIN;
        while !bytes.is_empty() {
            match self.line.write(bytes) {
                Ok(0) => return Err(closed()),
                Ok(count) => bytes = bytes.get(count..).unwrap_or_default(),
                Err(error) if is_timeout(&error) && Instant::now() < deadline => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    /// The next frame; `None` if none arrives before `deadline`.
    ///
    /// # Errors
    /// If the connection is closed.
    pub fn receive(&mut self, deadline: Instant) -> io::Result<Option<Frame>> {
        loop {
            while let Some(end) = self.text.iter().position(|byte| ENDS.contains(byte)) {
                let line: Vec<u8> = self.text.drain(..=end).collect();
                // Replies to commands are not frames.
                if let Some(frame) = slcan::decode(&line[..end]) {
                    return Ok(Some(frame));
                }
            }
            if Instant::now() >= deadline {
                return Ok(None);
            }
            let mut bytes = [0; 4_096];
            match self.line.read(&mut bytes) {
                Ok(0) => return Err(closed()),
                Ok(count) => self.text.extend(&bytes[..count]),
                Err(error) if is_timeout(&error) => {}
                Err(error) => return Err(error),
            }
        }
    }
}

impl Drop for SlcanClient {
    fn drop(&mut self) {
        // The adapter may be gone.
        let _ = self.line.write(CLOSE);
    }
}

fn closed() -> io::Error {
    io::Error::new(ErrorKind::UnexpectedEof, "closed by the other side")
}
