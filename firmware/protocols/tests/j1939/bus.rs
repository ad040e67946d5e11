//! A bus in virtual time for tests of a node: what the node sends, and when.

use hitch_protocols::can::Frame;
use hitch_protocols::j1939::diagnostics::KINDS;
use hitch_protocols::j1939::{
    ExitCode, HitchCommand, HitchStatus, Id, Name, NameFields, Node, Pgn, Settings, Variant,
};
use hitch_quantities::units::PerMille;

/// Somebody else's address.
pub const OTHER: u8 = 0x26;
/// The address that the node asks for.
pub const OURS: u8 = 0x80;

/// A frame that the node sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sent {
    pub at_ms: u32,
    pub id: Id,
    pub frame: Frame,
}

impl Sent {
    pub fn data(&self) -> &[u8] {
        self.frame.data()
    }
}

/// A node, and what it has sent.
pub struct Bus {
    pub node: Node,
    pub status: HitchStatus,
    pub now_ms: u32,
    pub sent: Vec<Sent>,
}

impl Bus {
    /// A bus with a node that hasn't said anything yet. Time starts shortly before the counter wraps.
    pub fn new(variant: Variant) -> Self {
        let settings = Settings {
            name: name(1),
            preferred_address: OURS,
            variant,
            occurrences: [0; KINDS],
            software: b"hitch 1",
        };
        Self {
            node: Node::new(settings),
            status: HitchStatus {
                position: Some(PerMille(620)),
                remote_permitted: true,
                exit: ExitCode::Clear,
                ..HitchStatus::default()
            },
            now_ms: u32::MAX - 700,
            sent: Vec::new(),
        }
    }

    /// A bus with a node that has its address, and the implement [`OTHER`].
    pub fn claimed(variant: Variant) -> Self {
        let mut bus = Self::new(variant);
        bus.run(251);
        bus.hear_claim(OTHER, implement(1));
        assert_eq!(bus.node.address(), Some(OURS));
        bus.sent.clear();
        bus
    }

    /// Lets time pass, polling every millisecond.
    pub fn run(&mut self, ms: u32) {
        for _ in 0..ms {
            self.step();
        }
    }

    /// One millisecond; how many frames it gave.
    pub fn step(&mut self) -> usize {
        let before = self.sent.len();
        while let Some(frame) = self.node.poll(self.now_ms, &self.status) {
            let id = Id::unpack(frame.extended_data_id().expect("J1939 has no other frames"));
            self.sent.push(Sent {
                at_ms: self.now_ms,
                id,
                frame,
            });
            assert!(self.sent.len() < before + 10, "polling doesn't end");
        }
        self.now_ms = self.now_ms.wrapping_add(1);
        self.sent.len() - before
    }

    /// Another node sends.
    pub fn receive(&mut self, pgn: Pgn, destination: u8, source: u8, data: &[u8]) {
        let id = Id {
            priority: 6,
            pgn,
            destination,
            source,
        };
        let frame = Frame::data_frame(id.pack().into(), data).unwrap();
        self.node.receive(&frame, self.now_ms);
    }

    /// Another node claims an address.
    pub fn hear_claim(&mut self, address: u8, name: Name) {
        self.receive(Pgn::ADDRESS_CLAIMED, 0xFF, address, &name.to_bytes());
    }

    /// Another node commands the hitch.
    pub fn command_from(&mut self, source: u8, command: HitchCommand) {
        self.receive(Pgn::HITCH_COMMANDS, 0xFF, source, &command.to_bytes());
    }

    /// The implement [`OTHER`] commands.
    pub fn command(&mut self, command: HitchCommand) {
        self.command_from(OTHER, command);
    }

    /// The operator consents in the next millisecond.
    pub fn consent(&mut self) {
        self.status.consents = true;
        self.step();
        self.status.consents = false;
    }

    /// The implement [`OTHER`] asks for the hitch at `raw`, the operator consents, and the implement has it.
    pub fn take_control(&mut self, raw: u8) {
        for _ in 0..2 {
            self.command(HitchCommand::Position(raw));
            self.run(99);
            assert_eq!(self.node.remote_state(), 1, "requested");
            self.step();
        }
        self.consent();
        assert_eq!(self.node.remote_state(), 2, "consented");
        self.command(HitchCommand::Position(raw));
        assert_eq!(self.node.remote_state(), 3, "active");
    }

    /// Another node asks for a group.
    pub fn ask(&mut self, group: Pgn, destination: u8) {
        self.receive(Pgn::REQUEST, destination, OTHER, &group.to_bytes());
    }

    /// What was sent of a group, and forgets everything that was sent.
    pub fn take(&mut self, pgn: Pgn) -> Vec<Sent> {
        let sent = std::mem::take(&mut self.sent);
        sent.into_iter().filter(|sent| sent.id.pgn == pgn).collect()
    }
}

/// The NAME of a hitch with this serial number; smaller ones win.
pub fn name(identity: u32) -> Name {
    NameFields::rear_hitch(identity + 1_000).into()
}

/// The NAME of an implement, a sprayer, with this serial number.
pub fn implement(identity: u32) -> Name {
    let fields = NameFields {
        function: 128,
        device_class: 6,
        ..NameFields::rear_hitch(identity + 2_000)
    };
    fields.into()
}
