//! The columns that a run may have.

use std::ops::RangeInclusive;

use hitch_plant::Channel;

/// Range of time stamps, s: beyond it, rounding errors affect the step between samples.
pub const TIME_S: RangeInclusive<f64> = -1e7..=1e10;

/// Range of currents, A.
pub const CURRENT_A: RangeInclusive<f64> = -10.0..=10.0;

/// Name of the time column.
pub const TIME: &str = "time_s";

/// Name of the lift current's column.
pub const LIFT: &str = "lift_current_a";

/// Name of the lowering current's column.
pub const LOWER: &str = "lower_current_a";

/// Name of the oil temperature's column.
pub const OIL_TEMPERATURE: &str = "oil_temperature_c";

/// A possible column of a log.
#[derive(Debug, PartialEq)]
pub struct Column {
    /// Its name, which ends in its unit.
    pub name: &'static str,
    /// Its unit, as formulas write it.
    pub unit: &'static str,
    /// Range of its values.
    pub range: RangeInclusive<f64>,
}

impl Column {
    /// A value, if it is in the range.
    ///
    /// # Errors
    /// What the value would be, and the range.
    pub fn checked(&self, value: f64) -> Result<f64, (String, String)> {
        let (low, high) = (self.range.start(), self.range.end());
        let would_be = || format!("would be {} = {value}", self.name);
        let range = || format!("the range is {low} to {high}");
        let is_in = self.range.contains(&value);
        is_in.then_some(value).ok_or_else(|| (would_be(), range()))
    }
}

const fn known(name: &'static str, unit: &'static str, range: RangeInclusive<f64>) -> Column {
    Column { name, unit, range }
}

/// The time column.
pub static TIMES: Column = known(TIME, "s", TIME_S);

/// The column of the lift current.
pub static LIFTS: Column = known(LIFT, "A", CURRENT_A);

/// All possible columns.
pub static COLUMNS: [Column; 8] = [
    known(TIME, "s", TIME_S),
    known(LIFT, "A", CURRENT_A),
    known(LOWER, "A", CURRENT_A),
    known(Channel::PumpPressure.key(), "bar", -10.0..=1000.0),
    known(Channel::CylinderPressure.key(), "bar", -10.0..=1000.0),
    known(Channel::Flow.key(), "l/min", -1000.0..=1000.0),
    known(Channel::RockerAngle.key(), "deg", -360.0..=360.0),
    known(OIL_TEMPERATURE, "degC", -60.0..=250.0),
];

/// The column with this name.
pub fn column(name: &str) -> Option<&'static Column> {
    COLUMNS.iter().find(|column| column.name == name)
}
