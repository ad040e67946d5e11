//! The closed loop of `hitch serve --can`: an ECU on a bus, shown and never commanded.

use std::fs;
use std::io::{ErrorKind, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::panic::AssertUnwindSafe;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::{JoinHandle, sleep, spawn};
use std::time::{Duration, Instant};

use hitch_ecu_host::ecu::slcan_server::SlcanServer;
use hitch_ecu_host::ecu::{CutFlash, OnHost};
use host_tests::live_ecu::{self, Operator};
use host_tests::page_server::{Answer, PageServer};
use host_tests::program::run;
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::running_ecu::{RunningEcu, said};

/// Time between two requests of the page, and of the proxy for either side.
const TURN: Duration = Duration::from_millis(50);
const PROXY_TURN: Duration = Duration::from_millis(2);
/// What a listener sends at the start, and at the end.
const LISTEN: &[u8] = b"\rC\rS5\rL\r";
const CLOSE: &[u8] = b"C\r";
/// The answer of an adapter that refuses a command.
const BELL: u8 = 0x07;

/// An slcan adapter in front of the bus of an ECU, which keeps what each of its hosts has sent.
struct Adapter {
    address: String,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Default)]
struct Shared {
    /// HOST:PORT of the bus; without one, no frame comes.
    bus: Mutex<Option<String>>,
    /// Whether the adapter knows the listen-only mode.
    refuses_to_listen: bool,
    sent: Mutex<Vec<Vec<u8>>>,
    stopped: AtomicBool,
}

impl Adapter {
    fn start(bus: Option<&str>, refuses_to_listen: bool) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap().to_string();
        listener.set_nonblocking(true).unwrap();
        let shared = Arc::new(Shared {
            bus: Mutex::new(bus.map(str::to_owned)),
            refuses_to_listen,
            ..Shared::default()
        });
        let of_thread = Arc::clone(&shared);
        let thread = spawn(move || {
            while !of_thread.stopped.load(Ordering::Relaxed) {
                match listener.accept() {
                    Ok((host, _)) => of_thread.serve(host),
                    Err(_) => sleep(PROXY_TURN),
                }
            }
        });
        Self {
            address,
            shared,
            thread: Some(thread),
        }
    }

    fn is_at(&self, bus: &str) {
        *self.shared.bus.lock().unwrap() = Some(bus.to_owned());
    }

    /// What each host has sent so far.
    fn sent(&self) -> Vec<Vec<u8>> {
        self.shared.sent.lock().unwrap().clone()
    }
}

impl Drop for Adapter {
    fn drop(&mut self) {
        self.shared.stopped.store(true, Ordering::Relaxed);
        let _ = self.thread.take().unwrap().join();
    }
}

impl Shared {
    /// Serves one host until either side hangs up.
    fn serve(&self, mut host: TcpStream) {
        host.set_nonblocking(false).unwrap();
        host.set_read_timeout(Some(PROXY_TURN)).unwrap();
        let bus = self.bus.lock().unwrap().clone();
        let ecu = bus.map(TcpStream::connect);
        // An adapter whose bus is gone hangs up.
        let Ok(mut ecu) = ecu.transpose() else { return };
        if let Some(ecu) = &ecu {
            ecu.set_read_timeout(Some(PROXY_TURN)).unwrap();
        }
        self.sent.lock().unwrap().push(Vec::new());
        let mut bytes = [0; 4_096];
        while !self.stopped.load(Ordering::Relaxed) {
            let Some(count) = received(host.read(&mut bytes)) else {
                return;
            };
            let (forwarded, refusal) = self.answer(&bytes[..count]);
            let mut sent = self.sent.lock().unwrap();
            sent.last_mut().unwrap().extend(&bytes[..count]);
            drop(sent);
            let Some(ecu) = &mut ecu else {
                continue;
            };
            let alive = ecu.write_all(&forwarded).is_ok() && host.write_all(&refusal).is_ok();
            let count = received(ecu.read(&mut bytes)).filter(|_| alive);
            let Some(count) = count else { return };
            if host.write_all(&bytes[..count]).is_err() {
                return;
            }
        }
    }

    /// What goes on to the bus, and what is refused.
    fn answer(&self, bytes: &[u8]) -> (Vec<u8>, Vec<u8>) {
        if self.refuses_to_listen && bytes == b"L\r" {
            (Vec::new(), vec![BELL])
        } else {
            (bytes.to_vec(), Vec::new())
        }
    }
}

/// Number of bytes; `None` at the end of a connection.
fn received(result: std::io::Result<usize>) -> Option<usize> {
    match result {
        Ok(0) => None,
        Ok(count) => Some(count),
        Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock) => {
            Some(0)
        }
        Err(_) => None,
    }
}

struct Tab<'s> {
    server: &'s PageServer,
    session: String,
}

impl<'s> Tab<'s> {
    fn open(server: &'s PageServer) -> Self {
        let tab = Self {
            server,
            session: server.begin(),
        };
        let described = tab.post("describe");
        assert_eq!(described.json()["source"], "bus", "{}", described.body);
        let opened = tab.post("open");
        assert_eq!(opened.status, 200, "{}", opened.body);
        tab
    }

    fn post(&self, what: &str) -> Answer {
        // The orders of the page's hidden controls.
        let orders = json!({ "lever_deg": 120.0, "load_kg": 400.0, "oil_temperature_c": 20.0,
            "button": "raise", "quick_lift": true });
        let body = json!({ "session": self.session, "orders": orders, "milliseconds": 50 });
        self.server.post(&format!("api/loop/{what}"), &body)
    }

    /// Asks until the answer is as wanted; that answer.
    fn until(&self, wanted: impl Fn(&Value) -> bool) -> Value {
        let begun = Instant::now();
        loop {
            let answer = self.post("step");
            assert_eq!(answer.status, 200, "{}", answer.body);
            let view = answer.json();
            if wanted(&view) {
                return view;
            }
            assert!(begun.elapsed() < Duration::from_secs(30), "{view}");
            sleep(TURN);
        }
    }
}

fn values(view: &Value, signal: &str) -> Vec<f64> {
    let values = view["loops"][0][signal].as_array().unwrap();
    values.iter().filter_map(Value::as_f64).collect()
}

fn has_problem(text: &'static str) -> impl Fn(&Value) -> bool {
    move |view| {
        let problem = view["bus"]["problem"].as_str();
        problem.is_some_and(|problem| problem.contains(text))
    }
}

fn signal_to_stop(server: &mut PageServer) {
    let sent = std::process::Command::new("kill")
        .args(["-INT", &server.process().to_string()])
        .status();
    assert!(sent.unwrap().success());
    assert_eq!(server.wait(), Some(0));
}

#[test]
fn the_page_shows_what_the_ecu_sends_and_sends_nothing_on_its_bus() {
    let dir = TempDir::new().unwrap();
    let mut ecu = RunningEcu::start(dir.path());
    let adapter = Adapter::start(Some(&ecu.bus), false);
    let mut server = PageServer::start(dir.path(), &["--can", &adapter.address]);
    let tab = Tab::open(&server);
    let mut times = Vec::new();
    let begun = Instant::now();
    while begun.elapsed() < Duration::from_secs(2) {
        let view = tab.until(|view| !values(view, "time_s").is_empty());
        times.extend(values(&view, "time_s"));
    }
    println!(
        "{} samples in {:.2} s",
        times.len(),
        times[times.len() - 1] - times[0]
    );
    assert!(times.len() > 75, "{} samples", times.len());
    let even = |pair: &[f64]| (pair[1] - pair[0] - 0.02).abs() < 1e-6;
    assert!(times.windows(2).all(even), "{times:?}");

    // The lever of the machine moves the hitch; that of the page does not.
    let at_rest = tab.until(|view| !values(view, "angle_deg").is_empty());
    let rest_deg = *values(&at_rest, "angle_deg").last().unwrap();
    assert_eq!(at_rest["bus"]["problem"], Value::Null);
    let said = at_rest["bus"]["text"].as_str().unwrap();
    assert!(
        said.contains("listen-only") && said.contains("address 128"),
        "{said}"
    );
    ecu.order(&format!("lever {}", rest_deg + 15.0));
    let (mut most_a, mut most_bar) = (0.0_f64, 0.0_f64);
    let begun = Instant::now();
    loop {
        let view = tab.until(|view| !values(view, "angle_deg").is_empty());
        let most = |signal| values(&view, signal).into_iter().fold(0.0, f64::max);
        (most_a, most_bar) = (
            most_a.max(most("lift_a")),
            most_bar.max(most("cylinder_bar")),
        );
        if (values(&view, "angle_deg").last().unwrap() - rest_deg - 15.0).abs() < 0.5 {
            break;
        }
        assert!(begun.elapsed() < Duration::from_secs(20), "{view}");
    }
    println!("lifted by 15 deg with {most_a:.2} A, {most_bar:.0} bar");
    assert!(
        most_a > 0.5 && most_bar > 20.0,
        "{most_a} A, {most_bar} bar"
    );

    // A second tab sees the same, beginning with the recent past.
    let other = Tab::open(&server);
    let past = other.until(|_| true);
    let past = values(&past, "angle_deg");
    assert!(
        (past[0] - rest_deg).abs() < 0.5 && past.len() > 100,
        "{past:?}"
    );

    drop(ecu);
    let lost = tab.until(has_problem("is lost"));
    assert_eq!(
        (&lost["bus"]["connected"], &lost["loops"][0]["state"]),
        (&json!(false), &json!("not heard"))
    );
    let ecu = RunningEcu::start(dir.path());
    adapter.is_at(&ecu.bus);
    let back = tab.until(|view| !values(view, "angle_deg").is_empty());
    assert_eq!(back["bus"]["connected"], true);
    let after_s = values(&back, "time_s");
    assert!(after_s[0] > times[times.len() - 1], "time goes on");

    signal_to_stop(&mut server);
    let deadline = Instant::now() + Duration::from_secs(5);
    while !adapter.sent().iter().all(|sent| sent.ends_with(CLOSE)) && Instant::now() < deadline {
        sleep(TURN);
    }
    let sent = adapter.sent();
    assert!(sent.len() >= 2, "{sent:?}");
    let last = sent.len() - 1;
    for (index, sent) in sent.iter().enumerate() {
        let whole = [LISTEN, CLOSE].concat();
        // Of a lost connection, the end may be missing.
        let is_right = *sent == whole || (index < last && *sent == LISTEN);
        assert!(is_right, "{}", String::from_utf8_lossy(sent));
    }
}

#[test]
fn a_calibration_is_written_only_with_tune_and_if_the_ecu_permits_it() {
    let dir = TempDir::new().unwrap();
    let mut ecu = RunningEcu::start(dir.path());
    let adapter = Adapter::start(Some(&ecu.bus), false);
    let server = PageServer::start(dir.path(), &["--can", &adapter.address]);
    let refused = Tab::open(&server).post("write");
    assert_eq!(refused.status, 409, "{}", refused.body);
    assert!(refused.body.contains("--tune"), "{}", refused.body);
    drop(server);

    let server = PageServer::start(dir.path(), &["--can", &adapter.address, "--tune"]);
    let tab = Tab::open(&server);
    assert_eq!(tab.post("describe").json()["may_write"], true);
    let locked = tab.post("write");
    assert_eq!(locked.status, 422, "{}", locked.body);
    assert!(locked.body.contains("service on"), "{}", locked.body);
    tab.until(|view| !values(view, "angle_deg").is_empty());
    ecu.order("service on");
    ecu.order("lock on");
    sleep(Duration::from_millis(100));
    let written = tab.post("write");
    println!("{}", written.body);
    assert_eq!(written.status, 200, "{}", written.body);
    assert!(written.json()["words"].as_u64().unwrap() > 100);
    let again = tab.post("write");
    assert_eq!(again.json()["changed"], 0, "{}", again.body);
    tab.until(|view| !values(view, "angle_deg").is_empty());
}

/// Blank flash and an unplugged lever are two codes, which come as a broadcast in packets.
#[test]
fn faults_are_shown_in_words() {
    let dir = TempDir::new().unwrap();
    let bus = SlcanServer::open("127.0.0.1:0").unwrap();
    let address = bus.address().unwrap().to_string();
    let done = AtomicBool::new(false);
    let broken = std::thread::scope(|scope| {
        scope.spawn(|| {
            live_ecu::run(
                &mut OnHost::start(CutFlash::blank()),
                bus,
                Operator::LeverUnplugged,
                &done,
            )
        });
        let server = PageServer::start(dir.path(), &["--can", &address]);
        let tab = Tab::open(&server);
        let both = |view: &Value| {
            let fault = view["loops"][0]["fault"].as_str();
            fault.is_some_and(|fault| fault.contains(", "))
        };
        let broken = std::panic::catch_unwind(AssertUnwindSafe(|| tab.until(both)));
        done.store(true, Ordering::Relaxed);
        broken.unwrap()["loops"][0].clone()
    });
    println!("{broken}");
    let text = broken["fault_text"].as_str().unwrap();
    assert!(
        text.contains("lever") && text.contains("factory calibration"),
        "{text}"
    );
    assert_eq!(broken["state"], "operator control faulty");
    let said = broken["state_text"].as_str().unwrap();
    assert!(said.contains("exit code 8"), "{said}");
}

#[test]
fn an_adapter_without_listen_only_mode_is_opened_as_usual_and_a_silent_bus_is_said() {
    let dir = TempDir::new().unwrap();
    let ecu = RunningEcu::start(dir.path());
    let adapter = Adapter::start(Some(&ecu.bus), true);
    let mut server = PageServer::start(dir.path(), &["--can", &adapter.address]);
    let tab = Tab::open(&server);
    let view = tab.until(|view| !values(view, "angle_deg").is_empty());
    let said = view["bus"]["text"].as_str().unwrap();
    assert!(said.contains("no listen-only mode"), "{said}");
    signal_to_stop(&mut server);
    sleep(TURN);
    assert_eq!(adapter.sent(), [[LISTEN, b"O\r", CLOSE].concat()]);

    let silent = Adapter::start(None, false);
    let server = PageServer::start(dir.path(), &["--can", &silent.address]);
    let tab = Tab::open(&server);
    let view = tab.until(has_problem("The bus is silent"));
    assert_eq!(view["bus"]["connected"], true);
}

// REQ-INPUT-01
#[test]
fn addresses_that_do_not_answer_are_said_as_by_hitch_record() {
    let dir = TempDir::new().unwrap();
    fs::write(dir.path().join("plain"), "no port").unwrap();
    let gone = TcpListener::bind("127.0.0.1:0").unwrap().local_addr();
    let gone = gone.unwrap().to_string();
    let record = [
        "record",
        "--out",
        "c",
        "--load",
        "150",
        "--temperature",
        "40",
        "--can",
    ];
    for address in ["nowhere", "can93", "./missing", "./plain", &gone] {
        let page = run(dir.path(), &["serve", "--no-browser", "--can", address]);
        let recorded = run(dir.path(), &[&record[..], &[address]].concat());
        assert_eq!(page.status.code(), Some(2));
        assert_eq!(said(&page), said(&recorded));
    }
    let both = run(
        dir.path(),
        &["serve", "--no-browser", "--ecu", "--can", &gone],
    );
    assert_eq!(both.status.code(), Some(2));
    assert!(
        said(&both).contains("cannot be used with"),
        "{}",
        said(&both)
    );
}
