//! The ECU behind a link: a request in, a reply out, on any machine.

use embedded_storage::nor_flash::NorFlash;
use heapless::{Deque, Vec};
use hitch_protocols::can::Frame;

use super::application::Ecu;
use super::drive::Drive;
use super::hardware::{Contacts, FlashRegions, Hardware};
use super::link::{MOST_FRAMES, Reply};
use super::scaling::BoardScaling;
use super::start_check::StartCheck;

/// Observer of a millisecond.
pub trait Probe {
    /// The samples are available.
    fn sampled(&mut self);
    /// The step of the controller has ended, and its pulses are passed to the drivers.
    fn driven(&mut self);
}

/// Without observer.
impl Probe for () {
    fn sampled(&mut self) {}
    fn driven(&mut self) {}
}

/// The ECU with inputs from requests and outputs to replies.
#[derive(Debug)]
pub struct HostedEcu<F, P = ()> {
    ecu: Ecu<F>,
    wires: Wires<P>,
}

#[derive(Debug, Default)]
struct Wires<P> {
    probe: P,
    drive: Drive,
    received: Deque<Frame, MOST_FRAMES>,
    sent: Vec<Frame, MOST_FRAMES>,
}

impl<P: Probe> Hardware for Wires<P> {
    fn drive(&mut self, drive: Drive) {
        self.probe.driven();
        self.drive = drive;
    }

    fn receive(&mut self) -> Option<Frame> {
        self.received.pop_front()
    }

    fn send(&mut self, frame: &Frame) -> bool {
        self.sent.push(*frame).is_ok()
    }

    fn frames_dropped(&self) -> u16 {
        0
    }

    fn is_bus_off(&self) -> bool {
        false
    }
}

impl<F: NorFlash, P: Probe + Default> HostedEcu<F, P> {
    /// The ECU in the state after power-up. Not inlined, as [`Ecu::start`].
    #[must_use]
    #[inline(never)]
    pub fn start(flash: FlashRegions<F>, serial_number: u32, scaling: BoardScaling) -> Self {
        Self {
            ecu: Ecu::start(flash, serial_number, scaling),
            wires: Wires::default(),
        }
    }

    /// Reports what the board has found at its start ([`Ecu::report`]).
    pub const fn report(&mut self, check: StartCheck) {
        self.ecu.report(check);
    }

    /// One millisecond; the sent frames are in [`Self::sent`].
    pub fn tick(&mut self, contacts: &Contacts, received: &[Frame]) -> Reply {
        self.wires.sent.clear();
        for frame in received.iter().take(MOST_FRAMES) {
            // The last tick emptied the queue, so there is room.
            let _ = self.wires.received.push_back(*frame);
        }
        self.wires.probe.sampled();
        let kicked = self.ecu.tick(contacts, &mut self.wires).is_some();
        let (drive, outputs) = (self.wires.drive, self.ecu.outputs());
        let milliampere = |value: i32| i16::try_from(value).unwrap_or(i16::MAX);
        Reply {
            lift: drive.lift.get(),
            lower: drive.lower.get(),
            enable: drive.enable,
            kicked,
            state: outputs.state as u8,
            fault: outputs.fault.map_or(0, |fault| fault as u8),
            trip: outputs.trip.map_or(0, |trip| trip as u8),
            frames: u8::try_from(self.wires.sent.len()).unwrap_or(u8::MAX),
            target_mdeg: outputs.target.0,
            lift_ma: milliampere(outputs.lift_current.0),
            lower_ma: milliampere(outputs.lower_current.0),
        }
    }

    /// The frames sent in the last tick.
    #[must_use]
    pub fn sent(&self) -> &[Frame] {
        &self.wires.sent
    }

    /// The observer.
    #[must_use]
    pub const fn probe(&self) -> &P {
        &self.wires.probe
    }

    /// The application.
    #[must_use]
    pub const fn ecu(&self) -> &Ecu<F> {
        &self.ecu
    }
}
