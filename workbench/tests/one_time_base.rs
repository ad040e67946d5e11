//! Channels that a writer put on the time base of faster ones count as the samples that they have.

use std::fs;
use std::path::Path;
use std::process::Command;

/// Rows from one sample to the next.
const RATIO: usize = 4;
/// The channels of the lower rate: pressures and flow.
const SLOW: std::ops::Range<usize> = 3..6;

/// A log whose slow channels are written by `between`: from a sample, the next one and the part of the way to it.
fn resampled(log: &str, between: fn(f64, f64, f64) -> f64) -> String {
    let (head, rows) = log.split_once('\n').unwrap();
    let cells: Vec<Vec<&str>> = rows.lines().map(|row| row.split(',').collect()).collect();
    let mut text = format!("{head}\n");
    for (row, own) in cells.iter().enumerate() {
        let first = row / RATIO * RATIO;
        let next = (first + RATIO).min(cells.len() - 1);
        let part = (row - first) as f64 / (next - first).max(1) as f64;
        let cell = |column: usize| {
            let value = |row: usize| cells[row].get(column)?.parse::<f64>().ok();
            let both = value(first)
                .zip(value(next))
                .filter(|_| SLOW.contains(&column));
            both.map_or_else(
                || own[column].to_owned(),
                |(from, to)| format!("{:.3}", between(from, to, part)),
            )
        };
        let row: Vec<String> = (0..own.len()).map(cell).collect();
        text += &(row.join(",") + "\n");
    }
    text
}

/// The error that `hitch compare` states, and the samples of the cylinder pressure.
fn compared(folder: &Path) -> (f64, f64) {
    let output = Command::new(env!("CARGO_BIN_EXE_hitch"))
        .args(["compare", "--json", "-"])
        .arg(folder)
        .output()
        .expect("it starts");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let number = |text: &str, key: &str| -> f64 {
        let (_, rest) = text.split_once(&format!("\"{key}\": ")).expect(key);
        let end = rest.find([',', '\n']).unwrap();
        rest[..end].parse().expect(key)
    };
    let (_, cylinder) = text.split_once("\"cylinder_pressure_bar\"").expect("it");
    (number(&text, "error"), number(cylinder, "samples"))
}

#[test]
fn a_copy_on_one_time_base_has_the_error_of_its_samples() {
    let demonstration = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/demonstration");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("one-time-base");
    fs::create_dir_all(&folder).unwrap();
    // Only the samples, as a table with dropouts: what the copies have to lead to.
    let writers: [fn(f64, f64, f64) -> f64; 3] = [
        |from, _, part| if part > 0.0 { f64::NAN } else { from },
        |from, _, _| from,
        |from, to, part| from + part * (to - from),
    ];
    let [samples, held, lines] = writers.map(|between| {
        for file in fs::read_dir(&demonstration).unwrap() {
            let path = file.unwrap().path();
            let mut text = fs::read_to_string(&path).unwrap();
            if path.extension().is_some_and(|end| end == "csv") {
                text = resampled(&text, between).replace("NaN", "");
            }
            fs::write(folder.join(path.file_name().unwrap()), text).unwrap();
        }
        compared(&folder)
    });
    for copy in [held, lines] {
        assert!(
            (copy.0 / samples.0 - 1.0).abs() < 0.03,
            "{copy:?} {samples:?}"
        );
        assert!(
            (copy.1 / samples.1 - 1.0).abs() < 0.01,
            "{copy:?} {samples:?}"
        );
    }
}
