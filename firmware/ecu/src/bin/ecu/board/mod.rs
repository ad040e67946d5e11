//! Drivers on register level: the differences between parts are in the folder of the part.
//!
//! The register layouts come from `stm32-metapac`, whose accesses are safe. Reserved bits and the order of writes are
//! checked against the reference manuals (RM0090 for the STM32F405, RM0440 for the STM32G474).

mod can;
mod clock;
mod clock_source;
mod coils;
mod converters;
mod core_clock;
mod factory_reference;
mod flash;
mod image_check;
mod log;
mod oscillators;
mod pins;
mod ram_test;
mod register_check;
mod registers;
mod reset;
mod serial_number;
mod slow_clock;
mod switches;
mod watchdog;

#[cfg(feature = "stm32f405")]
#[path = "stm32f405/mod.rs"]
mod part;
#[cfg(feature = "stm32g474")]
#[path = "stm32g474/mod.rs"]
mod part;

#[cfg(all(feature = "stm32f405", feature = "stm32g474"))]
compile_error!(
    "an image is for one part: choose the feature `stm32f405`, `stm32g474` or `nucleo-g474re`"
);

use hitch_ecu::FlashRegions;

pub use can::Can;
pub use clock::Clock;
pub use clock_source::Source;
pub use coils::{Coils, cut, run};
pub use converters::Converters;
pub use factory_reference::scaling;
pub use flash::DataFlash;
pub use image_check::ImageCheck;
pub use oscillators::Oscillators;
pub use part::flash::note_damaged_read;
pub use register_check::RegisterCheck;
pub use reset::reset_cause;
pub use serial_number::serial_number;
pub use slow_clock::SlowClock;
pub use switches::Switches;
pub use watchdog::Watchdog;

/// The peripherals of the ECU's board.
pub struct Board {
    /// The PWM outputs and the enable line.
    pub coils: Coils,
    /// The converters, which also trigger the milliseconds.
    pub converters: Converters,
    /// The bus.
    pub can: Can,
    /// The operator's contacts.
    pub switches: Switches,
    /// The clock against which the controller checks the tick rate.
    pub clock: Clock,
    /// Measures the main clock against the watchdog's oscillator.
    pub slow_clock: SlowClock,
    /// Resets the ECU if it is not triggered in time.
    pub watchdog: Watchdog,
    /// What the oscillators were found to be.
    pub oscillators: Oscillators,
    /// Flash of the calibration and of the fault log.
    pub flash: FlashRegions<DataFlash>,
}

impl Board {
    /// Initialises all peripherals; the coils are off. The watchdog is first: a crystal that does not start leads to a
    /// reset.
    pub fn start() -> Self {
        let watchdog = Watchdog::start();
        let oscillators = Oscillators::measure();
        part::start_clocks(oscillators.source());
        let coils = coils::start(part::TIMER_FUNCTION);
        let converters = Converters::start();
        Self {
            switches: switches::start(),
            clock: Clock::start(part::TIMER_HZ),
            slow_clock: SlowClock::new(oscillators.slow_counts),
            can: Can::start(),
            flash: flash::regions(),
            coils,
            converters,
            watchdog,
            oscillators,
        }
    }
}
