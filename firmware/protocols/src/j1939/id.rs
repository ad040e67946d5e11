//! The 29-bit identifier: priority, parameter group, destination and source (SAE J1939-21, ISO 11783-3).
//!
//! ```text
//! bit 28..26   25..24   23..16      15..8                          7..0
//! priority     page     PDU format  destination (format < 240)     source address
//!                                   or group extension
//! ```

use crate::can::{ExtendedId, Frame};

/// Global address: all nodes.
pub const GLOBAL: u8 = 255;
/// The source address of a node without address.
pub const NULL: u8 = 254;

/// Number of a parameter group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pgn(pub u32);

impl Pgn {
    /// Request for a group.
    pub const REQUEST: Self = Self(0xEA00);
    /// Acknowledgement.
    pub const ACKNOWLEDGEMENT: Self = Self(0xE800);
    /// Address claimed, or cannot claim.
    pub const ADDRESS_CLAIMED: Self = Self(0xEE00);
    /// Transport protocol, connection management.
    pub const TRANSPORT_CONNECTION: Self = Self(0xEC00);
    /// Transport protocol, data.
    pub const TRANSPORT_DATA: Self = Self(0xEB00);
    /// Commanded address.
    pub const COMMANDED_ADDRESS: Self = Self(0xFED8);
    /// Rear hitch status.
    pub const REAR_HITCH_STATUS: Self = Self(0xFE45);
    /// Electronic engine controller 1: engine speed.
    pub const ENGINE: Self = Self(0xF004);
    /// Wheel-based speed and distance.
    pub const WHEEL_SPEED: Self = Self(0xFE48);
    /// Ground-based speed and distance.
    pub const GROUND_SPEED: Self = Self(0xFE49);
    /// Hitch and PTO commands.
    pub const HITCH_COMMANDS: Self = Self(0xFE42);
    /// Request for a group to be repeated.
    pub const REPETITION_RATE: Self = Self(0xCC00);
    /// Heartbeat.
    pub const HEARTBEAT: Self = Self(0xF0E4);
    /// Required tractor facilities of an implement.
    pub const REQUIRED_FACILITIES: Self = Self(0xFE08);
    /// Available tractor facilities.
    pub const TRACTOR_FACILITIES: Self = Self(0xFE09);
    /// Tractor Implement Management, server to client.
    pub const TIM_SERVER: Self = Self(0x2300);
    /// Tractor Implement Management, client to server.
    pub const TIM_CLIENT: Self = Self(0x2400);
    /// Authentication for Tractor Implement Management, client to server.
    pub const AUTHENTICATION_CLIENT: Self = Self(0x6F00);
    /// Proprietary B: currents and rocker angle.
    pub const HITCH_MOTION: Self = Self(0xFF45);
    /// Proprietary B: pressures and supply.
    pub const HITCH_PRESSURES: Self = Self(0xFF46);
    /// Proprietary B: time until the implement is in work.
    pub const HITCH_WORK: Self = Self(0xFF47);
    /// Active trouble codes.
    pub const DM1: Self = Self(0xFECA);
    /// Previously active trouble codes.
    pub const DM2: Self = Self(0xFECB);
    /// Clear previously active trouble codes.
    pub const DM3: Self = Self(0xFECC);
    /// Software identification.
    pub const SOFTWARE_IDENTIFICATION: Self = Self(0xFEDA);
    /// Proprietary A, addressed to one node.
    pub const PROPRIETARY_A: Self = Self(0xEF00);

    /// True if the group is addressed to one node, or to all of them.
    #[must_use]
    pub const fn has_destination(self) -> bool {
        (self.0 >> 8) & 0xFF < 240
    }

    /// The number as in a message: three bytes, little-endian.
    #[must_use]
    pub const fn to_bytes(self) -> [u8; 3] {
        let [low, middle, high, _] = self.0.to_le_bytes();
        [low, middle, high]
    }

    /// Number from three bytes of a message; bits beyond the 18 of a number are dropped.
    #[must_use]
    pub const fn from_bytes([low, middle, high]: [u8; 3]) -> Self {
        Self(u32::from_le_bytes([low, middle, high & 0x03, 0]))
    }
}

/// An identifier, unpacked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Id {
    /// 0 (first) to 7.
    pub priority: u8,
    /// Parameter group; without a destination in it.
    pub pgn: Pgn,
    /// Destination; [`GLOBAL`] for groups without a destination.
    pub destination: u8,
    /// Source.
    pub source: u8,
}

impl Id {
    /// A message to all nodes.
    #[must_use]
    pub const fn broadcast(pgn: Pgn, priority: u8, source: u8) -> Self {
        Self {
            priority,
            pgn,
            destination: GLOBAL,
            source,
        }
    }

    /// The same message to one node.
    #[must_use]
    pub const fn to(self, destination: u8) -> Self {
        Self {
            destination,
            ..self
        }
    }

    /// Unpacks.
    #[must_use]
    pub fn unpack(id: ExtendedId) -> Self {
        let raw = id.as_raw();
        let [source, specific, _, _] = raw.to_le_bytes();
        let group = Pgn((raw >> 8) & 0x3_FFFF);
        let priority = (raw >> 26).to_le_bytes()[0] & 0x07;
        if group.has_destination() {
            Self {
                priority,
                pgn: Pgn(group.0 & 0x3_FF00),
                destination: specific,
                source,
            }
        } else {
            Self {
                priority,
                pgn: group,
                destination: GLOBAL,
                source,
            }
        }
    }

    /// Packs.
    #[must_use]
    pub fn pack(self) -> ExtendedId {
        let group = if self.pgn.has_destination() {
            (self.pgn.0 & 0x3_FF00) | u32::from(self.destination)
        } else {
            self.pgn.0 & 0x3_FFFF
        };
        let raw = (u32::from(self.priority & 0x07) << 26) | (group << 8) | u32::from(self.source);
        crate::can::extended_id(raw)
    }

    /// A frame of eight bytes with this identifier.
    #[must_use]
    pub fn frame(self, bytes: [u8; 8]) -> Frame {
        Frame::of_eight(self.pack(), bytes)
    }
}
