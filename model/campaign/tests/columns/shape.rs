//! The shape of a table: its rows, the times of each rate, and equal names.

use hitch_plant::Channel;

use crate::{assert_same, fault, loaded, plain, samples, table};

const PLAIN: &str = "[columns]\ntime_s = \"t:s\"\nlift_current_a = \"up:A\"\nlower_current_a = \"down:A\"\n\
    cylinder_pressure_bar = \"p:bar\"\nrocker_angle_deg = \"phi:deg\"\n";

#[test]
fn rows_have_the_cells_of_the_header_or_names() {
    let text = table("t,up,down,p,phi", ",", plain);
    let (head, rows) = text.split_once('\n').unwrap();
    let named = |name: &dyn Fn(usize) -> String| {
        let rows = rows.lines().enumerate();
        let rows: String = rows
            .map(|(i, row)| format!("{},{row}\n", name(i)))
            .collect();
        format!("{head}\n{rows}")
    };
    for (case, text) in [
        ("numbers", named(&|i| format!("\"{}\"", i + 1))),
        ("keywords", named(&|_| "DATA".to_owned())),
        (
            "empty cells",
            format!("{head}\n{}", rows.replace('\n', ",,\n")),
        ),
        (
            "statistics below",
            format!("{text}\nMean,0.5,0.1,20,60\nMax,1,1,40,90\n\nEnd\n"),
        ),
        (
            "lines below",
            format!("{text}\nEnd of measurement\nSamples: 200\n"),
        ),
    ] {
        assert_same(case, &loaded("bench.csv", text.as_bytes(), PLAIN), 1e-12);
    }
    for (text, expected) in [
        (
            format!("{head}\n{}", rows.replace('\n', ",7\n")),
            "bench.csv:2:1: the row has 6 cells, the header has 5",
        ),
        (
            text.replacen("\n0.02,", "\n0.02,7,", 1),
            "bench.csv:4:1: the row has 6 cells, the header has 5",
        ),
        (
            text.replacen("\n0.02,", "\n", 1),
            "bench.csv:4:1: the row has 4 cells, the header has 5",
        ),
    ] {
        let got = fault(&text, PLAIN);
        assert!(got.starts_with(expected), "{got}");
    }
}

#[test]
fn a_header_may_stand_in_a_comment_of_a_table_with_spaces() {
    let text = table("# t up down p phi", " ", plain);
    assert_same("NumPy", &loaded("bench.csv", text.as_bytes(), PLAIN), 1e-12);
}

#[test]
fn each_column_is_read_at_its_own_times() {
    let own = samples();
    let mut text = "t,up,down,phi,t slow,p\n".to_owned();
    for (i, [t, a, b, _, w]) in own.iter().enumerate() {
        let slow = own.get(10 * i).map(|row| format!("{},{}", row[0], row[3]));
        text += &format!(
            "{t},{a},{b},{w},{}\n",
            slow.unwrap_or_else(|| ",".to_owned())
        );
    }
    let run = loaded("bench.csv", text.as_bytes(), PLAIN);
    let pressure = run.channel(Channel::CylinderPressure).unwrap();
    let angle = run.channel(Channel::RockerAngle).unwrap();
    assert_eq!(run.time_s.len(), own.len());
    for (i, row) in own.iter().enumerate() {
        assert!((angle[i] - row[4]).abs() < 1e-9);
        match i % 10 {
            0 => assert!((pressure[i] - row[3]).abs() < 1e-9, "{i}: {}", pressure[i]),
            _ => assert!(pressure[i].is_nan(), "{i}: {}", pressure[i]),
        }
    }
    // Times without a unit are in that of the assigned ones.
    let in_ms = |cell: &str| match cell.parse::<f64>() {
        Ok(time_s) => (time_s * 1e3).to_string(),
        Err(_) => cell.to_owned(),
    };
    let rows = text.lines().map(|row| {
        let mut cells: Vec<String> = row.split(',').map(str::to_owned).collect();
        cells[0] = in_ms(&cells[0]);
        cells[4] = in_ms(&cells[4]);
        cells.join(",") + "\n"
    });
    let rows: String = rows.collect();
    let slow = loaded("bench.csv", rows.as_bytes(), &PLAIN.replace("t:s", "t:ms"));
    let again = slow.channel(Channel::CylinderPressure).unwrap();
    let is_same =
        |(a, b): (&f64, &f64)| a.is_nan() == b.is_nan() && (a.is_nan() || (a - b).abs() < 1e-9);
    assert!(pressure.iter().zip(again).all(is_same));
    let back = text.replacen(",0.1,", ",0.3,", 1);
    let got = fault(&back, PLAIN);
    assert!(
        got.starts_with("bench.csv:4:") && got.contains("time does not rise"),
        "{got}"
    );
}

#[test]
fn columns_with_equal_names_are_told_apart() {
    let text = table("t,up,down,p,p", ",", plain);
    let columns = PLAIN
        .replace("\"phi:deg\"", "\"p #2:deg\"")
        .replace("\"p:bar\"", "\"p #1:bar\"");
    assert_same(
        "equal",
        &loaded("bench.csv", text.as_bytes(), &columns),
        1e-12,
    );
    let got = fault(&text, &columns.replace("p #1", "p"));
    assert!(
        got.contains("column \"p\" is duplicated; assign p #1 or p #2"),
        "{got}"
    );
}

#[test]
fn labview_writes_times_as_a_column_or_as_a_step() {
    let columns = "[columns]\ntime_s = \"X_Value\"\nlift_current_a = \"up\"\nlower_current_a = \"down\"\n\
        cylinder_pressure_bar = \"p\"\nrocker_angle_deg = \"phi\"\n";
    let lvm = |is_column: bool| {
        let one_or_no = if is_column { "One" } else { "No" };
        let head = format!(
            "LabVIEW Measurement\t\nSeparator\tTab\nX_Columns\t{one_or_no}\nTime\t10:00:00\n***End_of_Header***\t\n\t\n\
             Channels\t4\t\t\t\t\nSamples\t200\t200\t200\t200\t\nTime\t10:00:00\t10:00:00\t10:00:00\t10:00:00\t\n\
             Y_Unit_Label\tA\tA\tbar\tdeg\t\nX0\t0.5\t0.5\t0.5\t0.5\t\nDelta_X\t0.01\t0.01\t0.01\t0.01\t\n\
             ***End_of_Header***\t\t\t\t\t\nX_Value\tup\tdown\tp\tphi\tComment\n"
        );
        let row = |[t, a, b, p, w]: [f64; 5]| {
            let time = if is_column {
                t.to_string()
            } else {
                String::new()
            };
            format!("{time}\t{a}\t{b}\t{p}\t{w}\n")
        };
        head + &samples().into_iter().map(row).collect::<String>()
    };
    // A second recording in the file has a header of its own, and continues.
    for is_column in [true, false] {
        let text = lvm(is_column);
        let (begin, header) = (
            text.find("Channels").unwrap(),
            text.find("Comment\n").unwrap() + 8,
        );
        let half = header + text[header..].match_indices('\n').nth(99).unwrap().0 + 1;
        let second = text[begin..header].replace("\t0.5", "\t1.5");
        let segments = format!("{}\n{second}{}", &text[..half], &text[half..]);
        let [one, two] =
            [&text, &segments].map(|text| loaded("bench.lvm", text.as_bytes(), columns));
        assert_same_times("two headers", &two, &one);
    }
    let column = loaded("bench.lvm", lvm(true).as_bytes(), columns);
    assert_same("a column", &column, 1e-12);
    let mut step = loaded("bench.lvm", lvm(false).as_bytes(), columns);
    assert_eq!(step.time_s[0], 0.5, "X0");
    for time_s in &mut step.time_s {
        *time_s -= 0.5;
    }
    assert_same("a step", &step, 1e-9);
}

fn assert_same_times(case: &str, run: &hitch_campaign::Run, expected: &hitch_campaign::Run) {
    assert_eq!(run.lift_current_a, expected.lift_current_a, "{case}");
    let pairs = run.time_s.iter().zip(&expected.time_s);
    assert!(pairs.clone().all(|(a, b)| (a - b).abs() < 1e-9), "{case}");
    assert_eq!(run.time_s.len(), expected.time_s.len(), "{case}");
}
