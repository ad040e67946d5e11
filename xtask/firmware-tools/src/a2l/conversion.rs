//! Conversions between raw counts and units, and names of codes.

use std::fmt::Write as _;

use hitch_protocols::xcp::measurements::MeasurementInfo;
use hitch_protocols::xcp::pages::Applied;
use hitch_quantities::{Fault, Reason, State, Trip, Trouble};

/// Display of raw values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Conversion {
    name: String,
    kind: Kind,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Kind {
    /// Counts in a unit.
    Scaled { unit: &'static str, per_unit: i32 },
    /// The unit itself, in single precision.
    Float { unit: &'static str },
    /// Names of codes.
    Named(Vec<(u8, String)>),
}

/// The name of the conversion from counts; it is added if it is new.
pub fn scaled(conversions: &mut Vec<Conversion>, suffix: &str, per_unit: i32) -> String {
    let unit = unit(suffix);
    let name = match suffix {
        "" => "number".to_owned(),
        _ => format!("{suffix}_{per_unit}"),
    };
    add(
        conversions,
        Conversion {
            name,
            kind: Kind::Scaled { unit, per_unit },
        },
    )
}

/// The name of the identity conversion of a single-precision number.
fn float(conversions: &mut Vec<Conversion>, suffix: &str) -> String {
    add(
        conversions,
        Conversion {
            name: format!("{suffix}_float"),
            kind: Kind::Float { unit: unit(suffix) },
        },
    )
}

/// The name of the conversion of a measurement.
pub fn of_measurement(conversions: &mut Vec<Conversion>, info: &MeasurementInfo) -> String {
    let names = match info.name {
        "state" => State::ALL
            .iter()
            .map(|state| (*state as u8, state.name().to_owned()))
            .collect(),
        "fault" => none_and(Fault::ALL.map(|fault| (fault as u8, fault.name().to_owned()))),
        "trip" => none_and(Trip::ALL.map(|trip| (trip as u8, format!("{trip:?}")))),
        "set_point_reason" => {
            none_and(Reason::ALL.map(|reason| (reason as u8, reason.name().to_owned())))
        }
        "field_trouble" => {
            none_and(Trouble::ALL.map(|trouble| (trouble as u8, trouble.name().to_owned())))
        }
        "calibration_state" => [Applied::InUse, Applied::Pending, Applied::Inconsistent]
            .map(|applied| (applied as u8, format!("{applied:?}")))
            .to_vec(),
        _ if info.is_float => return float(conversions, info.suffix),
        _ => return scaled(conversions, info.suffix, info.counts_per_unit),
    };
    add(
        conversions,
        Conversion {
            name: format!("{}_names", info.name),
            kind: Kind::Named(names),
        },
    )
}

fn none_and<const N: usize>(names: [(u8, String); N]) -> Vec<(u8, String)> {
    std::iter::once((0, "none".to_owned()))
        .chain(names)
        .collect()
}

fn add(conversions: &mut Vec<Conversion>, conversion: Conversion) -> String {
    let name = conversion.name.clone();
    if !conversions.contains(&conversion) {
        conversions.push(conversion);
    }
    name
}

/// The unit of a suffix, as displayed.
fn unit(suffix: &str) -> &'static str {
    match suffix {
        "deg" => "deg",
        "deg_per_s" => "deg/s",
        "mm" => "mm",
        "mm_per_s" => "mm/s",
        "mm_per_s2" => "mm/s^2",
        "mm2" => "mm^2",
        "m" => "m",
        "m_per_s" => "m/s",
        "n" => "N",
        "n_per_deg" => "N/deg",
        "mm_per_s_per_bar" => "mm/(s bar)",
        "hz" => "Hz",
        "ul_per_s" => "ul/s",
        "a" => "A",
        "a_per_s" => "A/s",
        "uc" => "uC",
        "bar" => "bar",
        "c" => "degC",
        "v" => "V",
        "ms" => "ms",
        "us" => "us",
        "percent" => "%",
        "ohm" => "Ohm",
        "ohm_per_s" => "Ohm/s",
        "rpm" => "1/min",
        "per_s" => "1/s",
        "count" | "" => "",
        _ => panic!("no unit is written down for `{suffix}`"),
    }
}

impl Conversion {
    /// Its definition in the file.
    pub fn definition(&self) -> String {
        let Self { name, kind } = self;
        match kind {
            Kind::Scaled { unit, per_unit } => {
                let decimals = per_unit.ilog10();
                format!(
                    "/begin COMPU_METHOD {name} \"\" RAT_FUNC \"%12.{decimals}\" \"{unit}\"\n  COEFFS 0 {per_unit} 0 0 0 1\n/end COMPU_METHOD\n"
                )
            }
            Kind::Float { unit } => format!(
                "/begin COMPU_METHOD {name} \"\" IDENTICAL \"%12.6\" \"{unit}\"\n/end COMPU_METHOD\n"
            ),
            Kind::Named(names) => {
                let mut text = format!(
                    "/begin COMPU_METHOD {name} \"\" TAB_VERB \"%12.0\" \"\"\n  COMPU_TAB_REF {name}_table\n/end COMPU_METHOD\n\
                     /begin COMPU_VTAB {name}_table \"\" TAB_VERB {}\n",
                    names.len()
                );
                for (code, name) in names {
                    let _ = writeln!(text, "  {code} \"{name}\"");
                }
                text + "  DEFAULT_VALUE \"unknown\"\n/end COMPU_VTAB\n"
            }
        }
    }
}
