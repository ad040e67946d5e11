//! `hitch record` and `hitch flash-calibration` through an slcan adapter on a serial line: a pseudo-terminal with the bus
//! of a running ECU behind it.

use std::fs;
use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::os::fd::AsRawFd;
use std::path::Path;
use std::process::Output;
use std::thread::{self, JoinHandle, sleep};
use std::time::Duration;

use hitch_campaign::Campaign;
use hitch_ecu_host::ecu::CutFlash;
use hitch_protocols::storage::CalibrationStore;
use host_tests::program::run;
use serial2::SerialPort;

use crate::running_ecu::{RunningEcu, said};

/// Time for which the adapter waits for bytes on either side.
const TURN: Duration = Duration::from_millis(2);
/// What a host sends first: end of a partial line, close, 250 kbit/s, open.
const OPENING: &[u8] = b"\rC\rS5\rO\r";

/// What happens to the adapter after some bytes from the ECU.
#[derive(Clone, Copy, PartialEq)]
enum Fate {
    Works,
    UnpluggedAfter(usize),
    SilentAfter(usize),
}

/// The adapter.
struct Adapter {
    port: String,
    /// Returns what the host has sent.
    thread: JoinHandle<Vec<u8>>,
}

impl Adapter {
    fn between(bus: &str, fate: Fate) -> Self {
        let (mut line, host_end) = SerialPort::pair().unwrap();
        line.set_read_timeout(TURN).unwrap();
        let port = fs::read_link(format!("/proc/self/fd/{}", host_end.as_raw_fd())).unwrap();
        let port = port.to_str().unwrap().to_owned();
        // The line hangs up while nothing has the host's end open.
        let held = fs::File::options()
            .read(true)
            .write(true)
            .open(&port)
            .unwrap();
        drop(host_end);
        let mut ecu = TcpStream::connect(bus).unwrap();
        ecu.set_read_timeout(Some(TURN)).unwrap();
        let thread = thread::spawn(move || {
            let mut sent = Vec::new();
            let mut forwarded = 0;
            let mut bytes = [0; 1_024];
            while !sent.ends_with(b"\rC\r") || sent.len() < OPENING.len() {
                let count = received(line.read(&mut bytes));
                sent.extend(&bytes[..count]);
                ecu.write_all(&bytes[..count]).unwrap();
                let count = received(ecu.read(&mut bytes));
                forwarded += count;
                match fate {
                    Fate::UnpluggedAfter(most) if forwarded > most => break,
                    Fate::SilentAfter(most) if forwarded > most => {}
                    _ => line.write_all(&bytes[..count]).unwrap(),
                }
            }
            drop(held);
            sent
        });
        Self { port, thread }
    }

    fn sent_by_host(self) -> Vec<u8> {
        self.thread.join().unwrap()
    }
}

fn received(result: std::io::Result<usize>) -> usize {
    match result {
        Ok(count) => count,
        Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock) => 0,
        Err(error) => panic!("{error}"),
    }
}

fn record(folder: &Path, port: &str) -> Output {
    let arguments = "--out c --load 150 --temperature 40 --seconds 2 --can";
    let mut arguments: Vec<&str> = arguments.split(' ').collect();
    arguments.insert(0, "record");
    arguments.push(port);
    run(folder, &arguments)
}

fn write(folder: &Path, port: &str) -> Output {
    run(folder, &["flash-calibration", "c.toml", "--can", port])
}

/// An ECU at rest that accepts calibrations.
fn unlocked(folder: &Path) -> RunningEcu {
    let calibration = "format = 1\n[position]\napproach_gain_per_s = 33\n";
    fs::write(folder.join("c.toml"), calibration).unwrap();
    let mut ecu = RunningEcu::start(folder);
    sleep(Duration::from_millis(1_200));
    ecu.order("service on");
    ecu.order("lock on");
    sleep(Duration::from_millis(100));
    ecu
}

fn stored_gain(folder: &Path) -> i32 {
    let flash = CutFlash::holding(fs::read(folder.join("flash.bin")).unwrap());
    let stored = CalibrationStore::new(flash).load().calibration;
    stored.position.approach_gain.0
}

fn assert_one_line(output: &Output, expected: &str) {
    let said = said(output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.contains(expected), "{said}");
}

/// The campaign has the run until the loss; it is deleted.
fn assert_kept(folder: &Path) {
    let campaign = folder.join("c");
    let runs = Campaign::load(&campaign).unwrap().runs;
    let samples = runs[0].time_s.len();
    assert!((20..200).contains(&samples), "{samples} samples");
    fs::remove_dir_all(campaign).unwrap();
}

#[test]
fn a_campaign_is_recorded_and_a_calibration_stored() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path();
    let mut ecu = unlocked(folder);
    let adapter = Adapter::between(&ecu.bus, Fate::Works);
    let recorded = record(folder, &adapter.port);
    assert!(recorded.status.success(), "{}", said(&recorded));
    let sent = adapter.sent_by_host();
    assert!(sent.starts_with(OPENING) && sent.ends_with(b"\rC\r"));
    let campaign = Campaign::load(&folder.join("c")).unwrap();
    let rows = campaign.runs[0].time_s.len();
    assert!(rows >= 190, "{rows} samples");

    let adapter = Adapter::between(&ecu.bus, Fate::Works);
    let written = write(folder, &adapter.port);
    assert!(written.status.success(), "{}", said(&written));
    assert!(adapter.sent_by_host().ends_with(b"\rC\r"));
    ecu.quit();
    assert_eq!(stored_gain(folder), 33);
}

#[test]
fn unplugging_or_silence_is_one_error_and_what_was_recorded_is_kept() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path();
    let mut ecu = unlocked(folder);
    let lost = "connection to the bus was lost";
    let silent = "does not answer";
    // After about one second of samples.
    for (fate, expected) in [
        (Fate::UnpluggedAfter(15_000), lost),
        (Fate::SilentAfter(15_000), silent),
    ] {
        let adapter = Adapter::between(&ecu.bus, fate);
        assert_one_line(&record(folder, &adapter.port), expected);
        assert_kept(folder);
        adapter.sent_by_host();
    }
    // While it reads the present calibration.
    for (fate, expected) in [
        (Fate::UnpluggedAfter(3_000), lost),
        (Fate::SilentAfter(3_000), silent),
    ] {
        let adapter = Adapter::between(&ecu.bus, fate);
        let output = write(folder, &adapter.port);
        assert_one_line(&output, expected);
        assert!(said(&output).contains("write again"), "{}", said(&output));
        adapter.sent_by_host();
    }
    // The next attempt succeeds.
    let adapter = Adapter::between(&ecu.bus, Fate::Works);
    let written = write(folder, &adapter.port);
    assert!(written.status.success(), "{}", said(&written));
    ecu.quit();
    assert_eq!(stored_gain(folder), 33);
}

#[test]
fn an_ecu_that_ends_amid_a_recording_over_tcp_is_one_error() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path();
    let ecu = unlocked(folder);
    let bus = ecu.bus.clone();
    let killer = thread::spawn(move || {
        sleep(Duration::from_millis(1_500));
        drop(ecu);
    });
    assert_one_line(&record(folder, &bus), "connection to the bus was lost");
    killer.join().unwrap();
    assert_kept(folder);
}

#[test]
fn wrong_addresses_are_reported_with_the_three_forms() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path();
    fs::write(folder.join("plain"), "no port").unwrap();
    for (port, expected) in [
        ("nowhere", "127.0.0.1:7701"),
        ("can93", "/dev/ttyACM0"),
        ("./missing", "that no other program uses"),
        ("./plain", "that no other program uses"),
    ] {
        assert_one_line(&record(folder, port), expected);
        assert!(!folder.join("c").exists());
    }
}
