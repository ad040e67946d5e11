//! Files of level 5: a header of 128 bytes and a sequence of elements; an element has a type, a length and its bytes.

use std::io::Read as _;

use flate2::read::ZlibDecoder;
use hitch_input::little_endian::{u16_at, u32_at};

use crate::value::{MOST_NUMBERS, Value};

/// Bytes of the header.
const HEADER: usize = 128;
/// Most bytes of an unpacked variable.
const LARGEST: u64 = 512 << 20;
/// Deepest nesting of structs.
const DEEPEST: usize = 16;

/// The variables of a file by name.
///
/// # Errors
/// What is wrong with the file.
pub fn variables(bytes: &[u8]) -> Result<Vec<(String, Value)>, String> {
    match bytes.get(HEADER - 2..HEADER) {
        Some(b"IM") => {}
        Some(b"MI") => return Err("is big-endian, which MATLAB no longer writes".to_owned()),
        _ => return Err("ends within its header, or is no MAT file".to_owned()),
    }
    let mut reader = Reader {
        numbers: 0,
        unpacked: 0,
    };
    let mut rest = &bytes[HEADER..];
    let mut variables = Vec::new();
    while !rest.is_empty() {
        let element = Element::next(&mut rest)?;
        match element.kind {
            Element::COMPRESSED => {
                let unpacked = reader.unpacked(element.data)?;
                let mut rest = unpacked.as_slice();
                let element = Element::next(&mut rest)?;
                variables.extend(reader.variable(&element, 0)?);
            }
            _ => variables.extend(reader.variable(&element, 0)?),
        }
    }
    Ok(variables)
}

/// A part of the file.
struct Element<'b> {
    kind: u32,
    data: &'b [u8],
}

impl<'b> Element<'b> {
    const INT8: u32 = 1;
    const UINT8: u32 = 2;
    const UINT16: u32 = 4;
    const INT32: u32 = 5;
    const MATRIX: u32 = 14;
    const COMPRESSED: u32 = 15;
    const UTF8: u32 = 16;
    const UTF16: u32 = 17;

    /// Takes the next element off the bytes.
    fn next(rest: &mut &'b [u8]) -> Result<Self, String> {
        let cut = || "ends in the middle of a variable".to_owned();
        let first = u32_at(rest, 0).ok_or_else(cut)?;
        let (small, small_kind) = ((first >> 16) as usize, first & 0xFFFF);
        if small != 0 {
            let data = rest.get(4..4 + small).filter(|_| small <= 4);
            let data = data.ok_or_else(|| "has a short element that is too long".to_owned())?;
            *rest = rest.get(8..).ok_or_else(cut)?;
            let kind = small_kind;
            return Ok(Self { kind, data });
        }
        let length = u32_at(rest, 4).ok_or_else(cut)? as usize;
        let data = rest.get(8..).and_then(|data| data.get(..length));
        let data = data.ok_or_else(cut)?;
        // Compressed elements are not padded.
        let padded = match first {
            Self::COMPRESSED => length,
            _ => length.next_multiple_of(8),
        };
        *rest = rest.get(8 + padded..).unwrap_or_default();
        Ok(Self { kind: first, data })
    }

    /// The numbers of an element of any numeric type.
    fn numbers(&self) -> Result<Vec<f64>, String> {
        fn all<const N: usize>(data: &[u8], number: impl Fn([u8; N]) -> f64) -> Vec<f64> {
            let (chunks, _) = data.as_chunks::<N>();
            chunks.iter().map(|bytes| number(*bytes)).collect()
        }
        let data = self.data;
        Ok(match self.kind {
            Self::INT8 => all(data, |b| i8::from_le_bytes(b).into()),
            Self::UINT8 => all(data, |b| u8::from_le_bytes(b).into()),
            3 => all(data, |b| i16::from_le_bytes(b).into()),
            Self::UINT16 => all(data, |b| u16::from_le_bytes(b).into()),
            Self::INT32 => all(data, |b| i32::from_le_bytes(b).into()),
            6 => all(data, |b| u32::from_le_bytes(b).into()),
            7 => all(data, |b| f32::from_le_bytes(b).into()),
            9 => all(data, f64::from_le_bytes),
            12 => all(data, |b| i64::from_le_bytes(b) as f64),
            13 => all(data, |b| u64::from_le_bytes(b) as f64),
            kind => return Err(format!("has numbers of type {kind}, which is not known")),
        })
    }

    fn text(&self) -> String {
        match self.kind {
            Self::UINT16 | Self::UTF16 => {
                let units = (0..self.data.len()).step_by(2);
                let units: Vec<u16> = units.filter_map(|at| u16_at(self.data, at)).collect();
                String::from_utf16_lossy(&units)
            }
            Self::INT8 | Self::UINT8 | Self::UTF8 => {
                let end = self.data.iter().position(|&byte| byte == 0);
                let text = &self.data[..end.unwrap_or(self.data.len())];
                String::from_utf8_lossy(text).into_owned()
            }
            _ => String::new(),
        }
    }
}

struct Reader {
    numbers: usize,
    unpacked: u64,
}

impl Reader {
    fn unpacked(&mut self, packed: &[u8]) -> Result<Vec<u8>, String> {
        let mut bytes = Vec::new();
        let left = LARGEST - self.unpacked;
        let mut unpacked = ZlibDecoder::new(packed).take(left);
        let read = unpacked.read_to_end(&mut bytes);
        read.map_err(|error| format!("has a variable that cannot be unpacked: {error}"))?;
        self.unpacked += bytes.len() as u64;
        if self.unpacked < LARGEST {
            Ok(bytes)
        } else {
            Err("has more than 512 MiB of data".to_owned())
        }
    }

    /// A variable with its name; `None` for an empty element, and for one that is no variable.
    fn variable(
        &mut self,
        element: &Element<'_>,
        depth: usize,
    ) -> Result<Option<(String, Value)>, String> {
        const STRUCT: u8 = 2;
        const OBJECT: u8 = 3;
        const TEXT: u8 = 4;
        const FIRST_NUMERIC: u8 = 6;
        const LAST_NUMERIC: u8 = 15;
        const OPAQUE: u8 = 17;
        if element.kind != Element::MATRIX || element.data.is_empty() {
            return Ok(None);
        }
        if depth > DEEPEST {
            return Err(format!("has structs nested more than {DEEPEST} times"));
        }
        let mut rest = element.data;
        let flags = Element::next(&mut rest)?;
        let class = *flags.data.first().unwrap_or(&0);
        if class == OPAQUE {
            let name = Element::next(&mut rest)?.text();
            return Ok(Some((name, Value::Object)));
        }
        let size = size(&Element::next(&mut rest)?.numbers()?)?;
        let name = Element::next(&mut rest)?.text();
        let value = match class {
            TEXT => Value::Text(Element::next(&mut rest)?.text()),
            STRUCT => self.structs(&mut rest, size, depth)?,
            OBJECT => Value::Object,
            FIRST_NUMERIC..=LAST_NUMERIC => self.matrix(&mut rest, size)?,
            _ => Value::Other,
        };
        Ok(Some((name, value)))
    }

    fn matrix(&mut self, rest: &mut &[u8], size: [usize; 2]) -> Result<Value, String> {
        let values = Element::next(rest)?.numbers()?;
        self.numbers += values.len();
        if self.numbers > MOST_NUMBERS {
            return Err(format!("has more than {MOST_NUMBERS} numbers"));
        }
        if size[0].checked_mul(size[1]) == Some(values.len()) {
            Ok(Value::Numbers { size, values })
        } else {
            Err(format!(
                "has a matrix of {} by {} with {} numbers",
                size[0],
                size[1],
                values.len()
            ))
        }
    }

    fn structs(
        &mut self,
        rest: &mut &[u8],
        size: [usize; 2],
        depth: usize,
    ) -> Result<Value, String> {
        let length = Element::next(rest)?.numbers()?;
        let length = length.first().map_or(0, |length| *length as usize);
        let names = Element::next(rest)?;
        if length == 0 {
            return Ok(Value::Structs(Vec::new()));
        }
        let name = |data| {
            Element {
                kind: Element::INT8,
                data,
            }
            .text()
        };
        let names: Vec<String> = names.data.chunks(length).map(name).collect();
        let mut structs = Vec::new();
        let count = size[0].saturating_mul(size[1]);
        // Structs without fields take no bytes, so that any number of them fits in a file.
        for _ in 0..if names.is_empty() { 0 } else { count } {
            let mut fields = Vec::with_capacity(names.len());
            for name in &names {
                let element = Element::next(rest)?;
                let value = self.variable(&element, depth + 1)?;
                fields.push((name.clone(), value.map_or(Value::Other, |(_, value)| value)));
            }
            structs.push(fields);
        }
        Ok(Value::Structs(structs))
    }
}

/// Rows, and columns of all further dimensions together.
fn size(dimensions: &[f64]) -> Result<[usize; 2], String> {
    let mut product = 1_usize;
    for dimension in dimensions.get(1..).unwrap_or_default() {
        let columns = product.checked_mul(*dimension as usize);
        product = columns.ok_or_else(|| "has a matrix of impossible size".to_owned())?;
    }
    let rows = dimensions.first().copied().unwrap_or(0.0);
    Ok([rows as usize, product])
}
