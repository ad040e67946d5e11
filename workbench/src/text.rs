//! Tables for a terminal, with aligned columns; numbers to the right.

/// A table of text cells.
#[derive(Debug, Clone, Default)]
pub struct Table {
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table with a header.
    pub fn new<'a>(header: impl IntoIterator<Item = &'a str>) -> Self {
        Self {
            rows: vec![header.into_iter().map(str::to_owned).collect()],
        }
    }

    /// Adds a row; its first cell is its name.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }
}

impl std::fmt::Display for Table {
    /// Each row on a line, indented by two spaces; the first column left-aligned, the others right-aligned.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let cell = |row: &Vec<String>, column: usize| {
            row.get(column).map_or(0, |cell| cell.chars().count())
        };
        let widths: Vec<usize> = (0..columns)
            .map(|column| {
                self.rows
                    .iter()
                    .map(|row| cell(row, column))
                    .max()
                    .unwrap_or(0)
            })
            .collect();
        for row in &self.rows {
            let mut line = String::from(" ");
            for (column, (cell, width)) in row.iter().zip(&widths).enumerate() {
                let padding = " ".repeat(width - cell.chars().count());
                line.push_str(if column == 0 { " " } else { "  " });
                line.push_str(&if column == 0 {
                    format!("{cell}{padding}")
                } else {
                    format!("{padding}{cell}")
                });
            }
            writeln!(f, "{}", line.trim_end())?;
        }
        Ok(())
    }
}

/// A number with a fixed number of decimals; a dash for NaN.
#[must_use]
pub fn known(value: f64, decimals: usize) -> String {
    if value.is_finite() {
        format!("{value:.decimals$}")
    } else {
        "-".to_owned()
    }
}

/// Breaks a text at spaces into lines of at most `width` characters; all but the first are indented.
pub fn wrapped(text: &str, width: usize) -> String {
    let mut lines: Vec<String> = vec![String::new()];
    for word in text.split_whitespace() {
        let line = lines
            .last_mut()
            .filter(|line| line.chars().count() + word.chars().count() < width);
        match line {
            Some(line) if line.is_empty() => line.push_str(word),
            Some(line) => {
                line.push(' ');
                line.push_str(word);
            }
            None => lines.push(format!("  {word}")),
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_texts_are_broken_between_words() {
        assert_eq!(
            wrapped("one two three four", 10),
            "one two\n  three\n  four"
        );
        assert_eq!(wrapped("", 10), "");
    }

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
}
