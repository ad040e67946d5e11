//! `hitch controller` with an external plant: a process with a line in and a line out for each step.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Stdio};

use hitch_controller_host::calibration_file;
use host_tests::program::hitch;

const HEADER: &str = "time_s,lever_deg,rocker_angle_deg";

/// The program with both ends of its pipes.
struct ControllerProcess {
    child: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
}

impl ControllerProcess {
    fn open(header: &str) -> Self {
        Self::open_with(header, &[])
    }

    fn open_with(header: &str, options: &[&str]) -> Self {
        let (controller, answer) = Self::answered(header, options);
        assert_eq!(answer, "lift_current_a,lower_current_a,state");
        controller
    }

    /// The process, and its answer to the header.
    fn answered(header: &str, options: &[&str]) -> (Self, String) {
        let mut command = hitch();
        let command = command
            .arg("controller")
            .args(options)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let input = child.stdin.take();
        let output = BufReader::new(child.stdout.take().unwrap());
        let mut controller = Self {
            child,
            input,
            output,
        };
        controller.send(header);
        let answer = controller.answer();
        (controller, answer)
    }

    fn send(&mut self, line: &str) {
        let input = self.input.as_mut().unwrap();
        writeln!(input, "{line}")
            .and_then(|()| input.flush())
            .unwrap();
    }

    fn answer(&mut self) -> String {
        let mut line = String::new();
        self.output.read_line(&mut line).unwrap();
        line.trim_end().to_owned()
    }

    /// Closes the input; returns exit code and standard error.
    fn close(mut self) -> (Option<i32>, String) {
        drop(self.input.take());
        let output = self.child.wait_with_output().unwrap();
        (
            output.status.code(),
            String::from_utf8(output.stderr).unwrap(),
        )
    }
}

/// An external hitch: linear valves with other thresholds, a lag of 60 ms, angle proportional to the integral of the
/// flow.
struct Toy {
    controller: ControllerProcess,
    step: u32,
    lift_a: f64,
    lower_a: f64,
    angle_deg: f64,
}

impl Toy {
    fn new(angle_deg: f64) -> Self {
        Self {
            controller: ControllerProcess::open(HEADER),
            step: 0,
            lift_a: 0.0,
            lower_a: 0.0,
            angle_deg,
        }
    }

    /// One millisecond; the state, and whether a coil was on.
    fn step(&mut self, lever_deg: f64) -> (String, bool) {
        let line = format!(
            "{:.3},{lever_deg},{:.4}",
            f64::from(self.step) * 1e-3,
            self.angle_deg
        );
        self.controller.send(&line);
        let answer = self.controller.answer();
        let cells: Vec<&str> = answer.split(',').collect();
        let [lift, lower, state] = cells[..] else {
            panic!("{answer:?}")
        };
        let (lift_a, lower_a): (f64, f64) = (lift.parse().unwrap(), lower.parse().unwrap());
        self.lift_a += (lift_a - self.lift_a) / 60.0;
        self.lower_a += (lower_a - self.lower_a) / 60.0;
        let rate = 45.0 * (self.lift_a - 1.2).max(0.0) - 70.0 * (self.lower_a - 1.1).max(0.0);
        self.angle_deg = (self.angle_deg + rate * 1e-3).clamp(44.1, 135.9);
        self.step += 1;
        (state.to_owned(), lift_a > 0.0 || lower_a > 0.0)
    }
}

#[test]
fn another_plant_is_moved_through_the_door() {
    let mut toy = Toy::new(90.0);
    for _ in 0..500 {
        assert_eq!(toy.step(70.0), ("locked".to_owned(), false));
    }
    // The operator picks the hitch up: through its angle, and back onto it.
    toy.step(91.0);
    for _ in 0..1_000 {
        toy.step(90.0);
    }
    for target_deg in [110.0, 75.0, 80.0] {
        for _ in 0..3_000 {
            toy.step(target_deg);
        }
        assert!(
            (toy.angle_deg - target_deg).abs() <= 0.5,
            "{} for {target_deg}",
            toy.angle_deg
        );
        assert!(
            (0..2_000).all(|_| !toy.step(target_deg).1),
            "hunts at {target_deg}"
        );
    }
    assert_eq!(toy.controller.close(), (Some(0), String::new()));
}

/// A hitch whose valves open at 1.2 A and 1.1 A and whose ends are a degree higher than the linkage says, with a
/// sensor's noise; the mechanic's hand is on button and switch or isn't.
fn step_taught(
    controller: &mut ControllerProcess,
    toy: &mut (u32, [f64; 2], f64),
    lever_deg: f64,
    hand: bool,
) -> String {
    let (step, [lift_a, lower_a], angle_deg) = toy;
    let noise_deg = f64::from(*step * 7919 % 41) * 1e-3 - 0.02;
    let hand = if hand { "5,1" } else { ",0" };
    controller.send(&format!(
        "{:.3},{lever_deg},{:.4},{hand}",
        f64::from(*step) * 1e-3,
        *angle_deg + noise_deg
    ));
    let answer = controller.answer();
    let cells: Vec<&str> = answer.split(',').collect();
    *lift_a += (cells[0].parse::<f64>().unwrap() - *lift_a) / 45.0;
    *lower_a += (cells[1].parse::<f64>().unwrap() - *lower_a) / 45.0;
    let rate = 45.0 * (*lift_a - 1.2).max(0.0) - 30.0 * (*lower_a - 1.1).max(0.0);
    *angle_deg = (*angle_deg + rate * 1e-3).clamp(45.1, 136.9);
    *step += 1;
    cells[2].to_owned()
}

/// Time for which the button is seen released before a press counts, ms.
const RELEASED_MS: u32 = 20;

fn release(controller: &mut ControllerProcess, toy: &mut (u32, [f64; 2], f64)) {
    for _ in 0..RELEASED_MS {
        assert_eq!(step_taught(controller, toy, 60.0, false), "locked");
    }
}

#[test]
fn a_machine_is_taught_over_stdin_and_keeps_the_result() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("taught.toml");
    let mut controller = ControllerProcess::open_with(
        &format!("{HEADER},jog_deg_per_s,teach"),
        &["--out", file.to_str().unwrap()],
    );
    let mut toy = (0, [0.0; 2], 90.0);
    release(&mut controller, &mut toy);
    let state = (0..60_000)
        .map(|_| step_taught(&mut controller, &mut toy, 60.0, true))
        .find(|state| state != "teaching");
    assert_eq!(state.as_deref(), Some("taught"));
    assert!(!file.exists(), "nobody has let go yet");
    assert_eq!(
        step_taught(&mut controller, &mut toy, 60.0, false),
        "locked"
    );
    let found = calibration_file::read(&file).unwrap();
    for (table, opens_ma) in [(&found.lift, 1_200), (&found.lower, 1_100)] {
        let error_ma = (table.threshold().0 - opens_ma).abs();
        assert!(error_ma <= 40, "{opens_ma} mA: {error_ma} off");
    }
    let lower_limit = found.position.lower_limit.0;
    assert!((lower_limit - 45_600).abs() <= 50, "{lower_limit}");
    // It continues with the result: the lever at its bottom stop moves the hitch to the new limit.
    for lever_deg in [60.0, 40.0, 90.0, 40.0] {
        (0..3_000).for_each(|_| {
            step_taught(&mut controller, &mut toy, lever_deg, false);
        });
    }
    assert!((toy.2 - 45.6).abs() <= 0.4, "{}", toy.2);
    assert_eq!(controller.close(), (Some(0), String::new()));
}

#[test]
fn who_lets_go_too_soon_has_taught_nothing() {
    let mut controller = ControllerProcess::open(&format!("{HEADER},jog_deg_per_s,teach"));
    let mut toy = (0, [0.0; 2], 90.0);
    release(&mut controller, &mut toy);
    for _ in 0..2_000 {
        assert_eq!(
            step_taught(&mut controller, &mut toy, 60.0, true),
            "teaching"
        );
    }
    assert_eq!(
        step_taught(&mut controller, &mut toy, 60.0, false),
        "locked"
    );
    assert_eq!(controller.close(), (Some(0), String::new()));
}

#[test]
fn a_missing_angle_is_a_fault_and_not_an_error() {
    let mut controller = ControllerProcess::open(HEADER);
    let answers: Vec<String> = (0..10)
        .map(|step| {
            controller.send(&format!("{:.3},90,", f64::from(step) * 1e-3));
            controller.answer()
        })
        .collect();
    assert_eq!(
        answers.last().map(String::as_str),
        Some("0.000,0.000,fault:angle")
    );
    assert_eq!(controller.close().0, Some(0));
}

#[test]
fn draft_reason_and_lost_sensor_are_answered_where_the_columns_are() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fitted.toml");
    let fitted = hitch_results::field_loop::pass::fitted_with(|calibration| {
        calibration.slip.highest_limit.0 = 0;
        calibration.work.angle.0 = 95_000;
    });
    std::fs::write(&path, calibration_file::write(&fitted)).unwrap();
    let header = [
        HEADER,
        "left_draft_pin_percent,right_draft_pin_percent,draft_set_point_n,function_code",
    ]
    .join(",");
    let (mut controller, answer) =
        ControllerProcess::answered(&header, &["--calibration", path.to_str().unwrap()]);
    assert_eq!(
        answer,
        "lift_current_a,lower_current_a,state,target_deg,draft_n,set_point_reason,lost_sensor,in_work,time_until_work_s"
    );
    let mut step = 0;
    let mut last = |lever_deg: f64, pins: [f64; 2], steps: u32| {
        let mut cells = Vec::new();
        for _ in 0..steps {
            // The last digit of a healthy pin changes.
            let [left, right] = pins.map(|pin| pin + f64::from(step % 3) * 1e-3);
            let time_s = f64::from(step) * 1e-3;
            controller.send(&format!(
                "{time_s:.3},{lever_deg},90,{left},{right},20000,1"
            ));
            cells = controller.answer().split(',').map(str::to_owned).collect();
            step += 1;
        }
        cells[3..].join(",")
    };
    last(80.0, [56.25; 2], 50);
    last(90.2, [56.25; 2], 50);
    // In the soil, with the lever through the angle, and near enough that nothing has to move: twice 6.25 % of 25 % at 40 kN.
    let answer = last(90.0, [56.25; 2], 1_000);
    let cells: Vec<&str> = answer.split(',').collect();
    let draft_n: f64 = cells[1].parse().unwrap();
    assert!((draft_n - 20_000.0).abs() < 50.0, "{answer}");
    assert_eq!(cells[2..], ["draft", "", "1", "0.000"], "{answer}");
    let answer = last(90.0, [0.0, 56.25], 60);
    assert!(answer.ends_with(",,holds,pin-range,1,0.000"), "{answer}");
}

#[test]
fn a_bad_line_ends_it_with_its_place() {
    let mut controller = ControllerProcess::open(HEADER);
    controller.send("0.000,90,90");
    assert_eq!(controller.answer(), "0.000,0.000,locked");
    controller.send("0.001,90,nought");
    let (code, said) = controller.close();
    assert_eq!(code, Some(2));
    assert!(
        said.starts_with("hitch: standard input:3:10: \"nought\" is not a finite number; "),
        "{said}"
    );
    assert_eq!(said.lines().count(), 1);
}

#[test]
fn the_example_of_the_documentation_runs() {
    let example = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/own_plant.py");
    let program = hitch().get_program().to_owned();
    let output = std::process::Command::new("python3")
        .arg(example)
        .arg(program)
        .output()
        .expect("the example needs python3");
    let said = String::from_utf8_lossy(&output.stdout);
    println!("{said}");
    assert!(
        output.status.success(),
        "{said}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert_eq!(said.lines().count(), 3);
    let lines = std::fs::read_to_string(example).unwrap().lines().count();
    assert!(lines <= 40, "{lines} lines are no short example");
}
