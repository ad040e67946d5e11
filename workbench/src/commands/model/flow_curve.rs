//! Flow curve of a valve from a text table, as given by a data sheet or a flow bench.

use std::path::Path;

use hitch_input::input_error::InputError;
use hitch_input::source_file::SourceFile;
use hitch_plant::units::M3_S_PER_LPM;
use hitch_plant::{ValveCurve, ValveCurveError};

use super::number_table::{NumberTable, Wanted};

const EXAMPLE: &str = "Current [A];Flow [l/min] or current_a,flow_lpm";

const COLUMNS: [Wanted; 2] = [
    Wanted {
        quantity: "current",
        words: &[],
        units: &[("a", 1.0), ("ma", 1e-3)],
        offered: "A or mA",
        example: EXAMPLE,
    },
    Wanted {
        quantity: "flow",
        words: &[],
        units: &[
            ("lpm", M3_S_PER_LPM),
            ("l/min", M3_S_PER_LPM),
            ("l_min", M3_S_PER_LPM),
            ("l/s", 1e-3),
            ("l_s", 1e-3),
            ("gpm", M3_S_PER_GPM),
            ("m3/s", 1.0),
            ("m3_s", 1.0),
        ],
        offered: "l/min, l/s, gpm or m3/s",
        example: EXAMPLE,
    },
];

/// A US gallon a minute, m3/s.
const M3_S_PER_GPM: f64 = 3.785_411_784e-3 / 60.0;

/// Reads a flow curve: a header with a current in A or mA and a flow in l/min, l/s, gpm or m3/s, and one row per point.
///
/// # Errors
/// A fault in the table, by line and column.
pub fn read(path: &Path) -> Result<ValveCurve, InputError> {
    let source = SourceFile::read_any(path)?;
    let table = NumberTable::read(&source, &COLUMNS)?;
    let ([currents, flows], bytes) = (table.columns, table.bytes);
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
        let table = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../model/paper/data/table2a_lift_valve.csv");
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
