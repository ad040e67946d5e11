//! Trouble codes of the CAN controller, from the driver to DM1.

use std::collections::VecDeque;

use hitch_ecu::link::Reply;
use hitch_ecu::{BoardScaling, Contacts, Drive, Ecu, Hardware, Panel};
use hitch_protocols::can::Frame;
use hitch_protocols::j1939::{Id, Pgn};
use hitch_quantities::units::PerMille;

use crate::bench::{Flash, samples};
use crate::engine::{of_the_board, stored};

/// SPN 639 with FMI 31 and 9, as DM1 has them.
const BUS_OFF: [u8; 3] = [0x7F, 0x02, 31];
const FRAMES_LOST: [u8; 3] = [0x7F, 0x02, 9];

/// A CAN controller that the test puts into any state.
#[derive(Default)]
struct Controller {
    is_off: bool,
    dropped: u16,
    received: VecDeque<Frame>,
    sent: Vec<Frame>,
}

impl Hardware for Controller {
    fn drive(&mut self, _: Drive) {}

    fn receive(&mut self) -> Option<Frame> {
        self.received.pop_front()
    }

    fn send(&mut self, frame: &Frame) -> bool {
        if !self.is_off {
            self.sent.push(*frame);
        }
        !self.is_off
    }

    fn frames_dropped(&self) -> u16 {
        self.dropped
    }

    fn is_bus_off(&self) -> bool {
        self.is_off
    }
}

/// A locked hitch that is at rest, and its bus.
struct Machine {
    ecu: Ecu<Flash>,
    bus: Controller,
    panel: Panel,
    now_ms: u32,
}

impl Machine {
    fn start(bus: Controller) -> Self {
        let flash = stored(of_the_board());
        Self {
            ecu: Ecu::start(flash.regions(), 1, BoardScaling::NOMINAL),
            bus,
            panel: Panel::FIELD,
            now_ms: 0,
        }
    }

    fn run(&mut self, ms: u32) {
        for _ in 0..ms {
            let contacts = Contacts {
                samples: samples(90_000, 100_000, &Reply::default()),
                panel: self.panel,
                clock_us: self.now_ms * 1_000,
                enable_feedback: Some(false),
                clock_ratio: Some(PerMille(1_000)),
            };
            self.ecu.tick(&contacts, &mut self.bus);
            self.now_ms += 1;
        }
    }

    /// Whether the code is in a DM1 of these milliseconds, which is a frame or, with several codes, a broadcast of data
    /// packets.
    fn reports(&mut self, code: [u8; 3], ms: u32) -> bool {
        self.bus.sent.clear();
        self.run(ms);
        let of_group = |wanted: Pgn| {
            self.bus.sent.iter().filter(move |frame| {
                let id = frame.extended_data_id().map(Id::unpack);
                id.is_some_and(|id| id.pgn == wanted)
            })
        };
        let packets: Vec<u8> = of_group(Pgn::TRANSPORT_DATA)
            .flat_map(|frame| &frame.data()[1..])
            .copied()
            .collect();
        of_group(Pgn::DM1).any(|frame| frame.data()[2..5] == code)
            || packets.windows(3).any(|bytes| bytes == code)
    }
}

#[test]
fn bus_off_is_told_once_the_controller_is_back() {
    for off_ms in [1, 6, 3_000] {
        let mut machine = Machine::start(Controller::default());
        assert!(!machine.reports(BUS_OFF, 2_000));
        machine.bus.is_off = true;
        machine.run(off_ms);
        machine.bus.is_off = false;
        assert!(machine.reports(BUS_OFF, 4_900), "{off_ms} ms");
        machine.run(200);
        assert!(!machine.reports(BUS_OFF, 3_000), "{off_ms} ms");
    }
}

#[test]
fn lost_frames_are_told_also_where_their_count_wraps() {
    for dropped in [0, u16::MAX] {
        let mut machine = Machine::start(Controller {
            dropped,
            ..Controller::default()
        });
        assert!(!machine.reports(FRAMES_LOST, 2_000));
        machine.bus.dropped = dropped.wrapping_add(1);
        assert!(machine.reports(FRAMES_LOST, 4_900), "{dropped}");
        machine.run(200);
        assert!(!machine.reports(FRAMES_LOST, 3_000), "{dropped}");
    }
}

#[test]
fn frames_that_were_lost_before_the_first_millisecond_are_no_trouble() {
    let mut machine = Machine::start(Controller {
        dropped: 7,
        ..Controller::default()
    });
    assert!(!machine.reports(FRAMES_LOST, 3_000));
}

#[test]
fn frames_that_were_lost_during_a_flash_operation_are_no_trouble() {
    for (later_ms, is_told) in [(0, false), (1, true)] {
        let mut machine = Machine::start(Controller::default());
        machine.run(1_000);
        // The code of the bus-off is written to the log of faults, in the millisecond in which it occurs.
        machine.bus.is_off = true;
        machine.run(1);
        machine.bus.is_off = false;
        machine.run(later_ms);
        machine.bus.dropped += 1;
        assert_eq!(
            machine.reports(FRAMES_LOST, 3_000),
            is_told,
            "lost {later_ms} ms later"
        );
    }
}

/// The engine speed locks the hitch, so that a frame that is used shows.
#[test]
fn frames_from_before_bus_off_are_not_used() {
    let id = Id {
        priority: 3,
        pgn: Pgn::ENGINE,
        destination: 0xFF,
        source: 0,
    };
    let [low, high] = (8 * 300_u16).to_le_bytes();
    let stands = id.frame([0xFF, 0xFF, 0xFF, low, high, 0xFF, 0xFF, 0xFF]);
    for (is_off, is_used) in [(true, false), (false, true)] {
        let mut machine = Machine::start(Controller::default());
        machine.run(100);
        machine.bus.is_off = is_off;
        machine.bus.received.push_back(stands);
        machine.run(1);
        machine.bus.is_off = false;
        machine.run(2);
        let speed = machine.ecu.inputs().engine_speed;
        assert_eq!(speed.is_some(), is_used, "{speed:?}");
        assert!(machine.bus.received.is_empty());
    }
}
