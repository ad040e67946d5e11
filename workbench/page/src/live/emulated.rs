//! The closed loop with the ECU: its application runs in real time against the plant, in a thread of its own.
//!
//! There is one ECU for the whole server. The tab that starts it keeps it until it stops it, closes, or is silent.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{JoinHandle, sleep};
use std::time::{Duration, Instant};

use hitch_closed_loop::driven::{Machine, Orders, Strip};

use super::answer::LoopAnswer;
use super::ecu_bench::EcuBench;
use hitch_closed_loop::Sample;
use hitch_ecu_host::ecu::{MachineError, Pace, PaceChange, PoweredEcu, Runner, delivered};

/// Silence of a tab after which its ECU is switched off.
const SILENT: Duration = Duration::from_secs(5);
/// Samples that are kept until the tab asks for them: one each 10 ms.
const MOST_SAMPLES: usize = 600;

/// The ECU of a server.
#[derive(Debug)]
pub struct EcuSocket {
    runner: Runner,
    /// The running ECU, which ends when it is replaced.
    present: Mutex<Option<Arc<Shared>>>,
}

/// The ECU that a tab has switched on; it ends when this is dropped.
#[derive(Debug)]
pub struct RunningEcu {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

/// What the thread of the ECU and the requests of the tab share.
#[derive(Debug)]
struct Shared {
    stopped: AtomicBool,
    exchange: Mutex<Exchange>,
}

#[derive(Debug)]
struct Exchange {
    orders: Orders,
    heard: Instant,
    samples: VecDeque<Sample>,
    strip: Strip,
    behind: bool,
    /// Why the ECU has ended.
    ended: Option<String>,
}

/// Reason why no ECU can be started.
#[derive(Debug, thiserror::Error)]
pub enum NoEcu {
    /// Another tab has it.
    #[error(
        "the ECU is in use by another tab: stop it there, or close that tab; a tab that is closed or hidden for some \
         seconds gives it back"
    )]
    InUse,
    /// It cannot be started.
    #[error("the ECU cannot be started: {0}")]
    Failed(#[from] std::io::Error),
}

impl EcuSocket {
    /// No ECU is running.
    pub fn new(runner: Runner) -> Self {
        Self {
            runner,
            present: Mutex::default(),
        }
    }

    /// Switches the ECU on, with the calibration of the present model, and the hitch at rest at an angle, degree.
    ///
    /// # Errors
    /// If another tab has it, or it cannot be started.
    pub fn start(
        &self,
        machine: Machine,
        orders: Orders,
        angle_deg: f64,
    ) -> Result<RunningEcu, NoEcu> {
        let mut present = self.present.lock().unwrap_or_else(PoisonError::into_inner);
        if present.as_ref().is_some_and(|running| running.is_running()) {
            return Err(NoEcu::InUse);
        }
        let shared = Arc::new(Shared {
            stopped: AtomicBool::new(false),
            exchange: Mutex::new(Exchange {
                orders,
                heard: Instant::now(),
                samples: VecDeque::new(),
                strip: Strip::default(),
                behind: false,
                ended: None,
            }),
        });
        let (runner, of_thread) = (self.runner.clone(), Arc::clone(&shared));
        let thread = std::thread::Builder::new()
            .name("ECU".to_owned())
            .spawn(move || run(&of_thread, &runner, &machine, angle_deg))?;
        *present = Some(Arc::clone(&shared));
        Ok(RunningEcu {
            shared,
            thread: Some(thread),
        })
    }

    /// Switches a running ECU off, and waits for its end.
    pub fn close(&self) {
        let present = self.present.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(running) = present.as_ref() else {
            return;
        };
        running.stopped.store(true, Ordering::Relaxed);
        let begun = Instant::now();
        while running.is_running() && begun.elapsed() < SILENT {
            sleep(Duration::from_millis(1));
        }
    }
}

impl RunningEcu {
    /// Passes the orders on; returns the samples since the last call and the present state.
    ///
    /// # Errors
    /// The reason, if the ECU has ended.
    pub fn exchange(&self, orders: Orders) -> Result<LoopAnswer, String> {
        let mut exchange = self.shared.lock();
        if let Some(reason) = &exchange.ended {
            return Err(reason.clone());
        }
        exchange.orders = orders;
        exchange.heard = Instant::now();
        let samples: Vec<Sample> = exchange.samples.drain(..).collect();
        Ok(LoopAnswer {
            loops: vec![exchange.strip.view(&samples)],
            speed: None,
            behind: Some(exchange.behind),
            bus: None,
        })
    }
}

impl Drop for RunningEcu {
    fn drop(&mut self) {
        self.shared.stopped.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // A thread that has panicked has ended as well.
            let _ = thread.join();
        }
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Exchange> {
        self.exchange.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn is_running(&self) -> bool {
        self.lock().ended.is_none()
    }
}

/// Runs the ECU until it is stopped, its tab is silent, or it ends.
fn run(shared: &Shared, runner: &Runner, machine: &Machine, angle_deg: f64) {
    let flash = delivered(&machine.rebuilt);
    let result = runner
        .power_up(flash)
        .and_then(|mut ecu| drive(shared, machine, angle_deg, &mut ecu));
    // The emulator has ended, and its folder is removed.
    shared.lock().ended = Some(match result {
        Ok(()) => {
            "the ECU was switched off, as its tab was silent or hidden; start it again".to_owned()
        }
        Err(error) => format!("{error}; start it again"),
    });
}

fn drive(
    shared: &Shared,
    machine: &Machine,
    angle_deg: f64,
    ecu: &mut PoweredEcu,
) -> Result<(), MachineError> {
    let orders = shared.lock().orders;
    let mut bench = EcuBench::new(&machine.plant, &orders, angle_deg);
    let mut pace: Option<Pace> = None;
    while !shared.stopped.load(Ordering::Relaxed) {
        let orders = {
            let exchange = shared.lock();
            if exchange.heard.elapsed() > SILENT {
                return Ok(());
            }
            exchange.orders
        };
        let sample = bench.tick(&orders, ecu)?;
        // The first millisecond includes the start of the emulator.
        let now = Instant::now();
        let (wait, change) = pace.get_or_insert_with(|| Pace::starting(now)).tick(now);
        shared.lock().take(sample, change);
        sleep(wait);
    }
    Ok(())
}

impl Exchange {
    fn take(&mut self, sample: Sample, change: Option<PaceChange>) {
        self.strip.follow(&sample);
        if Strip::shows(&sample) {
            if self.samples.len() == MOST_SAMPLES {
                self.samples.pop_front();
            }
            self.samples.push_back(sample);
        }
        if let Some(change) = change {
            self.behind = change == PaceChange::FallsBehind;
        }
    }
}
