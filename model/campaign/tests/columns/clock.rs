//! Clocks that are set back or stand still: no run contains such a step, and a log is cut there.

use falcon_mdf::Mf4Writer;
use hitch_campaign::{Campaign, LogNotes};

use crate::{HEAD, Row, campaign, fault, own_format, samples, write_manifest};

/// The first row behind the step.
const STEP: usize = 120;

/// The samples with this time between the rows around the step, s.
fn set(step_s: f64) -> Vec<Row> {
    let mut rows = samples();
    let later_s = step_s - 0.01;
    rows[STEP..].iter_mut().for_each(|row| row[0] += later_s);
    rows
}

fn own(rows: &[Row]) -> String {
    let text = own_format();
    let head = text.lines().next().unwrap();
    let row = |[t, a, b, p, w]: &Row| format!("{t},{a},{b},{p},{w}\n");
    format!("{head}\n{}", rows.iter().map(row).collect::<String>())
}

fn mdf(rows: &[Row]) -> Vec<u8> {
    let column = |index: usize| rows.iter().map(|row| row[index]).collect::<Vec<f64>>();
    let mut writer = Mf4Writer::new();
    let group = writer.add_group(&column(0)).unwrap();
    let names = ["lift_current_a", "lower_current_a", "cylinder_pressure_bar"];
    for ((index, name), unit) in (1..).zip(names).zip(["A", "A", "bar"]) {
        group.add_channel(name, unit, &column(index)).unwrap();
    }
    let mut bytes = Vec::new();
    writer.write(&mut bytes).unwrap();
    bytes
}

fn notes(file: &str, bytes: &[u8]) -> LogNotes {
    let dir = campaign(file, bytes, "");
    let text = HEAD.replace("FILE", file);
    let model = hitch_model_file::nominal();
    let read = Campaign::uncut(dir.path(), &text, model.linkage());
    read.unwrap_or_else(|error| panic!("{error}")).1.remove(0)
}

#[test]
fn a_step_of_the_clock_is_said_with_its_row() {
    for (step_s, expected) in [
        (-0.5, "its clock goes back from 1.19 s to 0.69 s"),
        (0.0, "its clock stands still from 1.19 s to 1.19 s"),
        (0.5, "its clock jumps from 1.19 s to 1.69 s"),
    ] {
        for (file, bytes, place) in [
            ("a.csv", own(&set(step_s)).into_bytes(), "line 122"),
            ("a.mf4", mdf(&set(step_s)), "row 121"),
        ] {
            if file == "a.mf4" && step_s < 0.0 {
                // The library that writes the file sorts its times.
                continue;
            }
            let LogNotes { steps, cut_off, .. } = notes(file, &bytes);
            assert_eq!((steps.len(), cut_off), (1, None), "{file} {step_s}");
            assert_eq!(steps[0].sample, STEP);
            assert_eq!(steps[0].said, format!("{place}: {expected}"));
        }
    }
    assert_eq!(notes("a.csv", own_format().as_bytes()), LogNotes::default());
}

#[test]
fn a_run_is_on_one_side_of_a_clock_that_was_set_back() {
    let text = own(&set(-0.5));
    let dir = campaign("a.csv", text.as_bytes(), "");
    let got = Campaign::load(dir.path()).unwrap_err().to_string();
    assert!(got.contains("a.csv:122:1: time goes back: 0.69"), "{got}");
    for (part, rows) in [("to_s = 1.19", 0..STEP), ("from_s = 2", STEP..200)] {
        write_manifest(dir.path(), "a.csv", part);
        let run = Campaign::load(dir.path()).unwrap().runs.remove(0);
        let expected: Vec<f64> = samples()[rows].iter().map(|row| row[1]).collect();
        assert_eq!(run.lift_current_a, expected, "{part}");
        assert!(run.time_s.windows(2).all(|pair| pair[1] > pair[0]));
    }
}

#[test]
fn times_with_too_few_digits_are_no_steps() {
    let rounded = samples().into_iter().map(|mut row| {
        row[0] = (row[0] * 10.0).floor() / 10.0;
        row
    });
    let got = fault(own(&rounded.collect::<Vec<Row>>()), "");
    let expected =
        "bench.csv:3:1: time stands still: 0 s after 0 s; export the times with more digits";
    assert_eq!(got, expected);
}
