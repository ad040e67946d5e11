//! A live ECU with plant and operator: its bus is a TCP port, and it runs in real time.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use hitch_ecu::{AdcCode, Contact, Contacts};
use hitch_workbench::ecu::{Bench, Bus, EcuMachine, Order};
use hitch_workbench::slcan_server::SlcanServer;

/// Actions of the operator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// Leaves the lever where it is, and so the hitch locked.
    Away,
    /// Moves the lever through the hitch once and then leaves it alone. Presses the consent button every two seconds.
    Present,
    /// The same, and then moves it up and down.
    Working,
    /// Has pulled the lever's plug.
    LeverUnplugged,
}

impl Operator {
    /// Where the lever is moved to just now, if it is.
    fn moves_lever(self, time_ms: u32) -> Option<f64> {
        let picks_up = matches!(self, Self::Present | Self::Working) && time_ms == PICK_UP_MS;
        if picks_up {
            return Some(START_DEG + 5.0);
        }
        let works =
            self == Self::Working && time_ms > PICK_UP_MS && time_ms.is_multiple_of(WORK_MS);
        let is_up = (time_ms / WORK_MS).is_multiple_of(2);
        works.then_some(if is_up {
            START_DEG
        } else {
            START_DEG + WORK_DEG
        })
    }
}

const START_DEG: f64 = 90.0;
const LOAD_KG: f64 = 150.0;
const OIL_TEMPERATURE_C: f64 = 40.0;
const SEED: u64 = 1;
/// When the operator picks the hitch up, ms.
const PICK_UP_MS: u32 = 1_000;
/// How often a working one moves the lever, ms, and how far.
const WORK_MS: u32 = 3_000;
const WORK_DEG: f64 = 10.0;
/// How often the consent button is pressed, ms, and how long.
const CONSENT_MS: u32 = 2_000;
const PRESSED_MS: u32 = 200;
/// Behind by more than this, time is given up: the machine has other things to do.
const MOST_BEHIND: Duration = Duration::from_millis(200);

/// Runs it until `stop` is set. Service is switched on, so tools may write.
pub fn run(
    machine: &mut impl EcuMachine,
    server: SlcanServer,
    operator: Operator,
    stop: &AtomicBool,
) {
    let model = hitch_model_file::nominal();
    let mut bench = Bench::new(&model, LOAD_KG, OIL_TEMPERATURE_C, START_DEG, SEED);
    bench.operator.apply(Order::Contact(Contact::Service, true));
    let mut bus = Bus::served_by(server);
    let mut said = Vec::new();
    let mut due = Instant::now();
    let mut time_ms = 0_u32;
    while !stop.load(Ordering::Relaxed) {
        if let Some(lever_deg) = operator.moves_lever(time_ms) {
            bench.operator.apply(Order::Lever(lever_deg));
        }
        let pressed = operator == Operator::Present && time_ms % CONSENT_MS < PRESSED_MS;
        let consent = Order::Contact(Contact::Consent, pressed);
        bench.operator.apply(consent);
        said.clear();
        let tamper = |contacts: &mut Contacts| {
            if operator == Operator::LeverUnplugged {
                contacts.samples.lever = AdcCode::default();
            }
        };
        let heard = bus.receive();
        let ticked = bench.tick_with(machine, &heard, &mut said, tamper);
        ticked.expect("the machine goes on");
        bus.send(&said);
        time_ms = time_ms.saturating_add(1);
        due += Duration::from_millis(1);
        match due.checked_duration_since(Instant::now()) {
            Some(early) => thread::sleep(early),
            None if due.elapsed() > MOST_BEHIND => due = Instant::now(),
            None => {}
        }
    }
}
