//! Scenarios for the images, one function each. Each returns a line with the measured figures.

mod bus;
mod buttons;
mod desk;
mod faults;
mod field;
mod first_flash;
mod history;
mod motion;
mod processor;
mod random;
mod remote;
mod rig;
mod setup;
mod start;
mod storage;

pub use rig::Rig;
pub use setup::{Scenario, Setup};

/// All of them, by name.
pub const ALL: [(&str, Scenario); 32] = [
    ("boot", start::boot),
    ("factory-fresh", start::factory_fresh),
    ("slow-crystal", start::slow_crystal),
    ("dead-crystal", start::dead_crystal),
    ("slow-clock-tolerance", start::slow_clock_tolerance),
    ("wrong-crystal", first_flash::wrong_crystal),
    ("unsealed-image", first_flash::unsealed_image),
    ("lift-hold-lower", motion::lift_hold_lower),
    ("store-and-read-back", storage::store_and_read_back),
    ("power-cuts", storage::power_cuts),
    ("fault-history", history::fault_history),
    ("log-compaction", history::compaction),
    ("electrical-faults", faults::electrical_faults),
    ("frozen-track", faults::frozen_track),
    ("enable-line", faults::enable_line),
    ("crystal-failure", processor::crystal_failure),
    ("debugger-halt", processor::debugger_halt),
    ("stuck-program", processor::stuck_program),
    ("stack-overflow", processor::stack_overflow),
    ("flipped-registers", processor::flipped_registers),
    ("flipped-code", processor::flipped_code),
    ("wrong-clock", processor::wrong_clock),
    ("damaged-ram", processor::damaged_ram),
    ("bus-off", bus::bus_off),
    ("flooded-bus", bus::flooded),
    ("remote-control", remote::consent),
    ("button-travel", buttons::longest_travel),
    ("button-contacts", buttons::contacts),
    ("draft-and-depth", field::draft_and_depth),
    ("stuck-conversions", field::stuck_conversions),
    ("desk", desk::bring_up),
    ("random-operation", random::operation),
];
