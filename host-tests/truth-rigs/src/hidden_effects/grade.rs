//! Grades answers against the truth.

use std::collections::BTreeSet;
use std::time::Instant;

use hitch_plant::Model;

use super::answer::Answer;
use super::detectability::detectability;
use super::explaining;
use super::starting_point;
use crate::second_rig::campaign_writer::campaign;
use crate::second_rig::draw::{Case, Kind};
use crate::second_rig::hidden::Fidelity;

/// Error up to which a model explains a campaign, sigmas.
const EXPLAINED: f64 = 1.1;

/// A case with its measure of difficulty.
#[derive(Debug, Clone)]
pub struct Posed {
    /// The case.
    pub case: Case,
    /// Detectability of the hidden effects, the smallest of several; infinite if there are none.
    pub detectability: f64,
}

/// An answer and how it does.
#[derive(Debug, Clone)]
pub struct Graded {
    /// The case.
    pub posed: Posed,
    /// The answer.
    pub answer: Answer,
    /// How long it took, s.
    pub seconds: f64,
}

impl Posed {
    /// Measures how difficult a case is.
    #[must_use]
    pub fn new(case: Case) -> Self {
        let least = case
            .hidden
            .iter()
            .map(|hidden| detectability(&case, hidden))
            .fold(f64::INFINITY, f64::min);
        Self {
            case,
            detectability: least,
        }
    }

    /// Lets the identification answer.
    #[must_use]
    pub fn ask(&self) -> Graded {
        self.ask_about(&starting_point(self.case.family))
    }

    /// Lets the identification answer, starting from a model.
    #[must_use]
    pub fn ask_about(&self, model: &Model) -> Graded {
        let campaign = campaign(&self.case);
        self.answered(|| explaining::answer(&campaign, model))
    }

    /// The answer of a method, timed.
    pub(super) fn answered(&self, answer: impl FnOnce() -> Answer) -> Graded {
        let start = Instant::now();
        Graded {
            posed: self.clone(),
            answer: answer(),
            seconds: start.elapsed().as_secs_f64(),
        }
    }
}

impl Graded {
    /// Ids of the hidden effects that are in the catalogue.
    fn truth(&self) -> BTreeSet<&str> {
        let case = &self.posed.case;
        case.hidden
            .iter()
            .filter(|_| case.kind != Kind::Outside)
            .map(|hidden| hidden.what.id)
            .collect()
    }

    /// Whether the first name is a true one.
    #[must_use]
    pub fn named_first(&self) -> bool {
        let first = self.answer.named.first();
        first.is_some_and(|first| self.truth().contains(first.as_str()))
    }

    /// Whether the first name is a true one, no other was needed, and no more than noise is left.
    #[must_use]
    pub fn explained(&self) -> bool {
        self.named_first() && self.answer.named.len() == 1 && self.answer.error <= EXPLAINED
    }

    /// Whether every true name is among those given or said to be possible.
    #[must_use]
    pub fn named_in_group(&self) -> bool {
        let said: BTreeSet<&str> = self
            .answer
            .named
            .iter()
            .chain(&self.answer.group)
            .map(String::as_str)
            .collect();
        self.truth().is_subset(&said)
    }

    /// Whether the names given are the true ones and no other.
    #[must_use]
    pub fn exact(&self) -> bool {
        let named: BTreeSet<&str> = self.answer.named.iter().map(String::as_str).collect();
        named == self.truth()
    }

    /// Whether effects are named, and neither they nor their alternatives are true.
    #[must_use]
    pub fn wrong(&self) -> bool {
        let truth = self.truth();
        let mut said = self.answer.named.iter().chain(&self.answer.group);
        !self.answer.named.is_empty() && !said.any(|name| truth.contains(name.as_str()))
    }

    /// Whether a name that is not true is stated with at least this probability.
    #[must_use]
    pub fn wrong_at(&self, confidence: f64) -> bool {
        self.stated()
            .any(|(stated, there)| !there && stated >= confidence)
    }

    /// For each true name with an interval whether that holds the true size; only sizes that mean the same.
    #[must_use]
    pub fn covered(&self) -> Vec<bool> {
        self.judged_intervals()
            .map(|(size, (_, low, high))| (*low..=*high).contains(&size))
            .collect()
    }

    /// Intervals that do not hold the true size, as text.
    #[must_use]
    pub fn missed_intervals(&self) -> Vec<String> {
        self.judged_intervals()
            .filter(|(size, (_, low, high))| !(*low..=*high).contains(size))
            .map(|(size, (id, low, high))| format!("{id} {size:.5} not in {low:.5} to {high:.5}"))
            .collect()
    }

    /// Probabilities that were stated for effects, and whether each of those is there.
    pub fn stated(&self) -> impl Iterator<Item = (f64, bool)> {
        let truth = self.truth();
        let stated = self.answer.confidences.iter();
        stated.map(move |(id, confidence)| (*confidence, truth.contains(id.as_str())))
    }

    /// True sizes with the intervals stated for them.
    fn judged_intervals(&self) -> impl Iterator<Item = (f64, &(String, f64, f64))> {
        let case = &self.posed.case;
        let judged = case.fidelity == Fidelity::Faithful && self.exact();
        let intervals = self.answer.intervals.iter().filter(move |_| judged);
        intervals.filter_map(|interval| {
            let hidden = case
                .hidden
                .iter()
                .find(|hidden| hidden.what.id == interval.0)?;
            hidden.what.comparable.then_some((hidden.size, interval))
        })
    }

    /// Whether the answer is fully correct.
    #[must_use]
    pub fn good(&self) -> bool {
        match self.posed.case.kind {
            Kind::Single => self.named_first(),
            Kind::Pair => self.exact(),
            Kind::Nothing => self.answer.named.is_empty() && !self.answer.unknown,
            Kind::Outside => self.answer.unknown,
        }
    }
}
