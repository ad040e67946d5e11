//! An ECU with plant and operator, live: its bus is a TCP port, and time is real.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use hitch_firmware::ecu::{AdcCode, Contact, Contacts};
use hitch_model::Model;
use hitch_workbench::can_door::CanDoor;
use hitch_workbench::ecu::{Bench, Bus, EcuMachine, Order};

/// What the operator does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// Leaves the lever where it is, and so the hitch locked.
    Away,
    /// Moves the lever through the hitch once and then leaves it alone.
    Present,
    /// Has pulled the lever's plug.
    LeverUnplugged,
}

const START_DEG: f64 = 90.0;
const LOAD_KG: f64 = 150.0;
const OIL_TEMPERATURE_C: f64 = 40.0;
const SEED: u64 = 1;
/// When the operator picks the hitch up, ms.
const PICK_UP_MS: u32 = 1_000;
/// Behind by more than this, time is given up: the machine has other things to do.
const MOST_BEHIND: Duration = Duration::from_millis(200);

/// Runs it until `stop` is set. Service is switched on, so tools may write.
pub fn run(machine: &mut impl EcuMachine, door: CanDoor, operator: Operator, stop: &AtomicBool) {
    let model = Model::nominal();
    let mut bench = Bench::new(&model, LOAD_KG, OIL_TEMPERATURE_C, START_DEG, SEED);
    bench.operator.obey(Order::Contact(Contact::Service, true));
    let mut bus = Bus::behind(door);
    let mut said = Vec::new();
    let mut due = Instant::now();
    let mut time_ms = 0_u32;
    while !stop.load(Ordering::Relaxed) {
        if operator == Operator::Present && time_ms == PICK_UP_MS {
            bench.operator.obey(Order::Lever(START_DEG + 5.0));
        }
        said.clear();
        let tamper = |contacts: &mut Contacts| {
            if operator == Operator::LeverUnplugged {
                contacts.samples.lever = AdcCode::default();
            }
        };
        let heard = bus.heard();
        let ticked = bench.tick_with(machine, &heard, &mut said, tamper);
        ticked.expect("the machine goes on");
        bus.tell(&said);
        time_ms = time_ms.saturating_add(1);
        due += Duration::from_millis(1);
        match due.checked_duration_since(Instant::now()) {
            Some(early) => thread::sleep(early),
            None if due.elapsed() > MOST_BEHIND => due = Instant::now(),
            None => {}
        }
    }
}
