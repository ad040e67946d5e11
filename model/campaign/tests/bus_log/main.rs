//! Tests of runs from logs of a CAN bus: formats, descriptions, and faults.

mod damaged;
mod descriptions;
mod faults;
mod logs;
mod tables;

use std::fmt::Write as _;

use hitch_campaign::Campaign;
use hitch_plant::Channel;
use logs::*;

#[test]
fn the_clock_of_the_ecu_counts_and_not_that_of_the_logger() {
    let run = loaded(MANIFEST, &candump(50));
    assert_eq!(run.time_s.len(), 50);
    for (index, time_s) in run.time_s.iter().enumerate() {
        assert!((time_s - 0.02 * index as f64).abs() < 1e-6, "{time_s}");
    }
    let close = |values: &[f64], expected: f64| {
        assert!(
            values.iter().all(|value| (value - expected).abs() < 1e-6),
            "{values:?}"
        );
    };
    close(&run.lift_current_a, 1.5);
    close(&run.lower_current_a, 0.0);
    close(run.channel(Channel::CylinderPressure).unwrap(), 20.0);
    close(run.channel(Channel::PumpPressure).unwrap(), 35.0);
    let angle_deg = run.channel(Channel::RockerAngle).unwrap();
    assert!((angle_deg[49] - 90.49).abs() < 1e-6, "{}", angle_deg[49]);
    assert_eq!(run.channel(Channel::Flow), None);
}

#[test]
fn every_kind_of_line_of_candump_is_read() {
    let log = format!(
        "(1699999999.5) can0 123#R\n\r\n(1699999999.6) can0 20000004#0000000000000000\n\
         (1699999999.7) can0 7FF#\n(1699999999.8) can0 18FF0000##1001122\n{}",
        candump(20).replace('\n', " R\r\n")
    );
    assert_eq!(loaded(MANIFEST, &log).time_s.len(), 20);
}

#[test]
fn a_log_of_vector_s_gives_the_same_run() {
    let expected = loaded(MANIFEST, &candump(30));
    let manifest = MANIFEST.replace("a.log", "a.ASC");
    for notation in ["absolute", "relative"] {
        let log = asc(30, notation);
        let folder = folder(&[("campaign.toml", &manifest), ("a.ASC", &log)]);
        let run = Campaign::load(folder.path()).unwrap().runs.remove(0);
        assert_eq!(run.channels, expected.channels);
        let apart = run
            .time_s
            .iter()
            .zip(&expected.time_s)
            .map(|(a, b)| (a - b).abs());
        assert!(apart.fold(0.0, f64::max) < 1e-6, "{notation}");
    }
}

#[test]
fn frames_of_other_messages_need_not_be_readable() {
    let others = "(1699999999.5) can0 123#001122334455667788\n(1699999999.6) can0 123#0x1\n\
        (1699999999.7) can0 123##\n(1699999999.8) can0 18FF0000#00 00\n";
    let log = format!("{others}{}", candump(20));
    assert_eq!(loaded(MANIFEST, &log), loaded(MANIFEST, &candump(20)));
    let others = " 0.0 1 123 Rx d 99 00\n 0.0 1 123 Rx d 8 00\n 0.0 CANFD 1 Rx 123 1 0 8 99 00\n";
    let log = asc(20, "absolute").replace("End TriggerBlock\n", others);
    let manifest = MANIFEST.replace("a.log", "a.asc");
    let folder = folder(&[("campaign.toml", &manifest), ("a.asc", &log)]);
    assert_eq!(
        Campaign::load(folder.path()).unwrap().runs[0].time_s.len(),
        20
    );
}

/// Both were written by python-can 4.6.1 from the bus of the ECU while it lowered the hitch.
#[test]
fn logs_of_another_program_are_read() {
    let [log, asc] = [
        include_str!("fixtures/python_can.log"),
        include_str!("fixtures/python_can.asc"),
    ];
    let of_candump = loaded(MANIFEST, log);
    let manifest = MANIFEST.replace("a.log", "a.asc");
    let folder = folder(&[("campaign.toml", &manifest), ("a.asc", asc)]);
    let of_asc = Campaign::load(folder.path()).unwrap().runs.remove(0);
    assert!(of_candump.lower_current_a == of_asc.lower_current_a);
    assert!(of_candump.channels == of_asc.channels);
    let angle_deg = of_candump.channel(Channel::RockerAngle).unwrap();
    let (first_deg, last_deg) = (angle_deg[0], angle_deg[angle_deg.len() - 1]);
    assert!((first_deg - 100.0).abs() < 0.2, "{first_deg}");
    assert!((last_deg - 90.0).abs() < 0.5, "{last_deg}");
    let most_a = of_candump
        .lower_current_a
        .iter()
        .fold(0.0_f64, |most, now| most.max(*now));
    assert!((1.5..3.5).contains(&most_a), "{most_a}");
    let cylinder_bar = of_candump.channel(Channel::CylinderPressure).unwrap();
    assert!((cylinder_bar[0] - 16.8).abs() < 0.5, "{}", cylinder_bar[0]);
}

#[test]
fn another_bus_is_read_by_its_own_description() {
    let dbc = "VERSION \"\"\nBU_: Rig\n\
        BO_ 256 Valves: 8 Rig\n SG_ Lift : 7|16@0- (0.5,0) [0|0] \"mA\" Rig\n SG_ Lower : 16|16@1- (0.5,0) [0|0] \"mA\" Rig\n\
        BO_ 257 Sensors: 8 Rig\n SG_ Which M : 0|8@1+ (1,0) [0|0] \"\" Rig\n SG_ Angle m1 : 8|32@1- (1,0) [0|0] \"rad\" Rig\n \
        SG_ Flow m2 : 8|16@1+ (0.01,-100) [0|0] \"L/min\" Rig\nSIG_VALTYPE_ 257 Angle : 1;\n";
    let manifest = format!(
        "{MANIFEST}[can]\ndbc = \"rig.dbc\"\nchannel = \"can1\"\n[can.signals]\nlift_current_a = \"Valves.Lift\"\n\
         lower_current_a = \"Valves.Lower\"\nrocker_angle_deg = \"Sensors.Angle\"\nflow_lpm = \"Sensors.Flow\"\n"
    );
    let mut log = String::new();
    for index in 0..40 {
        let time_s = f64::from(index) * 0.01;
        let angle: String = 1.5_f32
            .to_le_bytes()
            .map(|byte| format!("{byte:02X}"))
            .concat();
        // 1.5 A in big-endian, -0.5 A in little-endian order; angle and flow alternate, midway between currents.
        let _ = writeln!(
            log,
            "({time_s:.6}) can1 100#0BB818FC\n({time_s:.6}) can0 100#0000"
        );
        let _ = match index % 2 {
            0 => writeln!(log, "({:.6}) can1 101#01{angle}", time_s + 0.004),
            _ => writeln!(log, "({:.6}) can1 101#021027", time_s + 0.004),
        };
    }
    let files = [
        ("campaign.toml", manifest.as_str()),
        ("a.log", &log),
        ("rig.dbc", dbc),
    ];
    let run = Campaign::load(folder(&files).path()).unwrap_or_else(|error| panic!("{error}"));
    let run = &run.runs[0];
    assert!(run.lift_current_a.iter().all(|&current_a| current_a == 1.5));
    assert!(
        run.lower_current_a
            .iter()
            .all(|&current_a| current_a == -0.5)
    );
    let values = |channel| {
        let values = run.channel(channel).unwrap();
        values
            .iter()
            .copied()
            .filter(|value| !value.is_nan())
            .collect::<Vec<f64>>()
    };
    let (angles_deg, flows_lpm) = (values(Channel::RockerAngle), values(Channel::Flow));
    // Each is sampled once per two rows, and has no more values than that in the run.
    assert!(
        (19..=21).contains(&angles_deg.len()),
        "{}",
        angles_deg.len()
    );
    assert!(
        angles_deg
            .iter()
            .all(|angle| (angle - 1.5_f64.to_degrees()).abs() < 1e-6)
    );
    assert!(
        flows_lpm.iter().all(|flow| flow.abs() < 1e-9),
        "{flows_lpm:?}"
    );
}

#[test]
fn what_the_ecu_does_not_know_is_a_dropout() {
    // The angle of the first sample, 0x7148.
    let lost = candump(40).replace("4871", "FFFF");
    let run = loaded(MANIFEST, &lost);
    let angle_deg = run.channel(Channel::RockerAngle).unwrap();
    assert!(angle_deg[0].is_nan());
    assert!(angle_deg[1..].iter().all(|angle| !angle.is_nan()));
}

#[test]
fn two_machines_on_a_bus_are_told_apart() {
    let one = candump(12);
    let both: String = one
        .lines()
        .flat_map(|line| [line.to_owned(), line.replace(MOTION, MOTION_OF_ANOTHER)])
        .map(|line| line + "\n")
        .collect();
    let said = fault_of_log(&both);
    let expected =
        "a.log:2:1: HitchMotion comes from addresses 128 and 129; write source = 128 under [can]";
    assert!(said.starts_with(expected), "{said}");
    let chosen = loaded(&format!("{MANIFEST}[can]\nsource = 128\n"), &both);
    assert_eq!(chosen.channels, loaded(MANIFEST, &one).channels);
    let twice: String = one
        .lines()
        .flat_map(|line| [line.to_owned(), line.replace("can0", "can1")])
        .map(|line| line + "\n")
        .collect();
    let said = fault_of_log(&twice);
    let expected = "a.log:2:1: HitchMotion comes on \"can0\" and on \"can1\"; write channel = \"can0\" under [can]";
    assert!(said.starts_with(expected), "{said}");
    assert_eq!(
        loaded(&format!("{MANIFEST}[can]\nchannel = \"can1\"\n"), &twice)
            .time_s
            .len(),
        12
    );
}

/// A file with arbitrary contents is read or rejected with a message.
#[test]
fn no_log_makes_the_reader_panic() {
    let good = [candump(12), asc(12, "absolute")];
    let mut state = 1_u64;
    let mut random = move |below: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let alphabet: Vec<char> = "0189aFx#().\" \n\r\tRTé-+1e9".chars().collect();
    for round in 0..600 {
        let (name, text) = [("a.log", &good[0]), ("a.asc", &good[1])][round % 2];
        let mut letters: Vec<char> = text.chars().collect();
        for _ in 0..1 + random(4) {
            let at = random(letters.len());
            match random(3) {
                0 => drop(letters.splice(at..at, [alphabet[random(alphabet.len())]])),
                1 => letters[at] = alphabet[random(alphabet.len())],
                _ => letters.truncate(at.max(1)),
            }
        }
        let log: String = letters.into_iter().collect();
        let manifest = MANIFEST.replace("a.log", name);
        let folder = folder(&[("campaign.toml", &manifest), (name, &log)]);
        if let Err(error) = Campaign::load(folder.path()) {
            assert_eq!(error.to_string().lines().count(), 1);
        }
    }
}
