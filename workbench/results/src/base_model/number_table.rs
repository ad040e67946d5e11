//! Columns of numbers from a text table of any dialect, with the units in its header.

use hitch_campaign::survey::{LogColumn, text_table};
use hitch_input::input_error::InputError;
use hitch_input::source_file::SourceFile;
use hitch_input::written_unit::{parsed, spelling};

/// A column that a table has to have.
pub struct Wanted {
    /// Its quantity, for messages.
    pub quantity: &'static str,
    /// Words in its name; none if the unit identifies it.
    pub words: &'static [&'static str],
    /// Its units.
    pub units: &'static [&'static str],
}

/// Columns of numbers, in SI.
#[derive(Debug)]
pub struct NumberTable<const N: usize> {
    /// The columns, in the order asked for.
    pub columns: [Vec<f64>; N],
    /// Position of each row in the text.
    pub bytes: Vec<usize>,
}

impl<const N: usize> NumberTable<N> {
    /// Reads the columns, under a header as in `example`; rows that are empty or begin with `#` are skipped.
    ///
    /// # Errors
    /// A fault in the table, by line.
    pub fn read(
        source: &SourceFile,
        wanted: &[Wanted; N],
        example: &str,
    ) -> Result<Self, InputError> {
        let table = text_table(source)?.ok_or_else(|| {
            let hint = format!(
                "write a header such as {example} above the numbers, and one row for each point"
            );
            source.error("is not a table with a header", hint)
        })?;
        let mut columns = [const { Vec::new() }; N];
        for (values, wanted) in columns.iter_mut().zip(wanted) {
            let (found, si) = column(&table.columns, wanted).ok_or_else(|| {
                let units = wanted.units.join(" or ");
                let what = format!("no column is a {} in {units}", wanted.quantity);
                let hint = format!("write the unit in the header, as in {example}");
                source.error_at(table.header, what, hint)
            })?;
            let logged = table.numbers(source, found)?.iter();
            *values = logged.map(|value| si * value).collect();
        }
        Ok(Self {
            columns,
            bytes: table.rows,
        })
    }
}

/// A column, and the size of its unit in SI.
fn column<'c>(columns: &'c [LogColumn], wanted: &Wanted) -> Option<(&'c LogColumn, f64)> {
    let is_named = |column: &&LogColumn| {
        let name = column.name.to_lowercase();
        wanted.words.is_empty() || wanted.words.iter().any(|word| name.contains(word))
    };
    let mut named = columns.iter().filter(is_named);
    named.find_map(|column| Some((column, unit(column, wanted.units)?)))
}

/// Size of a column's unit in SI; `None` for unknown units. Without a written unit it is the end of the name: `flow_l_min`.
fn unit(column: &LogColumn, units: &[&str]) -> Option<f64> {
    let size = |text: &str| {
        let name = spelling(text);
        let is_wanted = units.contains(&name);
        parsed(name).filter(|_| is_wanted).map(|unit| unit.si)
    };
    if let Some(written) = &column.unit {
        return size(&written.to_lowercase());
    }
    let name = column.name.to_lowercase().replace('_', "/");
    name.match_indices('/')
        .find_map(|(at, _)| size(&name[at + 1..]))
}
