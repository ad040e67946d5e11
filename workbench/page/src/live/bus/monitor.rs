//! The thread that listens to the bus, for all tabs.

use std::io;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{JoinHandle, sleep};
use std::time::{Duration, Instant};

use hitch_quantities::ValidCalibration;

use super::super::answer::LoopAnswer;
use super::heard::Heard;
use super::state::State;
use super::view;
use hitch_ecu_host::xcp_tool::{BusAddress, CanListener, Written, write_to};
use hitch_output::error::Error;

/// Time after which the thread checks whether it has to end.
const TURN: Duration = Duration::from_millis(50);
/// Time between two attempts to open a lost adapter.
const RETRY: Duration = Duration::from_secs(1);
/// Silence of the bus after which the adapter is opened again: it may have lost its settings, or a gateway its network.
const REOPEN_AFTER: Duration = Duration::from_secs(10);
/// Time for which the end of the thread is awaited.
const ENDS_WITHIN: Duration = Duration::from_secs(1);

/// The listener of a server.
#[derive(Debug)]
pub struct BusMonitor {
    /// Whether a tab may have a calibration written to the ECU.
    pub may_write: bool,
    shared: Arc<Shared>,
    thread: JoinHandle<()>,
}

/// The place of a tab in what was heard.
#[derive(Debug)]
pub struct Place {
    shared: Arc<Shared>,
    /// Number of samples that the tab has.
    known: AtomicU64,
}

#[derive(Debug)]
struct Shared {
    address: BusAddress,
    stopped: AtomicBool,
    /// Number of writers that wait for the adapter, or have it.
    writers: AtomicUsize,
    /// Held by whoever has the adapter.
    adapter: Mutex<()>,
    state: Mutex<State>,
}

impl BusMonitor {
    /// Opens the bus, and listens.
    ///
    /// # Errors
    /// If the adapter cannot be opened.
    pub fn start(address: BusAddress, may_write: bool) -> Result<Self, Error> {
        let listener = CanListener::open(&address).map_err(|error| address.unreachable(&error))?;
        let shared = Arc::new(Shared {
            address,
            stopped: AtomicBool::new(false),
            writers: AtomicUsize::new(0),
            adapter: Mutex::default(),
            state: Mutex::new(State {
                adapter: Ok(listener.mode()),
                heard: Heard::new(Instant::now()),
            }),
        });
        let of_thread = Arc::clone(&shared);
        let no_thread = |error| Error::Failed(format!("the bus cannot be listened to: {error}"));
        let thread = std::thread::Builder::new()
            .name("CAN bus".to_owned())
            .spawn(move || of_thread.run(listener))
            .map_err(no_thread)?;
        Ok(Self {
            may_write,
            shared,
            thread,
        })
    }

    /// Writes a calibration to the ECU over XCP, which stores it; meanwhile nothing is listened to.
    ///
    /// # Errors
    /// If the ECU cannot be reached, or it refuses: its service switch has to be closed, and the hitch locked.
    pub fn write(&self, calibration: &ValidCalibration) -> Result<Written, Error> {
        let shared = &self.shared;
        shared.writers.fetch_add(1, Ordering::Relaxed);
        let written = {
            let _adapter = held(&shared.adapter);
            write_to(&shared.address, calibration, None)
        };
        shared.writers.fetch_sub(1, Ordering::Relaxed);
        written
    }

    /// The place of a new tab: it gets the kept samples first.
    pub fn place(&self) -> Place {
        Place {
            shared: Arc::clone(&self.shared),
            known: AtomicU64::new(0),
        }
    }

    /// Ends the thread, which closes the channel of the adapter.
    pub fn close(&self) {
        self.shared.stopped.store(true, Ordering::Relaxed);
        let begun = Instant::now();
        while !self.thread.is_finished() && begun.elapsed() < ENDS_WITHIN {
            sleep(Duration::from_millis(1));
        }
    }
}

impl Place {
    /// The samples since the last call, and the present state.
    pub fn advance(&self) -> LoopAnswer {
        let state = self.shared.lock();
        let (samples, count) = state
            .heard
            .samples_after(self.known.load(Ordering::Relaxed));
        self.known.store(count, Ordering::Relaxed);
        view::shown(&state, &self.shared.address, &samples, Instant::now())
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        held(&self.state)
    }

    fn is_wanted_by_writers(&self) -> bool {
        self.writers.load(Ordering::Relaxed) > 0
    }

    fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// Listens until the end of the server.
    fn run(&self, first: CanListener) {
        let mut first = Some(first);
        while !self.is_stopped() {
            if self.is_wanted_by_writers() {
                first = None;
                sleep(TURN);
                continue;
            }
            let ended = {
                let _adapter = held(&self.adapter);
                let opened = first
                    .take()
                    .map_or_else(|| CanListener::open(&self.address), Ok);
                opened.and_then(|listener| self.listen(listener))
            };
            if let Err(error) = ended {
                self.lock().adapter = Err(error.to_string());
                self.wait(RETRY);
            }
        }
    }

    /// Listens until the adapter is lost, wanted by a writer, or the bus is silent for long.
    fn listen(&self, mut listener: CanListener) -> io::Result<()> {
        self.lock().adapter = Ok(listener.mode());
        let mut active = Instant::now();
        let goes_on = || !self.is_stopped() && !self.is_wanted_by_writers();
        while goes_on() && active.elapsed() < REOPEN_AFTER {
            if let Some(frame) = listener.receive(Instant::now() + TURN)? {
                active = Instant::now();
                self.lock().heard.receive(&frame, active);
            }
        }
        Ok(())
    }

    fn wait(&self, time: Duration) {
        let begun = Instant::now();
        while !self.is_stopped() && begun.elapsed() < time {
            sleep(TURN);
        }
    }
}

/// A lock, after a panic too: the data stay valid.
fn held<T>(lock: &Mutex<T>) -> MutexGuard<'_, T> {
    lock.lock().unwrap_or_else(PoisonError::into_inner)
}
