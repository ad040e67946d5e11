//! SLCAN server: a CAN bus on a TCP port. Every connection behaves like an SLCAN adapter, compatible with python-can,
//! slcand and others (`slcan` on `socket://HOST:PORT`).
//!
//! All connections share one bus: a frame from a connection is sent to the ECU and to all other connections. No call
//! blocks.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream, ToSocketAddrs};

use hitch_protocols::can::Frame;
use hitch_protocols::can::slcan::{Adapter, encode};

/// Maximum number of connections; further ones wait.
const MOST_CONNECTIONS: usize = 8;
/// Maximum number of bytes read from a connection at once: some milliseconds of a fully loaded bus.
const MOST_READ: usize = 512;
/// Size of the send buffer of a connection, bytes: some seconds of a fully loaded bus. When it is full, the connection
/// is closed.
const MOST_WAITING: usize = 1 << 18;

/// The port and its connections.
#[derive(Debug)]
pub struct SlcanServer {
    listener: TcpListener,
    connections: Vec<Connection>,
}

#[derive(Debug)]
struct Connection {
    stream: TcpStream,
    adapter: Adapter,
    /// Bytes that are not yet sent.
    waiting: Vec<u8>,
    open: bool,
}

impl SlcanServer {
    /// Opens the port; 0 selects a free one.
    ///
    /// # Errors
    /// If the address is not available.
    pub fn open(address: impl ToSocketAddrs) -> io::Result<Self> {
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        Ok(Self {
            listener,
            connections: Vec::new(),
        })
    }

    /// The local address.
    ///
    /// # Errors
    /// If the system does not return it.
    pub fn address(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }

    /// Number of connections.
    #[must_use]
    pub fn connected(&self) -> usize {
        self.connections.len()
    }

    /// The frames received since the last call.
    pub fn receive(&mut self) -> Vec<Frame> {
        self.accept();
        let mut heard = Vec::new();
        for sender in 0..self.connections.len() {
            let frames = self.connections[sender].read();
            for frame in &frames {
                for (index, connection) in self.connections.iter_mut().enumerate() {
                    if index != sender {
                        connection.send(frame);
                    }
                }
            }
            heard.extend(frames);
        }
        self.flush();
        heard
    }

    /// Sends a frame to all connections.
    pub fn send(&mut self, frame: &Frame) {
        for connection in &mut self.connections {
            connection.send(frame);
        }
        self.flush();
    }

    fn accept(&mut self) {
        while self.connections.len() < MOST_CONNECTIONS {
            let Ok((stream, _)) = self.listener.accept() else {
                return;
            };
            // A connection that cannot be set to non-blocking would block the bus.
            if stream.set_nonblocking(true).is_ok() && stream.set_nodelay(true).is_ok() {
                self.connections.push(Connection {
                    stream,
                    adapter: Adapter::default(),
                    waiting: Vec::new(),
                    open: true,
                });
            }
        }
    }

    fn flush(&mut self) {
        self.connections.iter_mut().for_each(Connection::flush);
        self.connections.retain(|connection| connection.open);
    }
}

impl Connection {
    /// The received frames; other commands are answered.
    fn read(&mut self) -> Vec<Frame> {
        let mut bytes = [0; MOST_READ];
        let read = match self.stream.read(&mut bytes) {
            Ok(0) => {
                self.open = false;
                0
            }
            Ok(read) => read,
            Err(error) => {
                self.open &= is_harmless(&error);
                0
            }
        };
        let mut frames = Vec::new();
        for byte in &bytes[..read] {
            if let Some(heard) = self.adapter.receive(*byte) {
                self.waiting.extend(heard.reply);
                frames.extend(heard.frame);
            }
        }
        frames
    }

    fn send(&mut self, frame: &Frame) {
        if self.adapter.is_open() {
            self.waiting.extend(encode(frame));
        }
    }

    fn flush(&mut self) {
        while !self.waiting.is_empty() {
            match self.stream.write(&self.waiting) {
                Ok(0) => break,
                Ok(written) => drop(self.waiting.drain(..written)),
                Err(error) => {
                    self.open &= is_harmless(&error);
                    break;
                }
            }
        }
        self.open &= self.waiting.len() <= MOST_WAITING;
    }
}

/// Whether the operation would block.
fn is_harmless(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::WouldBlock | ErrorKind::Interrupted | ErrorKind::TimedOut
    )
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use hitch_protocols::can::ExtendedId;

    use super::*;

    fn frame(byte: u8) -> Frame {
        Frame::of_eight(ExtendedId::new(0x0CFE_4580).unwrap(), [byte; 8])
    }

    /// Polls the server until a result arrives.
    fn served<T>(
        server: &mut SlcanServer,
        mut done: impl FnMut(&mut SlcanServer, Vec<Frame>) -> Option<T>,
    ) -> T {
        let begun = Instant::now();
        loop {
            let frames = server.receive();
            if let Some(result) = done(server, frames) {
                return result;
            }
            assert!(begun.elapsed() < Duration::from_secs(10), "nothing comes");
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    fn connected(server: &mut SlcanServer) -> TcpStream {
        let before = server.connected();
        let mut stream = TcpStream::connect(server.address().unwrap()).unwrap();
        stream.write_all(b"C\rS5\rO\r").unwrap();
        served(server, |server, _| {
            (server.connected() > before).then_some(())
        });
        let mut replies = [0; 3];
        served(server, |_, _| Some(()));
        stream.read_exact(&mut replies).unwrap();
        assert_eq!(&replies, b"\r\r\r");
        stream
    }

    #[test]
    fn what_one_sends_reaches_the_ecu_and_the_others() {
        let mut server = SlcanServer::open("127.0.0.1:0").unwrap();
        let (mut one, mut other) = (connected(&mut server), connected(&mut server));
        one.write_all(&encode(&frame(7))).unwrap();
        let heard = served(&mut server, |_, frames| frames.first().copied());
        assert_eq!(heard, frame(7));
        let mut line = encode(&frame(7)).to_vec();
        other.read_exact(&mut line).unwrap();
        assert_eq!(line[..], encode(&frame(7))[..]);
        server.send(&frame(9));
        one.read_exact(&mut line[..2]).unwrap();
        assert_eq!(&line[..2], b"Z\r", "its own isn't echoed, but acknowledged");
        one.read_exact(&mut line).unwrap();
        assert_eq!(line[..], encode(&frame(9))[..]);
    }

    #[test]
    fn who_goes_away_or_never_reads_is_let_go() {
        let mut server = SlcanServer::open("127.0.0.1:0").unwrap();
        drop(connected(&mut server));
        served(&mut server, |server, _| {
            (server.connected() == 0).then_some(())
        });
        let _deaf = connected(&mut server);
        served(&mut server, |server, _| {
            (0..1_000).for_each(|_| server.send(&frame(1)));
            (server.connected() == 0).then_some(())
        });
    }
}
