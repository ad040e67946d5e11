//! Text form of the comparison with the paper.
use std::fmt;

use super::{CheckValve, Figure12, FlowTable, Paper, Table5, Travel};
use crate::text::colour::{self, BAD, GOOD, painted};
use crate::text::{Table, indented, wrapped};

impl fmt::Display for Paper {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Comparison of the paper with the model {}\n", self.model)?;
        for table in &self.table_2 {
            writeln!(f, "{table}")?;
        }
        let area = &self.orifice_area;
        let title =
            "Largest estimated orifice area (4.1; equations 5 and 6, least squares on Table 2)";
        writeln!(f, "{}", wrapped(title))?;
        writeln!(
            f,
            "  paper {:.3} mm2, model {:.3} mm2: {:+.4} %\n",
            area.paper_mm2,
            area.model_mm2,
            100.0 * area.relative_difference
        )?;
        writeln!(
            f,
            "{}\n{}\n{}",
            self.table_5, self.check_valve, self.figure_12
        )
    }
}

impl fmt::Display for FlowTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let letter = if self.valve == "lift" { 'A' } else { 'B' };
        writeln!(
            f,
            "Table 2{letter}: {} valve at {} bar over the orifice",
            self.valve, self.drop_bar
        )?;
        let mut table = Table::new(["current A", "paper l/min", "model l/min", "area mm2"]);
        for row in &self.rows {
            table.row([
                format!("{:.3}", row.current_a),
                format!("{:.3}", row.paper_lpm),
                format!("{:.3}", row.model_lpm),
                format!("{:.3}", row.area_mm2),
            ]);
        }
        write!(f, "{table}")?;
        writeln!(
            f,
            "  largest difference {:.4} l/min",
            self.largest_difference_lpm
        )
    }
}

impl fmt::Display for Table5 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let title = "Table 5: effects identified in the paper's flow test (Table 2, adjusted to the thresholds and \
                     saturations of Table 5, with the noise of a flow meter)";
        writeln!(f, "{}", wrapped(title))?;
        let [before, after] = self.error;
        writeln!(
            f,
            "  error {before:.2} -> {after:.2} sigma, verdict {}",
            colour::verdict(self.verdict)
        )?;
        let mut table = Table::new(["effect", "expected", "found, 95 %"]);
        for check in &self.effects {
            let expected = check
                .expected
                .map_or("none".to_owned(), |value| format!("{value:.4}"));
            table.row([check.effect.to_owned(), expected, check.found.to_string()]);
        }
        writeln!(f, "{table}")?;
        let mut table = Table::new(["", "Table 2", "Table 5", "model with these effects"]);
        for valve in &self.valves {
            let rows = [
                ("threshold, A", valve.threshold_a),
                ("saturation, l/min", valve.saturation_lpm),
                ("saturation, A", valve.saturation_a),
            ];
            for (name, value) in rows {
                let numbers = [value.table_2, value.table_5, value.model]
                    .map(|number| format!("{number:.3}"));
                table.row(
                    [format!("{} {name}", valve.valve)]
                        .into_iter()
                        .chain(numbers),
                );
            }
        }
        write!(f, "{table}")?;
        let line = "A shift moves the whole curve: no single shift yields both lowering currents of Table 5, 1.25 and \
                    3.1 A.";
        writeln!(f, "{}", indented(line, 2))?;
        let time = |time_s: Option<f64>| {
            time_s.map_or("infinite time".to_owned(), |time_s| {
                format!("{time_s:.1} s")
            })
        };
        let (table_2, table_5) = (
            time(self.slowest_lift.table_2_s),
            time(self.slowest_lift.table_5_s),
        );
        let line = format!(
            "The lift threshold was found in steps of 0.1 A, so 1.1 A does not contradict 1.126 A; but at {} A a lift \
             takes {table_2} with 1.126 A and {table_5} with 1.1 A. The axis of Figure 12A ends at 30 s.",
            self.slowest_lift.current_a
        );
        writeln!(f, "{}", indented(&line, 2))
    }
}

impl fmt::Display for CheckValve {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "Cracking pressure of the check valve (Table 4, equation 7)"
        )?;
        writeln!(
            f,
            "  paper {} bar, model {} bar",
            self.paper_bar, self.model_bar
        )?;
        let compression_mm = self
            .springs
            .first()
            .map_or(0.0, |spring| spring.compression_mm);
        let line = format!(
            "The paper states neither spring nor port. Springs with this cracking pressure, compressed by \
             {compression_mm} mm:"
        );
        writeln!(f, "{}", indented(&line, 2))?;
        let mut table = Table::new(["port mm", "stiffness N/mm", "equation 7 bar"]);
        for spring in &self.springs {
            table.row([
                format!("{:.0}", spring.port_diameter_mm),
                format!("{:.2}", spring.stiffness_n_mm),
                format!("{:.2}", spring.cracking_pressure_bar),
            ]);
        }
        write!(f, "{table}")
    }
}

impl fmt::Display for Figure12 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "Figure 12A: lifting time, s, by current and load\n{}",
            self.lifting
        )?;
        writeln!(
            f,
            "Figure 12B: lowering time, s, by current and load\n{}",
            self.lowering
        )?;
        let line = "The paper has Figure 12 as a plot only. Its statements on the figure, compared with the model:";
        writeln!(f, "{}", wrapped(line))?;
        for statement in &self.statements {
            let verdict = match statement.holds {
                true => painted(GOOD, "holds"),
                false => painted(BAD, "FAILS"),
            };
            let line = format!("{verdict} {}: {}", statement.paper, statement.model);
            writeln!(f, "{}", indented(&line, 2))?;
        }
        Ok(())
    }
}

impl fmt::Display for Travel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let loads = self.loads_kg.map(|load_kg| format!("{load_kg:.0} kg"));
        let mut table = Table::new([""].into_iter().chain(loads.iter().map(String::as_str)));
        for (current_a, times_s) in self.currents_a.iter().zip(&self.times_s) {
            let times = times_s
                .map(|time_s| time_s.map_or("never".to_owned(), |time_s| format!("{time_s:.2}")));
            table.row([format!("{current_a:.1} A")].into_iter().chain(times));
        }
        write!(f, "{table}")
    }
}
