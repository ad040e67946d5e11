//! The whole application, as on the ECU: requests in, replies out (see [`hitch_ecu::link`]).

use hitch_ecu::link::{
    FRAME_BYTES, MOST_FRAMES, REQUEST_BYTES, Reply, Request, frame_from_bytes, frame_to_bytes,
};
use hitch_ecu::{BoardScaling, Contacts, FlashRegions, HostedEcu, Probe};
use hitch_protocols::can::Frame;

use crate::flash_file::FlashFile;
use crate::link::Link;
use crate::outcome::{Done, Failure};
use crate::stopwatch::{self, Stopwatch};

/// Serial number of the emulated part.
const SERIAL_NUMBER: u32 = 1;

/// Runs until the requests end.
pub fn run(link: &mut Link, stopwatch: &Stopwatch) -> Result<Done, Failure> {
    let flash = FlashFile::open()?;
    let mut done = Done::default();
    while power_up(flash.clone(), link, stopwatch, &mut done)? == End::PowerCut {}
    Ok(done)
}

/// The timer when the samples were there, and when their pulses went to the drivers; it counts down.
#[derive(Default)]
struct Control {
    sampled: u32,
    driven: u32,
}

impl Control {
    const fn ticks(&self) -> u32 {
        self.sampled.wrapping_sub(self.driven)
    }
}

impl Probe for Control {
    fn sampled(&mut self) {
        self.sampled = stopwatch::now();
    }

    fn driven(&mut self) {
        self.driven = stopwatch::now();
    }
}

/// Why a machine came to its end.
#[derive(PartialEq, Eq)]
enum End {
    PowerCut,
    NoMoreRequests,
}

/// The life of a machine.
#[inline(never)]
fn power_up(
    flash: FlashRegions<FlashFile>,
    link: &mut Link,
    stopwatch: &Stopwatch,
    done: &mut Done,
) -> Result<End, Failure> {
    let mut machine: HostedEcu<FlashFile, Control> =
        HostedEcu::start(flash, SERIAL_NUMBER, BoardScaling::NOMINAL);
    let mut was_storing = false;
    while let Some(record) = link.read::<REQUEST_BYTES>()? {
        let Request::Tick { contacts, frames } = Request::from_bytes(&record) else {
            return Ok(End::PowerCut);
        };
        let received = receive(link, frames)?;
        let (reply, ticks) = stopwatch.ticks_of(|| tick(&mut machine, &contacts, &received));
        done.longest_control = done.longest_control.max(machine.probe().ticks());
        done.ticks += 1;
        let storing = was_storing || machine.ecu().is_storing();
        was_storing = machine.ecu().is_storing();
        match (reply.enable, storing) {
            (true, _) => done.longest_working = done.longest_working.max(ticks),
            (false, false) => done.longest = done.longest.max(ticks),
            (false, true) => done.longest_storing = done.longest_storing.max(ticks),
        }
        link.write(&reply.to_bytes())?;
        for frame in machine.sent() {
            link.write(&frame_to_bytes(frame))?;
        }
    }
    Ok(End::NoMoreRequests)
}

/// The millisecond as the ECU's loop calls it: not merged into the loop around it.
#[inline(never)]
fn tick(
    machine: &mut HostedEcu<FlashFile, Control>,
    contacts: &Contacts,
    received: &[Frame],
) -> Reply {
    machine.tick(contacts, received)
}

/// The frames that follow a request; what makes no frame is left out.
fn receive(link: &mut Link, frames: usize) -> Result<heapless::Vec<Frame, MOST_FRAMES>, Failure> {
    let mut received = heapless::Vec::new();
    for _ in 0..frames {
        let bytes = link.read::<FRAME_BYTES>()?;
        if let Some(frame) = bytes.as_ref().and_then(frame_from_bytes) {
            // A request has no more frames than this holds.
            let _ = received.push(frame);
        }
    }
    Ok(received)
}
