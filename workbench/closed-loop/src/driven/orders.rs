//! The orders of a step: operator, load, oil, and a broken sensor.

use hitch_quantities::Inputs;
use hitch_quantities::units::MilliDegreePerSecond;
use serde::Deserialize;

use super::field_orders::FieldOrders;
use super::sensor_fault::{Kind, SensorFault};

/// Largest advance of a request, ms.
pub const LONGEST_MS: u32 = 1000;
/// Lever positions, degree.
const LEVERS_DEG: std::ops::RangeInclusive<f64> = -360.0..=360.0;
/// Loads, kg.
pub const LOADS_KG: std::ops::RangeInclusive<f64> = 0.0..=2000.0;
/// Oil temperatures, C.
pub const OILS_C: std::ops::RangeInclusive<f64> = -20.0..=120.0;
/// Offsets of a sensor, degree or bar.
const OFFSETS: std::ops::RangeInclusive<f64> = -1000.0..=1000.0;
/// Rocker speed that a button requests, in thousandths of a degree per second; the firmware limits it.
const BUTTON: MilliDegreePerSecond = MilliDegreePerSecond(15_000);

/// Why a request cannot advance by this many milliseconds; `None` if it can.
#[must_use]
pub fn wrong_advance(milliseconds: u32) -> Option<String> {
    (!(1..=LONGEST_MS).contains(&milliseconds))
        .then(|| format!("milliseconds is {milliseconds}; it has to be from 1 to {LONGEST_MS}"))
}

/// A button that moves the hitch while it is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Button {
    /// Raises.
    Raise,
    /// Lowers.
    Lower,
}

/// What both hitches are given during a step.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct Orders {
    /// Set point on the lever, degree.
    pub lever_deg: f64,
    /// The held button.
    pub button: Option<Button>,
    /// The switch that stops the hitch.
    #[serde(default)]
    pub hold: bool,
    /// The button of the quick lift.
    #[serde(default)]
    pub quick_lift: bool,
    /// Load at the hitch point, kg.
    pub load_kg: f64,
    /// Oil temperature, C.
    pub oil_temperature_c: f64,
    /// The broken sensor.
    pub fault: Option<SensorFault>,
    /// Field and function, of a hitch that works on one.
    #[serde(default)]
    pub field: Option<FieldOrders>,
}

impl Orders {
    /// The first value outside its range, as a message.
    pub fn fault(&self) -> Option<String> {
        let offset = match self.fault.map(|fault| fault.kind) {
            Some(Kind::Offset(by)) => by,
            _ => 0.0,
        };
        let own = [
            ("lever_deg", self.lever_deg, LEVERS_DEG),
            ("load_kg", self.load_kg, LOADS_KG),
            ("oil_temperature_c", self.oil_temperature_c, OILS_C),
            ("offset", offset, OFFSETS),
        ];
        let of_field = self.field.iter().flat_map(FieldOrders::ranged);
        let mut outside = own
            .into_iter()
            .chain(of_field)
            .filter(|(_, value, range)| !range.contains(value));
        let (name, value, range) = outside.next()?;
        let (low, high) = (range.start(), range.end());
        Some(format!(
            "{name} is {value}; it has to be from {low} to {high}"
        ))
    }

    /// Sets the inputs of the operator besides the lever.
    pub fn tell(&self, inputs: &mut Inputs) {
        inputs.jog = self.button.map(|button| match button {
            Button::Raise => BUTTON,
            Button::Lower => MilliDegreePerSecond(-BUTTON.0),
        });
        inputs.switches.hold = self.hold;
        inputs.switches.quick_lift = self.quick_lift;
    }
}
