//! Tables with aligned columns, numbers to the right. Cells of a table that is too wide are broken into several lines.

use super::width::{broken, visible, width};

/// Indentation of a table, and distance of its columns, characters.
const GAP: usize = 2;
/// Indentation of a note.
const NOTE: &str = "      ";

/// A table of text cells.
#[derive(Debug, Clone, Default)]
pub struct Table {
    rows: Vec<Row>,
}

/// A row, with texts that are not in columns below it.
#[derive(Debug, Clone, Default)]
struct Row {
    cells: Vec<String>,
    notes: Vec<String>,
}

impl Row {
    fn new(cells: Vec<String>) -> Self {
        Self {
            cells,
            notes: Vec::new(),
        }
    }
}

impl Table {
    /// A table with a header.
    pub fn new<'a>(header: impl IntoIterator<Item = &'a str>) -> Self {
        Self {
            rows: vec![Row::new(header.into_iter().map(str::to_owned).collect())],
        }
    }

    /// A table with a header and rows.
    pub fn of<'a, R: IntoIterator<Item = String>>(
        header: impl IntoIterator<Item = &'a str>,
        rows: impl IntoIterator<Item = R>,
    ) -> Self {
        let mut table = Self::new(header);
        rows.into_iter().for_each(|row| table.row(row));
        table
    }

    /// Adds a row; its first cell is its name.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(Row::new(cells.into_iter().collect()));
    }

    /// Adds a text below the last row, across all columns.
    pub fn note(&mut self, text: impl Into<String>) {
        if let Some(row) = self.rows.last_mut() {
            row.notes.push(text.into());
        }
    }

    /// The table in lines of at most `width` characters, unless a word is too long for its column.
    fn fitted(&self, width: usize) -> String {
        let widths = self.widths(width);
        let mut text = String::new();
        for row in &self.rows {
            let notes = row.notes.iter().map(|note| broken(note, width, NOTE, NOTE));
            for line in lines(&row.cells, &widths).into_iter().chain(notes) {
                text.push_str(line.trim_end());
                text.push('\n');
            }
        }
        text
    }

    /// Widths of the columns: the widest columns are narrowed, none to less than its longest word.
    fn widths(&self, width: usize) -> Vec<usize> {
        let columns = self
            .rows
            .iter()
            .map(|row| row.cells.len())
            .max()
            .unwrap_or(0);
        let longest = |of: fn(&str) -> usize| -> Vec<usize> {
            let cells = |column: usize| {
                self.rows
                    .iter()
                    .filter_map(move |row| row.cells.get(column))
            };
            (0..columns)
                .map(|column| cells(column).map(|cell| of(cell)).max().unwrap_or(0))
                .collect()
        };
        let mut widths = longest(visible);
        let least = longest(|cell| cell.split_whitespace().map(visible).max().unwrap_or(0));
        let mut excess = (widths.iter().sum::<usize>() + GAP * columns).saturating_sub(width);
        while excess > 0 {
            let narrowable = (0..columns).filter(|&column| widths[column] > least[column]);
            let Some(widest) = narrowable.max_by_key(|&column| widths[column]) else {
                break;
            };
            widths[widest] -= 1;
            excess -= 1;
        }
        widths
    }
}

/// The lines of a row: the first column to the left, the others to the right.
fn lines(row: &[String], widths: &[usize]) -> Vec<String> {
    let cells: Vec<String> = row
        .iter()
        .zip(widths)
        .map(|(cell, width)| {
            if visible(cell) > *width {
                broken(cell, *width, "", "")
            } else {
                cell.clone()
            }
        })
        .collect();
    let height = cells.iter().map(|cell| cell.lines().count()).max();
    let line = |index: usize| {
        let mut line = String::new();
        for (column, (cell, width)) in cells.iter().zip(widths).enumerate() {
            let part = cell.lines().nth(index).unwrap_or("");
            let padding = " ".repeat(width.saturating_sub(visible(part)));
            line.push_str(&" ".repeat(GAP));
            line.push_str(&match column {
                0 => format!("{part}{padding}"),
                _ => format!("{padding}{part}"),
            });
        }
        line
    };
    (0..height.unwrap_or(0)).map(line).collect()
}

impl std::fmt::Display for Table {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.fitted(width()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned() {
        let mut table = Table::new(["run", "flow"]);
        table.row(["lift µ".to_owned(), "1.5".to_owned()]);
        table.row(["l".to_owned(), "12.25".to_owned()]);
        assert_eq!(
            table.to_string(),
            "  run      flow\n  lift µ    1.5\n  l       12.25\n"
        );
    }

    #[test]
    fn a_note_is_below_its_row() {
        let mut table = Table::new(["run", "flow"]);
        table.row(["lift".to_owned(), "1.5".to_owned()]);
        table.note("at 20 bar");
        table.row(["l".to_owned(), "12.25".to_owned()]);
        assert_eq!(
            table.to_string(),
            "  run    flow\n  lift    1.5\n      at 20 bar\n  l     12.25\n"
        );
    }

    #[test]
    fn a_wide_table_is_broken_between_words() {
        let mut table = Table::new(["run", "final error, deg"]);
        table.row(["lift".to_owned(), "1.5".to_owned()]);
        let lines = [
            "  run    final",
            "        error,",
            "           deg",
            "  lift     1.5\n",
        ];
        assert_eq!(table.fitted(14), lines.join("\n"));
    }
}
