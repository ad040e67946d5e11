//! The way from data to a saved calibration: its steps, each with its state.

use schemars::JsonSchema;
use serde::Serialize;

use crate::session::Session;

/// A step of the way.
#[derive(Debug, Serialize, JsonSchema)]
pub struct WayStep {
    /// Key.
    pub key: &'static str,
    /// Title.
    pub title: &'static str,
    /// The tab where it is made.
    pub tab: &'static str,
    /// Whether it is done.
    pub done: bool,
    /// Its state in a few words.
    pub state: String,
}

impl WayStep {
    /// The steps in their order.
    pub fn all(session: &Session) -> Vec<Self> {
        let subject = session.subject();
        let runs = plural(subject.experiment().runs.len(), "run");
        let step = |key, title, tab, (done, state)| Self {
            key,
            title,
            tab,
            done,
            state,
        };
        vec![
            step("data", "Data", "map", (true, runs)),
            step(
                "model",
                "Model",
                "model",
                (true, subject.model.name.clone()),
            ),
            step("fit", "Fit", "model", fit(session)),
            step("effects", "Effects", "missing", effects(session)),
            step(
                "calibration",
                "Calibration",
                "controller",
                calibration(session),
            ),
            step("loop", "Closed loop", "loop", closed_loop(session)),
            step("tuning", "Tuning", "controller", tuning(session)),
            step("save", "Save", "controller", saving(session)),
        ]
    }
}

fn calibration(session: &Session) -> (bool, String) {
    let is_used = session.tuned.is_some() || session.tab_loop.is_some();
    let state = if is_used {
        "of the model"
    } else {
        "not used yet"
    };
    (is_used, state.to_owned())
}

fn closed_loop(session: &Session) -> (bool, String) {
    let is_running = session.tab_loop.is_some();
    let state = if is_running { "running" } else { "not started" };
    (is_running, state.to_owned())
}

fn saving(session: &Session) -> (bool, String) {
    let Some(saved) = &session.saved else {
        return (false, "not saved".to_owned());
    };
    let is_saved = session.is_present(saved);
    let state = if is_saved { "saved" } else { "changed since" };
    (is_saved, state.to_owned())
}

fn fit(session: &Session) -> (bool, String) {
    match &session.subject().fitted {
        Some(fitted) => (
            true,
            format!("{:.2} → {:.2} σ", fitted.error_before, fitted.error_after),
        ),
        None => (false, "constants as declared".to_owned()),
    }
}

fn effects(session: &Session) -> (bool, String) {
    let added = session.fit().estimate.effects.len();
    let error = session.fit().error();
    let explained = session.explained.is_some() || session.at() > 0;
    match (added, explained) {
        (0, false) if session.present_ranking().is_some() => (false, "ranked".to_owned()),
        (0, false) => (false, "not looked for".to_owned()),
        (0, true) => (true, format!("none, {error:.2} σ")),
        (added, explained) => (
            explained,
            format!("{}, {error:.2} σ", plural(added, "effect")),
        ),
    }
}

fn tuning(session: &Session) -> (bool, String) {
    let Some(tuned) = session.present_tuned() else {
        let state = match session.tuned {
            Some(_) => "model changed since",
            None => "not tuned",
        };
        return (false, state.to_owned());
    };
    let limited = tuned.figures.iter().filter_map(|figure| figure.met);
    let met = limited.clone().filter(|&met| met).count();
    (true, format!("{met} of {} limits met", limited.count()))
}

fn plural(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}
