//! A client of an slcan adapter, on a TCP port or on a serial line.

use std::fmt;
use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use hitch_protocols::can::{Frame, slcan};
use serial2::SerialPort;

use super::listen_mode::ListenMode;
use super::patience::{PATIENCE, SENDS_WITHIN, is_timeout};

/// Baud rate of a serial line; adapters on USB ignore it.
const BAUD: u32 = 115_200;
/// Closes a channel that is open, and sets 250 kbit/s. The first end of line completes a partial command.
const SET_UP: &[u8] = b"\rC\rS5\r";
const OPEN: &[u8] = b"O\r";
const LISTEN: &[u8] = b"L\r";
const CLOSE: &[u8] = b"C\r";
/// A line ends with one of these: success, or failure.
const ENDS: [u8; 2] = [b'\r', REFUSED];
const REFUSED: u8 = 0x07;
/// Silence after which all replies to the first commands have arrived.
const QUIET: Duration = Duration::from_millis(60);
/// Time limit of the replies to the first commands; and of a reply, which some adapters never send.
const REPLIES_WITHIN: Duration = Duration::from_millis(500);

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
    /// Connects to a TCP port; the channel is not yet opened.
    ///
    /// # Errors
    /// If the connection fails.
    pub fn connect(address: &str) -> io::Result<Self> {
        let stream = TcpStream::connect(address)?;
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(PATIENCE))?;
        stream.set_write_timeout(Some(PATIENCE))?;
        Ok(Self::on(Box::new(stream)))
    }

    /// Opens a serial port; the channel is not yet opened.
    ///
    /// # Errors
    /// If the port does not exist, is in use, or is not a serial port.
    pub fn open_serial(port: &str) -> io::Result<Self> {
        let mut port = SerialPort::open(port, BAUD)?;
        // Other programs cannot open the line meanwhile; Windows never lets them.
        #[cfg(unix)]
        rustix::termios::ioctl_tiocexcl(&port)?;
        port.set_read_timeout(PATIENCE)?;
        port.set_write_timeout(PATIENCE)?;
        Ok(Self::on(Box::new(port)))
    }

    fn on(line: Box<dyn Line>) -> Self {
        Self {
            line,
            text: Vec::new(),
        }
    }

    /// Opens the channel for sending and receiving.
    ///
    /// # Errors
    /// If the connection is closed.
    pub fn open(&mut self) -> io::Result<()> {
        self.write(&[SET_UP, OPEN].concat())
    }

    /// Opens the channel for listening only: the adapter does not even acknowledge frames. An adapter that refuses this
    /// is opened as usual.
    ///
    /// # Errors
    /// If the connection is closed.
    pub fn listen(&mut self) -> io::Result<ListenMode> {
        self.write(SET_UP)?;
        // A channel that was open had frames on their way.
        let limit = Instant::now() + REPLIES_WITHIN;
        while Instant::now() < limit && self.read_until(Instant::now() + QUIET, |_| true)? {
            self.text.clear();
        }
        self.text.clear();
        self.write(LISTEN)?;
        let is_line = |text: &[u8]| text.iter().any(|byte| ENDS.contains(byte));
        self.read_until(Instant::now() + REPLIES_WITHIN, is_line)?;
        let end = self.text.iter().find(|byte| ENDS.contains(byte));
        if end != Some(&REFUSED) {
            return Ok(ListenMode::ListenOnly);
        }
        self.write(OPEN)?;
        Ok(ListenMode::Acknowledging)
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
            if !self.read_until(deadline, |_| true)? {
                return Ok(None);
            }
        }
    }

    /// Reads until the text is as wanted, at least once; false if it is not before `deadline`.
    fn read_until(
        &mut self,
        deadline: Instant,
        wanted: impl Fn(&[u8]) -> bool,
    ) -> io::Result<bool> {
        while Instant::now() < deadline {
            let mut bytes = [0; 4_096];
            match self.line.read(&mut bytes) {
                Ok(0) => return Err(closed()),
                Ok(count) => self.text.extend(&bytes[..count]),
                Err(error) if is_timeout(&error) => continue,
                Err(error) => return Err(error),
            }
            if wanted(&self.text) {
                return Ok(true);
            }
        }
        Ok(false)
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
