//! State of one browser tab: the steps from the initial model, with undo and redo, and the running computation.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use hitch_closed_loop::driven::Models;
use hitch_effects::TermEffect;
use hitch_identification::estimation::fit::Fit;
use hitch_identification::explanation::diagnosis;
use hitch_identification::selection::candidate::Candidate;
use hitch_plant::{Effect, Model, full_name};
use tokio::sync::broadcast;

use super::live::TabLoop;
use super::second::Second;
use super::source::Subject;
use super::tuned::TunedFor;
use super::upload::Upload;
use super::views::message::Message;
use hitch_results::comparison::Evaluated;
use hitch_results::explanation::{self, rebuilt};

/// Capacity of the message queue; a tab that is further behind requests the state again.
const KEPT_MESSAGES: usize = 256;

/// A step: a model evaluated on the campaign.
#[derive(Debug, Clone)]
pub struct Step {
    /// Title of the step.
    pub title: String,
    /// The evaluated model.
    pub evaluated: Arc<Evaluated>,
    /// Error on held-out runs; `None` without a fit.
    pub held_out: Option<f64>,
    /// Terms defined up to this step, those of the model file first.
    pub terms: Vec<&'static dyn Effect>,
}

impl Step {
    /// Defines a term; replaces an older one of the same name.
    pub fn define(&mut self, term: &'static TermEffect) {
        self.terms.retain(|known| known.id() != term.id());
        self.terms.push(term);
    }
}

/// Ranking of the effects that the model of a step may lack.
#[derive(Debug)]
pub struct Ranking {
    /// The model of the ranking.
    pub of: Arc<Evaluated>,
    /// The result.
    pub diagnosis: diagnosis::Diagnosis,
    /// The result in its display form.
    pub shown: explanation::Diagnosis,
}

impl Ranking {
    /// A candidate by its full name.
    pub fn candidate(&self, name: &str) -> Option<&Candidate> {
        let mut candidates = self.diagnosis.candidates.iter();
        candidates.find(|candidate| full_name(candidate.effect) == name)
    }
}

/// Explanation of the campaign from the model of a step.
#[derive(Debug)]
pub struct Explained {
    /// The present model when it was asked for.
    pub of: Arc<Evaluated>,
    /// The model that it starts from: the present one, with constants in the middle of their ranges.
    pub model: Model,
    /// The result.
    pub found: explanation::Explained,
}

/// A first model that was exchanged for another one, with the steps from it.
#[derive(Debug)]
struct Earlier {
    subject: Arc<Subject>,
    steps: Vec<Step>,
    at: usize,
}

/// A running computation.
#[derive(Debug, Clone)]
pub struct Job {
    /// Its description.
    pub title: String,
    /// Set to cancel it.
    pub cancelled: Arc<AtomicBool>,
    /// Whether it then ends soon with its best result so far.
    pub keeps_best: bool,
}

/// The steps of a tab; undone steps are kept until the next new step.
#[derive(Debug)]
pub struct Session {
    subject: Arc<Subject>,
    steps: Vec<Step>,
    at: usize,
    /// The latest ranking.
    pub ranking: Option<Arc<Ranking>>,
    /// The latest explanation.
    pub explained: Option<Arc<Explained>>,
    /// The first model before the present one.
    earlier: Option<Earlier>,
    /// The latest tuned calibration.
    pub tuned: Option<Arc<TunedFor>>,
    /// The model that was saved last.
    pub saved: Option<Arc<Evaluated>>,
    /// The running computation.
    pub job: Option<Job>,
    /// The closed loop.
    pub tab_loop: Option<TabLoop>,
    /// The second model.
    pub second: Option<Arc<Second>>,
    /// The files that are being opened.
    pub upload: Option<Arc<Upload>>,
    /// Sends messages to the tab.
    pub messages: broadcast::Sender<Message>,
}

impl Session {
    /// The models of the closed loop.
    pub fn models(&self) -> Models {
        Models::new(self.subject().model.clone(), self.rebuilt())
    }

    /// The session of a tab that was just opened.
    pub fn new(subject: Arc<Subject>) -> Self {
        Self {
            steps: vec![first(&subject)],
            subject,
            at: 0,
            ranking: None,
            explained: None,
            earlier: None,
            tuned: None,
            saved: None,
            job: None,
            tab_loop: None,
            second: None,
            upload: None,
            messages: broadcast::Sender::new(KEPT_MESSAGES),
        }
    }

    /// Opens another campaign; the steps of the present one are lost.
    pub fn open(&mut self, subject: Arc<Subject>) {
        self.give_up();
        self.steps = vec![first(&subject)];
        self.at = 0;
        self.subject = subject;
        self.forget();
        self.earlier = None;
    }

    /// Takes another first model on the same campaign; [`Session::back`] returns to the present one with its steps.
    pub fn exchange(&mut self, subject: Arc<Subject>) {
        self.give_up();
        self.earlier = Some(Earlier {
            steps: std::mem::replace(&mut self.steps, vec![first(&subject)]),
            at: std::mem::take(&mut self.at),
            subject: std::mem::replace(&mut self.subject, subject),
        });
        self.forget();
    }

    /// Returns to the first model before the present one; false if there is none. Once more, it returns to the present one.
    pub fn back(&mut self) -> bool {
        let Some(earlier) = &mut self.earlier else {
            return false;
        };
        std::mem::swap(&mut self.subject, &mut earlier.subject);
        std::mem::swap(&mut self.steps, &mut earlier.steps);
        std::mem::swap(&mut self.at, &mut earlier.at);
        self.forget();
        true
    }

    /// Name of the first model before the present one.
    pub fn earlier(&self) -> Option<&str> {
        let earlier = self.earlier.as_ref();
        earlier.map(|earlier| earlier.subject.model.name.as_str())
    }

    /// The present model, as it is saved.
    pub fn rebuilt(&self) -> Model {
        let name = format!(
            "{}-{}",
            self.subject.model.name,
            self.subject.experiment().name
        );
        rebuilt(&self.model(), &self.fit().estimate, name)
    }

    /// The explanation, if it starts from the present model.
    pub fn present_explanation(&self) -> Option<&Arc<Explained>> {
        let explained = self.explained.as_ref();
        explained.filter(|explained| self.is_present(&explained.of))
    }

    /// The tuned calibration, if it is for the present model.
    pub fn present_tuned(&self) -> Option<&Arc<TunedFor>> {
        let tuned = self.tuned.as_ref();
        tuned.filter(|tuned| self.is_present(&tuned.of))
    }

    /// Drops what belongs to another first model.
    fn forget(&mut self) {
        (self.ranking, self.explained) = (None, None);
        (self.tab_loop, self.second) = (None, None);
    }

    /// The campaign and the initial model.
    pub fn subject(&self) -> &Arc<Subject> {
        &self.subject
    }

    /// All steps, including undone ones.
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

    /// The initial model, with all terms defined since.
    pub fn model(&self) -> Model {
        self.subject.model.with_terms(self.present().terms.clone())
    }

    /// The fit of the present step.
    pub fn fit(&self) -> &Fit {
        &self.present().evaluated.fit
    }

    /// The ranking, if it belongs to the present model.
    pub fn present_ranking(&self) -> Option<&Arc<Ranking>> {
        let ranking = self.ranking.as_ref();
        ranking.filter(|ranking| self.is_present(&ranking.of))
    }

    /// Whether it is the present model.
    pub fn is_present(&self, evaluated: &Arc<Evaluated>) -> bool {
        Arc::ptr_eq(evaluated, &self.present().evaluated)
    }

    /// Adds a step after the present one; discards undone steps.
    pub fn push(&mut self, step: Step) {
        self.steps.truncate(self.at + 1);
        self.steps.push(step);
        self.at += 1;
    }

    /// Goes to a step, back or forward; false if it does not exist.
    pub fn go(&mut self, at: usize) -> bool {
        let exists = at < self.steps.len();
        if exists {
            self.at = at;
        }
        exists
    }

    /// Cancels the running computation. A search ends soon, with its best result so far; cancelled once more, it is given up.
    pub fn cancel(&mut self) {
        match &mut self.job {
            Some(job) if job.keeps_best && !job.cancelled.load(Ordering::Relaxed) => {
                job.cancelled.store(true, Ordering::Relaxed);
                job.title = "Ending with the best result so far".to_owned();
            }
            _ => self.give_up(),
        }
    }

    /// Gives up the running computation.
    fn give_up(&mut self) {
        if let Some(job) = self.job.take() {
            job.cancelled.store(true, Ordering::Relaxed);
        }
    }
}

/// The step of the initial model.
fn first(subject: &Subject) -> Step {
    Step {
        title: format!("Model {}", subject.model.name),
        evaluated: Arc::clone(&subject.start),
        held_out: None,
        terms: subject.model.terms.clone(),
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.give_up();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Source;

    fn step(session: &Session, title: &str) -> Step {
        Step {
            title: title.to_owned(),
            ..session.present().clone()
        }
    }

    #[test]
    fn an_exchanged_first_model_comes_back_with_its_steps() {
        let source = Source {
            campaign: None,
            model: hitch_model_file::nominal(),
            baseline: None,
        };
        let mut session = Session::new(Arc::new(source.read().unwrap()));
        assert!(!session.back() && session.earlier().is_none());
        session.push(step(&session, "one"));
        let dynamic = session.subject().exchanged(hitch_model_file::dynamic());
        session.exchange(Arc::new(dynamic.unwrap()));
        assert_eq!((session.at(), session.earlier()), (0, Some("nominal")));
        assert!(session.back());
        assert_eq!((session.at(), session.present().title.as_str()), (1, "one"));
        assert_eq!(session.earlier(), Some("dynamic"));
    }

    #[test]
    fn undone_steps_are_kept_until_something_else_is_done() {
        let source = Source {
            campaign: None,
            model: hitch_model_file::nominal(),
            baseline: None,
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
