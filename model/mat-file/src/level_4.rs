//! Files of level 4: a header of five numbers for each matrix, its name and its numbers.

use hitch_input::little_endian::u32_at;

use crate::value::{MOST_NUMBERS, Value};

/// Bytes of the header of a matrix.
const HEADER: usize = 20;
/// Longest name, with the zero behind it.
const LONGEST_NAME: usize = 256;
const CUT: &str = "ends in the middle of a variable";

/// The header of a matrix.
struct Header {
    size: [usize; 2],
    is_complex: bool,
    /// Bytes of the name, with the zero behind it.
    name: usize,
    number: fn(&[u8]) -> f64,
    /// Bytes of a number.
    width: usize,
    kind: u32,
}

impl Header {
    const NUMBERS: u32 = 0;
    const TEXT: u32 = 1;
    const SPARSE: u32 = 2;

    /// `None` if the bytes are no header of a matrix with numbers of this century's computers, which are little-endian.
    fn read(bytes: &[u8]) -> Option<Self> {
        let word = |index: usize| u32_at(bytes, 4 * index);
        let kind = word(0)?;
        let (form, kind) = (kind / 10, kind % 10);
        let (width, number): (usize, fn(&[u8]) -> f64) = match form {
            0 => (8, |bytes| f64::from_le_bytes(array(bytes))),
            1 => (4, |bytes| f32::from_le_bytes(array(bytes)).into()),
            2 => (4, |bytes| i32::from_le_bytes(array(bytes)).into()),
            3 => (2, |bytes| i16::from_le_bytes(array(bytes)).into()),
            4 => (2, |bytes| u16::from_le_bytes(array(bytes)).into()),
            5 => (1, |bytes| u8::from_le_bytes(array(bytes)).into()),
            _ => return None,
        };
        let name = word(4)? as usize;
        let is_sound = kind <= Self::SPARSE && word(3)? <= 1 && (2..=LONGEST_NAME).contains(&name);
        is_sound.then_some(Self {
            size: [word(1)? as usize, word(2)? as usize],
            is_complex: word(3)? == 1,
            name,
            number,
            width,
            kind,
        })
    }
}

/// The first bytes; zeros behind the end.
fn array<const N: usize>(bytes: &[u8]) -> [u8; N] {
    std::array::from_fn(|index| bytes.get(index).copied().unwrap_or_default())
}

/// Whether a file begins with the header and the name of a matrix.
pub fn is_one(bytes: &[u8]) -> bool {
    Header::read(bytes).is_some_and(|header| {
        let name = bytes.get(HEADER..HEADER + header.name);
        let name = name.and_then(|name| name.split_last());
        name.is_some_and(|(end, name)| {
            *end == 0 && name.iter().all(|c| c.is_ascii_alphanumeric() || *c == b'_')
        })
    })
}

/// The matrices by name.
///
/// # Errors
/// What is wrong with the file.
pub fn variables(mut rest: &[u8]) -> Result<Vec<(String, Value)>, String> {
    let mut variables = Vec::new();
    let mut left = MOST_NUMBERS;
    while !rest.is_empty() {
        let header = Header::read(rest).ok_or("has a variable that is not of level 4")?;
        let parts = if header.is_complex { 2 } else { 1 };
        let count = header.size[0].checked_mul(header.size[1]);
        let count = count.filter(|count| *count <= left).ok_or_else(|| {
            let [rows, columns] = header.size;
            format!("has a matrix of {rows} by {columns}, and may have {MOST_NUMBERS} numbers")
        })?;
        left -= count;
        let data = HEADER + header.name;
        let (name, numbers) = (rest.get(HEADER..data), rest.get(data..));
        let bytes = count * header.width;
        let numbers = numbers.and_then(|numbers| numbers.get(..bytes));
        let (name, numbers) = name.zip(numbers).ok_or(CUT)?;
        let values = numbers.chunks_exact(header.width).map(header.number);
        let value = match header.kind {
            Header::NUMBERS if !header.is_complex => Value::Numbers {
                size: header.size,
                values: values.collect(),
            },
            // Characters are numbers of any form.
            Header::TEXT => Value::Text(values.map(|code| char::from(code as u8)).collect()),
            _ => Value::Other,
        };
        let end = name.iter().position(|&byte| byte == 0);
        let name = String::from_utf8_lossy(&name[..end.unwrap_or(name.len())]);
        variables.push((name.into_owned(), value));
        rest = rest.get(data + parts * bytes..).ok_or(CUT)?;
    }
    Ok(variables)
}
