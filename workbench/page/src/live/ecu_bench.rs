//! The bench of the ECU with the orders of the page.

use std::ops::RangeInclusive;

use hitch_closed_loop::driven::{Button, Kind, Orders, Sensor, SensorFault};
use hitch_ecu::{AdcCode, BoardScaling, Contact, Contacts, Conversion, Samples};
use hitch_plant::Model;
use hitch_quantities::units::{MilliAmp, MilliDegree};
use hitch_quantities::{Fault, Outputs, State, Trip};

use hitch_closed_loop::Sample;
use hitch_ecu_host::ecu::{
    Bench, EcuMachine, MachineError, Moment, Order, PICK_UP_MS, ratiometric_codes, reach_deg,
};

/// Seed of the noise.
const SEED: u64 = 0x5eed_0001;

/// Bench, conditions and wiring.
pub struct EcuBench<'m> {
    bench: Bench<'m>,
    conversion: Conversion,
    wiring: BoardWiring,
    /// Range of the lever, degree.
    reach_deg: RangeInclusive<f64>,
    load_kg: f64,
    oil_temperature_c: f64,
}

impl<'m> EcuBench<'m> {
    /// A hitch at rest at an angle, degree. The lever is slightly below it until the operator moves it.
    pub fn new(plant: &'m Model, orders: &Orders, angle_deg: f64) -> Self {
        let (load_kg, oil_temperature_c) = (orders.load_kg, orders.oil_temperature_c);
        Self {
            bench: Bench::new(plant, load_kg, oil_temperature_c, angle_deg, SEED),
            conversion: Conversion::new(BoardScaling::NOMINAL),
            wiring: BoardWiring::default(),
            reach_deg: reach_deg(plant),
            load_kg,
            oil_temperature_c,
        }
    }

    /// One millisecond.
    ///
    /// # Errors
    /// If the machine has ended.
    pub fn tick(
        &mut self,
        orders: &Orders,
        machine: &mut impl EcuMachine,
    ) -> Result<Sample, MachineError> {
        self.set_conditions(orders);
        let wiring = &mut self.wiring;
        let angle_deg = self.bench.angle_deg();
        let tamper = |contacts: &mut Contacts| wiring.apply(orders.fault, &mut contacts.samples);
        let moment = self
            .bench
            .tick_with(machine, &[], &mut Vec::new(), tamper)?;
        if moment.time_ms >= PICK_UP_MS {
            self.operate(orders);
        }
        Ok(self.sample(&moment, angle_deg))
    }

    fn set_conditions(&mut self, orders: &Orders) {
        if self.load_kg != orders.load_kg {
            self.load_kg = orders.load_kg;
            self.bench.set_load_kg(orders.load_kg);
        }
        if self.oil_temperature_c != orders.oil_temperature_c {
            self.oil_temperature_c = orders.oil_temperature_c;
            self.bench.set_oil_temperature_c(orders.oil_temperature_c);
        }
    }

    /// Moves the controls; the lever moves at the speed of a hand.
    fn operate(&mut self, orders: &Orders) {
        let contacts = [
            (Contact::Hold, orders.hold),
            (Contact::QuickLift, orders.quick_lift),
        ];
        let (low_deg, high_deg) = (*self.reach_deg.start(), *self.reach_deg.end());
        let operator = &mut self.bench.operator;
        operator.apply(Order::Lever(orders.lever_deg.clamp(low_deg, high_deg)));
        let pressed = |button| orders.button == Some(button);
        operator.apply(Order::Buttons(
            pressed(Button::Raise),
            pressed(Button::Lower),
        ));
        for (contact, closed) in contacts {
            operator.apply(Order::Contact(contact, closed));
        }
    }

    fn sample(&mut self, moment: &Moment, angle_deg: f64) -> Sample {
        let (signals, reply) = (&moment.signals, &moment.reply);
        Sample {
            time_s: moment.time_ms as f64 * 1e-3,
            lever_deg: signals.lever_deg,
            angle_deg,
            cylinder_pressure_bar: signals.cylinder_pressure_bar,
            pump_pressure_bar: signals.pump_pressure_bar,
            inputs: self.conversion.inputs(&moment.contacts.samples),
            outputs: Outputs {
                state: State::from_code(reply.state).unwrap_or_default(),
                fault: Fault::from_code(reply.fault),
                trip: Trip::ALL.into_iter().find(|trip| *trip as u8 == reply.trip),
                target: MilliDegree(reply.target_mdeg),
                lift_current: MilliAmp(reply.lift_ma.into()),
                lower_current: MilliAmp(reply.lower_ma.into()),
                ..Outputs::default()
            },
        }
    }
}

/// A broken sensor at the converters.
#[derive(Debug, Default)]
struct BoardWiring {
    frozen: Option<(Sensor, AdcCode)>,
}

impl BoardWiring {
    fn apply(&mut self, fault: Option<SensorFault>, samples: &mut Samples) {
        self.frozen = self
            .frozen
            .filter(|(known, _)| fault.is_some_and(|fault| fault.sensor == *known));
        let Some(SensorFault { sensor, kind }) = fault else {
            return;
        };
        let (code, range) = match sensor {
            Sensor::Angle => (&mut samples.rocker_angle, 110.0),
            Sensor::Lever => (&mut samples.lever, 110.0),
            Sensor::CylinderPressure => (&mut samples.cylinder_pressure, 250.0),
            Sensor::PumpPressure => (&mut samples.pump_pressure, 250.0),
        };
        match kind {
            Kind::Open => *code = AdcCode::default(),
            Kind::Offset(by) => {
                let shifted = f64::from(code.get()) + ratiometric_codes(by / range);
                let shifted = shifted.round().clamp(0.0, f64::from(AdcCode::MAX.get()));
                *code = AdcCode::new(shifted as u16);
            }
            Kind::Frozen => *code = self.frozen.get_or_insert((sensor, *code)).1,
        }
        if kind != Kind::Frozen {
            self.frozen = None;
        }
    }
}
