//! Measurement files of LabVIEW (LVM): keywords above the names, and the times as a column or as a step.
//!
//! ```text
//! LabVIEW Measurement
//! X_Columns     No
//! ***End_of_Header***
//! Y_Unit_Label  A     bar
//! X0            0     0
//! Delta_X       0.02  0.02
//! ***End_of_Header***
//! X_Value       I     p     Comment
//! ```

use csv::StringRecord;

use crate::csv_log::decimals::Decimals;
use crate::csv_log::text_rows::{Header, MARKS, rows};

/// Begin of a file.
const MARK: &str = "LabVIEW Measurement";
/// Name of the columns of times.
const X: &str = "X_Value";

/// Times that are not in a column, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// Time of the first row.
    pub first_s: f64,
    /// Time between two rows.
    pub step_s: f64,
}

/// The header; `None` for another format.
pub fn header(text: &str) -> Option<Header> {
    text.starts_with(MARK).then_some(())?;
    let byte = text.find(&format!("\n{X}"))? + 1;
    let mark = *text.as_bytes().get(byte + X.len())?;
    MARKS.contains(&mark).then_some(())?;
    let (_, names) = rows(text, byte, mark).next()?;
    let mut header = Header::at(text, mark, byte, &names);
    let units = keyword(text, &header, "Y_Unit_Label");
    let mut units = units.iter().flatten().skip(1);
    for (index, cell) in header.cells.iter_mut().enumerate() {
        let unit = if index == 0 { None } else { units.next() };
        if cell.text == X {
            cell.unit = Some("s".to_owned());
        } else if cell.text == "Comment" {
            // Rows without a comment are shorter.
            (cell.text, cell.name) = Default::default();
        } else {
            cell.unit = unit.filter(|unit| !unit.is_empty()).cloned();
        }
    }
    Some(header)
}

/// The samples of a file, below the first of its headers: each recording of a file has one.
#[derive(Debug)]
pub struct Segments {
    steps: Option<Steps>,
    /// Whether the file is of LabVIEW, and the next row is within a header.
    is_lvm: bool,
    is_header: bool,
    /// Number of samples since the last header.
    samples: u32,
}

impl Segments {
    /// Of a file with these times, if they are not in a column.
    pub fn of(text: &str, steps: Option<Steps>) -> Self {
        Self {
            steps,
            is_lvm: text.starts_with(MARK),
            is_header: false,
            samples: 0,
        }
    }

    /// A row with its time; `None` in a header.
    pub fn sample(&mut self, row: StringRecord) -> Option<StringRecord> {
        let first = row.get(0).filter(|_| self.is_lvm).unwrap_or_default();
        if first == "Channels" || self.is_header {
            self.is_header = first != X;
            self.samples = 0;
            if let (Some(steps), "X0") = (&mut self.steps, first) {
                steps.first_s = Decimals::ANY.number(row.get(1)?)?;
            }
            return None;
        }
        let Some(Steps { first_s, step_s }) = self.steps else {
            return Some(row);
        };
        let time = (first_s + step_s * f64::from(self.samples)).to_string();
        self.samples += u32::from(!row.iter().all(str::is_empty));
        let others = row.iter().skip(1);
        Some(std::iter::once(time.as_str()).chain(others).collect())
    }
}

/// The times of a file without a column of them; `None` if it has one, or channels with different times.
pub fn steps(text: &str, header: &Header) -> Option<Steps> {
    let is_no = |cells: &Vec<String>| cells.get(1).is_some_and(|cell| cell == "No");
    keyword(text, header, "X_Columns").filter(is_no)?;
    let same = |name: &str| {
        let cells = keyword(text, header, name)?;
        let filled = cells.iter().skip(1).filter(|cell| !cell.is_empty());
        let mut numbers = filled.map(|cell| Decimals::ANY.number(cell));
        let first = numbers.next()??;
        numbers.all(|number| number == Some(first)).then_some(first)
    };
    Some(Steps {
        first_s: same("X0").unwrap_or(0.0),
        step_s: same("Delta_X")?,
    })
}

/// The cells of the last line with a keyword above the names.
fn keyword(text: &str, header: &Header, name: &str) -> Option<Vec<String>> {
    let above = text.get(..header.byte)?.lines();
    let mut lines = above.rev().filter_map(|line| {
        let cells = line.split(char::from(header.mark));
        let cells: Vec<String> = cells.map(|cell| cell.trim().to_owned()).collect();
        (cells[0] == name).then_some(cells)
    });
    lines.next()
}
