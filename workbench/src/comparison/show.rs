//! A comparison as text and as report tables.

use std::fmt;

use hitch_plant::Channel;

use super::{Cell, Comparison, Grouping};
use crate::heat_table::{HeatTable, Shade};
use crate::text::Table;

/// Number of worst cells that are listed.
const NAMED_CELLS: usize = 5;
/// Minimum number of samples of a listed cell.
const FEWEST_SAMPLES: usize = 20;
/// Smallest error of a listed cell, in sigma; below it is noise.
const NAMED_ABOVE: f64 = 1.2;

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Campaign {}, model {}", self.campaign, self.model)?;
        writeln!(
            f,
            "  error {:.2} sigma (noise of the instruments: {:.2})\n",
            self.error, self.noise_floor
        )?;
        let mut table = Table::new(["channel", "error sigma", "rms", "noise", "unit", "samples"]);
        for channel in &self.channels {
            let numbers = [
                format!("{:.2}", channel.error),
                format!("{:.3}", channel.rms),
                format!("{:.3}", channel.noise),
            ];
            let rest = [channel.unit.to_owned(), channel.samples.to_string()];
            table.row(
                [channel.channel.to_owned()]
                    .into_iter()
                    .chain(numbers)
                    .chain(rest),
            );
        }
        writeln!(f, "{table}")?;
        for by in Grouping::ALL {
            writeln!(f, "Error in sigma {}\n{}", by.title(), self.grid(by).text())?;
        }
        self.where_it_fails(f)
    }
}

impl Comparison {
    /// Errors of a grouping: a row for each group, a column for each channel.
    pub fn grid(&self, by: Grouping) -> HeatTable {
        let measured = |channel: &Channel| {
            self.channels
                .iter()
                .any(|known| known.channel == channel.key())
        };
        let channels: Vec<Channel> = Channel::ALL.into_iter().filter(measured).collect();
        let mut rows: Vec<(String, Vec<Option<f64>>)> = Vec::new();
        for cell in self.cells.iter().filter(|cell| cell.by == by) {
            let column = channels
                .iter()
                .position(|channel| channel.key() == cell.channel);
            let row = rows
                .iter()
                .position(|(name, _)| *name == cell.part)
                .unwrap_or_else(|| {
                    rows.push((cell.part.clone(), vec![None; channels.len()]));
                    rows.len() - 1
                });
            if let Some(column) = column {
                rows[row].1[column] = Some(cell.error);
            }
        }
        let columns = channels
            .iter()
            .map(|channel| channel.title().to_owned())
            .collect();
        HeatTable {
            corner: by.title().to_owned(),
            columns,
            rows,
            shade: Shade::Sigmas,
        }
    }

    /// The cells with the largest errors, by regime and by current, above the noise.
    pub fn worst_cells(&self) -> Vec<&Cell> {
        let telling = |cell: &&Cell| {
            matches!(cell.by, Grouping::Regime | Grouping::Current)
                && cell.samples >= FEWEST_SAMPLES
                && cell.error > NAMED_ABOVE
        };
        let mut cells: Vec<&Cell> = self.cells.iter().filter(telling).collect();
        cells.sort_by(|a, b| b.error.total_cmp(&a.error));
        cells.truncate(NAMED_CELLS);
        cells
    }

    fn where_it_fails(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let worst = self.worst_cells();
        if worst.is_empty() {
            return writeln!(f, "The error is within the noise everywhere.");
        }
        writeln!(f, "Largest errors by condition")?;
        for cell in worst {
            writeln!(
                f,
                "  {}, {}: {:.1} sigma, mean {:+.1}",
                cell.channel, cell.part, cell.error, cell.bias
            )?;
        }
        writeln!(f, "Largest errors in time")?;
        for stretch in self
            .worst
            .iter()
            .filter(|stretch| stretch.error > NAMED_ABOVE)
        {
            let (from_s, to_s) = (stretch.from_s, stretch.to_s);
            writeln!(
                f,
                "  {}: {} from {from_s:.1} to {to_s:.1} s, {:.1} sigma",
                stretch.channel, stretch.run, stretch.error
            )?;
        }
        Ok(())
    }
}

impl HeatTable {
    /// The table for a terminal.
    pub fn text(&self) -> Table {
        let header = [self.corner.as_str()]
            .into_iter()
            .chain(self.columns.iter().map(String::as_str));
        let mut table = Table::new(header);
        for (name, cells) in &self.rows {
            let cells = cells
                .iter()
                .map(|cell| cell.map_or("-".to_owned(), |value| format!("{value:.2}")));
            table.row([name.clone()].into_iter().chain(cells));
        }
        table
    }
}
