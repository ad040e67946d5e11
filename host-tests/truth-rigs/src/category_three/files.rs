//! The data sheets and the logs of the machine as files.

use std::fmt::Write as _;
use std::path::Path;
use std::{fs, io};

use super::compressed_mdf::{self, Group};
use super::machine::{LIFT_CURVE, LOWER_CURVE, STROKE_M, Wear, angle_deg, height_m};
use super::working_day::{Sample, log};

/// Points of the linkage's drawing.
const LINKAGE_POINTS: u32 = 20;

/// Writes the data sheets and the logs to a folder: valve curves and linkage as CSV, three logs of the tractor's logger
/// as MDF, and one of the workshop's logger as a German table.
///
/// # Errors
/// If a file cannot be written.
pub fn write(folder: &Path) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    let file = |name: &str| folder.join(name);
    fs::write(file("lift_valve.csv"), curve(&LIFT_CURVE))?;
    fs::write(file("lowering_valve.csv"), curve(&LOWER_CURVE))?;
    fs::write(file("linkage.csv"), linkage())?;
    let new = [("new_400kg.mf4", 400.0, 1), ("new_2000kg.mf4", 2000.0, 2)];
    for (name, load_kg, seed) in new {
        fs::write(file(name), mdf(&log(load_kg, Wear::New, seed)))?;
    }
    fs::write(file("worn_2000kg.mf4"), mdf(&log(2000.0, Wear::Worn, 3)))?;
    fs::write(file("worn_1200kg.csv"), german(&log(1200.0, Wear::Worn, 4)))
}

fn curve(points: &[(f64, f64)]) -> String {
    let rows = points.iter().map(|(ma, gpm)| format!("{ma:.0},{gpm}\n"));
    format!("Current [mA],Flow [gpm]\n{}", rows.collect::<String>())
}

fn linkage() -> String {
    let row = |point: u32| {
        let share = f64::from(point) / f64::from(LINKAGE_POINTS);
        format!(
            "{:.1},{:.3},{:.2}\n",
            1e3 * share * STROKE_M,
            angle_deg(share),
            1e3 * height_m(share)
        )
    };
    let rows: String = (0..=LINKAGE_POINTS).map(row).collect();
    format!("travel_mm,angle_deg,height_mm\n{rows}")
}

/// Currents and pressures in one group of channels, the angle in another.
fn mdf(samples: &[Sample]) -> Vec<u8> {
    let column = |index: usize, unit: f64| samples.iter().map(move |s| s[index] * unit).collect();
    compressed_mdf::bytes(&[
        Group {
            time_s: column(0, 1.0),
            channels: vec![
                ("LiftValveCurrent", "mA", column(1, 1e3)),
                ("LowerValveCurrent", "mA", column(2, 1e3)),
                ("CylinderPressure", "kPa", column(3, 100.0)),
                ("PumpPressure", "kPa", column(4, 100.0)),
            ],
        },
        Group {
            time_s: column(0, 1.0),
            channels: vec![("RockerAngle", "rad", column(5, 1f64.to_radians()))],
        },
    ])
}

/// Semicolons, decimal commas, a title, a row of units, Windows-1252.
fn german(samples: &[Sample]) -> Vec<u8> {
    let mut text = "Halle 3, Prüfer: Groß;;;;;\r\n\
        Zeit;Ventil Heben Strom;Ventil Senken Strom;Druck Zylinder;Druck Pumpe;Winkel Hubwelle\r\n\
        s;mA;mA;bar;bar;°\r\n"
        .to_owned();
    for [time_s, lift_a, lower_a, cylinder_bar, pump_bar, angle_deg] in samples {
        let (lift_ma, lower_ma) = (1e3 * lift_a, 1e3 * lower_a);
        let mut row = String::new();
        // Writing to a string cannot fail.
        let _ = write!(
            row,
            "{time_s:.2};{lift_ma:.1};{lower_ma:.1};{cylinder_bar:.2};{pump_bar:.2};{angle_deg:.3}\r\n"
        );
        text += &row.replace('.', ",");
    }
    let latin = |c: char| u8::try_from(u32::from(c)).unwrap_or(b'?');
    text.chars().map(latin).collect()
}
