//! A tool connected to an ECU.

use hitch_protocols::can::Frame;
use hitch_protocols::j1939::{Id, Pgn};
use hitch_protocols::key::{Nonce, Secret};
use hitch_protocols::xcp::map::CALIBRATION_BASE;
use hitch_protocols::xcp::{
    Access, CalibrationPages, EcuMemory, Event, Measurements, Slave, TOOL_ADDRESS,
};
use hitch_quantities::ValidCalibration;
use hitch_quantities::calibration::calibration_words::{GROUPS, SCALARS_WORD, word_range};
use hitch_quantities::calibration::parameter::ParameterInfo;

/// Address of the ECU.
pub const ECU: u8 = 0x80;

/// Tool and ECU.
pub struct Desk {
    pub slave: Slave,
    pub pages: CalibrationPages,
    pub measurements: Measurements,
    pub access: Access,
    pub nonce: Nonce,
    pub now_us: u32,
}

/// An error answer with its code.
pub type Error = u8;

pub const OUT_OF_RANGE: Error = 0x22;
pub const WRITE_PROTECTED: Error = 0x23;
pub const ACCESS_DENIED: Error = 0x24;
pub const ACCESS_LOCKED: Error = 0x25;

impl Desk {
    /// An ECU without connection, at rest, with tuning enabled.
    pub fn new() -> Self {
        Self::with_secret(None)
    }

    /// The same with a secret.
    pub fn with_secret(secret: Option<Secret>) -> Self {
        let mut slave = Slave::new(secret);
        slave.set_address(Some(ECU));
        Self {
            slave,
            pages: CalibrationPages::new(&ValidCalibration::nominal()),
            measurements: Measurements::default(),
            access: Access::AtRest,
            nonce: Nonce::default(),
            now_us: 0,
        }
    }

    /// The same with a tool connected.
    pub fn connected() -> Self {
        let mut desk = Self::new();
        desk.obeyed(&[0xFF, 0]);
        desk
    }

    pub fn receive(&mut self, frame: &Frame) {
        let mut memory = EcuMemory {
            pages: &mut self.pages,
            measurements: &self.measurements,
            access: self.access,
            nonce: self.nonce,
        };
        self.slave.receive(frame, &mut memory, self.now_us);
    }

    /// The tool sends a command.
    pub fn send(&mut self, command: &[u8]) {
        self.receive(&frame(command, ECU, TOOL_ADDRESS));
    }

    /// A step of the ECU with this event.
    pub fn event(&mut self, event: Event) {
        let memory = EcuMemory {
            pages: &mut self.pages,
            measurements: &self.measurements,
            access: self.access,
            nonce: self.nonce,
        };
        self.slave.event(event, &memory, self.now_us);
    }

    /// The packets that the ECU has to send.
    pub fn packets(&mut self) -> Vec<Vec<u8>> {
        let mut packets = Vec::new();
        while let Some(frame) = self.slave.poll() {
            let id = Id::unpack(frame.extended_data_id().unwrap());
            assert_eq!(
                (id.pgn, id.destination, id.source),
                (Pgn::PROPRIETARY_A, TOOL_ADDRESS, ECU)
            );
            packets.push(frame.data().to_vec());
        }
        packets
    }

    /// The answer to a command.
    pub fn ask(&mut self, command: &[u8]) -> Result<Vec<u8>, Error> {
        self.send(command);
        let answers = self.packets();
        let [answer] = answers.as_slice() else {
            panic!("{command:02X?}: {answers:02X?}");
        };
        match answer.as_slice() {
            [0xFF, rest @ ..] => Ok(rest.to_vec()),
            [0xFE, error, ..] => Err(*error),
            other => panic!("{command:02X?}: {other:02X?}"),
        }
    }

    /// The answer to a command that has to succeed.
    pub fn obeyed(&mut self, command: &[u8]) -> Vec<u8> {
        let answer = self.ask(command);
        answer.unwrap_or_else(|error| panic!("{command:02X?}: error {error:02X}"))
    }

    pub fn set_address(&mut self, address: u32) {
        let [a, b, c, d] = address.to_le_bytes();
        self.obeyed(&[0xF6, 0, 0, 0, a, b, c, d]);
    }

    /// Reads a word.
    pub fn read(&mut self, address: u32) -> Result<i32, Error> {
        let [a, b, c, d] = address.to_le_bytes();
        let bytes = self.ask(&[0xF4, 4, 0, 0, a, b, c, d])?;
        Ok(i32::from_le_bytes(bytes.try_into().unwrap()))
    }

    /// Writes a word.
    pub fn write(&mut self, address: u32, value: i32) -> Result<(), Error> {
        self.set_address(address);
        let [a, b, c, d] = value.to_le_bytes();
        self.ask(&[0xF0, 4, a, b, c, d]).map(drop)
    }
}

/// A command in a frame.
pub fn frame(command: &[u8], destination: u8, source: u8) -> Frame {
    let id = Id {
        priority: 6,
        pgn: Pgn::PROPRIETARY_A,
        destination,
        source,
    };
    Frame::data_frame(id.pack().into(), command).unwrap()
}

/// Address of a word of the calibration.
pub fn word_address(word: usize) -> u32 {
    CALIBRATION_BASE + 4 * u32::try_from(word).unwrap()
}

/// Every scalar: its group, description, address, and whether it may be changed while the hitch moves.
pub fn scalars() -> Vec<(&'static str, &'static ParameterInfo, u32, bool)> {
    let all = GROUPS.iter().flat_map(|group| {
        let parameters = group.parameters.iter();
        parameters.map(|parameter| (group.name, parameter))
    });
    all.zip(SCALARS_WORD..)
        .map(|((group, parameter), word)| {
            let live = word_range(word).unwrap().class.is_live();
            (group, parameter, word_address(word), live)
        })
        .collect()
}

/// Address of a scalar.
pub fn scalar(group: &str, name: &str) -> u32 {
    let all = scalars();
    let found = all
        .iter()
        .find(|(of, parameter, ..)| *of == group && parameter.name == name);
    found.unwrap().2
}
