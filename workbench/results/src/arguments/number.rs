//! Numbers of options, each with its range.

use std::ops::RangeInclusive;

/// Loads of a hitch, kg: category 4 lifts 13 t.
pub const LOADS_KG: RangeInclusive<f64> = 0.0..=20_000.0;
/// Temperatures of hydraulic oil, C.
pub const OIL_C: RangeInclusive<f64> = -40.0..=120.0;

/// Parses a number in a range from the command line.
pub fn number(range: RangeInclusive<f64>) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |text| match text.parse() {
        Ok(number) if range.contains(&number) => Ok(number),
        _ => Err(format!(
            "it has to be a number from {} to {}",
            range.start(),
            range.end()
        )),
    }
}
