//! The dialect of a text table: separator, position of the header, decimal mark.

use std::collections::HashSet;

use csv::StringRecord;

use crate::csv_log::clock::is_clock;
use crate::csv_log::decimals::Decimals;
use crate::csv_log::lvm;
use crate::csv_log::text_rows::{Header, HeaderCell, MARKS, rows};
use crate::scale::is_unit;
use crate::time_base::is_time_name;

/// Number of rows that are searched for a header.
const HEADER_WITHIN: usize = 200;

impl HeaderCell {
    /// Splits a name from a unit in brackets behind it.
    pub fn new(text: &str) -> Self {
        let text = text.trim().trim_start_matches('#').trim_start();
        let (name, unit) = match in_brackets(text) {
            Some((name, unit)) => (name, Some(unit.to_owned())),
            None => (text, None),
        };
        Self {
            text: text.to_owned(),
            name: name.to_owned(),
            unit,
        }
    }

    /// Whether it is the column with this name.
    pub fn is(&self, name: &str) -> bool {
        self.text == name || self.name == name || self.plain_name() == name
    }

    /// Its name without the number that was added because other cells have the same name.
    fn plain_name(&self) -> &str {
        let number = self
            .name
            .rsplit_once(" #")
            .filter(|_| !self.text.contains(" #"));
        number.map_or(&self.name, |(name, _)| name)
    }
}

/// Splits `Name [unit]`, `Name (unit)`, `Name {unit}` and `Name / unit`.
fn in_brackets(text: &str) -> Option<(&str, &str)> {
    for (open, close) in [('[', ']'), ('(', ')'), ('{', '}')] {
        if let Some((name, unit)) = text
            .strip_suffix(close)
            .and_then(|text| text.rsplit_once(open))
        {
            // A name may end in brackets without a unit.
            let is_bracket = open == '[' || is_unit(unit);
            return is_bracket.then(|| (name.trim_end(), unit.trim()));
        }
    }
    let (name, unit) = text.rsplit_once(" / ")?;
    is_unit(unit).then(|| (name.trim_end(), unit.trim()))
}

impl Header {
    /// The row with the most of `names`; `None` if there is none.
    pub fn with_names(text: &str, names: &[&str]) -> Option<Self> {
        if let Some(header) = lvm::header(text) {
            return Some(header);
        }
        let found = |row: &StringRecord| {
            let mut cells: Vec<HeaderCell> = row.iter().map(HeaderCell::new).collect();
            tell_apart(&mut cells);
            let is_there = |name: &&&str| cells.iter().any(|cell| cell.is(name));
            names.iter().filter(is_there).count()
        };
        let mut best: Option<(usize, u8, usize, StringRecord)> = None;
        for mark in MARKS {
            for (byte, row) in rows(text, 0, mark).take(HEADER_WITHIN) {
                let count = found(&row);
                if count > best.as_ref().map_or(0, |best| best.0) {
                    best = Some((count, mark, byte, row));
                }
            }
        }
        best.map(|(_, mark, byte, row)| Self::at(text, mark, byte, &row))
    }

    /// The row before the first samples, for a table with unknown names; `None` if the text is not a table.
    pub fn guessed(text: &str) -> Option<Self> {
        let of_mark = |mark| {
            let rows: Vec<(usize, StringRecord)> =
                rows(text, 0, mark).take(HEADER_WITHIN).collect();
            let width = usual_width(&rows)?;
            let first = rows
                .iter()
                .position(|(_, row)| row.len() >= width && is_sample(row))?;
            let above = rows[..first].iter().rev();
            let possible =
                above.filter(|(_, row)| row.len() >= 2 && !is_units(row) && row.len() + 1 >= width);
            // Of equal rows the uppermost has the names; a comment has them only if no other row has.
            let is_remark = |row: &StringRecord| row.get(0).is_some_and(|c| c.starts_with('#'));
            let (byte, header) =
                possible.max_by_key(|(_, row)| (!is_remark(row), names_in(row)))?;
            Some(Self::at(text, mark, *byte, header))
        };
        lvm::header(text).or_else(|| MARKS.into_iter().find_map(of_mark))
    }

    /// The header in this row, with the units below it.
    pub fn at(text: &str, mark: u8, byte: usize, row: &StringRecord) -> Self {
        // The mark of a comment is no cell, though spaces separate it from the names.
        let is_mark = mark == b' ' && row.get(0) == Some("#");
        let names = row.iter().skip(is_mark.into());
        let mut cells: Vec<HeaderCell> = names.map(HeaderCell::new).collect();
        let mut below = rows(text, byte, mark)
            .skip(1)
            .take(HEADER_WITHIN)
            .peekable();
        while let Some((_, row)) = below.next_if(|(_, row)| !holds_samples(row)) {
            // A keyword may precede the units of a header that has none.
            let skipped = match row.len() == cells.len() + 1 && is_units(&row) {
                true => 1,
                false if row.len() > cells.len() && !ends_empty(&row, cells.len()) => continue,
                false => 0,
            };
            for (cell, unit) in cells.iter_mut().zip(row.iter().skip(skipped)) {
                let unit = bare(unit);
                if cell.unit.is_none() && is_unit(unit) {
                    cell.unit = Some(unit.to_owned());
                }
            }
        }
        tell_apart(&mut cells);
        let data_byte = below.next().map_or(text.len(), |(byte, _)| byte);
        Self {
            mark,
            byte,
            width: cells.len(),
            cells,
            data_byte,
        }
    }

    /// The names of its columns.
    pub fn names(&self) -> Vec<&str> {
        let cells = self.cells.iter().map(|cell| cell.name.as_str());
        cells.filter(|name| !name.is_empty()).collect()
    }
}

/// Whether a row below a header contains samples: any number or time.
fn holds_samples(row: &StringRecord) -> bool {
    row.iter().any(is_value)
}

/// Whether a row contains mostly numbers and times.
pub fn is_sample(row: &StringRecord) -> bool {
    let filled: Vec<&str> = row.iter().filter(|cell| !cell.is_empty()).collect();
    let values = filled.iter().filter(|cell| is_value(cell)).count();
    filled.len() > 1 && 2 * values > filled.len()
}

fn is_value(cell: &str) -> bool {
    Decimals::ANY.number(cell).is_some() || is_clock(cell)
}

/// Whether a row contains only units, possibly behind a keyword.
fn is_units(row: &StringRecord) -> bool {
    let mut filled = row.iter().filter(|cell| !cell.is_empty()).peekable();
    let is_keyword = filled.peek().is_some_and(|first| {
        let first = first.to_lowercase();
        first.contains("unit") || first.contains("einheit")
    });
    let mut units = filled.skip(usize::from(is_keyword)).peekable();
    units.peek().is_some() && units.all(|cell| is_unit(bare(cell)))
}

/// A text without brackets around it.
fn bare(text: &str) -> &str {
    let is_bracket = |c| matches!(c, '[' | ']' | '(' | ')' | '{' | '}');
    text.trim_matches(is_bracket).trim()
}

/// Whether all cells from `index` on are empty.
fn ends_empty(row: &StringRecord, index: usize) -> bool {
    row.iter().skip(index).all(str::is_empty)
}

/// The number of different names that a row may contain.
fn names_in(row: &StringRecord) -> usize {
    let is_name = |cell: &&str| cell.chars().any(char::is_alphabetic) && !cell.contains('=');
    let names: HashSet<&str> = row.iter().filter(is_name).collect();
    names.len() + usize::from(names.iter().any(|name| is_time_name(name)))
}

/// Numbers the cells with equal names: `Druck #1`, `Druck #2`.
fn tell_apart(cells: &mut [HeaderCell]) {
    let names: Vec<String> = cells.iter().map(|cell| cell.name.clone()).collect();
    for (index, cell) in cells.iter_mut().enumerate() {
        let equal = |part: &[String]| part.iter().filter(|name| **name == cell.name).count();
        if !cell.name.is_empty() && equal(&names) > 1 {
            cell.name = format!("{} #{}", cell.name, equal(&names[..=index]));
        }
    }
}

/// The number of cells of most rows, if it is at least two and most rows agree.
fn usual_width(rows: &[(usize, StringRecord)]) -> Option<usize> {
    let count = |width: usize| rows.iter().filter(|(_, row)| row.len() == width).count();
    let widths = rows.iter().map(|(_, row)| row.len());
    let usual = widths.max_by_key(|width| count(*width))?;
    (usual >= 2 && 2 * count(usual) > rows.len()).then_some(usual)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::csv_log::decimals::is_missing;

    #[test]
    fn a_header_is_found_behind_remarks_and_before_units() {
        let text =
            "Messung 5;\r\nBench 2\r\n\r\nZeit;Strom;Druck p2 [bar]\r\ns;mA;\r\n0,00;1,5;20\r\n";
        for header in [
            Header::with_names(text, &["Strom", "Druck p2"]).unwrap(),
            Header::guessed(text).unwrap(),
        ] {
            assert_eq!(header.mark, b';');
            assert_eq!(header.names(), ["Zeit", "Strom", "Druck p2"]);
            let units: Vec<&str> = header
                .cells
                .iter()
                .flat_map(|cell| cell.unit.as_deref())
                .collect();
            assert_eq!(units, ["s", "mA", "bar"]);
            assert!(text[header.data_byte..].starts_with("0,00"));
        }
        assert_eq!(Header::guessed("nothing\nhere\n"), None);
        assert_eq!(Header::with_names(text, &["x"]), None);
    }

    #[test]
    fn decimals_are_told_from_each_other() {
        let of = |cells: &[&str]| Decimals::of(cells.iter().copied());
        assert_eq!(of(&["1,5", "2"]).number("2,25"), Some(2.25));
        assert_eq!(of(&["1.5", "2"]).number("2.25"), Some(2.25));
        assert_eq!(
            of(&["1.5", "2"]).number("1,234"),
            None,
            "thousands are not decimals"
        );
        assert_eq!(of(&["1,5"]).number("1.234"), None);
        assert_eq!(Decimals::ANY.number("1.234,5"), None);
        for missing in ["inf", "", "NaN", "#DIV/0!", "-1.#IND", "1.#QNAN", "#N/A"] {
            assert!(is_missing(missing), "{missing}");
            assert_eq!(Decimals::ANY.number(missing), None);
        }
        let thousands = |cells: &[&str]| of(cells).of_column(cells).0.number("1,499");
        assert_eq!(thousands(&["0", "2", "1,499", "1,500"]), Some(1_499.0));
        assert_eq!(thousands(&["0", "2", "1,499", "1,5"]), Some(1.499));
        assert_eq!(thousands(&["0,002", "0", "1,499"]), Some(1.499));
        assert_eq!(thousands(&["1,499", "1,500"]), Some(1.499));
        let german = Decimals::of(["1,5"].into_iter()).of_column(&["1.234,5", "0,5"]);
        assert_eq!(german.0.number("1.234,5"), Some(1_234.5));
    }

    #[test]
    fn units_stand_in_brackets() {
        for (text, name, unit) in [
            ("Strom [mA]", "Strom", Some("mA")),
            ("Druck (bar)", "Druck", Some("bar")),
            ("Winkel / °", "Winkel", Some("°")),
            ("Druck (Zylinder)", "Druck (Zylinder)", None),
        ] {
            let cell = HeaderCell::new(text);
            assert_eq!((cell.name.as_str(), cell.unit.as_deref()), (name, unit));
        }
    }
}
