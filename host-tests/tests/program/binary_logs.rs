//! MAT, Parquet and BLF files of other programs read to the same runs as text; broken ones are refused.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

use hitch_campaign::{Campaign, survey};
use host_tests::python::{self, installed, scripts};
use host_tests::refusal::refused;
use host_tests::seeds::cases;
use tempfile::TempDir;

use crate::import::{assert_same, dbc, imported, own};

/// Rows of the small files that are broken.
const FEW_ROWS: usize = 24;

/// Writes the log as files of other programs; the arguments of their imports. Nothing without Python.
fn written(dir: &Path, rows: usize) -> Option<Vec<String>> {
    // The tests of this file share the environment, which is installed once.
    static PYTHON: LazyLock<Option<PathBuf>> = LazyLock::new(|| {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
        installed("binary_logs.txt", folder)
    });
    let python = PYTHON.as_ref()?;
    fs::write(dir.join("own.csv"), own()).unwrap();
    fs::write(dir.join("rig.dbc"), dbc()).unwrap();
    let mut command = Command::new(python);
    let command = command
        .arg(scripts().join("write_binary_logs.py"))
        .arg(dir.join("own.csv"))
        .arg(rows.to_string());
    let said = python::run(command).unwrap_or_else(|reason| panic!("{reason}"));
    Some(said.lines().map(str::to_owned).collect())
}

// REQ-INPUT-03
#[test]
fn binary_logs_of_other_programs_read_to_the_same_runs() {
    let dir = TempDir::new().unwrap();
    let Some(files) = written(dir.path(), 0) else {
        return;
    };
    assert_eq!(files.len(), 13, "{files:?}");
    let (_, expected) = imported(dir.path(), "import own.csv --out c --load 150");
    for file in files {
        fs::remove_dir_all(dir.path().join("c")).unwrap();
        let (_, runs) = imported(dir.path(), &format!("import {file} --out c --load 150"));
        assert_same(&file, &runs, &expected);
    }
    refused(
        dir.path(),
        &"import refused.zstd.parquet --out d --load 150"
            .split(' ')
            .collect::<Vec<_>>(),
        "zstd",
    );
}

/// The files with each of these contents are read, or refused, and never anything else.
fn read_all(path: &Path, contents: impl Iterator<Item = Vec<u8>>) -> (usize, usize) {
    let (mut read, mut all) = (0, 0);
    let dir = path.parent().unwrap();
    for content in contents {
        fs::write(path, content).unwrap();
        let is_read = if survey::is_bus(path) {
            survey::bus_signals(path, &dir.join("rig.dbc")).map(|_| ())
        } else {
            survey::Survey::of(path).map(|_| ())
        };
        let campaign = Campaign::load(dir);
        for message in [is_read.err(), campaign.as_ref().err().cloned()] {
            // Of a panic inside a library, which is caught.
            let said = message.map(|error| error.to_string()).unwrap_or_default();
            assert!(!said.contains("its pages are damaged"), "{said}");
        }
        read += usize::from(campaign.is_ok());
        all += 1;
    }
    (read, all)
}

// REQ-INPUT-03
#[test]
fn broken_binary_logs_are_refused() {
    let dir = TempDir::new().unwrap();
    let Some(files) = written(dir.path(), FEW_ROWS) else {
        return;
    };
    for file in files {
        let name = file.split(' ').next().unwrap();
        let arguments = format!("import {file} --out {name}.d --load 150");
        let arguments: Vec<&str> = arguments.split(' ').collect();
        let output = host_tests::program::run(dir.path(), &arguments);
        assert!(output.status.success(), "{file}: {output:?}");
        let folder = dir.path().join(format!("{name}.d"));
        let whole = fs::read(dir.path().join(name)).unwrap();
        // The campaign refers to the copy beside it, which is broken in its place.
        let manifest = fs::read_to_string(folder.join("campaign.toml")).unwrap();
        let original = dir.path().canonicalize().unwrap().join(name);
        let manifest = manifest.replace(original.to_str().unwrap(), name);
        fs::write(folder.join("campaign.toml"), manifest).unwrap();
        fs::write(folder.join("rig.dbc"), dbc()).unwrap();
        let path = folder.join(name);
        assert_eq!(read_all(&path, [whole.clone()].into_iter()), (1, 1));
        // Odd steps reach all places of the formats' words.
        let prefixes = (0..whole.len())
            .step_by(cases(101, 3))
            .map(|length| whole[..length].to_vec());
        let (read, cut) = read_all(&path, prefixes);
        let flipped = (0..whole.len()).step_by(cases(37, 1)).map(|at| {
            let mut bytes = whole.clone();
            bytes[at] ^= [0x01, 0x80, 0xFF][at % 3];
            bytes
        });
        let (accepted, all) = read_all(&path, flipped);
        println!("{name}: {read} of {cut} cut ones are read, {accepted} of {all} changed ones");
        if name.ends_with(".blf") {
            assert!(read * 4 > cut, "{name}: {read} of {cut}")
        } else {
            assert!(read * 4 < cut, "{name}: {read} of {cut}")
        }
    }
}

/// An element of a MAT file.
fn element(kind: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = [kind.to_le_bytes(), (data.len() as u32).to_le_bytes()].concat();
    bytes.extend_from_slice(data);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

/// A MAT file of one matrix with these dimensions, class and further elements.
fn mat(class: u8, dimensions: [u32; 2], further: &[u8]) -> Vec<u8> {
    let mut file = b"MATLAB 5.0 MAT-file".to_vec();
    file.resize(124, b' ');
    file.extend_from_slice(&[0, 1, b'I', b'M']);
    let matrix = [
        element(6, &[class, 0, 0, 0, 0, 0, 0, 0]),
        element(5, dimensions.map(u32::to_le_bytes).as_flattened()),
        element(1, b"t"),
        further.to_vec(),
    ];
    file.extend(element(14, &matrix.concat()));
    file
}

/// A BLF file with this content behind its header.
fn blf(content: &[u8]) -> Vec<u8> {
    let mut file = b"LOGG\x90\0\0\0".to_vec();
    file.resize(144, 0);
    file.extend_from_slice(content);
    file
}

/// An object of a BLF file that states its size.
fn object(kind: u32, size: u32, body: &[u8]) -> Vec<u8> {
    let mut bytes = b"LOBJ\x10\0\x01\0".to_vec();
    bytes.extend(size.to_le_bytes());
    bytes.extend(kind.to_le_bytes());
    bytes.extend_from_slice(body);
    bytes
}

// REQ-INPUT-03
#[test]
fn hostile_binary_logs_are_refused() {
    let dir = TempDir::new().unwrap();
    fs::write(dir.path().join("rig.dbc"), dbc()).unwrap();
    let huge = mat(6, [u32::MAX, u32::MAX], &element(9, &[0; 80]));
    let nested = (0..4000).fold(element(14, &[]), |inner, _| {
        let fields = [element(5, &[8, 0, 0, 0]), element(1, b"a\0\0\0\0\0\0\0")].concat();
        let one = mat(2, [1, 1], &[fields, inner].concat());
        one[128..].to_vec()
    });
    let header = b"MATLAB 5.0 MAT-file".to_vec();
    let nested = [mat(6, [0, 0], &[])[..128].to_vec(), nested].concat();
    let struct_bomb = [element(5, &[8, 0, 0, 0]), element(1, b"")].concat();
    let container = |size: u32, packed: &[u8]| {
        let head = [2_u32.to_le_bytes(), [0; 4], size.to_le_bytes(), [0; 4]].concat();
        let body = [head, packed.to_vec()].concat();
        object(10, 16 + body.len() as u32, &body)
    };
    for (file, content, expected) in [
        ("huge.mat", huge, "with 10 numbers"),
        ("nested.mat", nested, "nested more than 16 times"),
        ("empty.mat", header, "ends within its header"),
        (
            "structs.mat",
            mat(2, [u32::MAX, 7], &struct_bomb),
            "contains no vectors",
        ),
        (
            "object.mat",
            mat(17, [1, 1], &[]),
            "which only MATLAB can read",
        ),
        (
            "new.mat",
            b"MATLAB 7.3 MAT-file, Platform".to_vec(),
            "a MAT file of version 7.3 (HDF5)",
        ),
        ("zero.blf", blf(&object(1, 0, &[])), "an object of 0 bytes"),
        (
            "long.blf",
            blf(&object(1, u32::MAX, &[])),
            "ends in the middle of an object",
        ),
        (
            "bomb.blf",
            blf(&container(u32::MAX, b"x")),
            "a container of 4294967295 bytes",
        ),
        (
            "packed.blf",
            blf(&container(100, b"xyz")),
            "cannot be unpacked",
        ),
        ("none.blf", blf(b"nothing of it is an object"), "no object"),
        ("empty.blf", blf(b""), "contains no message"),
        (
            "short.parquet",
            b"PAR1PAR1".to_vec(),
            "cannot be read as Parquet",
        ),
    ] {
        fs::write(dir.path().join(file), content).unwrap();
        let mut arguments = vec!["import", file, "--out", "c", "--load", "150"];
        arguments.extend(file.ends_with(".blf").then_some("rig.dbc"));
        refused(dir.path(), &arguments, expected);
    }
}
