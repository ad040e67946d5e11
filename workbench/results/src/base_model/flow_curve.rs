//! Flow curve of a valve from a text table, as given by a data sheet or a flow bench.

use hitch_input::input_error::InputError;
use hitch_input::source_file::SourceFile;
use hitch_plant::{ValveCurve, ValveCurveError};

use super::number_table::{NumberTable, Wanted};

const EXAMPLE: &str = "Current [A];Flow [l/min] or current_a,flow_lpm";

const COLUMNS: [Wanted; 2] = [
    Wanted {
        quantity: "current",
        words: &[],
        units: &["A", "mA"],
    },
    Wanted {
        quantity: "flow",
        words: &[],
        units: &["l/min", "l/s", "gpm", "m3/s"],
    },
];

/// Reads a flow curve: a header with a current in A or mA and a flow in l/min, l/s, gpm or m3/s, and one row per point.
///
/// # Errors
/// A fault in the table, by line and column.
pub fn of(source: &SourceFile) -> Result<ValveCurve, InputError> {
    let table = NumberTable::read(source, &COLUMNS, EXAMPLE)?;
    let ([currents, flows], bytes) = (table.columns, table.bytes);
    let passes_at_rest = flows.first().is_some_and(|&flow| flow > 0.0);
    if passes_at_rest {
        let hint = "insert a first row with the opening current and flow 0";
        return Err(source.error_at(bytes[0], "the flow of the first point is not zero", hint));
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
    use std::path::Path;

    use super::*;

    fn read_text(text: &str) -> Result<ValveCurve, InputError> {
        of(&SourceFile::any_of(
            Path::new("table.csv"),
            text.as_bytes(),
        )?)
    }

    #[test]
    fn tables_of_any_dialect_are_read() {
        let english = read_text("current_a,flow_lpm\n0,0\n1.5,0\n2,20\n").expect("a curve");
        let german =
            read_text("Strom [mA];Durchfluss [l/min]\n0;0\n1500;0\n2000;20,0\n").expect("a curve");
        assert_eq!(english.currents_a(), [0.0, 1.5, 2.0]);
        assert_eq!(english, german);
        let table = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../model/paper/data/table2a_lift_valve.csv");
        let shipped = of(&SourceFile::read_any(&table).expect("a file")).expect("a curve");
        // The model omits collinear points at the end.
        let nominal = hitch_model_file::nominal();
        let curve = &nominal.constants().lift_valve.curve;
        for (&current_a, &flow_m3_s) in curve.currents_a().iter().zip(curve.flows_m3_s()) {
            assert_eq!(shipped.flow_m3_s(current_a), flow_m3_s, "{current_a} A");
        }
    }

    #[test]
    fn the_unit_is_written_or_ends_the_name() {
        for (header, one_lpm) in [
            ("current_a,flow_l_min", 1.0),
            ("current_a,flow_l_s", 1.0 / 60.0),
            ("I_MA,Q_M3_S", 1e-3 / 60.0),
            ("Current [mA],Flow [gpm]", 1.0 / 3.785_411_784),
        ] {
            let one_a = if header.to_lowercase().contains("ma") {
                1e3
            } else {
                1.0
            };
            let text = format!("{header}\n0,0\n{},{}\n", 2.0 * one_a, 20.0 * one_lpm);
            let curve = read_text(&text).expect("a curve");
            let flow_m3_s = curve.flow_m3_s(2.0);
            assert!(
                (flow_m3_s / (20.0 * 1e-3 / 60.0) - 1.0).abs() < 1e-12,
                "{header}"
            );
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
