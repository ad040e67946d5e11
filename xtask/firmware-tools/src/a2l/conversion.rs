//! Conversions between raw counts and units, and names of codes.

use a2lfile::{
    A2lObjectName as _, Coeffs, CompuMethod, CompuTabRef, CompuVtab, ConversionType, DefaultValue,
    Module, ValuePairsStruct,
};
use hitch_protocols::xcp::measurements::MeasurementInfo;
use hitch_protocols::xcp::pages::Applied;
use hitch_quantities::{Fault, Reason, State, Trip, Trouble};

/// The name of the conversion from counts; it is added if it is new.
pub fn scaled(module: &mut Module, suffix: &str, per_unit: i32) -> String {
    let name = match suffix {
        "" => "number".to_owned(),
        _ => format!("{suffix}_{per_unit}"),
    };
    let decimals = per_unit.ilog10();
    let mut method = method(name, ConversionType::RatFunc, decimals, unit(suffix));
    method.coeffs = Some(Coeffs::new(0.0, f64::from(per_unit), 0.0, 0.0, 0.0, 1.0));
    add(module, method)
}

/// The name of the identity conversion of a single-precision number.
fn float(module: &mut Module, suffix: &str) -> String {
    let name = format!("{suffix}_float");
    add(
        module,
        method(name, ConversionType::Identical, 6, unit(suffix)),
    )
}

/// The name of the conversion of a measurement.
pub fn of_measurement(module: &mut Module, info: &MeasurementInfo) -> String {
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
        _ if info.is_float => return float(module, info.suffix),
        _ => return scaled(module, info.suffix, info.counts_per_unit),
    };
    let name = format!("{}_names", info.name);
    let mut method = method(name.clone(), ConversionType::TabVerb, 0, "");
    method.compu_tab_ref = Some(CompuTabRef::new(format!("{name}_table")));
    module
        .compu_vtab
        .push(table(format!("{name}_table"), names));
    add(module, method)
}

/// The names of codes.
fn table(name: String, names: Vec<(u8, String)>) -> CompuVtab {
    let count = u16::try_from(names.len()).unwrap_or(u16::MAX);
    let mut table = CompuVtab::new(name, String::new(), ConversionType::TabVerb, count);
    let pairs = names.into_iter();
    table.value_pairs = pairs
        .map(|(code, name)| ValuePairsStruct::new(code.into(), name))
        .collect();
    table.default_value = Some(DefaultValue::new("unknown".to_owned()));
    table
}

fn none_and<const N: usize>(names: [(u8, String); N]) -> Vec<(u8, String)> {
    std::iter::once((0, "none".to_owned()))
        .chain(names)
        .collect()
}

fn method(name: String, kind: ConversionType, decimals: u32, unit: &str) -> CompuMethod {
    CompuMethod::new(
        name,
        String::new(),
        kind,
        format!("%12.{decimals}"),
        unit.to_owned(),
    )
}

fn add(module: &mut Module, method: CompuMethod) -> String {
    let name = method.get_name().to_owned();
    if !module.compu_method.contains_key(&name) {
        module.compu_method.push(method);
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
