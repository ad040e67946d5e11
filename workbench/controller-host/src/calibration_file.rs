//! Calibration files: the firmware's calibration in engineering units, as TOML.
//!
//! ```toml
//! format = 1
//! [lift]                       # flow over current at the compensated drop
//! current_a = [1.126, 1.138, ...]
//! flow_lpm  = [0.0, 0.143, ...]
//! [lower]                      # the same at hydraulics.reference_drop_bar
//! [linkage]                    # piston travel at equally spaced rocker angles
//! first_angle_deg = 44.0
//! angle_step_deg  = 2.0
//! travel_mm = [-0.116, ...]
//! [position]                   # and a section for every group of scalars
//! restart_band_mm = 0.6
//! ```
//!
//! Flows of a valve differ by at least 0.25 % of the largest one: each cell of the firmware's inverse map can represent
//! one kink.
//!
//! Missing sections and keys have the values of the nominal calibration, so a file may contain only the differences.
//! Names, units, ranges and reasons of the scalars come from the firmware.

use std::fmt::Write as _;
use std::path::Path;

use hitch_input::input_error::InputError;
use hitch_input::source_file::SourceFile;
use hitch_input::toml_reader::TomlTable;
use hitch_quantities::calibration::linkage::LINKAGE_POINTS;
use hitch_quantities::calibration::parameter::ParameterGroup;
use hitch_quantities::calibration::valve_table::{VALVE_POINTS, ValvePoint, ValveTable};
use hitch_quantities::units::{MicroLitrePerSecond, Micrometre, MilliAmp, MilliDegree};
use hitch_quantities::{Calibration, CalibrationError, ValidCalibration};

/// Version of the file format.
const FORMAT: f64 = 1.0;
/// Microlitres a second in one litre a minute.
const UL_S_PER_LPM: f64 = 1e6 / 60.0;
/// Range of currents in a valve table, A.
const CURRENTS_A: std::ops::RangeInclusive<f64> = 0.0..=5.0;
/// Range of flows in a valve table, l/min.
const FLOWS_LPM: std::ops::RangeInclusive<f64> = 0.0..=600.0;
/// Range of the linkage table's travel, mm.
const TRAVELS_MM: std::ops::RangeInclusive<f64> = -10.0..=2000.0;

/// Calls `$visit` with every group of scalars of a calibration.
macro_rules! with_groups {
    ($calibration:expr, $visit:ident $(, $argument:expr)*) => {
        $visit(&mut $calibration.hydraulics $(, $argument)*)?;
        $visit(&mut $calibration.sensors $(, $argument)*)?;
        $visit(&mut $calibration.lock $(, $argument)*)?;
        $visit(&mut $calibration.operator $(, $argument)*)?;
        $visit(&mut $calibration.motion $(, $argument)*)?;
        $visit(&mut $calibration.position $(, $argument)*)?;
        $visit(&mut $calibration.rate $(, $argument)*)?;
        $visit(&mut $calibration.hold $(, $argument)*)?;
        $visit(&mut $calibration.saturation $(, $argument)*)?;
        $visit(&mut $calibration.teach $(, $argument)*)?;
        $visit(&mut $calibration.current $(, $argument)*)?;
        $visit(&mut $calibration.bus $(, $argument)*)?;
        $visit(&mut $calibration.draft $(, $argument)*)?;
        $visit(&mut $calibration.depth $(, $argument)*)?;
        $visit(&mut $calibration.slip $(, $argument)*)?;
        $visit(&mut $calibration.ride $(, $argument)*)?;
        $visit(&mut $calibration.work $(, $argument)*)?;
        $visit(&mut $calibration.safety $(, $argument)*)?;
    };
}

// Defined below the macro that it uses.
mod key;
mod objection;
mod scalars;
mod setting;
use key::is_exact;
pub use key::key;
use objection::objection;
use scalars::write_scalars;
pub use setting::{Scalar, scalar, set, with_settings};

/// Sections that are not groups of scalars.
const TABLES: [&str; 3] = ["lift", "lower", "linkage"];

/// Reads and validates a calibration file.
///
/// # Errors
/// The first fault, with file, line and column.
pub fn read(path: &Path) -> Result<ValidCalibration, InputError> {
    parse(&SourceFile::read(path)?)
}

/// Parses and validates the text of a calibration file.
///
/// # Errors
/// The first fault, with file, line and column.
pub fn parse(source: &SourceFile) -> Result<ValidCalibration, InputError> {
    let file = TomlTable::parse(source)?;
    let mut calibration = Calibration::nominal();
    let mut sections = vec!["format"];
    sections.extend(TABLES);
    with_groups!(calibration, list_group, &mut sections);
    file.only(&sections)?;
    if file.required_number("format", 0.0..=1e6)? != FORMAT {
        let what = "this format of calibration files is not known";
        return Err(file.error_at("format", what, format!("write format = {FORMAT}")));
    }
    read_valve(&file, "lift", &mut calibration.lift)?;
    read_valve(&file, "lower", &mut calibration.lower)?;
    read_linkage(&file, &mut calibration)?;
    with_groups!(calibration, read_group, &file);
    calibration
        .sealed()
        .validate()
        .map_err(|error| refused(&file, error))
}

/// The text of a complete calibration file, each scalar with its reason.
#[must_use]
pub fn write(calibration: &Calibration) -> String {
    written(calibration, None)
}

/// The same for a tuned calibration: previous values are noted.
#[must_use]
pub fn write_tuned(calibration: &Calibration, before: &Calibration) -> String {
    written(calibration, Some(before))
}

fn written(calibration: &Calibration, before: Option<&Calibration>) -> String {
    let mut text = format!(
        "# Calibration of a hitch controller; see `hitch calibrate --help`.\nformat = {FORMAT}\n"
    );
    write_valve(
        &mut text,
        "lift",
        "flow over current at the compensated drop",
        &calibration.lift,
    );
    write_valve(
        &mut text,
        "lower",
        "flow over current at hydraulics.reference_drop_bar",
        &calibration.lower,
    );
    let linkage = &calibration.linkage;
    let travel: Vec<f64> = linkage
        .travel
        .iter()
        .map(|travel| f64::from(travel.0) / 1e3)
        .collect();
    let _ = write!(
        text,
        "\n# Piston travel at equally spaced rocker angles\n[linkage]\nfirst_angle_deg = {:?}\nangle_step_deg = {:?}\ntravel_mm = {travel:?}\n",
        f64::from(linkage.first_angle.0) / 1e3,
        f64::from(linkage.angle_step.0) / 1e3,
    );
    write_scalars(calibration, before, &mut text);
    text
}

#[allow(
    clippy::unnecessary_wraps,
    reason = "shares its signature with the visitors that can fail"
)]
fn list_group<G: ParameterGroup>(_group: &mut G, names: &mut Vec<&str>) -> Result<(), InputError> {
    names.push(G::NAME);
    Ok(())
}

fn read_group<G: ParameterGroup>(group: &mut G, file: &TomlTable<'_>) -> Result<(), InputError> {
    let Some(section) = file.table(G::NAME)? else {
        return Ok(());
    };
    let keys: Vec<String> = G::INFO.iter().map(key).collect();
    section.only(&keys.iter().map(String::as_str).collect::<Vec<_>>())?;
    for (index, (info, key)) in G::INFO.iter().zip(&keys).enumerate() {
        let counts = f64::from(info.counts_per_unit);
        let range = f64::from(info.min) / counts..=f64::from(info.max) / counts;
        if let Some(value) = section.number(key, range)? {
            if !is_exact(info, value) {
                let what = format!("{key} = {value} is not an integer");
                return Err(section.error_at(
                    key,
                    what,
                    format!("write for example {key} = {value:.0}"),
                ));
            }
            group.set(index, (value * counts).round() as i32);
        }
    }
    Ok(())
}

fn read_valve(file: &TomlTable<'_>, valve: &str, table: &mut ValveTable) -> Result<(), InputError> {
    let Some(section) = file.table(valve)? else {
        return Ok(());
    };
    section.only(&["current_a", "flow_lpm"])?;
    let list = |key, range| {
        section
            .numbers(key, range)?
            .ok_or_else(|| section.missing(key))
    };
    let currents_a = list("current_a", CURRENTS_A)?;
    let flows_lpm = list("flow_lpm", FLOWS_LPM)?;
    if currents_a.len() != flows_lpm.len() || !(2..=VALVE_POINTS).contains(&currents_a.len()) {
        let what = format!(
            "{} currents and {} flows in [{valve}]",
            currents_a.len(),
            flows_lpm.len()
        );
        let hint = format!("give as many flows as currents, 2 to {VALVE_POINTS} of them");
        return Err(section.error_at("flow_lpm", what, hint));
    }
    if let Some(pair) = currents_a
        .windows(2)
        .find(|pair| pair[0] < pair[1] && milli(pair[0]) == milli(pair[1]))
    {
        let what = format!(
            "currents {} and {} of [{valve}] are the same to 1 mA",
            pair[0], pair[1]
        );
        return Err(section.error_at(
            "current_a",
            what,
            "write them at least 1 mA apart, or delete one",
        ));
    }
    *table = ValveTable {
        count: currents_a.len() as u32,
        points: [ValvePoint::default(); VALVE_POINTS],
    };
    for (point, (current_a, flow_lpm)) in table
        .points
        .iter_mut()
        .zip(currents_a.iter().zip(flows_lpm))
    {
        *point = ValvePoint {
            flow: MicroLitrePerSecond((flow_lpm * UL_S_PER_LPM).round() as i32),
            current: MilliAmp(milli(*current_a)),
        };
    }
    Ok(())
}

/// Thousandths, the resolution of tables.
fn milli(value: f64) -> i32 {
    (value * 1e3).round() as i32
}

fn write_valve(text: &mut String, valve: &str, what: &str, table: &ValveTable) {
    let column =
        |value: fn(&ValvePoint) -> f64| table.used().iter().map(value).collect::<Vec<f64>>();
    let currents_a = column(|point| f64::from(point.current.0) / 1e3);
    // Four decimals of l/min are finer than a microlitre per second.
    let flows_lpm = column(|point| (f64::from(point.flow.0) / UL_S_PER_LPM * 1e4).round() / 1e4);
    let _ = write!(
        text,
        "\n# Valve: {what}\n[{valve}]\ncurrent_a = {currents_a:?}\nflow_lpm = {flows_lpm:?}\n"
    );
}

fn read_linkage(file: &TomlTable<'_>, calibration: &mut Calibration) -> Result<(), InputError> {
    let Some(section) = file.table("linkage")? else {
        return Ok(());
    };
    section.only(&["first_angle_deg", "angle_step_deg", "travel_mm"])?;
    let table = &mut calibration.linkage;
    table.first_angle = MilliDegree(milli(
        section.required_number("first_angle_deg", -360.0..=360.0)?,
    ));
    table.angle_step = MilliDegree(milli(
        section.required_number("angle_step_deg", 0.001..=90.0)?,
    ));
    let travels_mm = section
        .numbers("travel_mm", TRAVELS_MM)?
        .ok_or_else(|| section.missing("travel_mm"))?;
    if travels_mm.len() != LINKAGE_POINTS {
        let what = format!("{} travels in [linkage]", travels_mm.len());
        return Err(section.error_at("travel_mm", what, format!("give {LINKAGE_POINTS} of them")));
    }
    for (travel, travel_mm) in table.travel.iter_mut().zip(travels_mm) {
        *travel = Micrometre(milli(travel_mm));
    }
    Ok(())
}

/// The firmware's objection to a calibration, at its position in the file.
fn refused(file: &TomlTable<'_>, error: CalibrationError) -> InputError {
    let (section, what, hint) = objection(error);
    file.error_at(section, what, hint)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(text: &str) -> SourceFile {
        SourceFile {
            path: "c.toml".into(),
            text: text.to_owned(),
        }
    }

    fn fault(text: &str) -> String {
        parse(&source(text)).map_or_else(|error| error.to_string(), |_| "no fault".to_owned())
    }

    #[test]
    fn a_written_calibration_reads_back_the_same() {
        let nominal = Calibration::nominal();
        let read = parse(&source(&write(&nominal))).unwrap();
        assert_eq!(*read, nominal);
    }

    #[test]
    fn a_file_may_hold_just_what_differs() {
        let read = parse(&source("format = 1\n[position]\nrestart_band_mm = 0.7\n")).unwrap();
        assert_eq!(read.position.restart_band, Micrometre(700));
        assert_eq!(read.lift, Calibration::nominal().lift);
    }

    #[test]
    fn faults_say_what_and_where() {
        assert!(fault("[lift]\n").starts_with("c.toml:1:1: the top level has no format"));
        let unit = fault("format = 1\n[position]\nrestart_band_in = 1\n");
        assert!(
            unit.starts_with(
                "c.toml:3:1: unit in is not known, this key has to be restart_band_mm"
            ),
            "{unit}"
        );
        let range = fault("format = 1\n[safety]\nlift_current_limit_a = 50\n");
        assert!(
            range.starts_with("c.toml:3:24: lift_current_limit_a = 50 is out of range"),
            "{range}"
        );
        let order = fault("format = 1\n[lift]\ncurrent_a = [1.0, 0.9]\nflow_lpm = [0, 10]\n");
        assert!(
            order.starts_with("c.toml:2:1: point 2 of [lift] is out of order"),
            "{order}"
        );
        let close = fault(
            "format = 1\n[lift]\ncurrent_a = [1.0, 1.1, 1.2, 3.0]\nflow_lpm = [0, 1, 1.09, 40]\n",
        );
        assert!(
            close.starts_with("c.toml:2:1: point 3 of [lift] is too close to the previous one"),
            "{close}"
        );
        let same =
            fault("format = 1\n[lift]\ncurrent_a = [1.126, 1.1261, 3]\nflow_lpm = [0, 1, 40]\n");
        assert!(
            same.starts_with(
                "c.toml:3:13: currents 1.126 and 1.1261 of [lift] are the same to 1 mA"
            ),
            "{same}"
        );
        let half = fault("format = 1\n[hold]\ncorrections_count = 5.5\n");
        assert!(
            half.starts_with("c.toml:3:21: corrections_count = 5.5 is not an integer"),
            "{half}"
        );
        let crossed = fault("format = 1\n[position]\nlower_limit_deg = 140\n");
        assert!(
            crossed.contains("lower_limit of [position] is not below upper_limit"),
            "{crossed}"
        );
        let count = fault("format = 1\n[lower]\ncurrent_a = [1, 2, 3]\nflow_lpm = [0, 1]\n");
        assert!(
            count.starts_with("c.toml:4:12: 3 currents and 2 flows"),
            "{count}"
        );
    }

    #[test]
    fn no_text_makes_it_panic() {
        let good = write(&Calibration::nominal());
        for end in 0..good.len().min(3_000) {
            let _ = fault(&good[..end]);
        }
        for bad in [
            "format = nan",
            "format = 1\nlift = 3",
            "format = 1\n[lift]\ncurrent_a = []\nflow_lpm = []",
            "\0",
        ] {
            assert_ne!(fault(bad), "no fault", "{bad:?}");
        }
    }
}
