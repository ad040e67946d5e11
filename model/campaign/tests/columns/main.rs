//! Tests of `[columns]` in `campaign.toml`: logs in foreign formats are read as the same run as in the project's own
//! format.

use std::fs;
use std::path::Path;

use falcon_mdf::{Mf4Writer, WriteCodec};
use hitch_campaign::{Campaign, Run};
use hitch_plant::Channel;
use proptest::prelude::*;
use tempfile::TempDir;

mod clock;
mod cut_off;
mod groups;
mod shape;

const HEAD: &str =
    "format = 1\nname = \"a\"\n[[run]]\nfile = \"FILE\"\nbench = \"hitch\"\nload_kg = 150\n";

/// A sample: time, currents, cylinder pressure, angle.
type Row = [f64; 5];

fn samples() -> Vec<Row> {
    let row = |i: u32| {
        let time_s = f64::from(i) * 0.01;
        [
            time_s,
            (time_s * 3.0).sin().abs(),
            0.002,
            20.0 + time_s,
            60.0 + 10.0 * time_s,
        ]
    };
    (0..200).map(row).collect()
}

fn own_format() -> String {
    let row = |[t, a, b, p, w]: Row| format!("{t},{a},{b},{p},{w}\n");
    let rows: String = samples().into_iter().map(row).collect();
    format!("time_s,lift_current_a,lower_current_a,cylinder_pressure_bar,rocker_angle_deg\n{rows}")
}

fn campaign(file: &str, bytes: &[u8], columns: &str) -> TempDir {
    let dir = TempDir::new().unwrap();
    fs::write(dir.path().join(file), bytes).unwrap();
    write_manifest(dir.path(), file, columns);
    dir
}

fn write_manifest(dir: &Path, file: &str, columns: &str) {
    let head = HEAD.replace("FILE", file);
    fs::write(dir.join("campaign.toml"), format!("{head}\n{columns}")).unwrap();
}

fn loaded(file: &str, bytes: &[u8], columns: &str) -> Run {
    let dir = campaign(file, bytes, columns);
    let mut campaign = Campaign::load(dir.path()).unwrap_or_else(|error| panic!("{error}"));
    campaign.runs.remove(0)
}

fn fault(bytes: impl AsRef<[u8]>, columns: &str) -> String {
    let dir = campaign("bench.csv", bytes.as_ref(), columns);
    let error = match Campaign::load(dir.path()) {
        Ok(_) => "no fault".to_owned(),
        Err(error) => error.to_string(),
    };
    error.replace(&format!("{}/", dir.path().display()), "")
}

fn assert_same(case: &str, run: &Run, rounding: f64) {
    let own = loaded("own.csv", own_format().as_bytes(), "");
    assert_eq!(run.time_s.len(), own.time_s.len(), "{case}");
    let channel = |run: &Run, channel| {
        run.channel(channel)
            .map(<[f64]>::to_vec)
            .unwrap_or_default()
    };
    let pairs = [
        (run.time_s.clone(), own.time_s.clone()),
        (run.lift_current_a.clone(), own.lift_current_a.clone()),
        (run.lower_current_a.clone(), own.lower_current_a.clone()),
        (
            channel(run, Channel::CylinderPressure),
            channel(&own, Channel::CylinderPressure),
        ),
        (
            channel(run, Channel::RockerAngle),
            channel(&own, Channel::RockerAngle),
        ),
    ];
    for (got, expected) in pairs {
        assert_eq!(got.len(), expected.len(), "{case}");
        for (got, expected) in got.iter().zip(&expected) {
            assert!(
                (got - expected).abs() <= rounding,
                "{case}: {got} is not {expected}"
            );
        }
    }
}

/// A table with time, currents, pressure and angle as written by a logger.
fn table(header: &str, mark: &str, cells: impl Fn(Row) -> [String; 5]) -> String {
    let rows = samples()
        .into_iter()
        .map(|row| cells(row).join(mark) + "\n");
    header.to_owned() + "\n" + &rows.collect::<String>()
}

fn plain([t, a, b, p, w]: Row) -> [String; 5] {
    [t, a, b, p, w].map(|value| value.to_string())
}

const GERMAN: &str = r#"
[columns]
time_s = "Zeit"
lift_current_a = "Ventil Heben Strom"
lower_current_a = "Ventil Senken Strom"
cylinder_pressure_bar = "Druck Zylinder"
rocker_angle_deg = "Winkel Hubwelle"
"#;

#[test]
fn a_german_table_in_windows_1252_with_a_row_of_units_is_read() {
    let header = "Prüfstand 3\nMessung: Öl 40 °C;\n\n\
        Zeit;Bemerkung;Ventil Heben Strom;Ventil Senken Strom;Druck Zylinder;Winkel Hubwelle\ns;;mA;mA;MPa;°";
    let text = table(header, ";", |[t, a, b, p, w]| {
        let comma = |value: f64| value.to_string().replace('.', ",");
        let remark = format!("{};läuft", comma(t));
        [
            remark,
            comma(a * 1e3),
            comma(b * 1e3),
            comma(p / 10.0),
            comma(w),
        ]
    });
    let text = text.replace('\n', "\r\n");
    let cp1252: Vec<u8> = text
        .chars()
        .map(|c| u8::try_from(u32::from(c)).unwrap())
        .collect();
    assert_same("cp1252", &loaded("bench.csv", &cp1252, GERMAN), 1e-9);
    let marked = format!("\u{feff}{text}");
    assert_same(
        "UTF-8",
        &loaded("bench.csv", marked.as_bytes(), GERMAN),
        1e-9,
    );
    let utf16: Vec<u8> = marked.encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert_same("UTF-16", &loaded("bench.csv", &utf16, GERMAN), 1e-9);
}

const ENGLISH: &str = r#"
[columns]
time_s = "Timestamp"
lift_current_a = "I lift:mA"
lower_current_a = "I lower"
cylinder_pressure_bar = "p cyl:psi"
rocker_angle_deg = "phi"
"#;

#[test]
fn times_are_dates_clocks_and_epochs_and_units_stand_in_brackets() {
    let header = "Timestamp,I lift,I lower (A),p cyl [whatever],phi [rad]";
    let psi = |bar: f64| bar * 1e5 / 6_894.757_293_168;
    let of = |time: &dyn Fn(f64) -> String| {
        table(header, ",", |[t, a, b, p, w]| {
            let numbers = [a * 1e3, b, psi(p), w.to_radians()].map(|value| value.to_string());
            let [a, b, p, w] = numbers;
            [time(t), a, b, p, w]
        })
    };
    let date = of(&|t| format!("2026-11-21T10:00:{:09.6}+01:00", 4.5 + t));
    let clock = of(&|t| format!("23:59:{:06.3}", 57.0 + t));
    let epoch = of(&|t| format!("{:.3}", 1_795_255_200.0 + t));
    let milliseconds = of(&|t| format!("{}", 1_795_255_200_000.0 + (t * 1e3).round()));
    for (case, text) in [
        ("date", date),
        ("clock", clock),
        ("epoch", epoch),
        ("ms", milliseconds),
    ] {
        assert_same(case, &loaded("bench.csv", text.as_bytes(), ENGLISH), 1e-6);
    }
}

#[test]
fn own_names_are_read_with_any_mark() {
    let own = own_format();
    assert_same(
        "tab",
        &loaded("own.csv", own.replace(',', "\t").as_bytes(), ""),
        0.0,
    );
    let german = own.replace(',', ";").replace('.', ",");
    assert_same("comma", &loaded("own.csv", german.as_bytes(), ""), 0.0);
    // A run in the project's format is read in the same campaign.
    assert_same("own", &loaded("own.csv", own.as_bytes(), ENGLISH), 0.0);
}

#[test]
fn flags_are_dropouts_and_a_row_that_was_cut_short_is_left_out() {
    let header = "Timestamp,I lift,I lower [A],p cyl,phi [deg]";
    let mut text = table(header, ",", |[t, a, b, p, w]| {
        let psi = p * 1e5 / 6_894.757_293_168;
        plain([t, a * 1e3, b, psi, w])
    });
    for flag in ["NaN", "", "OVERLOAD", "--", "#N/A", "inf"] {
        let at = text.find("\n0.5,").unwrap();
        let comma = at + text[at..].rfind_from_end_of_row();
        let row_end = at + 1 + text[at + 1..].find('\n').unwrap();
        let with_flag = format!("{}{flag}{}", &text[..=comma], &text[row_end..]);
        let run = loaded("bench.csv", with_flag.as_bytes(), ENGLISH);
        assert!(
            run.channel(Channel::RockerAngle).unwrap()[50].is_nan(),
            "{flag}"
        );
    }
    text.push_str("2.00,0.1");
    assert_same(
        "cut short",
        &loaded("bench.csv", text.as_bytes(), ENGLISH),
        1e-9,
    );
}

/// Position of the last comma of a row that begins after a line break.
trait LastComma {
    fn rfind_from_end_of_row(&self) -> usize;
}

impl LastComma for str {
    fn rfind_from_end_of_row(&self) -> usize {
        let row = self[1..].lines().next().unwrap();
        1 + row.rfind(',').unwrap()
    }
}

#[test]
fn sensors_are_scaled_by_two_points_and_a_cylinder_by_the_linkage() {
    let columns = r#"
[columns]
time_s = "t:ms"
lift_current_a = "up:A"
lower_current_a = "down:A"
cylinder_pressure_bar = { column = "U", unit = "V", from = [0.5, 4.5], to = [0, 250] }
rocker_angle_deg = "x:mm"
"#;
    let text = table("t|up|down|U|x", "|", |[t, a, b, p, _]| {
        plain([t * 1e3, a, b, 0.5 + p / 62.5, 79.0])
    });
    let run = loaded("bench.csv", text.as_bytes(), columns);
    assert!((run.channel(Channel::CylinderPressure).unwrap()[0] - 20.0).abs() < 1e-9);
    let angle_deg = run.channel(Channel::RockerAngle).unwrap()[0];
    assert!((80.0..100.0).contains(&angle_deg), "{angle_deg}");
}

#[test]
fn faults_have_a_place_and_a_way_out() {
    let text = table("Timestamp,I lift,I lower [A],p cyl,phi [deg]", ",", plain);
    let cases = [
        (
            fault(&text, &ENGLISH.replace("I lift", "I lfit")),
            "bench.csv:1:1: column \"I lfit\" does not exist; [columns] assigns it to lift_current_a; did you mean I lift?",
        ),
        (
            fault(&text, &ENGLISH.replace("\"p cyl:psi\"", "\"p cyl\"")),
            "bench.csv:1:30: \"p cyl\" of cylinder_pressure_bar has no unit",
        ),
        (
            fault(&text, &ENGLISH.replace("time_s", "#")),
            "bench.csv:1:1: no column is assigned to time_s",
        ),
        (
            fault(
                text.replacen("0.002", "0,002", 1)
                    .replacen("0,002", "\"0,002\"", 1),
                ENGLISH,
            ),
            "bench.csv:2:5: \"0,002\" in column \"I lower\" is not a number",
        ),
        (
            fault(text.replacen("0.002", "1000", 1), ENGLISH),
            "bench.csv:2:5: \"1000\" in column \"I lower\" would be lower_current_a = 1000; the range is -10 to 10",
        ),
        (
            fault(text.replacen("\n0.02,", "\nlater,", 1), ENGLISH),
            "bench.csv:4:1: \"later\" is not a time",
        ),
        (
            fault(text.replace("phi", "p cyl"), ENGLISH),
            "bench.csv:1:36: column \"p cyl\" is duplicated",
        ),
        (
            fault(&text, &ENGLISH.replace("\"phi\"", "\"phi:bar\"")),
            "bench.csv:1:1: column \"phi:bar\" does not exist",
        ),
        (
            fault(&text, &ENGLISH.replace("rocker_angle_deg", "angle")),
            "campaign.toml:14:1: key \"angle\" is not known in [columns]",
        ),
        (
            fault(
                &text,
                &ENGLISH.replace("\"phi\"", "{ column = \"phi\", from = [1, 2] }"),
            ),
            "campaign.toml:14:20: [columns.rocker_angle_deg] has no to",
        ),
        (
            fault("a b c\n", ENGLISH),
            "bench.csv: no row contains any of the names",
        ),
    ];
    for (got, expected) in cases {
        assert!(
            got.starts_with(expected),
            "expected {expected}\n     got {got}"
        );
    }
}

const OF_MDF: &str = r#"
[columns]
lift_current_a = "I_lift"
lower_current_a = "I_lower"
cylinder_pressure_bar = "p_cyl"
rocker_angle_deg = "phi"
"#;

fn mdf(codec: Option<WriteCodec>) -> Vec<u8> {
    let column = |index: usize| samples().iter().map(|row| row[index]).collect::<Vec<f64>>();
    let thousand = |values: Vec<f64>| values.iter().map(|value| value * 1e3).collect::<Vec<f64>>();
    let mut writer = Mf4Writer::new();
    if let Some(codec) = codec {
        writer.set_compression(true);
        writer.set_codec(codec);
    }
    let group = writer.add_group(&column(0)).unwrap();
    group
        .add_channel("I_lift", "mA", &thousand(column(1)))
        .unwrap();
    group
        .add_channel("I_lower", "mA", &thousand(column(2)))
        .unwrap();
    group.add_channel("p_cyl", "bar", &column(3)).unwrap();
    // Sampled twice as fast as the rest.
    let times: Vec<f64> = (0..400).map(|i| f64::from(i) * 0.005).collect();
    let angles: Vec<f64> = times
        .iter()
        .map(|t| (60.0 + 10.0 * t).to_radians())
        .collect();
    let group = writer.add_group(&times).unwrap();
    group.add_channel("phi", "rad", &angles).unwrap();
    let mut bytes = Vec::new();
    writer.write(&mut bytes).unwrap();
    bytes
}

#[test]
fn mdf_is_read_compressed_or_not_and_at_several_rates() {
    for codec in [
        None,
        Some(WriteCodec::Deflate),
        Some(WriteCodec::TransposedDeflate),
    ] {
        assert_same(
            &format!("{codec:?}"),
            &loaded("log.mf4", &mdf(codec), OF_MDF),
            1e-9,
        );
    }
}

#[test]
fn mdf_is_refused_with_the_true_reason() {
    let of_mdf = |name: &str, bytes: &[u8], columns: &str| {
        let dir = campaign(name, bytes, columns);
        Campaign::load(dir.path()).unwrap_err().to_string()
    };
    let whole = mdf(Some(WriteCodec::Deflate));
    let said = of_mdf("log.mf4", &whole, &OF_MDF.replace("I_lift", "I_left"));
    assert!(
        said.contains("channel \"I_left\" does not exist") && said.contains("did you mean I_lift"),
        "{said}"
    );
    let said = of_mdf("log.mf4", &whole, "");
    assert!(
        said.contains("no channel is assigned to lift_current_a"),
        "{said}"
    );
    let said = of_mdf("log.mf4", b"time_s,lift_current_a\n\0", "");
    assert!(said.contains("is a binary file, not text"), "{said}");
    for length in (0..whole.len()).step_by(37) {
        let said = of_mdf("log.mf4", &whole[..length], OF_MDF);
        assert_eq!(said.lines().count(), 1, "{length}: {said}");
    }
}

#[test]
fn logs_are_read_where_they_are() {
    let logs = TempDir::new().unwrap();
    let log = logs.path().join("own.csv");
    fs::write(&log, own_format()).unwrap();
    let dir = logs.path().join("campaign");
    fs::create_dir(&dir).unwrap();
    for file in [log.display().to_string(), "../own.csv".to_owned()] {
        write_manifest(&dir, &file.replace('\\', "/"), "");
        let run = Campaign::load(&dir).unwrap().runs.remove(0);
        assert_same(&file, &run, 0.0);
    }
}

#[test]
fn a_run_may_have_columns_of_its_own() {
    let text = table("t,up,down,p,phi", ",", plain);
    let columns = "[run.columns]\ntime_s = \"t:s\"\nlift_current_a = \"up:A\"\nlower_current_a = \"down:A\"\n\
        cylinder_pressure_bar = \"p:bar\"\nrocker_angle_deg = \"phi:deg\"\n";
    assert_same("own", &loaded("bench.csv", text.as_bytes(), columns), 1e-12);
}

/// The number of cases of a property: few by day, many with `HITCH_THOROUGH`.
fn cases(few: u32, many: u32) -> u32 {
    match std::env::var_os("HITCH_THOROUGH") {
        Some(_) => many,
        None => few,
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(128, 16_384), failure_persistence: None, ..ProptestConfig::default() })]

    /// A log with arbitrary changes of its bytes is either read or rejected with a message of one line.
    #[test]
    fn mutations_never_panic(
        in_mdf in any::<bool>(),
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let (file, mut bytes, columns) = if in_mdf { ("log.mf4", mdf(Some(WriteCodec::TransposedDeflate)), OF_MDF) } else { ("bench.csv", table("Timestamp,I lift,I lower [A],p cyl,phi [deg]", ",", plain).into_bytes(), ENGLISH) };
        for (place, byte) in edits {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        let dir = campaign(file, &bytes, columns);
        if let Err(error) = Campaign::load(dir.path()) {
            prop_assert_eq!(error.to_string().lines().count(), 1, "{}", error);
        }
    }
}
