//! A CAN interface of Linux (socketcan).

use std::io::{self, ErrorKind};
use std::time::Instant;

use hitch_protocols::can::Frame;
use socketcan::{CanDataFrame, CanFrame, CanSocket, EmbeddedFrame, Socket};

use super::patience::{PATIENCE, SENDS_WITHIN, is_timeout};

/// The interface.
#[derive(Debug)]
pub struct CanInterface {
    socket: CanSocket,
}

impl CanInterface {
    /// Opens the interface of this name.
    ///
    /// # Errors
    /// If there is none, or access is denied.
    pub fn open(name: &str) -> io::Result<Self> {
        let socket = CanSocket::open(name)?;
        socket.set_read_timeout(PATIENCE)?;
        socket.set_write_timeout(SENDS_WITHIN)?;
        Ok(Self { socket })
    }

    /// Sends a data frame.
    ///
    /// # Errors
    /// If the interface is down or gone, or the frame is a remote frame.
    pub fn send(&self, frame: &Frame) -> io::Result<()> {
        let frame = to_socket(frame).ok_or(ErrorKind::InvalidInput)?;
        self.socket.write_frame(&frame)
    }

    /// The next data frame; `None` if none arrives before `deadline`.
    ///
    /// # Errors
    /// If the interface is down or gone.
    pub fn receive(&self, deadline: Instant) -> io::Result<Option<Frame>> {
        loop {
            match self.socket.read_frame() {
                Ok(frame) => {
                    if let Some(frame) = from_socket(&frame) {
                        return Ok(Some(frame));
                    }
                }
                Err(error) if is_timeout(&error) => {}
                Err(error) => return Err(error),
            }
            if Instant::now() >= deadline {
                return Ok(None);
            }
        }
    }
}

/// A data frame for the interface; `None` for a remote frame.
fn to_socket(frame: &Frame) -> Option<CanDataFrame> {
    if frame.is_remote() {
        None
    } else {
        CanDataFrame::new(frame.id(), frame.data())
    }
}

/// A data frame from the interface; `None` for remote frames and for error frames, which report the state of the bus.
fn from_socket(frame: &CanFrame) -> Option<Frame> {
    match frame {
        CanFrame::Data(frame) => Frame::data_frame(frame.id(), frame.data()),
        CanFrame::Remote(_) | CanFrame::Error(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use hitch_protocols::can::{ExtendedId, Id, StandardId};
    use proptest::collection::vec;
    use proptest::prelude::*;
    use socketcan::{CanErrorFrame, Frame as _};

    use super::*;

    fn any_id() -> impl Strategy<Value = Id> {
        prop_oneof![
            (0..=0x1FFF_FFFFu32).prop_map(|id| Id::Extended(ExtendedId::new(id).unwrap())),
            (0..=0x7FFu16).prop_map(|id| Id::Standard(StandardId::new(id).unwrap())),
        ]
    }

    proptest! {
        #[test]
        fn a_data_frame_keeps_identifier_kind_length_and_bytes(
            id in any_id(),
            data in vec(any::<u8>(), 0..=8),
        ) {
            const EXTENDED_FLAG: u32 = 1 << 31;
            let sent = Frame::data_frame(id, &data).unwrap();
            let socket = to_socket(&sent).unwrap();
            // The identifier word of the kernel's interface: linux/can.h.
            let word = match id {
                Id::Extended(id) => id.as_raw() | EXTENDED_FLAG,
                Id::Standard(id) => u32::from(id.as_raw()),
            };
            prop_assert_eq!(socket.id_word(), word);
            prop_assert_eq!(socket.dlc(), data.len());
            prop_assert_eq!(socket.data(), &data[..]);
            prop_assert_eq!(from_socket(&CanFrame::Data(socket)), Some(sent));
        }

        #[test]
        fn remote_and_error_frames_are_ignored(
            id in any_id(),
            length in 0..=8usize,
            error_bits in 1..0x200u32,
        ) {
            let remote = CanFrame::new_remote(id, length).unwrap();
            prop_assert_eq!(from_socket(&remote), None);
            let remote = Frame::remote_frame(id, length).unwrap();
            prop_assert!(to_socket(&remote).is_none());
            let error = CanErrorFrame::new_error(error_bits, &[0; 8]).unwrap();
            prop_assert_eq!(from_socket(&CanFrame::Error(error)), None);
        }
    }

    /// Needs the kernel's virtual CAN: `ip link add dev vcan0 type vcan && ip link set vcan0 up`.
    #[test]
    fn frames_pass_through_a_virtual_interface() {
        use crate::xcp_tool::BusAddress;
        use std::time::Duration;
        let Ok(BusAddress::Interface(name)) = "vcan0".parse() else {
            eprintln!("skipped: this machine has no vcan0");
            return;
        };
        let (one, other) = (
            CanInterface::open(&name).unwrap(),
            CanInterface::open(&name).unwrap(),
        );
        let id = ExtendedId::new(0x18EF_80F9).unwrap();
        let frame = Frame::of_eight(id, [1, 2, 3, 4, 5, 6, 7, 8]);
        one.send(&frame).unwrap();
        let deadline = Instant::now() + Duration::from_secs(1);
        assert_eq!(other.receive(deadline).unwrap(), Some(frame));
    }
}
