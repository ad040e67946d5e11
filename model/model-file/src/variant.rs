//! Reads the variants of a machine: kind of the pump, number of cylinders, measured linkage.

use hitch_input::input_error::{InputError, quote};
use hitch_input::toml_reader::TomlTable;
use hitch_plant::{Constants, LinkageTable, LinkageTableError, PumpKind};

use crate::constants::{
    CYLINDER_COUNT, CYLINDERS, KIND, KINDS, LINKAGE_COLUMNS, M_PER_MM, RAD_PER_DEG,
};

/// Ranges of the columns of a measured linkage, in their units.
const LINKAGE_RANGES: [std::ops::RangeInclusive<f64>; 3] =
    [0.0..=5000.0, -360.0..=360.0, -10_000.0..=10_000.0];

/// Reads them into the constants; what a file does not state stays as it is.
pub fn read(top: &TomlTable<'_>, constants: &mut Constants) -> Result<(), InputError> {
    if let Some(pump) = top.table("pump")? {
        read_kind(&pump, constants)?;
    }
    if let Some(cylinder) = top.table("cylinder")?
        && let Some(count) = cylinder.number(CYLINDERS, CYLINDER_COUNT)?
    {
        if count.fract() != 0.0 {
            let what = format!("{CYLINDERS} is {count}, not a whole number");
            return Err(cylinder.error_at(CYLINDERS, what, "write 1 or 2"));
        }
        constants.cylinder.count = count as u8;
    }
    if let Some(linkage) = top.table("linkage")?
        && LINKAGE_COLUMNS.iter().any(|key| linkage.has(key))
    {
        constants.linkage_table = Some(read_linkage(&linkage)?);
    }
    Ok(())
}

fn read_kind(pump: &TomlTable<'_>, constants: &mut Constants) -> Result<(), InputError> {
    let Some(written) = pump.text(KIND)? else {
        return Ok(());
    };
    let Some((_, kind)) = KINDS.iter().find(|(name, _)| *name == written) else {
        let what = format!("kind {} is not known", quote(written));
        let hint = "use \"fixed-displacement\" or \"load-sensing\"";
        return Err(pump.error_at(KIND, what, hint));
    };
    if *kind == PumpKind::LoadSensing && constants.pump.kind != *kind {
        constants.pump.standby_pressure_pa = f64::NAN;
        constants.pump.response_time_s = f64::NAN;
    }
    constants.pump.kind = *kind;
    Ok(())
}

fn read_linkage(table: &TomlTable<'_>) -> Result<LinkageTable, InputError> {
    let column = |index: usize, unit: f64| {
        let key = LINKAGE_COLUMNS[index];
        let values = table.numbers(key, LINKAGE_RANGES[index].clone())?;
        let values = values.ok_or_else(|| table.missing(key))?;
        let values = values.into_iter().map(|value| value * unit);
        Ok::<Vec<f64>, InputError>(values.collect())
    };
    let travel_m = column(0, M_PER_MM)?;
    let angle_rad = column(1, RAD_PER_DEG)?;
    let height_m = column(2, M_PER_MM)?;
    LinkageTable::new(travel_m, angle_rad, height_m).map_err(|fault| {
        let hint = match fault {
            LinkageTableError::Length { .. } => "give a value of each for every measured point",
            LinkageTableError::Order { .. } => {
                "sort the points by travel; angle and height rise with it"
            }
        };
        table.error_at(LINKAGE_COLUMNS[0], fault.to_string(), hint)
    })
}
