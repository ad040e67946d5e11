//! What one tab of a browser has done: the steps from the first model, with undo and redo, and what runs for it.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use hitch_effects::TermEffect;
use hitch_identification::estimation::fit::Fit;
use hitch_identification::explanation::explain;
use hitch_identification::selection::candidate::Candidate;
use hitch_identification::suggestion::Suggestion;
use hitch_plant::{Effect, Model, full_name};
use serde_json::Value;
use tokio::sync::broadcast;

use super::source::Subject;
use crate::comparison::Evaluated;
use crate::explanation;

/// Messages that a tab may be behind by; one that is further behind asks for the state anew.
const KEPT_MESSAGES: usize = 256;

/// A model on the way, evaluated on the campaign.
#[derive(Debug, Clone)]
pub struct Step {
    /// What was done, for people.
    pub title: String,
    /// The model evaluated.
    pub evaluated: Arc<Evaluated>,
    /// Error on runs that were not used to fit; `None` where nothing was fitted.
    pub held_out: Option<f64>,
    /// Terms that were defined up to here, those of the model's file first.
    pub terms: Vec<&'static dyn Effect>,
}

impl Step {
    /// Defines a term; an older one of the same name is gone.
    pub fn define(&mut self, term: &'static TermEffect) {
        self.terms.retain(|known| known.id() != term.id());
        self.terms.push(term);
    }
}

/// Effects that the model of a step could lack, ranked.
#[derive(Debug)]
pub struct Ranking {
    /// The model that they were tried on.
    pub of: Arc<Evaluated>,
    /// What was found.
    pub diagnosis: explain::Diagnosis,
    /// The same for people.
    pub shown: explanation::Diagnosis,
}

impl Ranking {
    /// A candidate by its full name.
    pub fn candidate(&self, name: &str) -> Option<&Candidate> {
        let mut candidates = self.diagnosis.candidates.iter();
        candidates.find(|candidate| full_name(candidate.effect) == name)
    }
}

/// What explains the campaign from the model of a step.
#[derive(Debug)]
pub struct Explained {
    /// The model that it begins with.
    pub of: Arc<Evaluated>,
    /// What was found.
    pub explanation: explain::Explanation,
    /// A term for what stays unexplained.
    pub suggestion: Option<Suggestion>,
    /// The same for people.
    pub shown: explanation::Explanation,
}

/// A computation that runs.
#[derive(Debug, Clone)]
pub struct Job {
    /// What it does, for people.
    pub title: String,
    /// Set when its result is no longer wanted.
    pub cancelled: Arc<AtomicBool>,
}

/// The steps of a tab; undone ones are kept until something else is done.
#[derive(Debug)]
pub struct Session {
    subject: Arc<Subject>,
    steps: Vec<Step>,
    at: usize,
    /// The latest ranking.
    pub ranking: Option<Arc<Ranking>>,
    /// The latest explanation.
    pub explained: Option<Arc<Explained>>,
    /// What runs now.
    pub job: Option<Job>,
    /// Tells the tab how that goes.
    pub messages: broadcast::Sender<Value>,
}

impl Session {
    /// The session of a tab that was just opened.
    pub fn new(subject: Arc<Subject>) -> Self {
        let first = Step {
            title: format!("Model {}", subject.model.name),
            evaluated: Arc::clone(&subject.start),
            held_out: None,
            terms: subject.model.terms.clone(),
        };
        Self {
            subject,
            steps: vec![first],
            at: 0,
            ranking: None,
            explained: None,
            job: None,
            messages: broadcast::Sender::new(KEPT_MESSAGES),
        }
    }

    /// What it is about.
    pub fn subject(&self) -> &Arc<Subject> {
        &self.subject
    }

    /// All steps, undone ones too.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// Index of the present step.
    pub fn at(&self) -> usize {
        self.at
    }

    /// The present step.
    pub fn present(&self) -> &Step {
        &self.steps[self.at]
    }

    /// The model to begin with, with the terms that were defined since.
    pub fn model(&self) -> Model {
        self.subject.model.with_terms(self.present().terms.clone())
    }

    /// The fit of the present step.
    pub fn fit(&self) -> &Fit {
        &self.present().evaluated.fit
    }

    /// The ranking, if it is of the present model.
    pub fn present_ranking(&self) -> Option<&Arc<Ranking>> {
        let present = &self.present().evaluated;
        let ranking = self.ranking.as_ref();
        ranking.filter(|ranking| Arc::ptr_eq(&ranking.of, present))
    }

    /// Adds a step after the present one; what was undone is gone.
    pub fn push(&mut self, step: Step) {
        self.steps.truncate(self.at + 1);
        self.steps.push(step);
        self.at += 1;
    }

    /// Goes to a step, back or forth; whether there is such a step.
    pub fn go(&mut self, at: usize) -> bool {
        let exists = at < self.steps.len();
        if exists {
            self.at = at;
        }
        exists
    }

    /// Ends what runs: its result is no longer wanted.
    pub fn cancel(&mut self) {
        if let Some(job) = self.job.take() {
            job.cancelled.store(true, Ordering::Relaxed);
        }
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.cancel();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::serve::Source;

    fn step(session: &Session, title: &str) -> Step {
        Step {
            title: title.to_owned(),
            ..session.present().clone()
        }
    }

    #[test]
    fn undone_steps_are_kept_until_something_else_is_done() {
        let source = Source {
            campaign: None,
            model: hitch_model_file::nominal(),
        };
        let mut session = Session::new(Arc::new(source.read().unwrap()));
        for title in ["one", "two"] {
            session.push(step(&session, title));
        }
        assert!(session.go(0) && !session.go(3));
        assert_eq!((session.at(), session.steps().len()), (0, 3));
        assert!(session.go(1));
        session.push(step(&session, "three"));
        let titles: Vec<&str> = session.steps().iter().map(|s| s.title.as_str()).collect();
        assert_eq!(titles, ["Model nominal", "one", "three"]);
        assert_eq!(session.present().title, "three");
    }
}
