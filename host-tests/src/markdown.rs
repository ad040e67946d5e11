//! Tables in Markdown, for the output of measurements.

/// A table with aligned columns, in lines without a last line break.
#[must_use]
pub fn table<const N: usize>(header: [&str; N], rows: &[[String; N]]) -> String {
    let header = header.map(str::to_owned);
    let widths: [usize; N] = std::array::from_fn(|column| {
        let cells = rows.iter().chain([&header]).map(|row| &row[column]);
        cells
            .map(|cell| cell.chars().count())
            .max()
            .unwrap_or_default()
    });
    let line = |row: &[String; N]| {
        let cells = row
            .iter()
            .zip(widths)
            .map(|(cell, width)| format!(" {cell:width$} "));
        format!("|{}|", cells.collect::<Vec<_>>().join("|"))
    };
    let rule = widths.map(|width| "-".repeat(width));
    let rule = line(&rule).replace(' ', "-");
    let lines: Vec<String> = [line(&header), rule]
        .into_iter()
        .chain(rows.iter().map(line))
        .collect();
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    #[test]
    fn columns_are_as_wide_as_their_widest_cell() {
        let rows = [["a".to_owned(), "1.25".to_owned()]];
        let expected = "| xx | s    |\n|----|------|\n| a  | 1.25 |";
        assert_eq!(super::table(["xx", "s"], &rows), expected);
    }
}
