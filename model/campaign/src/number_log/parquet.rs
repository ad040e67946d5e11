//! Columns of Parquet files: numbers, truth values and time stamps, with gaps. Nested columns, texts and decimals are
//! ignored.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

use parquet::basic::{LogicalType, TimeUnit};
use parquet::column::page::{Page, PageMetadata, PageReader};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl, get_column_reader};
use parquet::data_type::DataType;
use parquet::errors::{ParquetError, Result};
use parquet::file::metadata::ColumnChunkMetaData;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;

use super::number_column::{Fault, MOST_NUMBERS, NumberColumn};
use crate::csv_log::text_rows::HeaderCell;

const HINT: &str = "write it again, with the compression snappy or gzip or without one, or as CSV: pandas.read_parquet(...).to_csv(...)";

/// Reads the columns of a file.
///
/// # Errors
/// The file is broken, compressed otherwise, or contains no numbers.
pub fn read(bytes: Vec<u8>) -> std::result::Result<Vec<NumberColumn>, Fault> {
    // The known panics of the library on broken files are excluded below; this is for others.
    let read = catch_unwind(AssertUnwindSafe(|| columns(bytes)));
    let read = read.unwrap_or_else(|_| Err(broken("its pages")));
    let columns = read.map_err(|error| (format!("cannot be read as Parquet: {error}"), HINT))?;
    if columns.is_empty() {
        Err(("contains no column of numbers".to_owned(), HINT))
    } else {
        Ok(columns)
    }
}

fn broken(what: &str) -> ParquetError {
    ParquetError::General(format!("{what} are damaged"))
}

fn columns(bytes: Vec<u8>) -> Result<Vec<NumberColumn>> {
    let length = bytes.len() as u64;
    let file = SerializedFileReader::new(bytes::Bytes::from(bytes))?;
    let schema = file.metadata().file_metadata().schema_descr_ptr();
    let mut columns = Vec::new();
    let mut left = MOST_NUMBERS;
    for index in 0..schema.num_columns() {
        let descriptor = schema.column(index);
        if descriptor.max_rep_level() > 0 {
            continue;
        }
        let Some(per_s) = number_unit(&descriptor) else {
            continue;
        };
        let mut values = Vec::new();
        let origin = Origin {
            is_of_times: per_s.is_some(),
            first: Cell::new(None),
        };
        for group in 0..file.num_row_groups() {
            let group = file.get_row_group(group)?;
            if index >= group.num_columns() {
                return Err(broken("its row groups"));
            }
            check_place(group.metadata().column(index), length)?;
            let pages = Box::new(Pages {
                inner: group.get_column_page_reader(index)?,
                has_dictionary: false,
            });
            let before = values.len();
            let reader = get_column_reader(descriptor.clone(), pages);
            add(
                reader,
                descriptor.max_def_level(),
                &origin,
                left,
                &mut values,
            )?;
            left -= values.len() - before;
        }
        let cell = HeaderCell::new(&descriptor.path().string());
        for value in &mut values {
            // A quotient is the number that its decimal figures are read to; a product with the inverse need not be.
            *value /= per_s.unwrap_or(1.0);
        }
        columns.push(NumberColumn {
            name: cell.name,
            unit: cell.unit.or_else(|| per_s.map(|_| "s".to_owned())),
            values,
            ..NumberColumn::default()
        });
    }
    Ok(columns)
}

/// The first time stamp of a column, from which its others are counted: as seconds since 1970 they would be rounded.
struct Origin {
    is_of_times: bool,
    first: Cell<Option<i64>>,
}

impl Origin {
    fn distance(&self, value: i64) -> i64 {
        if !self.is_of_times {
            return value;
        }
        let first = self.first.get().unwrap_or(value);
        self.first.set(Some(first));
        value.wrapping_sub(first)
    }
}

/// Of a column of numbers: the units of time stamps in a second, or `None`. Nothing for other columns.
fn number_unit(column: &ColumnDescriptor) -> Option<Option<f64>> {
    use parquet::basic::Type;
    if matches!(
        column.physical_type(),
        Type::BYTE_ARRAY | Type::FIXED_LEN_BYTE_ARRAY | Type::INT96
    ) {
        return None;
    }
    match column.logical_type_ref() {
        None | Some(LogicalType::Integer { .. }) => Some(None),
        Some(LogicalType::Timestamp(stamp)) => Some(Some(match stamp.unit {
            TimeUnit::MILLIS => 1e3,
            TimeUnit::MICROS => 1e6,
            TimeUnit::NANOS => 1e9,
        })),
        Some(_) => None,
    }
}

/// The library panics if the place of a column is negative.
fn check_place(column: &ColumnChunkMetaData, length: u64) -> Result<()> {
    let offset = column
        .dictionary_page_offset()
        .unwrap_or(column.data_page_offset());
    let end = u64::try_from(offset).ok().and_then(|begin| {
        let size = u64::try_from(column.compressed_size()).ok()?;
        begin.checked_add(size)
    });
    match end {
        Some(end) if end <= length && column.data_page_offset() >= 0 => Ok(()),
        _ => Err(broken("the places of its columns")),
    }
}

/// Adds the values of a part of a column; NaN where there is none, which is where the level is not the deepest.
fn add(
    reader: ColumnReader,
    deepest: i16,
    origin: &Origin,
    left: usize,
    values: &mut Vec<f64>,
) -> Result<()> {
    use ColumnReader as Of;
    let of_times = |value: &i64| origin.distance(*value) as f64;
    match reader {
        Of::BoolColumnReader(of) => add_typed(of, deepest, |v| u8::from(*v).into(), left, values),
        Of::Int32ColumnReader(of) => add_typed(of, deepest, |v| (*v).into(), left, values),
        Of::Int64ColumnReader(of) => add_typed(of, deepest, of_times, left, values),
        Of::FloatColumnReader(of) => add_typed(of, deepest, |v| (*v).into(), left, values),
        Of::DoubleColumnReader(of) => add_typed(of, deepest, |v| *v, left, values),
        _ => Ok(()),
    }
}

fn add_typed<T: DataType>(
    mut reader: ColumnReaderImpl<T>,
    deepest: i16,
    number: impl Fn(&T::T) -> f64,
    mut left: usize,
    values: &mut Vec<f64>,
) -> Result<()> {
    const AT_ONCE: usize = 8192;
    let (mut levels, mut present) = (Vec::new(), Vec::new());
    loop {
        levels.clear();
        present.clear();
        let (records, ..) = reader.read_records(AT_ONCE, Some(&mut levels), None, &mut present)?;
        if records == 0 {
            return Ok(());
        }
        left = left
            .checked_sub(records)
            .ok_or_else(|| ParquetError::General(format!("more than {MOST_NUMBERS} numbers")))?;
        if levels.is_empty() {
            values.extend(present.iter().map(&number));
            continue;
        }
        let mut present = present.iter();
        values.extend(levels.iter().map(|&level| {
            if level == deepest {
                present.next().map_or(f64::NAN, &number)
            } else {
                f64::NAN
            }
        }));
    }
}

/// Pages of a column, of which the first has the dictionary if one is used. The library panics otherwise.
struct Pages {
    inner: Box<dyn PageReader>,
    has_dictionary: bool,
}

impl Iterator for Pages {
    type Item = Result<Page>;

    fn next(&mut self) -> Option<Self::Item> {
        self.get_next_page().transpose()
    }
}

impl PageReader for Pages {
    fn get_next_page(&mut self) -> Result<Option<Page>> {
        use parquet::basic::Encoding::{PLAIN_DICTIONARY, RLE_DICTIONARY};
        let page = self.inner.get_next_page()?;
        match &page {
            Some(Page::DictionaryPage { .. }) => self.has_dictionary = true,
            Some(data) if !self.has_dictionary => {
                if [PLAIN_DICTIONARY, RLE_DICTIONARY].contains(&data.encoding()) {
                    return Err(broken("its dictionaries"));
                }
            }
            Some(_) | None => {}
        }
        Ok(page)
    }

    fn peek_next_page(&mut self) -> Result<Option<PageMetadata>> {
        self.inner.peek_next_page()
    }

    fn skip_next_page(&mut self) -> Result<()> {
        self.inner.skip_next_page()
    }

    fn at_record_boundary(&mut self) -> Result<bool> {
        self.inner.at_record_boundary()
    }
}
