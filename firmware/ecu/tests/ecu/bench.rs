//! An ECU with flash in RAM on a hitch that follows its coils without lag.

use std::cell::RefCell;
use std::ops::Range;
use std::rc::Rc;

use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};
use hitch_ecu::link::Reply;
use hitch_ecu::{AdcCode, BoardScaling, Contacts, FlashRegions, HostedEcu, Panel, Samples};
use hitch_protocols::can::Frame;
use hitch_protocols::j1939::{Id, Pgn};
use hitch_protocols::key::Secret;
use hitch_quantities::State;
use hitch_quantities::units::PerMille;

const PAGE: usize = 2_048;
const PAGES: usize = 4;
const LOG_PAGES: usize = 2;
const KEY_PAGES: usize = 1;

/// Power failed.
#[derive(Debug)]
pub struct PowerCut;

impl NorFlashError for PowerCut {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

/// Flash with error correction: each 8 bytes can be programmed once after they were erased. Clones share it. What is
/// read and written is the calibration's region; the log of faults is behind it.
#[derive(Clone)]
pub struct Flash {
    bytes: Rc<RefCell<Vec<u8>>>,
    region: Range<usize>,
}

impl Flash {
    pub fn blank() -> Self {
        Self {
            bytes: Rc::new(RefCell::new(vec![
                0xFF;
                PAGE * (PAGES + LOG_PAGES + KEY_PAGES)
            ])),
            region: 0..PAGE * PAGES,
        }
    }

    /// The same with the secret of the safety values.
    pub fn with_secret(self, secret: &Secret) -> Self {
        let record = secret.to_record();
        let start = PAGE * (PAGES + LOG_PAGES);
        self.bytes.borrow_mut()[start..start + record.len()].copy_from_slice(&record);
        self
    }

    /// Flips a bit of a byte.
    pub fn flip(&self, byte: usize) {
        self.bytes.borrow_mut()[byte] ^= 1;
    }

    /// What all regions hold.
    pub fn all_bytes(&self) -> Vec<u8> {
        self.bytes.borrow().clone()
    }

    /// The regions of an ECU.
    pub fn regions(self) -> FlashRegions<Self> {
        let fault_log = Self {
            bytes: Rc::clone(&self.bytes),
            region: PAGE * PAGES..PAGE * (PAGES + LOG_PAGES),
        };
        let key = Self {
            bytes: Rc::clone(&self.bytes),
            region: PAGE * (PAGES + LOG_PAGES)..PAGE * (PAGES + LOG_PAGES + KEY_PAGES),
        };
        FlashRegions {
            calibration: self,
            fault_log,
            key,
        }
    }

    fn place(&self, from: u32, length: usize) -> Range<usize> {
        let start = self.region.start + from as usize;
        assert!(start + length <= self.region.end, "outside its region");
        start..start + length
    }
}

impl ErrorType for Flash {
    type Error = PowerCut;
}

impl ReadNorFlash for Flash {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, target: &mut [u8]) -> Result<(), PowerCut> {
        target.copy_from_slice(&self.bytes.borrow()[self.place(offset, target.len())]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.region.len()
    }
}

impl NorFlash for Flash {
    const WRITE_SIZE: usize = 8;
    const ERASE_SIZE: usize = PAGE;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), PowerCut> {
        self.bytes.borrow_mut()[self.place(from, (to - from) as usize)].fill(0xFF);
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), PowerCut> {
        let target = &mut self.bytes.borrow_mut()[self.place(offset, bytes.len())];
        assert!(
            target.iter().all(|&byte| byte == 0xFF),
            "programmed twice at {offset}"
        );
        target.copy_from_slice(bytes);
        Ok(())
    }
}

/// The ECU, its hitch and its operator.
pub struct Bench {
    pub machine: HostedEcu<Flash>,
    pub panel: Panel,
    /// Thousandths of a degree.
    pub lever: i32,
    angle_micro: i64,
    pub reply: Reply,
    pub now_ms: u32,
    /// Frames for the next millisecond.
    pub received: Vec<Frame>,
    /// Frames that the ECU has sent, with their time.
    pub sent: Vec<(u32, Frame)>,
}

impl Bench {
    /// Powered up at 90 degrees with the lever elsewhere.
    pub fn start(flash: Flash) -> Self {
        Self {
            machine: HostedEcu::start(flash.regions(), 1, BoardScaling::NOMINAL),
            panel: Panel::FIELD,
            lever: 100_000,
            angle_micro: 90_000_000,
            reply: Reply::default(),
            now_ms: 0,
            received: Vec::new(),
            sent: Vec::new(),
        }
    }

    /// A message from another node.
    pub fn receive(&mut self, pgn: Pgn, source: u8, bytes: [u8; 8]) {
        let id = Id {
            priority: 3,
            pgn,
            destination: 0xFF,
            source,
        };
        self.received.push(id.frame(bytes));
    }

    /// One millisecond, in which `tamper` changes what the ECU is told.
    pub fn step_with(&mut self, tamper: impl FnOnce(&mut Contacts)) -> Reply {
        // The converter's last digit trembles, as that of a healthy sensor does.
        let tremble = [0, 40, -40, 20][(self.now_ms % 4) as usize];
        let angle = (self.angle_micro / 1_000) as i32 + tremble;
        let mut contacts = Contacts {
            samples: samples(angle, self.lever, &self.reply),
            panel: self.panel,
            clock_us: self.now_ms * 1_000,
            enable_feedback: Some(self.reply.enable),
            clock_ratio: Some(PerMille(1_000)),
        };
        tamper(&mut contacts);
        let received = std::mem::take(&mut self.received);
        self.reply = self.machine.tick(&contacts, &received);
        let sent = self.machine.sent().iter();
        self.sent.extend(sent.map(|&frame| (self.now_ms, frame)));
        let up = i64::from((i32::from(self.reply.lift_ma) - 1_126).max(0)) * 40;
        let down = i64::from((i32::from(self.reply.lower_ma) - 999).max(0)) * 40;
        self.angle_micro += up - down;
        self.now_ms += 1;
        self.reply
    }

    /// Milliseconds; true if no coil was on in any of them.
    pub fn is_still(&mut self, ms: u32) -> bool {
        (0..ms).all(|_| {
            let reply = self.step_with(|_| {});
            reply.lift == 0 && reply.lower == 0
        })
    }

    /// Milliseconds; the state after the last.
    pub fn run(&mut self, ms: u32) -> State {
        (0..ms).for_each(|_| {
            self.step_with(|_| {});
        });
        self.state()
    }

    /// Moves the lever through the hitch and to `lever`.
    pub fn pick_up(&mut self, lever: i32) {
        self.lever = 80_000;
        self.run(50);
        self.lever = 95_000;
        self.run(50);
        self.lever = lever;
    }

    /// Angle of the rocker, thousandths of a degree.
    pub const fn angle(&self) -> i32 {
        (self.angle_micro / 1_000) as i32
    }

    pub fn state(&self) -> State {
        State::from_code(self.reply.state).unwrap()
    }
}

/// The code of a share of full scale.
pub fn code(share: f64) -> AdcCode {
    AdcCode::new((share * 4_096.0).round().clamp(0.0, 4_095.0) as u16)
}

/// The codes of a healthy machine whose coils have just what is asked for.
pub fn samples(angle: i32, lever: i32, reply: &Reply) -> Samples {
    let ratiometric = |share: f64| code(0.1 + 0.8 * share);
    let of_angle = |angle: i32| ratiometric((f64::from(angle) * 1e-3 - 35.0) / 110.0);
    let current = |current: i16| code(f64::from(current) / 5_000.0);
    Samples {
        rocker_angle: of_angle(angle),
        lever: of_angle(lever),
        upper_limit: of_angle(145_000),
        lowering_dial: ratiometric(1.0),
        lift_current: current(reply.lift_ma),
        lower_current: current(reply.lower_ma),
        supply: code(13_800.0 / 24_576.0),
        cylinder_pressure: ratiometric(20.0 / 250.0),
        pump_pressure: ratiometric(4.0 / 250.0),
        second_angle: of_angle(180_000 - angle),
        sensor_supply: code(5_000.0 / 6_600.0),
        reference: BoardScaling::NOMINAL.reference,
        // Neither pins nor a depth sensor nor their dials are fitted.
        ..Samples::default()
    }
}
