//! Long computations: each runs in its own thread and reports its progress.
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use hitch_identification::data::limit::Limit;
use tokio::sync::broadcast;

use super::refusal::Refusal;
use super::request::{idle, lock};
use super::session::Job;
use super::sessions::Shared;
use super::tasks::{Outcome, Ready, Task};
use super::views::candidate::ShownCandidate;
use super::views::message::Message;
use hitch_results::arguments::search::limit;

/// Panic payload that unwinds a cancelled computation.
struct Cancelled;

/// Reports the progress of a computation to its tab.
pub struct Reporter {
    cancelled: Arc<AtomicBool>,
    keeps_best: bool,
    messages: broadcast::Sender<Message>,
}

impl Reporter {
    /// Reports the current stage, the completed fraction (0 to 1, `None` if unknown) and the error.
    pub fn progress(&self, text: &str, fraction: Option<f64>, error: Option<f64>) {
        self.tell(Message::Progress {
            text: text.to_owned(),
            fraction,
            error,
        });
    }

    /// Reports an evaluated effect.
    pub fn candidate(&self, candidate: ShownCandidate, fraction: f64) {
        self.tell(Message::Candidate {
            candidate,
            fraction,
        });
    }

    /// The limit of a search that keeps its best result: a time, s, and until it is cancelled.
    pub fn limit(&self, budget_s: f64) -> Limit<'_> {
        limit(budget_s, Some(&*self.cancelled))
    }

    /// Whether a search goes on: until it is cancelled.
    pub fn goes_on(&self) -> ControlFlow<()> {
        if self.cancelled.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    fn tell(&self, message: Message) {
        if self.cancelled.load(Ordering::Relaxed) && !self.keeps_best {
            // Unwinds to the start of the computation without a panic message.
            resume_unwind(Box::new(Cancelled));
        }
        // There may be no receiver.
        let _ = self.messages.send(message);
    }
}

/// Starts a computation for a session.
///
/// # Errors
/// If a computation is running, or the task does not fit the session.
pub fn start(session: &Shared, task: Task) -> Result<(), Refusal> {
    let mut open = lock(session);
    idle(&open)?;
    let ready = Ready::new(&open, task)?;
    let reporter = Reporter {
        cancelled: Arc::default(),
        keeps_best: ready.keeps_best(),
        messages: open.messages.clone(),
    };
    open.job = Some(Job {
        title: ready.title(),
        cancelled: Arc::clone(&reporter.cancelled),
        keeps_best: reporter.keeps_best,
    });
    drop(open);
    let session = Arc::clone(session);
    tokio::task::spawn_blocking(move || {
        let outcome = catch_unwind(AssertUnwindSafe(|| ready.run(&reporter)));
        finish(&session, &reporter, outcome);
    });
    Ok(())
}

/// Stores the result unless the computation was given up, and reports its end.
fn finish(session: &Shared, reporter: &Reporter, outcome: std::thread::Result<Outcome>) {
    let mut open = lock(session);
    let is_own = |job: &Job| Arc::ptr_eq(&job.cancelled, &reporter.cancelled);
    if !open.job.as_ref().is_some_and(is_own) {
        return;
    }
    open.job = None;
    let message = match outcome {
        Ok(Outcome::Failed(text)) => Message::Failed { text },
        Ok(outcome) => {
            outcome.apply(&mut open);
            Message::Done
        }
        Err(_) => Message::Failed {
            text: "The computation failed. The model is unchanged; try another effect.".to_owned(),
        },
    };
    let _ = open.messages.send(message);
}
