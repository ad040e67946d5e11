//! The description file (ASAM MCD-2 MC, "A2L") of the ECU's parameters and measurements.
//!
//! All contents come from the tables of the firmware: names, units, ranges and reasons of the parameters, the
//! measurements, and their address map. The file is therefore valid for every image from the same source, independent
//! of the linker; its identity (EPK) has to equal that of the ECU.

mod conversion;
mod interface;

use std::fmt::Write as _;
use std::fs;

use anyhow::{Context, Result};
use arm_build::workspace;
use hitch_protocols::xcp::map::{
    CALIBRATION_BASE, IDENTITY, IDENTITY_BASE, MEASUREMENT_BASE, SLOT_BYTES,
};
use hitch_protocols::xcp::measurements::{self, MeasurementInfo, Width};
use hitch_quantities::calibration::CALIBRATION_BYTES;
use hitch_quantities::calibration::calibration_words::{
    GROUPS, LIFT_WORD, LINKAGE_WORD, LONGEST_TRAVEL, LOWER_WORD, SCALARS_WORD, word_range,
};
use hitch_quantities::calibration::class::{Class, Tightening};
use hitch_quantities::calibration::linkage::LINKAGE_POINTS;
use hitch_quantities::calibration::parameter::ParameterInfo;
use hitch_quantities::calibration::valve_table::VALVE_POINTS;

use conversion::Conversion;

/// Path of the file.
const FILE: &str = "firmware/hitch.a2l";

/// Writes the file.
pub fn write() -> Result<()> {
    let path = workspace::root().join(FILE);
    fs::write(&path, text()).with_context(|| format!("can't write {}", path.display()))?;
    println!("{FILE} is up to date");
    Ok(())
}

/// Contents of the file.
fn text() -> String {
    let mut conversions = Vec::new();
    let body = [
        parameters(&mut conversions),
        measurements(&mut conversions),
        groups(),
    ]
    .concat();
    let conversions: String = conversions.iter().map(Conversion::definition).collect();
    format!(
        "/* Written by `cargo xtask a2l` from the tables of the firmware: don't edit. */\n\
         ASAP2_VERSION 1 71\n\
         /begin PROJECT hitch \"Electro-hydraulic three-point hitch\"\n\
         /begin MODULE ecu \"Hitch controller\"\n\n\
         {aml}\n{memory}\n{interface}\n{LAYOUTS}\n{conversions}\n{body}\
         /end MODULE\n/end PROJECT\n",
        aml = interface::AML,
        memory = memory(),
        interface = interface::text(),
    )
}

/// Storage of parameters: words, and the tables of the valves and of the linkage.
const LAYOUTS: &str = "\
/begin RECORD_LAYOUT word FNC_VALUES 1 SLONG COLUMN_DIR DIRECT /end RECORD_LAYOUT
/begin RECORD_LAYOUT valve
  NO_AXIS_PTS_X 1 ULONG
  AXIS_PTS_X 2 SLONG INDEX_INCR DIRECT
  FNC_VALUES 3 SLONG ALTERNATE_WITH_X DIRECT
/end RECORD_LAYOUT
";

fn memory() -> String {
    let identity = String::from_utf8_lossy(&IDENTITY);
    format!(
        "/begin MOD_COMMON \"\"\n  BYTE_ORDER MSB_LAST\n  ALIGNMENT_LONG 4\n/end MOD_COMMON\n\
         /begin MOD_PAR \"\"\n  EPK \"{identity}\"\n  ADDR_EPK 0x{IDENTITY_BASE:08X}\n  \
         /begin MEMORY_SEGMENT calibration \"working page in RAM, reference page in flash\" DATA FLASH INTERN \
         0x{CALIBRATION_BASE:08X} 0x{CALIBRATION_BYTES:X} -1 -1 -1 -1 -1\n{pages}  /end MEMORY_SEGMENT\n/end MOD_PAR\n",
        pages = interface::PAGES,
    )
}

/// Address of a word of the calibration.
fn word_address(word: usize) -> u32 {
    CALIBRATION_BASE + SLOT_BYTES * u32::try_from(word).unwrap_or(u32::MAX / SLOT_BYTES)
}

/// A text in quotes.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.trim().replace('"', "\\\""))
}

/// A number of raw counts in its unit.
fn physical(counts: i32, per_unit: i32) -> f64 {
    f64::from(counts) / f64::from(per_unit)
}

fn parameters(conversions: &mut Vec<Conversion>) -> String {
    let mut text = String::new();
    valve(
        &mut text,
        "lift",
        "Lift valve at the compensated drop",
        LIFT_WORD,
        conversions,
    );
    let lower = "Lowering valve at hydraulics.reference_drop";
    valve(&mut text, "lower", lower, LOWER_WORD, conversions);
    linkage(&mut text, conversions);
    let mut word = SCALARS_WORD;
    for group in &GROUPS {
        for parameter in group.parameters {
            scalar(
                &mut text,
                group.name,
                parameter,
                class_of_word(word),
                word,
                conversions,
            );
            word += 1;
        }
    }
    text
}

fn class_of_word(word: usize) -> Class {
    word_range(word).map_or(Class::Machine, |range| range.class)
}

fn scalar(
    text: &mut String,
    group: &str,
    parameter: &ParameterInfo,
    class: Class,
    word: usize,
    conversions: &mut Vec<Conversion>,
) {
    let per_unit = parameter.counts_per_unit;
    let when = match class {
        Class::Live => "",
        Class::Machine => " (Changed at rest only.)",
        Class::Safety(Tightening::Up) => {
            " (Safety: changed at rest only, reduced with the key only.)"
        }
        Class::Safety(Tightening::Down) => {
            " (Safety: changed at rest only, increased with the key only.)"
        }
        Class::Safety(Tightening::None) => " (Safety: changed at rest and with the key only.)",
    };
    let _ = write!(
        text,
        "/begin CHARACTERISTIC {group}.{name}\n  {reason}\n  VALUE 0x{address:08X} word 0 {conversion} {min} {max}\n/end CHARACTERISTIC\n",
        name = parameter.name,
        reason = quoted(&format!("{}{when}", parameter.reason.trim())),
        address = word_address(word),
        conversion = conversion::scaled(conversions, parameter.suffix, per_unit),
        min = physical(parameter.min, per_unit),
        max = physical(parameter.max, per_unit),
    );
}

/// Current over flow, preceded by the number of points.
fn valve(
    text: &mut String,
    name: &str,
    what: &str,
    word: usize,
    conversions: &mut Vec<Conversion>,
) {
    let flow = conversion::scaled(conversions, "ul_per_s", 1);
    let current = conversion::scaled(conversions, "a", 1_000);
    let _ = write!(
        text,
        "/begin CHARACTERISTIC {name}.current\n  {what}\n  CURVE 0x{address:08X} valve 0 {current} 0 5\n  \
         /begin AXIS_DESCR STD_AXIS NO_INPUT_QUANTITY {flow} {VALVE_POINTS} 0 10000000\n    MONOTONY STRICT_INCREASE\n  \
         /end AXIS_DESCR\n/end CHARACTERISTIC\n",
        what = quoted(&format!(
            "{what}: current over flow, from the threshold to saturation. Flows are at least 0.25 % of the largest one apart. (Changed at rest only.)"
        )),
        address = word_address(word),
    );
}

fn linkage(text: &mut String, conversions: &mut Vec<Conversion>) {
    let angle = conversion::scaled(conversions, "deg", 1_000);
    let travel = conversion::scaled(conversions, "mm", 1_000);
    let axis = [
        (
            "first_angle",
            "Angle of the first point of the linkage's table",
            -360.0,
        ),
        (
            "angle_step",
            "Angle from point to point of the linkage's table",
            0.001,
        ),
    ];
    for (word, (name, what, min)) in (LINKAGE_WORD..).zip(axis) {
        let address = word_address(word);
        let _ = write!(
            text,
            "/begin CHARACTERISTIC linkage.{name}\n  {what}\n  VALUE 0x{address:08X} word 0 {angle} {min} 360\n/end CHARACTERISTIC\n",
            what = quoted(&format!("{what}. (Changed at rest only.)")),
        );
    }
    let most = physical(LONGEST_TRAVEL, 1_000);
    let _ = write!(
        text,
        "/begin CHARACTERISTIC linkage.travel\n  \"Piston travel at each point of the linkage's table, strictly rising. (Changed at rest only.)\"\n  \
         VAL_BLK 0x{address:08X} word 0 {travel} -{most} {most}\n  MATRIX_DIM {LINKAGE_POINTS}\n/end CHARACTERISTIC\n",
        address = word_address(LINKAGE_WORD + 2),
    );
}

fn measurements(conversions: &mut Vec<Conversion>) -> String {
    let mut text = String::new();
    for (slot, info) in (0..).zip(measurements::INFO) {
        let conversion = conversion::of_measurement(conversions, info);
        let _ = write!(
            text,
            "/begin MEASUREMENT {name}\n  {description}\n  {width} {conversion} 0 0 {min} {max}\n  ECU_ADDRESS 0x{address:08X}\n/end MEASUREMENT\n",
            name = info.name,
            description = quoted(info.description),
            width = width(info),
            min = physical(info.min, info.counts_per_unit),
            max = physical(info.max, info.counts_per_unit),
            address = MEASUREMENT_BASE + SLOT_BYTES * slot,
        );
    }
    text
}

const fn width(info: &MeasurementInfo) -> &'static str {
    match info.width {
        _ if info.is_float => "FLOAT32_IEEE",
        Width::U8 => "UBYTE",
        Width::U16 => "UWORD",
        Width::I16 => "SWORD",
        Width::U32 => "ULONG",
        Width::I32 => "SLONG",
    }
}

/// Parameters as in the sections of a calibration file.
fn groups() -> String {
    let tables = [
        ("lift", "lift.current".to_owned()),
        ("lower", "lower.current".to_owned()),
        (
            "linkage",
            "linkage.first_angle linkage.angle_step linkage.travel".to_owned(),
        ),
    ];
    let scalars = GROUPS.iter().map(|group| {
        let names = group.parameters.iter();
        let names: Vec<String> = names
            .map(|parameter| format!("{}.{}", group.name, parameter.name))
            .collect();
        (group.name, names.join(" "))
    });
    let mut text = String::new();
    for (name, members) in tables.into_iter().chain(scalars) {
        let _ = write!(
            text,
            "/begin GROUP {name} \"\" ROOT\n  /begin REF_CHARACTERISTIC {members} /end REF_CHARACTERISTIC\n/end GROUP\n"
        );
    }
    let names: Vec<&str> = measurements::INFO.iter().map(|info| info.name).collect();
    let _ = write!(
        text,
        "/begin GROUP measurements \"\" ROOT\n  /begin REF_MEASUREMENT {} /end REF_MEASUREMENT\n/end GROUP\n",
        names.join(" ")
    );
    text
}

#[cfg(test)]
mod tests {
    use a2lfile::{A2lFile, A2lObjectName as _};

    use super::*;

    /// The file as another program reads it, to the letter of the standard.
    fn parsed() -> A2lFile {
        let (file, remarks) = a2lfile::load_from_string(&text(), None, true).expect("an A2L file");
        assert!(remarks.is_empty(), "{remarks:?}");
        file
    }

    #[test]
    fn the_file_in_the_project_is_what_the_tables_say() {
        let kept = fs::read_to_string(workspace::root().join(FILE)).expect("the file is there");
        assert!(
            kept == text(),
            "{FILE} is out of date: run `cargo xtask a2l`"
        );
    }

    #[test]
    fn another_program_finds_nothing_wrong_with_it() {
        let found = parsed().check();
        assert!(found.is_empty(), "{found:?}");
    }

    #[test]
    fn the_interface_is_understood_by_its_description() {
        let file = parsed();
        let module = &file.project.module[0];
        let valid = |data: &a2lfile::IfData| data.ifdata_valid && data.ifdata_items.is_some();
        assert!(module.if_data.iter().all(valid));
        let segment = &module.mod_par.as_ref().unwrap().memory_segment[0];
        assert!(segment.if_data.iter().all(valid) && segment.if_data.len() == 1);
    }

    #[test]
    fn every_parameter_and_measurement_is_in_it_once() {
        let file = parsed();
        let module = &file.project.module[0];
        let scalars: usize = GROUPS.iter().map(|group| group.parameters.len()).sum();
        // Two curves, and three of the linkage.
        assert_eq!(module.characteristic.len(), scalars + 5);
        assert_eq!(module.measurement.len(), measurements::COUNT);
        let mut addresses: Vec<u32> = module
            .characteristic
            .iter()
            .map(|one| one.address)
            .collect();
        addresses.dedup();
        assert_eq!(addresses.len(), scalars + 5);
    }

    #[test]
    fn a_number_in_single_precision_is_shown_as_it_is() {
        let file = parsed();
        let module = &file.project.module[0];
        let noise = module.measurement.get("angle_noise").expect("it is there");
        assert_eq!(noise.datatype, a2lfile::DataType::Float32Ieee);
        let conversion = module.compu_method.get(&noise.conversion).unwrap();
        assert_eq!(
            conversion.conversion_type,
            a2lfile::ConversionType::Identical
        );
        assert_eq!(conversion.unit, "deg");
    }

    #[test]
    fn a_parameter_has_unit_range_and_reason() {
        let file = parsed();
        let module = &file.project.module[0];
        let limit = module.characteristic.get("safety.lift_current_limit");
        let limit = limit.expect("it is there");
        assert_eq!((limit.lower_limit, limit.upper_limit), (0.1, 5.0));
        assert!(
            limit
                .long_identifier
                .starts_with("Largest current of the lift coil")
        );
        let conversion = module.compu_method.get(&limit.conversion).unwrap();
        assert_eq!(conversion.unit, "A");
        assert_eq!(
            conversion.coeffs.as_ref().unwrap().b,
            1_000.0,
            "counts in an ampere"
        );
        assert_eq!(conversion.get_name(), "a_1000");
    }
}
