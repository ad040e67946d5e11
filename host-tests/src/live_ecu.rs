//! A live ECU with plant and operator: its bus is a TCP port, and it runs in real time.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use hitch_ecu::{AdcCode, Contact, Contacts};
use hitch_ecu_host::ecu::slcan_server::SlcanServer;
use hitch_ecu_host::ecu::{Bench, Bus, EcuMachine, Order};

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
    /// Moves the lever to the hitch once and then leaves it alone. Consents to nothing.
    Withholding,
    /// The same, and then moves it to its upper end and back. Consents to nothing.
    Lifting,
    /// As [`Self::Withholding`], without service; then a wire of the external button up is shorted to ground.
    WireShorted,
    /// Has closed the transport lock.
    OnRoad,
}

impl Operator {
    /// Where the lever is moved to just now, if it is.
    fn moves_lever(self, time_ms: u32) -> Option<f64> {
        if time_ms == PICK_UP_MS {
            return match self {
                Self::Present | Self::Working => Some(START_DEG + 5.0),
                Self::Withholding | Self::Lifting | Self::WireShorted => Some(START_DEG + 0.5),
                Self::Away | Self::LeverUnplugged | Self::OnRoad => None,
            };
        }
        let highest_deg = match self {
            Self::Working => START_DEG + WORK_DEG,
            Self::Lifting => LEVER_END_DEG,
            _ => return None,
        };
        let works = time_ms > PICK_UP_MS && time_ms.is_multiple_of(WORK_MS);
        let is_up = (time_ms / WORK_MS).is_multiple_of(2);
        works.then_some(if is_up { START_DEG } else { highest_deg })
    }
}

/// Rocker angle at the start, degree.
pub const START_DEG: f64 = 90.0;
/// Upper end of the lever, degree.
const LEVER_END_DEG: f64 = 145.0;
const LOAD_KG: f64 = 150.0;
const OIL_TEMPERATURE_C: f64 = 40.0;
const SEED: u64 = 1;
/// When the operator picks the hitch up, ms.
const PICK_UP_MS: u32 = 1_000;
/// How often a working one moves the lever, ms, and how far.
const WORK_MS: u32 = 3_000;
const WORK_DEG: f64 = 10.0;
/// When the wire is shorted, ms.
const SHORTED_MS: u32 = 3_000;
/// How often the consent button is pressed, ms, and how long.
const CONSENT_MS: u32 = 2_000;
const PRESSED_MS: u32 = 200;
/// Behind by more than this, time is given up: the machine has other things to do.
const MOST_BEHIND: Duration = Duration::from_millis(200);

/// Runs it until `stop` is set. Service is switched on, so tools may write, except where a wire is shorted. Returns the lowest and the highest rocker
/// angle of the plant, degree.
pub fn run(
    machine: &mut impl EcuMachine,
    server: SlcanServer,
    operator: Operator,
    stop: &AtomicBool,
) -> [f64; 2] {
    let model = hitch_model_file::nominal();
    let mut bench = Bench::new(&model, LOAD_KG, OIL_TEMPERATURE_C, START_DEG, SEED);
    let is_serviced = operator != Operator::WireShorted;
    let service = Order::Contact(Contact::Service, is_serviced);
    bench.operator.apply(service);
    let mut bus = Bus::served_by(server);
    let mut said = Vec::new();
    let mut due = Instant::now();
    let mut time_ms = 0_u32;
    let mut travelled_deg = [START_DEG; 2];
    while !stop.load(Ordering::Relaxed) {
        if let Some(lever_deg) = operator.moves_lever(time_ms) {
            bench.operator.apply(Order::Lever(lever_deg));
        }
        let pressed = operator == Operator::Present && time_ms % CONSENT_MS < PRESSED_MS;
        let consent = Order::Contact(Contact::Consent, pressed);
        bench.operator.apply(consent);
        let is_shorted = operator == Operator::WireShorted && time_ms >= SHORTED_MS;
        for (contact, is_closed) in [
            (Contact::Up, is_shorted),
            (Contact::FieldMode, operator != Operator::OnRoad),
        ] {
            bench.operator.apply(Order::Contact(contact, is_closed));
        }
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
        let [lowest_deg, highest_deg] = travelled_deg;
        let angle_deg = bench.angle_deg();
        travelled_deg = [lowest_deg.min(angle_deg), highest_deg.max(angle_deg)];
        time_ms = time_ms.saturating_add(1);
        due += Duration::from_millis(1);
        match due.checked_duration_since(Instant::now()) {
            Some(early) => thread::sleep(early),
            None if due.elapsed() > MOST_BEHIND => due = Instant::now(),
            None => {}
        }
    }
    travelled_deg
}
