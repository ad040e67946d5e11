//! The firmware's controller as a component.

use hitch_controller::Controller;
use hitch_controller_host::samples::{self, QUANTITIES, SWITCHES};
use hitch_controller_host::teaching::{self, Teaching};
use hitch_quantities::{Fault, Outputs, State, Trip, ValidCalibration};

use crate::component::{Component, Refusal, boolean, real};
use crate::variable::{Causality, Value, Variable};

/// The controller's step, s.
pub const STEP_S: f64 = 1e-3;
/// Deviation of a communication step from a multiple of the controller's that counts as rounding, s.
const ROUNDING_S: f64 = 1e-9;
/// Most steps of the controller in a communication step. It bounds the time of one call.
const MOST_STEPS: f64 = 3_600_000.0;

/// Quantities that the controller cannot do without: they count as sampled from the start.
const NEEDED: usize = 2;

/// Indices of the variables.
mod index {
    use hitch_controller_host::samples::{QUANTITIES, SWITCHES};

    pub const QUANTITY: usize = 0;
    pub const IS_SAMPLED: usize = QUANTITY + QUANTITIES.len();
    pub const SWITCH: usize = IS_SAMPLED + QUANTITIES.len();
    pub const OUTPUTS: usize = SWITCH + SWITCHES.len();
}

/// Unit, value at the start and meaning of each of [`QUANTITIES`].
type Quantity = (&'static str, f64, &'static str);

/// What may be set: the controller itself judges what is plausible.
const RANGE: (f64, f64) = (-1e6, 1e6);

#[rustfmt::skip]
const ABOUT: [Quantity; QUANTITIES.len()] = [
    ("deg", 90.0, "set point of the lever on the scale of the rocker angle"),
    ("deg", 90.0, "measured angle of the rocker arm"),
    ("bar", 0.0, "measured cylinder pressure"),
    ("bar", 0.0, "measured pump pressure"),
    ("degC", 40.0, "measured oil temperature"),
    ("V", 13.8, "measured supply"),
    ("deg/s", 0.0, "hold-to-run request, speed of the rocker, positive is up; while it is sampled, the lever has no say"),
    ("deg", 180.0, "upper-limit dial on the scale of the rocker angle"),
    ("%", 100.0, "lowering-rate dial; 0 is shut, 100 is open"),
    ("1/min", 0.0, "engine speed"),
    ("A", 0.0, "measured current of the lift coil"),
    ("A", 0.0, "measured current of the lowering coil"),
    ("%", 50.0, "output of the left draft pin over its supply"),
    ("%", 50.0, "output of the right draft pin over its supply"),
    ("m/s", 0.0, "speed over the ground; sampled in the steps in which a message is received"),
    ("m/s", 0.0, "speed of the driven wheels; sampled in the steps in which a message is received"),
    ("N", 0.0, "set point of the draft"),
    ("%", 50.0, "mix dial; 0 is position, 100 is draft"),
    ("%", 30.0, "slip limit"),
    ("", 0.0, "code of the function: 0 position, 1 draft, 2 mix, 3 depth limit, 4 depth"),
    ("%", 25.0, "output of the external depth sensor over its supply"),
    ("mm", 0.0, "set point of the depth"),
];

const SWITCHES_ABOUT: [&str; SWITCHES.len()] = [
    "transport lock: nothing moves, and the lever has to pick the hitch up afterwards",
    "hold: the hitch stays where it is whatever the lever does",
    "quick lift, a button: the first press raises, the next returns to the lever",
    "service: with it, jog_deg_per_s teaches a locked machine",
    "consent to remote control, a button; no effect without an implement on a bus",
    "second contact of the button up, closed while it is released; counts with operator.second_contact",
    "second contact of the button down, closed while it is released; counts with operator.second_contact",
    "quick engagement, lowers the implement into the soil while it is held",
];

/// The controller with a calibration.
#[derive(Clone)]
pub struct ControllerComponent {
    calibration: ValidCalibration,
    variables: Vec<Variable>,
    controller: Controller,
    teaching: Teaching,
}

impl ControllerComponent {
    /// The controller as it is after power-up.
    #[must_use]
    pub fn new(calibration: ValidCalibration) -> Self {
        let mut variables = inputs();
        variables.extend(outputs());
        Self {
            controller: Controller::new(calibration.clone()),
            calibration,
            variables,
            teaching: Teaching::default(),
        }
    }

    /// Puts what a step asked for among the values.
    fn show(&self, outputs: &Outputs, values: &mut [Value]) {
        let milli = |value: i32| Value::Real(f64::from(value) * 1e-3);
        let percent = |duty: i32| Value::Real(f64::from(duty) * 1e-3);
        let shown = [
            milli(outputs.lift_current.0),
            milli(outputs.lower_current.0),
            percent(outputs.lift_duty.0),
            percent(outputs.lower_duty.0),
            milli(outputs.target.0),
            milli(outputs.travel.0),
            milli(outputs.speed.0),
            Value::Integer(outputs.state as i32),
            Value::Integer(outputs.fault.map_or(0, |fault| fault as i32)),
            Value::Integer(outputs.trip.map_or(0, |trip| trip as i32)),
            Value::Text(teaching::state(outputs, &self.controller)),
        ];
        for (place, value) in values.iter_mut().skip(index::OUTPUTS).zip(shown) {
            *place = value;
        }
    }
}

fn inputs() -> Vec<Variable> {
    let mut inputs: Vec<Variable> = QUANTITIES
        .into_iter()
        .zip(ABOUT)
        .map(|(name, (unit, start, text))| {
            Variable::real(name, Causality::Input, (start, unit), RANGE, text)
        })
        .collect();
    inputs.extend(QUANTITIES.into_iter().enumerate().map(|(number, name)| {
        let text =
            format!("whether {name} is sampled; false: it is not fitted, or its sample is missing");
        let start = Value::Boolean(number < NEEDED);
        Variable::new(&format!("{name}_valid"), Causality::Input, start, "", &text)
    }));
    let switches = SWITCHES.into_iter().zip(SWITCHES_ABOUT);
    inputs.extend(switches.map(|(name, text)| {
        Variable::new(name, Causality::Input, Value::Boolean(false), "", text)
    }));
    inputs
}

fn outputs() -> Vec<Variable> {
    let reals = [
        ("lift_current_a", "A", "current asked of the lift coil"),
        ("lower_current_a", "A", "current asked of the lowering coil"),
        (
            "lift_duty_percent",
            "%",
            "share of the supply for the lift coil",
        ),
        (
            "lower_duty_percent",
            "%",
            "share of the supply for the lowering coil",
        ),
        (
            "target_deg",
            "deg",
            "set point that is worked on, inside the limits",
        ),
        (
            "estimated_travel_mm",
            "mm",
            "estimated travel of the piston",
        ),
        (
            "estimated_speed_mm_per_s",
            "mm/s",
            "estimated speed of the piston",
        ),
    ];
    let named = |name: &str, code: u8| format!("{code} {}", name.replace('-', " "));
    let states = State::ALL.map(|state| named(state.name(), state as u8));
    let faults = Fault::ALL.map(|fault| named(fault.name(), fault as u8));
    let trips = Trip::ALL.map(|trip| format!("{} {trip:?}", trip as u8));
    let codes = [
        ("state_code", format!("state: {}", states.join(", "))),
        (
            "fault_code",
            format!("fault: 0 none, {}", faults.join(", ")),
        ),
        (
            "trip_code",
            format!("trip of the safety envelope: 0 none, {}", trips.join(", ")),
        ),
    ];
    let mut outputs: Vec<Variable> = reals
        .into_iter()
        .map(|(name, unit, text)| Variable::output(name, unit, text))
        .collect();
    outputs.extend(
        codes.map(|(name, text)| {
            Variable::new(name, Causality::Output, Value::Integer(0), "", &text)
        }),
    );
    outputs.push(Variable::new(
        "state",
        Causality::Output,
        Value::Text(String::new()),
        "",
        "state as `hitch controller` prints it",
    ));
    outputs
}

impl Component for ControllerComponent {
    fn variables(&self) -> &[Variable] {
        &self.variables
    }

    fn initialise(&mut self, values: &mut [Value]) -> Result<(), Refusal> {
        self.controller = Controller::new(self.calibration.clone());
        self.teaching = Teaching::default();
        self.show(&Outputs::default(), values);
        Ok(())
    }

    fn step(&mut self, values: &mut [Value], slopes: &[f64], dt_s: f64) -> Result<(), Refusal> {
        let steps = steps(dt_s)?;
        let mut outputs = Outputs::default();
        for step in 0..steps {
            let since_s = f64::from(step) * STEP_S;
            let sampled: [Option<f64>; QUANTITIES.len()] = std::array::from_fn(|number| {
                let slope = slopes.get(index::QUANTITY + number).unwrap_or(&0.0);
                let value = real(values, index::QUANTITY + number) + slope * since_s;
                boolean(values, index::IS_SAMPLED + number).then_some(value)
            });
            let switches = std::array::from_fn(|number| boolean(values, index::SWITCH + number));
            outputs = self.controller.step(&samples::inputs(&sampled, switches));
            self.teaching.follow(&mut self.controller, outputs.state);
        }
        self.show(&outputs, values);
        Ok(())
    }

    fn copy(&self) -> Box<dyn Component> {
        Box::new(self.clone())
    }
}

/// The steps of the controller in a communication step.
fn steps(dt_s: f64) -> Result<u32, Refusal> {
    let steps = (dt_s / STEP_S).round();
    let is_multiple = (steps * STEP_S - dt_s).abs() <= ROUNDING_S * steps.max(1.0);
    if !(1.0..=MOST_STEPS).contains(&steps) || !is_multiple {
        return Err(Refusal(format!(
            "the communication step is {dt_s} s; take a multiple of the controller's step, 0.001 s, up to an hour"
        )));
    }
    Ok(steps as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_multiples_of_a_millisecond() {
        assert_eq!(steps(1e-3), Ok(1));
        assert_eq!(steps(0.3 - 0.2), Ok(100));
        for wrong in [
            0.5e-3,
            1.5e-3,
            1.000_1e-3,
            0.0,
            1e9,
            f64::NAN,
            f64::INFINITY,
        ] {
            assert!(steps(wrong).is_err(), "{wrong}");
        }
    }
}
