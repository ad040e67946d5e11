//! The paper beside this model, as text.
use std::fmt;

use super::{CheckValve, Figure12, FlowTable, Paper, Travel};
use crate::text::Table;

impl fmt::Display for Paper {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "The paper beside the model {}\n", self.model)?;
        for table in &self.table_2 {
            writeln!(f, "{table}")?;
        }
        let area = &self.orifice_area;
        writeln!(
            f,
            "Greatest estimated orifice area (4.1; equations 5 and 6, least squares on Table 2)"
        )?;
        writeln!(
            f,
            "  paper {:.3} mm2, here {:.3} mm2: {:+.4} %\n",
            area.paper_mm2,
            area.model_mm2,
            100.0 * area.relative_difference
        )?;
        writeln!(f, "{}\n{}", self.check_valve, self.figure_12)
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
            "  greatest difference {:.4} l/min",
            self.largest_difference_lpm
        )
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
        writeln!(
            f,
            "  The paper prints neither spring nor port. Springs that make it so, compressed by {} mm:",
            {
                self.springs
                    .first()
                    .map_or(0.0, |spring| spring.compression_mm)
            }
        )?;
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
        writeln!(
            f,
            "The paper prints Figure 12 as a plot only. What it says of it, and the model:"
        )?;
        for statement in &self.statements {
            let verdict = if statement.holds { "holds" } else { "FAILS" };
            writeln!(f, "  {verdict}  {}: {}", statement.paper, statement.model)?;
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
