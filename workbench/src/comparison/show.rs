//! A comparison as text and as tables of a report.

use std::fmt;

use hitch_plant::Channel;

use super::{Cell, Comparison, Grouping};
use crate::heat_table::{HeatTable, Shade};
use crate::text::Table;

/// So many of the worst cells are named.
const NAMED_CELLS: usize = 5;
/// A cell with fewer samples is not named: its error is chance.
const FEWEST_SAMPLES: usize = 20;
/// Error in sigma below which a cell is not named: it is noise.
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
    /// Errors of a grouping: a row a part, a column a channel.
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

    /// The cells with the greatest errors, by regime and by current, if any are beyond noise.
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
            return writeln!(f, "Nowhere does the error stand out of the noise.");
        }
        writeln!(f, "Where it fails")?;
        for cell in worst {
            writeln!(
                f,
                "  {}, {}: {:.1} sigma, on average {:+.1}",
                cell.channel, cell.part, cell.error, cell.bias
            )?;
        }
        writeln!(f, "When it fails")?;
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
    /// The same table for a terminal.
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
