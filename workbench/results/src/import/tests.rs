//! What is assumed, refused and left out.

use hitch_campaign::survey::LogColumn;

use super::{Kind, Mapping, Undetermined};

fn ramp(step: f64, samples: i32) -> Vec<f64> {
    (0..samples).map(|i| step * f64::from(i)).collect()
}

fn column(name: &str, unit: Option<&str>, values: Vec<f64>) -> LogColumn {
    LogColumn {
        name: name.to_owned(),
        unit: unit.map(str::to_owned),
        values,
        ..LogColumn::default()
    }
}

/// A table with times, currents, an angle and two pressures.
fn table() -> Vec<LogColumn> {
    let mut columns = vec![
        column("Time", Some("s"), ramp(0.02, 400)),
        column("Lift Current", Some("A"), ramp(0.005, 400)),
        column("Lower Current", Some("A"), ramp(0.005, 400)),
        column("Rocker Angle", Some("deg"), ramp(0.2, 400)),
        column("Pump Pressure", Some("bar"), ramp(0.1, 400)),
        column("Cylinder Pressure", Some("bar"), ramp(0.1, 400)),
    ];
    for column in &mut columns {
        column.times = Some("Time".to_owned());
    }
    columns
}

fn draft(columns: &[LogColumn], named: &[(&str, &str)]) -> (Mapping, Option<Undetermined>) {
    let named: Vec<(String, String)> = named
        .iter()
        .map(|(channel, source)| ((*channel).to_owned(), (*source).to_owned()))
        .collect();
    Mapping::draft(columns, Kind::Table, &named)
}

fn proposed(columns: &[LogColumn], named: &[(&str, &str)]) -> Mapping {
    let (mapping, untold) = draft(columns, named);
    assert_eq!(untold, None);
    mapping
}

fn refused(columns: &[LogColumn], named: &[(&str, &str)]) -> String {
    let Undetermined { what, hint } = draft(columns, named).1.unwrap();
    format!("{what}; {hint}")
}

fn has(mapping: &Mapping, channel: &str) -> bool {
    mapping.taken.iter().any(|taken| taken.channel == channel)
}

#[test]
fn a_channel_without_a_name_is_left_out() {
    let columns = table();
    assert!(has(&proposed(&columns, &[]), "pump_pressure_bar"));
    let mapping = proposed(&columns, &[("pump_pressure_bar", "")]);
    assert!(!has(&mapping, "pump_pressure_bar"));
    assert!(
        mapping.notes.is_empty(),
        "left out by the user: {:?}",
        mapping.notes
    );
    let said = refused(&columns, &[("lift_current_a", "")]);
    assert!(said.contains("lift_current_a"), "{said}");
}

#[test]
fn a_column_that_cannot_be_used_is_listed_with_its_reason() {
    let mut columns = table();
    columns[4].unit = Some("%".to_owned());
    columns[5].fault = Some("it has texts".to_owned());
    let mapping = proposed(&columns, &[]);
    let notes = mapping
        .notes
        .iter()
        .map(ToString::to_string)
        .collect::<Vec<_>>()
        .join("\n");
    for expected in [
        "left out: \"Pump Pressure\": it is in %; give two points, as in --map pump_pressure_bar=\"Pump Pressure:% ",
        "left out: \"Cylinder Pressure\": it has texts",
    ] {
        assert!(notes.contains(expected), "{notes}");
    }
    let said = refused(
        &columns,
        &[("cylinder_pressure_bar", "Cylinder Pressure:bar")],
    );
    assert!(
        said.starts_with("--map cylinder_pressure_bar=Cylinder Pressure:bar: it has texts"),
        "{said}"
    );
}

#[test]
fn a_position_without_a_unit_is_refused() {
    let mut columns = table();
    columns[3].name = "Rear Hitch Position".to_owned();
    columns[3].unit = None;
    let said = refused(&columns, &[]);
    for expected in [
        "\"Rear Hitch Position\" has no unit",
        "--map rocker_angle_deg=\"Rear Hitch Position:deg\"",
        "--map rocker_angle_deg=\"Rear Hitch Position:% 0=50 100=120\"",
        "--map rocker_angle_deg=",
    ] {
        assert!(said.contains(expected), "{said}");
    }
    assert!(!has(
        &proposed(&columns, &[("rocker_angle_deg", "")]),
        "rocker_angle_deg"
    ));
    let source = "Rear Hitch Position:% 0=50 100=120";
    assert!(has(
        &proposed(&columns, &[("rocker_angle_deg", source)]),
        "rocker_angle_deg"
    ));
    // Without a unit, values that rest on an end are refused; with a unit there is only a note.
    columns[3].name = "Rocker Angle".to_owned();
    columns[3].values = ramp(0.5, 400)
        .iter()
        .map(|value| value.min(100.0))
        .collect();
    assert!(refused(&columns, &[]).contains("has no unit"));
    columns[3].name = "rocker_angle_deg".to_owned();
    assert!(has(&proposed(&columns, &[]), "rocker_angle_deg"));
    columns[3].name = "Rocker Angle".to_owned();
    columns[3].unit = Some("deg".to_owned());
    let notes = proposed(&columns, &[])
        .notes
        .iter()
        .map(ToString::to_string)
        .collect::<Vec<_>>()
        .join("\n");
    assert!(
        notes.contains("assumed: \"Rocker Angle\" is in deg as the log states, though"),
        "{notes}"
    );
    let given = proposed(&columns, &[("rocker_angle_deg", "Rocker Angle:deg")]);
    assert!(given.notes.is_empty(), "{:?}", given.notes);
}

#[test]
fn one_name_in_two_groups_is_refused_with_both() {
    let mut columns = table();
    columns[1].name = "Lift Current @ fast".to_owned();
    columns.push(column("Lift Current @ slow", Some("mA"), ramp(10.0, 40)));
    let said = refused(&columns, &[]);
    for expected in [
        "lift_current_a may be \"Lift Current @ fast\" (A, 400 samples) or \"Lift Current @ slow\" (mA, 40 samples)",
        "--map lift_current_a=\"Lift Current @ slow\"",
    ] {
        assert!(said.contains(expected), "{said}");
    }
    let mapping = proposed(&columns, &[("lift_current_a", "Lift Current @ fast")]);
    assert_eq!(mapping.taken[1].source, "Lift Current @ fast");
    let said = refused(&columns, &[("lift_current_a", "Lift Current")]);
    assert!(
        said.contains("write \"Lift Current @ fast\" or \"Lift Current @ slow\""),
        "{said}"
    );
}

#[test]
fn times_of_another_rate_are_in_the_unit_of_the_first() {
    let mut columns = table();
    let mut slow = column("Time slow", None, ramp(0.2, 40));
    slow.times = Some("Time slow".to_owned());
    columns[4].times = slow.times.clone();
    columns.push(slow);
    let notes = proposed(&columns, &[])
        .notes
        .iter()
        .map(ToString::to_string)
        .collect::<Vec<_>>()
        .join("\n");
    assert!(
        notes.contains("assumed: \"Time slow\" is in s, as \"Time\""),
        "{notes}"
    );
    columns[6].values = ramp(200.0, 40);
    let said = refused(&columns, &[]);
    assert!(
        said.starts_with(
            "the times \"Time slow\" would last 7800.0000 s in s, and \"Time\" 7.9800 s in s"
        ),
        "{said}"
    );
    assert_eq!(draft(&columns, &[("pump_pressure_bar", "")]).1, None);
    columns[6].unit = Some("ms".to_owned());
    assert!(proposed(&columns, &[]).notes.is_empty());
}

#[test]
fn a_channel_whose_times_make_no_run_is_refused() {
    let mut columns = table();
    for column in &mut columns {
        column.times = None;
        column.lasts_s = Some(0.007);
    }
    columns.remove(0);
    let draft = |named: &[(String, String)]| Mapping::draft(&columns, Kind::Channels, named);
    let (_, untold) = draft(&[]);
    let what = untold.unwrap().what;
    assert!(
        what.starts_with("the samples of \"Lift Current\" would last 0.0070 s at 57000.0000 Hz"),
        "{what}"
    );
    let given = ("lift_current_a".to_owned(), "Lift Current:A".to_owned());
    assert_eq!(draft(&[given]).1, None);
}
