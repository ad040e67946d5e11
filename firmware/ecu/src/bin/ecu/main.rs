//! The ECU: the application on a board.
//!
//! A cyclic executive: TIM1 triggers the converters a thousand times a second, and when they have finished, one tick of
//! the application runs. There is a single task without interrupts, so there is no shared state and no lock, the stack
//! has a single call chain, and the execution order is that of the source. While the program waits for the converters
//! it receives frames from the bus, often enough that the hardware queue does not overflow.

#![no_std]
#![no_main]

mod board;

use core::panic::PanicInfo;

use cortex_m_rt::{ExceptionFrame, entry, exception};
use hitch_ecu::{Contacts, Drive, Ecu, Hardware, Samples, StartCheck};
use hitch_protocols::can::Frame;
use hitch_protocols::j1939::Trouble;
use hitch_quantities::{Fault, State};

use board::{
    Board, Can, Coils, Converters, ImageCheck, Oscillators, RegisterCheck, SlowClock, Source,
};

/// Coils and bus, as the application sees them.
struct Outside {
    coils: Coils,
    can: Can,
    /// The start has found nothing that forbids it. The application knows this too, and locks the hitch.
    may_drive: bool,
}

impl Hardware for Outside {
    fn drive(&mut self, drive: Drive) {
        // If an output fails, the driver has cut both coils, and its read-back reports the rest.
        let _ = self
            .coils
            .drive(if self.may_drive { drive } else { Drive::OFF });
    }

    fn receive(&mut self) -> Option<Frame> {
        self.can.next_heard()
    }

    fn send(&mut self, frame: &Frame) -> bool {
        self.can.send(frame)
    }

    fn frames_dropped(&self) -> u16 {
        self.can.dropped()
    }

    fn is_bus_off(&self) -> bool {
        self.can.is_off()
    }
}

#[entry]
fn main() -> ! {
    defmt::info!("reset by {=str}", board::reset_cause());
    let board = Board::start();
    let mut watchdog = board.watchdog;
    let mut converters = board.converters;
    let mut slow_clock = board.slow_clock;
    let mut switches = board.switches;
    let Some(mut image) = ImageCheck::start() else {
        give_up();
    };
    let check = start_check(&board.oscillators, &image);
    let mut outside = Outside {
        coils: board.coils,
        can: board.can,
        may_drive: !check.locks,
    };
    let mut ecu = Ecu::start(board.flash, board::serial_number(), board::scaling());
    ecu.report(check);
    let mut logged = Logged::default();
    watchdog.begin_operation();
    board::run();
    let registers = RegisterCheck::seal();
    loop {
        let samples = next_samples(&mut converters, &mut outside.can, &mut slow_clock);
        let contacts = Contacts {
            samples,
            panel: switches.read(),
            clock_us: board.clock.now_us(),
            enable_feedback: Some(outside.coils.enable_feedback()),
            clock_ratio: slow_clock.ratio(),
        };
        if !registers.holds() {
            give_up();
        }
        // Without permission the watchdog isn't kicked, and resets the ECU.
        if let Some(permission) = ecu.tick(&contacts, &mut outside) {
            watchdog.kick(permission);
        }
        if !image.step() {
            give_up();
        }
        logged.update(ecu.outputs().state, ecu.outputs().fault);
    }
}

/// What forbids to drive the coils, and what the mechanic has to know about the image.
fn start_check(oscillators: &Oscillators, image: &ImageCheck) -> StartCheck {
    let mut check = StartCheck::default();
    defmt::info!("crystal of {=u32} Hz", oscillators.crystal_hz);
    if oscillators.source() != Source::Crystal {
        defmt::error!("locked: crystal or watchdog's oscillator out of range");
        check.lock(Trouble::Crystal);
    }
    if cfg!(feature = "debugging") {
        defmt::warn!("image for debugging");
        check.note(Trouble::ImageForDebugging);
    }
    match image.is_sealed() {
        true => {}
        false if cfg!(feature = "debugging") => check.note(Trouble::ImageUnsealed),
        false => {
            defmt::error!("locked: image without checksum");
            check.lock(Trouble::ImageUnsealed);
        }
    }
    check
}

/// Listens to the bus and to the slow clock until the converters are done. If they never are, the watchdog resets the
/// ECU.
fn next_samples(converters: &mut Converters, can: &mut Can, slow_clock: &mut SlowClock) -> Samples {
    loop {
        can.listen();
        slow_clock.listen();
        converters.listen();
        if let Some(samples) = converters.take() {
            return samples;
        }
    }
}

/// What was logged last: only what changes is logged.
#[derive(Default)]
struct Logged {
    state: State,
    fault: Option<Fault>,
}

impl Logged {
    fn update(&mut self, state: State, fault: Option<Fault>) {
        if state != self.state {
            defmt::info!("{=str}", state.name());
            self.state = state;
        }
        if fault != self.fault {
            defmt::warn!("fault: {=str}", fault.map_or("none", Fault::name));
            self.fault = fault;
        }
    }
}

/// Cuts the coils and lets the watchdog reset the ECU.
fn give_up() -> ! {
    board::cut();
    loop {
        cortex_m::asm::nop();
    }
}

#[panic_handler]
fn on_panic(_: &PanicInfo<'_>) -> ! {
    give_up()
}

#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    give_up()
}

/// Either a part of the calibration or of the log of faults can't be read, as programming it was interrupted: then its copy
/// or entry is damaged, and the program goes on. Or the crystal has failed, and the timers run at another rate.
#[exception]
unsafe fn NonMaskableInt() {
    if !board::note_damaged_read() {
        give_up();
    }
}

/// No interrupt is enabled.
#[exception]
unsafe fn DefaultHandler(_: i16) -> ! {
    give_up()
}
