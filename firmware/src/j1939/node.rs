//! The hitch as a node on the bus: what it hears, and what it says when.

use super::claim::AddressClaim;
use super::hitch::{HitchCommand, HitchStatus, StatusMessage};
use super::id::{GLOBAL, Id, Pgn};
use super::name::Name;
use super::remote::{Remote, RemoteControl};
use super::time::since_ms;
use crate::can::Frame;

/// The rear hitch status is repeated this often, ms.
const STATUS_PERIOD_MS: u32 = 100;
/// A status that has changed comes no closer to the last one than this, ms: a moving hitch changes it all the time.
const STATUS_SPACING_MS: u32 = 20;
/// Priority of the rear hitch status.
const STATUS_PRIORITY: u8 = 3;

/// The address that a node asks for first unless told otherwise: the first that self-configurable nodes may take.
pub const PREFERRED_ADDRESS: u8 = 128;

/// What a node is told once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Its NAME; two nodes on a bus must differ in it.
    pub name: Name,
    /// The address that it asks for first.
    pub preferred_address: u8,
}

/// The node.
#[derive(Clone, Debug)]
pub struct Node {
    claim: AddressClaim,
    remote: RemoteControl,
    remote_permitted: bool,
    last_status: Option<([u8; 8], u32)>,
}

impl Node {
    /// A node that will claim its address with the first [`Self::poll`].
    #[must_use]
    pub fn new(settings: Settings) -> Self {
        Self {
            claim: AddressClaim::new(settings.name, settings.preferred_address),
            remote: RemoteControl::default(),
            remote_permitted: false,
            last_status: None,
        }
    }

    /// The node's address, once it may be used. It changes when another node wins it.
    #[must_use]
    pub const fn address(&self) -> Option<u8> {
        self.claim.address()
    }

    /// What an implement asks of the hitch just now.
    #[must_use]
    pub fn remote(&self) -> Remote {
        self.remote.remote()
    }

    /// Takes a frame from the bus. What isn't J1939, isn't for this node or is malformed changes nothing.
    pub fn receive(&mut self, frame: &Frame, now_ms: u32) {
        let Some(id) = frame.extended_data_id().map(Id::unpack) else {
            return;
        };
        let Some(bytes) = frame.eight() else {
            return;
        };
        match id.pgn {
            Pgn::ADDRESS_CLAIMED => {
                self.claim
                    .heard_claim(id.source, Name::from_bytes(*bytes), now_ms);
            }
            Pgn::HITCH_COMMANDS => {
                let command = HitchCommand::from_bytes(bytes);
                let permitted = self.remote_permitted;
                self.remote.command(command, id.source, permitted, now_ms);
            }
            _ => {}
        }
    }

    /// The next frame that is due. Called once a millisecond or more, until it gives none.
    pub fn poll(&mut self, now_ms: u32, status: &HitchStatus) -> Option<Frame> {
        self.remote_permitted = status.remote_permitted;
        self.remote.update(status, now_ms);
        if let Some(claim) = self.claim.poll(now_ms) {
            return Some(claim);
        }
        let source = self.claim.address()?;
        self.hitch_status(source, now_ms, status)
    }

    fn hitch_status(&mut self, source: u8, now_ms: u32, status: &HitchStatus) -> Option<Frame> {
        let message = StatusMessage::new(
            status,
            self.remote.limit_status(status),
            self.remote.exit_code(status),
        );
        let bytes = message.to_bytes();
        if let Some((last, sent_ms)) = self.last_status {
            let age_ms = since_ms(sent_ms, now_ms);
            let changed = bytes != last && age_ms >= STATUS_SPACING_MS;
            if !changed && age_ms < STATUS_PERIOD_MS {
                return None;
            }
        }
        self.last_status = Some((bytes, now_ms));
        self.remote.reported(message.position);
        let id = Id {
            priority: STATUS_PRIORITY,
            pgn: Pgn::REAR_HITCH_STATUS,
            destination: GLOBAL,
            source,
        };
        Some(id.frame(bytes))
    }
}
