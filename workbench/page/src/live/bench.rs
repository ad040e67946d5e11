//! The thread in which both hitches run.

use std::sync::mpsc::{Receiver, Sender, SyncSender, TrySendError, channel, sync_channel};
use std::time::Instant;

use axum::http::StatusCode;
use hitch_closed_loop::driven::{Machine, Orders, Pair};

use super::answer::LoopAnswer;
use crate::refusal::Refusal;

/// An advance of both hitches.
struct Advance {
    orders: Orders,
    steps: u32,
    answer: Sender<LoopAnswer>,
}

/// Both hitches of a tab; the thread ends when this is dropped.
#[derive(Debug)]
pub struct Bench {
    orders: SyncSender<Advance>,
}

impl Bench {
    /// Starts both hitches at rest at an angle, degree.
    ///
    /// # Errors
    /// If no thread can be started.
    pub fn start(machine: Machine, orders: Orders, angle_deg: f64) -> std::io::Result<Self> {
        let (sender, advances) = sync_channel(1);
        std::thread::Builder::new()
            .name("closed loop".to_owned())
            .spawn(move || run(&machine, &orders, angle_deg, &advances))?;
        Ok(Self { orders: sender })
    }

    /// Requests an advance by `steps` milliseconds; its result, when it is ready.
    ///
    /// # Errors
    /// If the previous one has not ended, or the simulation has failed.
    pub fn advance(&self, orders: Orders, steps: u32) -> Result<Receiver<LoopAnswer>, Refusal> {
        let (answer, pending) = channel();
        let advance = Advance {
            orders,
            steps,
            answer,
        };
        match self.orders.try_send(advance) {
            Ok(()) => Ok(pending),
            Err(TrySendError::Full(_)) => Err(Refusal::of(
                StatusCode::TOO_MANY_REQUESTS,
                "an earlier step of the closed loop has not ended",
            )),
            Err(TrySendError::Disconnected(_)) => Err(failed()),
        }
    }
}

/// The simulation has failed.
pub fn failed() -> Refusal {
    Refusal::of(
        StatusCode::INTERNAL_SERVER_ERROR,
        "the simulation has failed; start the closed loop again",
    )
}

/// Advances both hitches until the sender is dropped.
fn run(machine: &Machine, orders: &Orders, angle_deg: f64, advances: &Receiver<Advance>) {
    let mut pair = Pair::new(machine, orders, angle_deg);
    while let Ok(advance) = advances.recv() {
        let began = Instant::now();
        let loops = pair.advance(&advance.orders, advance.steps);
        let took_s = began.elapsed().as_secs_f64().max(1e-6);
        // The request may have been abandoned.
        let _ = advance.answer.send(LoopAnswer {
            loops: loops.into(),
            speed: Some(f64::from(advance.steps) * 1e-3 / took_s),
            behind: None,
            bus: None,
        });
    }
}
