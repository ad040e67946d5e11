//! A comparison as text and as report tables.

use std::fmt;

use hitch_plant::Channel;

use super::{Cell, ChannelError, Comparison, Grouping};
use crate::measurement;
use crate::web::heat_table::{HeatTable, Shade};
use hitch_output::text::colour::{by_sigma, sigma};
use hitch_output::text::{Table, indented, wrapped};

/// Number of worst cells that are listed.
const NAMED_CELLS: usize = 5;
/// Minimum number of samples of a listed cell.
const FEWEST_SAMPLES: usize = 20;
/// Smallest error of a listed cell, in sigma; below it is noise.
const NAMED_ABOVE: f64 = 1.2;

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let head = format!("Campaign {}, model {}", self.campaign, self.model);
        writeln!(f, "{}", wrapped(&head))?;
        write!(f, "{}", measurement::text(&self.measurement))?;
        writeln!(
            f,
            "  error {} sigma (noise of the instruments: {:.2})\n",
            sigma(self.error),
            self.noise_floor
        )?;
        let row = |channel: &ChannelError| {
            let numbers = [
                sigma(channel.error),
                format!("{:.3}", channel.rms),
                format!("{:.3}", channel.noise),
            ];
            let rest = [channel.unit.to_owned(), channel.samples.to_string()];
            let names = [channel.channel.to_owned()].into_iter();
            names.chain(numbers).chain(rest)
        };
        let header = ["channel", "error sigma", "rms", "noise", "unit", "samples"];
        writeln!(f, "{}", Table::of(header, self.channels.iter().map(row)))?;
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
            let error = by_sigma(&format!("{:.1}", cell.error), cell.error);
            let line = format!(
                "{}, {}: {error} sigma, mean {:+.1}",
                cell.channel, cell.part, cell.bias
            );
            writeln!(f, "{}", indented(&line, 2))?;
        }
        writeln!(f, "Largest errors in time")?;
        for stretch in self
            .worst
            .iter()
            .filter(|stretch| stretch.error > NAMED_ABOVE)
        {
            let (from_s, to_s) = (stretch.from_s, stretch.to_s);
            let error = by_sigma(&format!("{:.1}", stretch.error), stretch.error);
            let line = format!(
                "{}: {} from {from_s:.1} to {to_s:.1} s, {error} sigma",
                stretch.channel, stretch.run
            );
            writeln!(f, "{}", indented(&line, 2))?;
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
        let row = |(name, cells): &(String, Vec<Option<f64>>)| {
            let cells = cells.iter().map(|cell| cell.map_or("-".to_owned(), sigma));
            [name.clone()].into_iter().chain(cells).collect::<Vec<_>>()
        };
        Table::of(header, self.rows.iter().map(row))
    }
}
