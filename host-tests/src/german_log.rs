//! A log as a German logger writes it: semicolons, decimal commas, currents in mA.

/// Header of the log, in the order of the format's columns.
const HEADER: &str = "Zeit [s];Ventil Heben Strom [mA];Ventil Senken Strom [mA];Pumpendruck [bar];Zylinderdruck [bar];\
     Volumenstrom [l/min];Winkel Hubwelle [°]";

/// [`german_log`] with the cylinder pressure as the voltage of its sensor: 0.5 V at 0 bar, 4.5 V at 250 bar.
///
/// # Panics
/// If the shipped log has other columns.
#[must_use]
pub fn german_log_in_volts() -> String {
    let plain = german_log().replace("Zylinderdruck [bar]", "Zylinderdruck [V]");
    let mut lines = plain.lines();
    let mut text = format!("{}\n", lines.next().expect("a header"));
    for line in lines {
        let mut cells: Vec<String> = line.split(';').map(str::to_owned).collect();
        if let Ok(bar) = cells[4].replace(',', ".").parse::<f64>() {
            cells[4] = format!("{:.6}", 0.5 + bar * 4.0 / 250.0).replace('.', ",");
        }
        text += &(cells.join(";") + "\n");
    }
    text
}

/// Two files of one recording, which begins in the middle of a motion, with the log of a whole one behind its rest. The times
/// state no unit, the cylinder pressure is a voltage, and the humidity of the air is no signal of a run.
///
/// # Panics
/// If the shipped log has other columns.
#[must_use]
pub fn german_recording() -> [String; 2] {
    const STEP_S: f64 = 0.02;
    let text = german_log_in_volts();
    let (header, rows) = text.split_once('\n').expect("a header");
    let header = header.replace("Zeit [s]", "Zeit") + ";Luftfeuchte [%]";
    let rows: Vec<&str> = rows
        .lines()
        .map(|row| row.split_once(';').expect("a time").1)
        .collect();
    let middle = rows.len() / 2;
    let recorded: Vec<String> = rows[middle..]
        .iter()
        .chain(&rows)
        .enumerate()
        .map(|(index, row)| {
            let time = format!("{:.2}", STEP_S * index as f64).replace('.', ",");
            format!("{time};{row};45,0\n")
        })
        .collect();
    // The next file begins in the whole motion.
    let (first, second) = recorded.split_at(recorded.len() - middle);
    [first, second].map(|rows| format!("{header}\n{}", rows.concat()))
}

/// The shipped log of a lowering move with 150 kg, as such a log.
///
/// # Panics
/// If the shipped log has other columns.
#[must_use]
pub fn german_log() -> String {
    let own = include_str!("../../workbench/data/demonstration/lower_2.2A_150kg.csv");
    let mut lines = own.lines();
    let names: Vec<&str> = lines.next().expect("a header").split(',').collect();
    assert_eq!(names.len(), HEADER.split(';').count(), "{names:?}");
    assert_eq!(names[1..3], ["lift_current_a", "lower_current_a"]);
    let mut text = format!("{HEADER}\n");
    for line in lines {
        let cells = line.split(',').enumerate().map(|(column, cell)| {
            let value: Option<f64> = cell.parse().ok();
            let scaled = value.map(|value| {
                if column == 1 || column == 2 {
                    1000.0 * value
                } else {
                    value
                }
            });
            scaled.map_or_else(String::new, |value| format!("{value:.4}").replace('.', ","))
        });
        text += &cells.collect::<Vec<_>>().join(";");
        text.push('\n');
    }
    text
}
