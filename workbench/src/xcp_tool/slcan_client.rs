//! A client of an slcan adapter on a TCP port.

use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use hitch_protocols::can::{Frame, slcan};

/// Timeout of one read, after which the deadline is checked.
const PATIENCE: Duration = Duration::from_millis(20);

/// The client.
#[derive(Debug)]
pub struct SlcanClient {
    stream: TcpStream,
    /// Received bytes of an incomplete line.
    text: Vec<u8>,
}

impl SlcanClient {
    /// Connects and opens the channel.
    ///
    /// # Errors
    /// If the connection fails.
    pub fn connect(address: &str) -> io::Result<Self> {
        let mut stream = TcpStream::connect(address)?;
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(PATIENCE))?;
        // 250 kbit/s, for an adapter with a physical bus.
        stream.write_all(b"\rC\rS5\rO\r")?;
        Ok(Self {
            stream,
            text: Vec::new(),
        })
    }

    /// Sends a frame.
    ///
    /// # Errors
    /// If the connection is closed.
    pub fn send(&mut self, frame: &Frame) -> io::Result<()> {
        self.stream.write_all(&slcan::encode(frame))
    }

    /// The next frame; `None` if none arrives before `deadline`.
    ///
    /// # Errors
    /// If the connection is closed.
    pub fn receive(&mut self, deadline: Instant) -> io::Result<Option<Frame>> {
        loop {
            while let Some(end) = self.text.iter().position(|&byte| byte == b'\r') {
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
            match self.stream.read(&mut bytes) {
                Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
                Ok(count) => self.text.extend(&bytes[..count]),
                Err(error) if is_timeout(&error) => {}
                Err(error) => return Err(error),
            }
        }
    }
}

fn is_timeout(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
    )
}
