//! A drift of the converters' reference, and of a sensor supply, with the whole application in closed loop: the hitch
//! hardly moves, and the drift is reported.

use hitch_ecu::{AdcCode, Contacts, Samples};
use hitch_ecu_host::ecu::{Bench, CutFlash, Moment, OnHost, delivered};
use hitch_plant::Model;
use hitch_quantities::{Fault, State, ValidCalibration};

const START_DEG: f64 = 90.0;
/// The lever goes here first, degree.
const AT_DEG: f64 = 110.0;
/// Length of a drift, ms.
const DRIFT_MS: u64 = 3_000;
/// Final value of reference or sensor supply.
const LEFT: f64 = 0.92;

struct Machine<'m> {
    bench: Bench<'m>,
    ecu: OnHost,
}

impl<'m> Machine<'m> {
    /// A hitch that has been lifted and rests.
    fn resting(model: &'m Model) -> Self {
        let flash = CutFlash::holding(delivered(&ValidCalibration::nominal()));
        let mut machine = Self {
            bench: Bench::new(model, 150.0, 40.0, START_DEG, 1),
            ecu: OnHost::start(flash),
        };
        machine.bench.operator.lever_target_deg = AT_DEG;
        let moments: Vec<Moment> = (0..6_000).map(|_| machine.tick(|_| {})).collect();
        let last = moments.last().unwrap().reply;
        assert_eq!(State::from_code(last.state), Some(State::Holding));
        assert!((machine.bench.angle_deg() - AT_DEG).abs() < 0.3);
        machine
    }

    fn tick(&mut self, tamper: impl FnOnce(&mut Contacts)) -> Moment {
        self.bench
            .tick_with(&mut self.ecu, &[], &mut Vec::new(), tamper)
            .unwrap()
    }

    /// Drifts to the final value and holds it for a second: largest travel, the fault, and its time, ms.
    fn drift(&mut self, tamper: fn(&mut Samples, f64)) -> (f64, Option<(Fault, u64)>) {
        let from_deg = self.bench.angle_deg();
        let (mut way_deg, mut reported) = (0.0_f64, None);
        for ms in 0..DRIFT_MS + 1_000 {
            let share = 1.0 - (1.0 - LEFT) * (ms.min(DRIFT_MS) as f64 / DRIFT_MS as f64);
            let moment = self.tick(|contacts| tamper(&mut contacts.samples, share));
            way_deg = way_deg.max((self.bench.angle_deg() - from_deg).abs());
            let fault = Fault::from_code(moment.reply.fault);
            reported = reported.or(fault.map(|fault| (fault, ms)));
        }
        (way_deg, reported)
    }
}

fn times(code: AdcCode, factor: f64) -> AdcCode {
    let code = (f64::from(code.get()) * factor).round();
    AdcCode::new(code.min(f64::from(AdcCode::MAX.get())) as u16)
}

/// All converter codes are relative to the reference.
fn reference(samples: &mut Samples, share: f64) {
    *samples = Samples::from_codes(samples.codes().map(|code| times(code, 1.0 / share)));
}

/// Every sensor signal is proportional to its supply.
fn sensor_supply(samples: &mut Samples, share: f64) {
    for code in [
        &mut samples.sensor_supply,
        &mut samples.rocker_angle,
        &mut samples.second_angle,
        &mut samples.lever,
        &mut samples.upper_limit,
        &mut samples.lowering_dial,
        &mut samples.cylinder_pressure,
        &mut samples.pump_pressure,
    ] {
        *code = times(*code, share);
    }
}

#[test]
fn eight_percent_lost_in_three_seconds_move_the_hitch_by_less_than_half_a_degree() {
    let model = hitch_model_file::dynamic();
    for (what, tamper, fault) in [
        (
            "reference",
            reference as fn(&mut Samples, f64),
            Fault::Reference,
        ),
        ("sensor supply", sensor_supply, Fault::SensorSupply),
    ] {
        let (way_deg, reported) = Machine::resting(&model).drift(tamper);
        println!("{what}: {way_deg:.3} degree, {reported:?}");
        assert!(way_deg < 0.5, "{what}: {way_deg} degree");
        assert_eq!(reported.map(|(fault, _)| fault), Some(fault), "{what}");
    }
}
