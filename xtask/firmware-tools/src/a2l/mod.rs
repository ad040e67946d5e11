//! The description file (ASAM MCD-2 MC, "A2L") of the ECU's parameters and measurements.
//!
//! All contents come from the tables of the firmware: names, units, ranges and reasons of the parameters, the
//! measurements, and their address map. The file is therefore valid for every image from the same source, independent
//! of the linker; its identity (EPK) has to equal that of the ECU.

mod conversion;
mod interface;

use std::fs;

use a2lfile::{
    A2lObject as _, A2lObjectName as _, AxisDescr, AxisDescrAttribute, Characteristic,
    CharacteristicType, DataType, EcuAddress, Group, MatrixDim, Measurement, Module, Monotony,
    MonotonyType, RefCharacteristic, RefMeasurement, Root,
};
use anyhow::{Context, Result};
use arm_build::workspace;
use hitch_protocols::xcp::map::{CALIBRATION_BASE, MEASUREMENT_BASE, SLOT_BYTES};
use hitch_protocols::xcp::measurements::{self, MeasurementInfo, Width};
use hitch_quantities::calibration::calibration_words::{
    GROUPS, LIFT_WORD, LINKAGE_WORD, LONGEST_TRAVEL, LOWER_WORD, SCALARS_WORD, word_range,
};
use hitch_quantities::calibration::class::{Class, Tightening};
use hitch_quantities::calibration::linkage::LINKAGE_POINTS;
use hitch_quantities::calibration::valve_table::VALVE_POINTS;

/// Path of the file.
const FILE: &str = "firmware/hitch.a2l";

/// Writes the file.
pub fn write() -> Result<()> {
    let path = workspace::root().join(FILE);
    fs::write(&path, text()?).with_context(|| format!("can't write {}", path.display()))?;
    println!("{FILE} is up to date");
    Ok(())
}

/// Contents of the file.
fn text() -> Result<String> {
    let mut file = interface::file()?;
    let module = &mut file.project.module[0];
    valve(
        module,
        "lift",
        "Lift valve at the compensated drop",
        LIFT_WORD,
    );
    valve(
        module,
        "lower",
        "Lowering valve at hydraulics.reference_drop",
        LOWER_WORD,
    );
    linkage(module);
    scalars(module);
    groups(module);
    measurements(module);
    Ok(file.write_to_string())
}

/// Address of a word of the calibration.
fn word_address(word: usize) -> u32 {
    CALIBRATION_BASE + SLOT_BYTES * u32::try_from(word).unwrap_or(u32::MAX / SLOT_BYTES)
}

/// A number of raw counts in its unit.
fn physical(counts: i32, per_unit: i32) -> f64 {
    f64::from(counts) / f64::from(per_unit)
}

/// A parameter of words from `word` on, `range` in the unit of `conversion`.
fn characteristic(
    name: String,
    what: String,
    kind: CharacteristicType,
    word: usize,
    conversion: String,
    range: [f64; 2],
) -> Characteristic {
    let layout = match kind {
        CharacteristicType::Curve => "valve",
        _ => "word",
    };
    let address = word_address(word);
    let [min, max] = range;
    let layout = layout.to_owned();
    let mut made =
        Characteristic::new(name, what, kind, address, layout, 0.0, conversion, min, max);
    made.get_layout_mut().item_location.3.1 = true;
    made
}

fn scalars(module: &mut Module) {
    let parameters = GROUPS
        .iter()
        .flat_map(|group| group.parameters.iter().map(move |one| (group.name, one)));
    for (word, (group, parameter)) in (SCALARS_WORD..).zip(parameters) {
        let when = match word_range(word).map_or(Class::Machine, |range| range.class) {
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
        let per_unit = parameter.counts_per_unit;
        let conversion = conversion::scaled(module, parameter.suffix, per_unit);
        module.characteristic.push(characteristic(
            format!("{group}.{}", parameter.name),
            format!("{}{when}", parameter.reason.trim())
                .trim()
                .to_owned(),
            CharacteristicType::Value,
            word,
            conversion,
            [parameter.min, parameter.max].map(|counts| physical(counts, per_unit)),
        ));
    }
}

/// Current over flow, preceded by the number of points.
fn valve(module: &mut Module, name: &str, what: &str, word: usize) {
    let flow = conversion::scaled(module, "ul_per_s", 1);
    let current = conversion::scaled(module, "a", 1_000);
    let mut curve = characteristic(
        format!("{name}.current"),
        format!(
            "{what}: current over flow, from the threshold to saturation. Flows are at least 0.25 % of the largest one apart. (Changed at rest only.)"
        ),
        CharacteristicType::Curve,
        word,
        current,
        [0.0, 5.0],
    );
    let points = u16::try_from(VALVE_POINTS).unwrap_or(u16::MAX);
    let none = "NO_INPUT_QUANTITY".to_owned();
    let mut axis = AxisDescr::new(AxisDescrAttribute::StdAxis, none, flow, points, 0.0, 1e7);
    axis.monotony = Some(Monotony::new(MonotonyType::StrictIncrease));
    curve.axis_descr.push(axis);
    module.characteristic.push(curve);
}

fn linkage(module: &mut Module) {
    let angle = conversion::scaled(module, "deg", 1_000);
    let travel = conversion::scaled(module, "mm", 1_000);
    let longest = physical(LONGEST_TRAVEL, 1_000);
    let (value, block) = (CharacteristicType::Value, CharacteristicType::ValBlk);
    let parts = [
        (
            "first_angle",
            "Angle of the first point of the linkage's table.",
            value,
            &angle,
            [-360.0, 360.0],
        ),
        (
            "angle_step",
            "Angle from point to point of the linkage's table.",
            value,
            &angle,
            [0.001, 360.0],
        ),
        (
            "travel",
            "Piston travel at each point of the linkage's table, strictly rising.",
            block,
            &travel,
            [-longest, longest],
        ),
    ];
    for (word, (name, what, kind, conversion, range)) in (LINKAGE_WORD..).zip(parts) {
        let name = format!("linkage.{name}");
        let what = format!("{what} (Changed at rest only.)");
        let mut part = characteristic(name, what, kind, word, conversion.clone(), range);
        if kind == block {
            let mut points = MatrixDim::new();
            points
                .dim_list
                .push(u16::try_from(LINKAGE_POINTS).unwrap_or(u16::MAX));
            part.matrix_dim = Some(points);
        }
        module.characteristic.push(part);
    }
}

fn measurements(module: &mut Module) {
    for (slot, info) in (0..).zip(measurements::INFO) {
        let conversion = conversion::of_measurement(module, info);
        let [min, max] = [info.min, info.max].map(|counts| physical(counts, info.counts_per_unit));
        let (name, what) = (info.name.to_owned(), info.description.trim().to_owned());
        let mut made = Measurement::new(name, what, width(info), conversion, 0, 0.0, min, max);
        let mut address = EcuAddress::new(MEASUREMENT_BASE + SLOT_BYTES * slot);
        address.get_layout_mut().item_location.0.1 = true;
        made.ecu_address = Some(address);
        module.measurement.push(made);
    }
    let mut group = root("measurements");
    let mut members = RefMeasurement::new();
    members.identifier_list = measurements::INFO
        .iter()
        .map(|info| info.name.to_owned())
        .collect();
    group.ref_measurement = Some(members);
    module.group.push(group);
}

const fn width(info: &MeasurementInfo) -> DataType {
    match info.width {
        _ if info.is_float => DataType::Float32Ieee,
        Width::U8 => DataType::Ubyte,
        Width::U16 => DataType::Uword,
        Width::I16 => DataType::Sword,
        Width::U32 => DataType::Ulong,
        Width::I32 => DataType::Slong,
    }
}

/// Parameters as in the sections of a calibration file: what stands before the dot of their names.
fn groups(module: &mut Module) {
    for characteristic in module.characteristic.iter() {
        let name = characteristic.get_name();
        let section = name.split('.').next().unwrap_or(name);
        if !module.group.contains_key(section) {
            let mut group = root(section);
            group.ref_characteristic = Some(RefCharacteristic::new());
            module.group.push(group);
        }
        if let Some(members) = module
            .group
            .get_mut(section)
            .and_then(|group| group.ref_characteristic.as_mut())
        {
            members.identifier_list.push(name.to_owned());
        }
    }
}

fn root(name: &str) -> Group {
    let mut group = Group::new(name.to_owned(), String::new());
    group.root = Some(Root::new());
    group
}

#[cfg(test)]
mod tests {
    use a2lfile::A2lFile;

    use super::*;

    /// The file as another program reads it, to the letter of the standard.
    fn parsed() -> A2lFile {
        let (file, remarks) =
            a2lfile::load_from_string(&text().expect("a description"), None, true)
                .expect("an A2L file");
        assert!(remarks.is_empty(), "{remarks:?}");
        file
    }

    #[test]
    fn the_file_in_the_project_is_what_the_tables_say() {
        let kept = fs::read_to_string(workspace::root().join(FILE)).expect("the file is there");
        assert!(
            kept == text().expect("a description"),
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
        assert_eq!(noise.datatype, DataType::Float32Ieee);
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
