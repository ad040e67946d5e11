//! The ECU's bus, used by third-party programs: python-can, cantools, can-j1939 and pyxcp.
//!
//! Each script runs with its own ECU: the firmware's application with plant and operator, its bus on a TCP port. The
//! packages are installed once, under the target folder; without Python or network these tests are skipped with a
//! message, except in continuous integration (`CI` is set).

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use hitch_campaign::{Campaign, Run};
use hitch_ecu_host::ecu::slcan_server::SlcanServer;
use hitch_ecu_host::ecu::{CutFlash, EcuMachine, Emulator, FLASH_BYTES, OnHost, find_image};
use hitch_plant::Channel;
use host_tests::live_ecu::{self, Operator};
use host_tests::program::hitch;
use host_tests::python::{installed, run, scripts};

/// The Python that has the packages, or nothing on a machine where that may be.
fn installed_python() -> Option<&'static Path> {
    static PYTHON: OnceLock<Option<PathBuf>> = OnceLock::new();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let python = PYTHON.get_or_init(|| installed("requirements.txt", folder));
    python.as_deref()
}

/// Runs a script with the ECU of `start`; its output has to contain `expected`.
fn client<M: EcuMachine>(
    script: &str,
    start: impl FnOnce() -> M + Send,
    operator: Operator,
    expected: &[&str],
) {
    run_client(&[script], start, operator, expected);
}

/// The same for a script with further arguments. Returns the lowest and the highest rocker angle of the plant, degree;
/// nothing if the script was not run.
pub fn run_client<M: EcuMachine>(
    script: &[&str],
    start: impl FnOnce() -> M + Send,
    operator: Operator,
    expected: &[&str],
) -> Option<[f64; 2]> {
    let python = installed_python()?;
    let [script, arguments @ ..] = script else {
        panic!("no script");
    };
    let server = SlcanServer::open("127.0.0.1:0").unwrap();
    let bus = server.address().unwrap().to_string();
    let done = AtomicBool::new(false);
    let (said, travelled_deg) = std::thread::scope(|scope| {
        let ecu = scope.spawn(|| live_ecu::run(&mut start(), server, operator, &done));
        let firmware = Path::new(env!("CARGO_MANIFEST_DIR")).join("../firmware");
        let mut command = Command::new(python);
        let command = command.arg(scripts().join(script)).arg(&bus).arg(firmware);
        let command = command.args(arguments);
        // Log files and byte code don't belong among the sources.
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
        let command = command.current_dir(folder);
        let said = run(command.env("PYTHONPYCACHEPREFIX", folder.join("python-cache")));
        done.store(true, Ordering::Relaxed);
        (said, ecu.join().unwrap())
    });
    let said = said.unwrap_or_else(|reason| panic!("{reason}"));
    println!("{said}");
    for line in expected {
        assert!(
            said.contains(line),
            "{script} didn't come to \"{line}\":\n{said}"
        );
    }
    Some(travelled_deg)
}

/// The application on the host. Its flash is blank, so it uses the factory calibration and reports it.
fn here() -> OnHost {
    OnHost::start(CutFlash::blank())
}

const SESSION: [&str; 6] = [
    "identity: ",
    "parameters: ",
    "pages: ",
    "checksum: ",
    "stored",
    "measured: ",
];

#[test]
fn an_implement_reads_the_status_by_the_dbc_and_commands_the_hitch() {
    let expected = [
        "status: ",
        "remote: consented",
        "remote: at ",
        "remote: timed out",
    ];
    client("hitch_messages.py", here, Operator::Present, &expected);
}

#[test]
fn logs_of_the_bus_are_runs() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bus-logs");
    fs::create_dir_all(&folder).unwrap();
    let expected = ["logged: "];
    client("log_bus.py", here, Operator::Working, &expected);
    if installed_python().is_none() {
        return;
    }
    let manifest = "format = 1\n[[run]]\nfile = \"run.log\"\nbench = \"hitch\"\nload_kg = 150\n\
         [[run]]\nfile = \"run.asc\"\nbench = \"hitch\"\nload_kg = 150\n";
    fs::write(folder.join("campaign.toml"), manifest).unwrap();
    let campaign = Campaign::load(&folder).unwrap_or_else(|error| panic!("{error}"));
    let [candump, asc] = &campaign.runs[..] else {
        panic!("two runs");
    };
    for run in [candump, asc] {
        // By the ECU's clock, not one sample is missing, whatever the logger's computer did meanwhile.
        let even = run
            .time_s
            .windows(2)
            .all(|two| (two[1] - two[0] - 0.02).abs() < 1e-6);
        assert!(even && run.time_s.len() > 100, "{:?}", run.time_s);
        let angle_deg = run.channel(Channel::RockerAngle).unwrap();
        let ends_deg = angle_deg
            .iter()
            .fold([f64::MAX, f64::MIN], |[low, high], now| {
                [low.min(*now), high.max(*now)]
            });
        let moved_deg = ends_deg[1] - ends_deg[0];
        assert!((9.0..11.0).contains(&moved_deg), "{moved_deg}");
        let flowed = |current_a: &[f64]| current_a.iter().any(|now| *now > 1.2);
        assert!(flowed(&run.lift_current_a) || flowed(&run.lower_current_a));
        assert!(run.channel(Channel::CylinderPressure).is_some());
        assert!(run.channel(Channel::PumpPressure).is_some());
    }
    let angle = |run: &Run| run.channel(Channel::RockerAngle).map(<[f64]>::to_vec);
    assert!(candump.lift_current_a == asc.lift_current_a && angle(candump) == angle(asc));
}

/// The example of the README, with its own ECU.
#[test]
fn a_gain_is_tuned_while_the_hitch_moves() {
    let Some(python) = installed_python() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/tune_live.py");
    let mut command = Command::new(python);
    let command = command.arg(example).arg(hitch().get_program());
    let said = run(command.arg("--host").current_dir(folder.path()));
    let said = said.unwrap_or_else(|reason| panic!("{reason}"));
    println!("{said}");
    assert_eq!(said.matches("within 0.5 deg after").count(), 3, "{said}");
    assert!(folder.path().join("tuning.svg").exists());
}

#[test]
fn another_node_takes_the_address_and_reads_trouble_codes() {
    let expected = [
        "DM1 by broadcast",
        "address: 0x80 was lost, 0x81 claimed",
        "request: refused",
        "DM1 by connection",
        "software: ",
    ];
    client(
        "j1939_network.py",
        here,
        Operator::LeverUnplugged,
        &expected,
    );
}

#[test]
fn a_calibration_tool_finds_everything_by_the_a2l() {
    client("xcp_session.py", here, Operator::Away, &SESSION);
}

#[test]
#[ignore = "needs the ARM image: run by `cargo xtask test`"]
fn the_emulated_ecu_is_tuned_like_the_one_here() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("flash"), vec![u8::MAX; FLASH_BYTES]).unwrap();
    let emulated = || {
        let image = find_image(None).unwrap();
        Emulator::start(&image, folder.path()).unwrap()
    };
    client("xcp_session.py", emulated, Operator::Away, &SESSION);
}
