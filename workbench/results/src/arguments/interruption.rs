//! Ctrl-C during a search. The first one ends the search with its best result so far. The second one ends the program.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::channel;
use std::{io, process, thread};

use tokio::runtime::Builder;
#[cfg(unix)]
use tokio::signal::unix::{SignalKind, signal};
#[cfg(windows)]
use tokio::signal::windows::ctrl_c;

/// Exit code of a program that Ctrl-C ended: 128 and the number of the signal.
const INTERRUPTED: i32 = 130;

static REQUESTED: AtomicBool = AtomicBool::new(false);

/// Listens to Ctrl-C from now on. Returns what the first one sets; `None` if the system does not report it, so that it ends
/// the program.
pub fn requested() -> Option<&'static AtomicBool> {
    static LISTENS: OnceLock<bool> = OnceLock::new();
    LISTENS.get_or_init(listen).then_some(&REQUESTED)
}

/// Waits for Ctrl-C in a thread of its own; whether the system reports it.
fn listen() -> bool {
    let (send, receive) = channel();
    thread::spawn(move || {
        let runtime = Builder::new_current_thread().enable_io().build()?;
        runtime.block_on(async {
            #[cfg(unix)]
            let mut interrupts = signal(SignalKind::interrupt())?;
            #[cfg(windows)]
            let mut interrupts = ctrl_c()?;
            // The receiver waits for it.
            let _ = send.send(());
            while interrupts.recv().await.is_some() {
                if REQUESTED.swap(true, Ordering::Relaxed) {
                    process::exit(INTERRUPTED);
                }
                eprintln!("ending with the best result so far; Ctrl-C again ends at once");
            }
            Ok::<(), io::Error>(())
        })
    });
    receive.recv().is_ok()
}
