//! `hitch ecu` as a process: real time, and the end of the emulator.

use std::fs;
use std::io::Read;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use hitch_ecu_host::ecu::find_image;
use host_tests::program::hitch;

use crate::running_ecu::started;

fn signal(child: &Child, name: &str) {
    let sent = Command::new("kill")
        .args([name, &child.id().to_string()])
        .status();
    assert!(sent.unwrap().success());
}

#[test]
fn a_suspended_ecu_says_when_it_falls_behind_real_time_and_when_it_keeps_up() {
    let mut child = hitch()
        .args(["ecu", "--host", "--seconds", "6"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    sleep(Duration::from_millis(1_500));
    signal(&child, "-STOP");
    sleep(Duration::from_millis(700));
    signal(&child, "-CONT");
    // It needs a second in which this machine lets it keep up.
    let mut said = String::new();
    child
        .stderr
        .take()
        .unwrap()
        .read_to_string(&mut said)
        .unwrap();
    let mut table = String::new();
    child
        .stdout
        .take()
        .unwrap()
        .read_to_string(&mut table)
        .unwrap();
    assert!(child.wait().unwrap().success());
    println!("{said}{table}");
    let lines: Vec<&str> = said.lines().collect();
    assert!(lines[0].starts_with("behind real time: "), "{said}");
    assert_eq!(lines[1], "in real time again", "{said}");
    assert!(
        table.lines().any(|row| row.ends_with("behind real time")),
        "{table}"
    );
    let last = table.lines().last().unwrap();
    assert!(!last.contains("behind"), "{table}");
}

/// State of a process by `/proc`; `None` if it is gone.
fn state(process: &str) -> Option<char> {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    stat.rsplit_once(')')?.1.trim_start().chars().next()
}

/// Process ids of the children, over all threads.
fn children(parent: &Child) -> Vec<String> {
    let threads = fs::read_dir(format!("/proc/{}/task", parent.id())).unwrap();
    let lists =
        threads.map(|thread| fs::read_to_string(thread.unwrap().path().join("children")).unwrap());
    lists
        .collect::<String>()
        .split_whitespace()
        .map(str::to_owned)
        .collect()
}

#[test]
#[ignore = "needs the ARM image: run by `cargo xtask test`"]
fn the_emulator_ends_with_a_program_that_is_killed() {
    let image = find_image(None).unwrap();
    // Amid the emulated steps, and while the emulator starts.
    for after in [Duration::from_millis(1_000), Duration::ZERO] {
        let mut command = hitch();
        command
            .args(["ecu", "--can", "127.0.0.1:0", "--image"])
            .arg(&image);
        let (mut child, line) = started(&mut command);
        assert!(line.starts_with("CAN is open"), "{line}");
        sleep(after);
        let emulators = children(&child);
        assert_eq!(emulators.len(), 1, "{emulators:?}");
        // SIGKILL: the program cannot end its children.
        child.kill().unwrap();
        child.wait().unwrap();
        let killed = Instant::now();
        // Z: it has ended, and nothing has asked for its status.
        while state(&emulators[0]).is_some_and(|state| state != 'Z') {
            assert!(killed.elapsed() < Duration::from_secs(5), "it still runs");
            sleep(Duration::from_millis(10));
        }
        println!(
            "the emulator ended {} ms after the program",
            killed.elapsed().as_millis()
        );
    }
}
