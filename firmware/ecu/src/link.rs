//! A millisecond of the ECU as bytes, for a host that runs it through a pipe or a file.
//!
//! ```text
//! request  codes of all channels     panel  kind  frames  enable  0  clock ratio  clock   frames
//!          2 each                    2      1     1       1       1  2            4 us    16 each
//! reply    lift  lower  enable  kicked  state  fault  trip  frames  target  lift  lower  frames
//!          2     2      1       1       1      1      1     1       4 mdeg  2 mA  2 mA   16 each
//! frame    identifier; bit 31: of 29 bits, bit 30: remote   length  0  bytes
//!          4                                                1       3  8
//! ```
//!
//! All values are little-endian. `enable` is the read-back of the enable line: 0 none, 1 low, 2 high. A clock ratio of
//! -1 means none.

use embedded_can::{ExtendedId, Id, StandardId};
use hitch_protocols::can::Frame;
use hitch_quantities::image::{Reader, Writer};
use hitch_quantities::units::PerMille;

use super::adc_code::AdcCode;
use super::hardware::Contacts;
use super::panel::Panel;
use super::samples::Samples;

/// Bytes of a request without its frames.
pub const REQUEST_BYTES: usize = 2 * Samples::CHANNELS + 12;
/// Bytes of a reply without its frames.
pub const REPLY_BYTES: usize = 18;
/// Bytes of a frame.
pub const FRAME_BYTES: usize = 16;
/// Maximum number of frames of a request or a reply: more than the capacity of a bus in a millisecond.
pub const MOST_FRAMES: usize = 8;

/// Code of a missing clock ratio.
const NO_RATIO: i16 = -1;

/// A request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// A millisecond with frames.
    Tick {
        /// The inputs.
        contacts: Contacts,
        /// Number of frames that follow.
        frames: usize,
    },
    /// Power off and on: only the flash contents are kept.
    PowerCycle,
}

/// Result of a millisecond.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reply {
    /// Compare value of the lift coil.
    pub lift: u16,
    /// Compare value of the lowering coil.
    pub lower: u16,
    /// The enable line.
    pub enable: bool,
    /// Whether the watchdog was reset.
    pub kicked: bool,
    /// Code of the state.
    pub state: u8,
    /// Code of the fault, 0 for none.
    pub fault: u8,
    /// Code of the trip of the envelope, 0 for none.
    pub trip: u8,
    /// Number of frames that follow.
    pub frames: u8,
    /// Present set point, millidegrees.
    pub target_mdeg: i32,
    /// Requested current of the lift coil, mA.
    pub lift_ma: i16,
    /// Requested current of the lowering coil, mA.
    pub lower_ma: i16,
}

impl Request {
    /// As bytes.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; REQUEST_BYTES] {
        let (contacts, kind, frames) = match self {
            Self::Tick { contacts, frames } => (*contacts, 0, *frames),
            Self::PowerCycle => (Contacts::default(), 1, 0),
        };
        let frames = u8::try_from(frames.min(MOST_FRAMES)).unwrap_or(0);
        let enable = match contacts.enable_feedback {
            None => 0,
            Some(false) => 1,
            Some(true) => 2,
        };
        let ratio = contacts.clock_ratio.map_or(NO_RATIO, |ratio| {
            i16::try_from(ratio.0.max(0)).unwrap_or(i16::MAX)
        });
        let mut writer = Writer::default();
        for code in contacts.samples.codes() {
            writer.put(code.get().to_le_bytes());
        }
        writer.put(contacts.panel.bits().to_le_bytes());
        writer.put([kind, frames, enable, 0]);
        writer.put(ratio.to_le_bytes());
        writer.put(contacts.clock_us.to_le_bytes());
        writer.bytes()
    }

    /// From bytes; the number of frames is limited to its maximum.
    #[must_use]
    pub fn from_bytes(bytes: &[u8; REQUEST_BYTES]) -> Self {
        let mut reader = Reader(bytes);
        let codes =
            [(); Samples::CHANNELS].map(|()| AdcCode::new(u16::from_le_bytes(reader.take())));
        let panel = u16::from_le_bytes(reader.take());
        let [kind, frames, enable, _] = reader.take();
        let ratio = i16::from_le_bytes(reader.take());
        let clock_us = u32::from_le_bytes(reader.take());
        if kind == 1 {
            return Self::PowerCycle;
        }
        Self::Tick {
            contacts: Contacts {
                samples: Samples::from_codes(codes),
                panel: Panel::from_bits(panel),
                clock_us,
                enable_feedback: match enable {
                    1 => Some(false),
                    2 => Some(true),
                    _ => None,
                },
                clock_ratio: Some(ratio)
                    .filter(|&ratio| ratio != NO_RATIO)
                    .map(|ratio| PerMille(i32::from(ratio))),
            },
            frames: usize::from(frames).min(MOST_FRAMES),
        }
    }
}

impl Reply {
    /// As bytes.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; REPLY_BYTES] {
        let (enable, kicked) = (u8::from(self.enable), u8::from(self.kicked));
        let mut writer = Writer::default();
        writer.put(self.lift.to_le_bytes());
        writer.put(self.lower.to_le_bytes());
        writer.put([
            enable,
            kicked,
            self.state,
            self.fault,
            self.trip,
            self.frames,
        ]);
        writer.put(self.target_mdeg.to_le_bytes());
        writer.put(self.lift_ma.to_le_bytes());
        writer.put(self.lower_ma.to_le_bytes());
        writer.bytes()
    }

    /// From bytes.
    #[must_use]
    pub fn from_bytes(bytes: &[u8; REPLY_BYTES]) -> Self {
        let mut reader = Reader(bytes);
        let [lift, lower] = [reader.take(), reader.take()].map(u16::from_le_bytes);
        let [enable, kicked, state, fault, trip, frames] = reader.take();
        Self {
            lift,
            lower,
            enable: enable != 0,
            kicked: kicked != 0,
            state,
            fault,
            trip,
            frames,
            target_mdeg: i32::from_le_bytes(reader.take()),
            lift_ma: i16::from_le_bytes(reader.take()),
            lower_ma: i16::from_le_bytes(reader.take()),
        }
    }
}

const EXTENDED: u32 = 1 << 31;
const REMOTE: u32 = 1 << 30;

/// A frame as bytes.
#[must_use]
pub fn frame_to_bytes(frame: &Frame) -> [u8; FRAME_BYTES] {
    let id = match frame.id() {
        Id::Standard(id) => u32::from(id.as_raw()),
        Id::Extended(id) => id.as_raw() | EXTENDED,
    };
    let remote = if frame.is_remote() { REMOTE } else { 0 };
    let mut bytes = [0; FRAME_BYTES];
    let (head, data) = bytes.split_at_mut(8);
    let [a, b, c, d] = (id | remote).to_le_bytes();
    head.copy_from_slice(&[a, b, c, d, frame.length(), 0, 0, 0]);
    data.copy_from_slice(&frame.padded());
    bytes
}

/// A frame from bytes, if they are valid.
#[must_use]
pub fn frame_from_bytes(bytes: &[u8; FRAME_BYTES]) -> Option<Frame> {
    let [a, b, c, d, length, _, _, _, data @ ..] = bytes;
    let word = u32::from_le_bytes([*a, *b, *c, *d]);
    let bits = word & ExtendedId::MAX.as_raw();
    let id = if word & EXTENDED != 0 {
        Id::Extended(ExtendedId::new(bits)?)
    } else {
        Id::Standard(StandardId::new(u16::try_from(bits).ok()?)?)
    };
    Frame::from_padded(id, word & REMOTE != 0, *length, *data)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_and_replies_go_round() {
        let contacts = Contacts {
            samples: Samples::from_codes(core::array::from_fn(|index| {
                AdcCode::new(index as u16 * 300)
            })),
            panel: Panel::FIELD,
            clock_us: 0x1234_5678,
            enable_feedback: Some(false),
            clock_ratio: Some(PerMille(1_013)),
        };
        let tick = Request::Tick {
            contacts,
            frames: 3,
        };
        for request in [tick, Request::PowerCycle] {
            assert_eq!(Request::from_bytes(&request.to_bytes()), request);
        }
        let reply = Reply {
            lift: 1,
            enable: true,
            state: 3,
            frames: 2,
            target_mdeg: -70_000,
            lower_ma: 1_500,
            ..Reply::default()
        };
        assert_eq!(Reply::from_bytes(&reply.to_bytes()), reply);
    }

    #[test]
    fn frames_go_round_and_nonsense_is_none() {
        let extended = Id::Extended(ExtendedId::new(0x0CFE_4528).unwrap());
        let standard = Id::Standard(StandardId::MAX);
        for frame in [
            Frame::data_frame(extended, &[1, 2, 3]).unwrap(),
            Frame::remote_frame(standard, 8).unwrap(),
        ] {
            assert_eq!(frame_from_bytes(&frame_to_bytes(&frame)), Some(frame));
        }
        let mut too_long = frame_to_bytes(&Frame::data_frame(standard, &[]).unwrap());
        too_long[4] = 9;
        assert_eq!(frame_from_bytes(&too_long), None);
    }
}
