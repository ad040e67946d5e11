//! Conversion from an instrument's unit to the unit of a column.

use std::sync::LazyLock;

use hitch_input::Dimension;
use hitch_input::input_error::quote;
use hitch_input::written_unit::{above_air, parsed, spelling};
use hitch_plant::{Channel, Linkage, Model};

use crate::run_columns::{Column, OIL_TEMPERATURE, TIME};

/// Kelvin at 0 degrees Celsius.
const ZERO_C_K: f64 = 273.15;

/// Pressure of air, bar: the standard atmosphere.
const AIR_BAR: f64 = 1.013_25;

/// Conversion of a raw value to a value of a column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scale {
    /// `factor * value + offset`.
    Line {
        /// The factor.
        factor: f64,
        /// The offset.
        offset: f64,
    },
    /// Travel of the cylinder from its retracted end, converted to the rocker angle.
    Travel {
        /// Metres per raw unit.
        metres: f64,
    },
}

impl Scale {
    /// The identity.
    pub const ONE: Self = Self::Line {
        factor: 1.0,
        offset: 0.0,
    };

    /// From `unit` to the unit of `column`.
    ///
    /// # Errors
    /// `unit` is not a unit of that quantity.
    pub fn of(unit: &str, column: &Column) -> Result<Self, String> {
        let unit = spelling(unit);
        if unit == column.unit {
            return Ok(Self::ONE);
        }
        let line = |factor: f64, offset: f64| Ok(Self::Line { factor, offset });
        if let Some(above_air) = above_air(unit).filter(|_| column.unit == "bar") {
            return match Self::of(above_air, column)? {
                Self::Line { factor, .. } => line(factor, -AIR_BAR),
                travel @ Self::Travel { .. } => Ok(travel),
            };
        }
        if column.name == OIL_TEMPERATURE {
            match unit {
                "K" => return line(1.0, -ZERO_C_K),
                "degF" => return line(5.0 / 9.0, -160.0 / 9.0),
                _ => {}
            }
        }
        let (own, wanted) = (parsed(unit), parsed(column.unit));
        match own.zip(wanted) {
            Some((own, wanted)) if own.dimension == wanted.dimension => {
                line(own.si / wanted.si, 0.0)
            }
            Some((own, _)) if is_angle(column) && own.dimension == Dimension::LENGTH => {
                Ok(Self::Travel { metres: own.si })
            }
            _ if unit == "%" => Err(format!(
                "{} is in percent, and two points are not given",
                column.name
            )),
            _ if unit == "V" => Err(format!(
                "{} is a voltage, and two points of its sensor are not given",
                column.name
            )),
            _ => Err(format!("{} is not a unit of {}", quote(unit), column.name)),
        }
    }

    /// The line through two calibration points; `None` if they coincide.
    pub fn through(from: [f64; 2], to: [f64; 2]) -> Option<Self> {
        let factor = (to[1] - to[0]) / (from[1] - from[0]);
        let offset = to[0] - factor * from[0];
        let is_sound = factor.is_finite() && factor != 0.0 && offset.is_finite();
        is_sound.then_some(Self::Line { factor, offset })
    }

    /// The column's value, for a hitch with this linkage.
    pub fn apply(self, value: f64, linkage: &Linkage) -> f64 {
        match self {
            Self::Line { factor, offset } => value * factor + offset,
            Self::Travel { .. } if value.is_nan() => value,
            Self::Travel { metres } => {
                let posture = linkage.at(value * metres);
                posture.rocker_angle_rad.to_degrees()
            }
        }
    }
}

/// Whether a text is a unit of a column's quantity; volts are accepted for all.
pub fn is_unit_of(unit: &str, column: &Column) -> bool {
    spelling(unit) == "V" || Scale::of(unit, column).is_ok()
}

/// Whether a text is any unit of a log.
pub fn is_unit(text: &str) -> bool {
    let unit = spelling(text);
    let is_known = matches!(
        unit,
        "V" | "mV" | "degF" | "%" | "-" | "1" | "iso" | "clock"
    );
    is_known || above_air(unit).is_some() || (!unit.is_empty() && parsed(unit).is_some())
}

fn is_angle(column: &Column) -> bool {
    column.name == Channel::RockerAngle.key()
}

/// Whether a column contains times.
pub fn is_time(column: &Column) -> bool {
    column.name == TIME
}

/// The linkage of the nominal model, for campaigns that are read without a model.
pub fn nominal_linkage() -> &'static Linkage {
    static NOMINAL: LazyLock<Model> = LazyLock::new(hitch_model_file::nominal);
    NOMINAL.linkage()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run_columns::{LIFT, column};

    fn converted(value: f64, unit: &str, name: &str) -> f64 {
        let scale = Scale::of(unit, column(name).unwrap());
        scale
            .unwrap_or_else(|what| panic!("{what}"))
            .apply(value, nominal_linkage())
    }

    #[test]
    fn units_are_converted() {
        for (value, unit, name, expected) in [
            (1_500.0, "mA", LIFT, 1.5),
            (1_500.0, "ma", LIFT, 1.5),
            (100.0, "psi", "pump_pressure_bar", 6.894_757),
            (12.5, "MPa", "pump_pressure_bar", 125.0),
            (250.0, "kPa", "cylinder_pressure_bar", 2.5),
            (10.0, "gpm", "flow_lpm", 37.854_118),
            (std::f64::consts::FRAC_PI_2, "rad", "rocker_angle_deg", 90.0),
            (90.0, "°", "rocker_angle_deg", 90.0),
            (90.0, "Deg", "rocker_angle_deg", 90.0),
            (20.0, "L/min", "flow_lpm", 20.0),
            (40.0, "C", "oil_temperature_c", 40.0),
            (104.0, "°F", "oil_temperature_c", 40.0),
            (104.0, "degF", "oil_temperature_c", 40.0),
            (313.15, "K", "oil_temperature_c", 40.0),
            (20.0, "ms", "time_s", 0.02),
            (0.5, "days", "time_s", 43_200.0),
            (114.503_774, "psia", "pump_pressure_bar", 6.881_507),
            (11.013_25, "bar(a)", "pump_pressure_bar", 10.0),
            (79.0, "mm", "rocker_angle_deg", 90.0),
        ] {
            let got = converted(value, unit, name);
            assert!(
                (got - expected).abs() < 0.5e-5 * expected.abs() || unit == "mm",
                "{value} {unit}: {got}"
            );
        }
        let middle_deg = converted(79.0, "mm", "rocker_angle_deg");
        assert!((80.0..100.0).contains(&middle_deg), "{middle_deg}");
    }

    #[test]
    fn what_is_no_unit_of_the_quantity_is_refused() {
        for (unit, name) in [
            ("bar", LIFT),
            ("", LIFT),
            ("V", LIFT),
            ("A", "flow_lpm"),
            ("m", "flow_lpm"),
        ] {
            assert!(Scale::of(unit, column(name).unwrap()).is_err(), "{unit}");
        }
        assert_eq!(Scale::through([1.0, 1.0], [0.0, 5.0]), None);
        let pressure = Scale::through([0.5, 4.5], [0.0, 250.0]).unwrap();
        assert!((pressure.apply(2.5, nominal_linkage()) - 125.0).abs() < 1e-9);
    }

    #[test]
    fn units_are_told_from_names() {
        for unit in ["A", "mA", "°C", "l/min", "psi", "V", "Grad", "s"] {
            assert!(is_unit(unit), "{unit}");
        }
        for name in ["Strom", "", "Ventil 1", "angle"] {
            assert!(!is_unit(name), "{name}");
        }
    }
}
