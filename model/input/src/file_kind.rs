//! Identification of binary files by their first bytes.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

/// Number of bytes that are examined.
const LOOKED_AT: usize = 4096;

/// A kind of file that is identified by its first bytes.
struct Kind {
    magic: &'static [u8],
    name: &'static str,
    hint: &'static str,
}

const AS_CSV: &str = "export its channels as CSV or as MDF 4 (.mf4) with the tool that wrote it";
const AS_BLF: &str = "give its name the extension .blf";
const AS_MAT: &str = "give its name the extension .mat";
const AS_MAT_7: &str =
    "load it in MATLAB and write it as version 7: save('log.mat', '-struct', 's', '-v7')";
const AS_PARQUET: &str = "give its name the extension .parquet";
const UNPACK: &str = "unpack it first";
const AS_MDF: &str = "give its name the extension .mf4";

const fn kind(magic: &'static [u8], name: &'static str, hint: &'static str) -> Kind {
    Kind { magic, name, hint }
}

static KINDS: [Kind; 15] = [
    kind(b"MDF     ", "an MDF file", AS_MDF),
    kind(b"UnFinMF ", "an unfinalised MDF file", AS_MDF),
    kind(b"LOGG", "a binary log of a CAN bus (BLF)", AS_BLF),
    kind(b"MATLAB 5.0", "a MAT file of MATLAB", AS_MAT),
    kind(b"MATLAB 7.3", "a MAT file of version 7.3 (HDF5)", AS_MAT_7),
    kind(b"\x89HDF\r\n\x1a\n", "an HDF5 file", AS_CSV),
    kind(b"PAR1", "a Parquet file", AS_PARQUET),
    kind(b"TDSm", "a TDMS file of LabVIEW", AS_CSV),
    kind(
        b"PK\x03\x04",
        "a ZIP archive or an Excel workbook",
        "unpack it, or save the sheet as CSV",
    ),
    kind(
        b"\xD0\xCF\x11\xE0",
        "an Office document",
        "save the sheet as CSV",
    ),
    kind(b"\x1F\x8B", "compressed with gzip", UNPACK),
    kind(b"\x28\xB5\x2F\xFD", "compressed with zstd", UNPACK),
    kind(b"7z\xBC\xAF\x27\x1C", "a 7z archive", UNPACK),
    kind(b"%PDF", "a PDF document", AS_CSV),
    kind(b"SQLite format 3", "an SQLite database", AS_CSV),
];

/// The kind of a file that begins with `bytes`, and how to convert it to text; `None` if it may be text.
pub fn of_binary(bytes: &[u8]) -> Option<(&'static str, &'static str)> {
    of_magic(bytes).or_else(|| {
        let begin = &bytes[..bytes.len().min(LOOKED_AT)];
        begin.contains(&0).then_some(("a binary file", AS_CSV))
    })
}

/// The same for formats with a magic number.
pub fn of_magic(bytes: &[u8]) -> Option<(&'static str, &'static str)> {
    let known = KINDS.iter().find(|kind| bytes.starts_with(kind.magic));
    known.map(|kind| (kind.name, kind.hint))
}

/// Whether a file that begins with `bytes` is a binary log of a CAN bus (BLF).
pub fn is_blf(bytes: &[u8]) -> bool {
    bytes.starts_with(b"LOGG")
}

/// Whether a file that begins with `bytes` is a MAT file of version 5, 6 or 7.
pub fn is_mat(bytes: &[u8]) -> bool {
    bytes.starts_with(b"MATLAB 5.0")
}

/// The first bytes of a file; `None` if it is shorter or cannot be read.
pub fn first_bytes(path: &Path) -> Option<[u8; 16]> {
    let mut bytes = [0; 16];
    let mut file = File::open(path).ok()?;
    file.read_exact(&mut bytes).ok()?;
    Some(bytes)
}

/// Whether a file that begins with `bytes` is Parquet.
pub fn is_parquet(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PAR1")
}

/// Whether a file that begins with `bytes` is MDF.
pub fn is_mdf(bytes: &[u8]) -> bool {
    bytes.starts_with(b"MDF     ") || bytes.starts_with(b"UnFinMF ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_told_by_their_first_bytes() {
        assert_eq!(of_binary(b"PAR1\x15").unwrap().0, "a Parquet file");
        assert_eq!(of_binary(b"\x01\x00\x02").unwrap().0, "a binary file");
        assert_eq!(of_binary(b"time_s,lift_current_a\n"), None);
        assert!(is_mdf(b"MDF     4.10    "));
    }
}
