//! Ctrl-C during a search. The first one ends the search with its best result so far. The second one ends the program.

use std::sync::atomic::{AtomicBool, Ordering};

/// Exit code of a program that Ctrl-C ended: 128 and the number of the signal.
const INTERRUPTED: i32 = 130;

static REQUESTED: AtomicBool = AtomicBool::new(false);

/// Listens to Ctrl-C from now on. Returns what the first one sets; `None` if the system does not report it, so that it ends
/// the program.
pub fn requested() -> Option<&'static AtomicBool> {
    let listens = ctrlc::set_handler(|| {
        if REQUESTED.swap(true, Ordering::Relaxed) {
            std::process::exit(INTERRUPTED);
        }
        eprintln!("ending with the best result so far; Ctrl-C again ends at once");
    });
    match listens {
        Ok(()) | Err(ctrlc::Error::MultipleHandlers) => Some(&REQUESTED),
        Err(_) => None,
    }
}
