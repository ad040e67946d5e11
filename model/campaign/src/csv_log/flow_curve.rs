//! Flow curve of a valve from a text table, as given by a data sheet or a flow bench.

use std::path::Path;

use csv::StringRecord;
use hitch_input::input_error::{InputError, quote};
use hitch_input::source_file::SourceFile;
use hitch_plant::units::M3_S_PER_LPM;
use hitch_plant::{ValveCurve, ValveCurveError};

use crate::csv_log::dialect::{Decimals, Header, HeaderCell, rows};

/// Units of current, in A.
const CURRENT: [(&str, f64); 2] = [("a", 1.0), ("ma", 1e-3)];

/// Units of flow, in m3/s.
const FLOW: [(&str, f64); 5] = [
    ("lpm", M3_S_PER_LPM),
    ("l/min", M3_S_PER_LPM),
    ("l_min", M3_S_PER_LPM),
    ("m3/s", 1.0),
    ("m3_s", 1.0),
];

/// Reads a flow curve: a header with a current in A or mA and a flow in l/min or m3/s, and one row per point.
///
/// # Errors
/// A fault in the table, by line and column.
pub fn read(path: &Path) -> Result<ValveCurve, InputError> {
    let source = SourceFile::read_any(path)?;
    let header = Header::guessed(&source.text).ok_or_else(|| {
        let mend = "write a header such as current_a,flow_lpm above the numbers, and one row for each point";
        source.error("is not a table with a header", mend)
    })?;
    let (current, ampere) = column(&source, &header, &CURRENT, "current", "A or mA")?;
    let (flow, m3_s) = column(&source, &header, &FLOW, "flow", "l/min or m3/s")?;
    let decimals = Decimals::in_columns(&source.text, &header, &[current, flow]);
    let (mut currents, mut flows, mut bytes) = (Vec::new(), Vec::new(), Vec::new());
    for (byte, row) in rows(&source.text, header.data_byte, header.mark) {
        if row
            .iter()
            .all(|cell| cell.is_empty() || cell.starts_with('#'))
        {
            continue;
        }
        currents.push(ampere * number(&source, byte, &row, current, decimals)?);
        flows.push(m3_s * number(&source, byte, &row, flow, decimals)?);
        bytes.push(byte);
    }
    let passes_at_rest = flows.first().is_some_and(|&flow| flow > 0.0);
    if passes_at_rest {
        let mend = "insert a first row with the opening current and flow 0";
        return Err(source.error_at(bytes[0], "the flow of the first point is not zero", mend));
    }
    ValveCurve::new(currents, flows).map_err(|error| match error {
        ValveCurveError::Order { index } => {
            let what = "the current does not rise or the flow falls";
            source.error_at(
                bytes[index],
                what,
                "sort the rows by current; the flow must not fall",
            )
        }
        ValveCurveError::Length { .. } => source.error(error.to_string(), "add points"),
    })
}

/// Index and unit of the column of a quantity.
fn column(
    source: &SourceFile,
    header: &Header,
    units: &[(&str, f64)],
    quantity: &str,
    offered: &str,
) -> Result<(usize, f64), InputError> {
    let cells = header.cells.iter().enumerate();
    let mut found = cells.filter_map(|(index, cell)| Some((index, unit(cell, units)?)));
    found.next().ok_or_else(|| {
        source.error_at(
            header.byte,
            format!("no column is a {quantity} in {offered}"),
            "write the unit in the header, as in Current [A];Flow [l/min] or current_a,flow_lpm",
        )
    })
}

/// Size of a column's unit in SI; `None` for unknown units.
fn unit(cell: &HeaderCell, units: &[(&str, f64)]) -> Option<f64> {
    let written = cell.unit.as_ref().map(|unit| unit.to_lowercase());
    let name = cell.name.to_lowercase();
    let is_of = |unit: &str| match &written {
        Some(written) => written == unit,
        None => name.ends_with(&format!("_{unit}")),
    };
    units
        .iter()
        .find(|(unit, _)| is_of(unit))
        .map(|(_, si)| *si)
}

fn number(
    source: &SourceFile,
    byte: usize,
    row: &StringRecord,
    cell: usize,
    decimals: Decimals,
) -> Result<f64, InputError> {
    let text = row.get(cell).unwrap_or_default();
    decimals.number(text).ok_or_else(|| {
        let what = format!("{} is not a number", quote(text));
        source.error_at(byte, what, "write a number, or delete the row")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Result<ValveCurve, InputError> {
        let file = tempfile::NamedTempFile::new().expect("a file");
        std::fs::write(file.path(), text).expect("a file");
        read(file.path())
    }

    #[test]
    fn tables_of_any_dialect_are_read() {
        let english = read_text("current_a,flow_lpm\n0,0\n1.5,0\n2,20\n").expect("a curve");
        let german =
            read_text("Strom [mA];Durchfluss [l/min]\n0;0\n1500;0\n2000;20,0\n").expect("a curve");
        assert_eq!(english.currents_a(), [0.0, 1.5, 2.0]);
        assert_eq!(english, german);
        let table =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("../paper/data/table2a_lift_valve.csv");
        let shipped = read(&table).expect("a curve");
        // The model omits collinear points at the end.
        let nominal = hitch_model_file::nominal();
        let curve = &nominal.constants().lift_valve.curve;
        for (&current_a, &flow_m3_s) in curve.currents_a().iter().zip(curve.flows_m3_s()) {
            assert_eq!(shipped.flow_m3_s(current_a), flow_m3_s, "{current_a} A");
        }
    }

    #[test]
    fn faults_are_told_by_line() {
        for (text, line, what) in [
            (
                "current_a,flow_lpm\n0,0\n2,20\n1.5,30\n",
                4,
                "does not rise",
            ),
            ("current_a,flow_lpm\n0,3\n2,20\n", 2, "is not zero"),
            ("current_a,flow_lpm\n0,0\n1,x\n2,3\n", 3, "not a number"),
            ("current_a,flow\n0,0\n1,2\n", 1, "no column is a flow"),
        ] {
            let error = read_text(text).expect_err("a fault");
            assert_eq!(error.place.map(|place| place.line), Some(line), "{error}");
            assert!(error.to_string().contains(what), "{error}");
        }
    }
}
