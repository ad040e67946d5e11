//! JSON views of the way from data to a saved calibration: its steps, each with its state.

use std::sync::Arc;

use hitch_identification::constants::tolerances::names;
use serde_json::{Value, json};

use crate::base_model::fit::ShownConstant;
use crate::serve::session::Session;
use crate::tuning::figures;

/// The steps in their order, each with its state in a few words, whether it is done, and the tab where it is made.
pub fn steps(session: &Session) -> Vec<Value> {
    let subject = session.subject();
    let runs = subject.experiment().runs.len();
    let step = |key: &str, title: &str, tab: &str, is_done: bool, state: String| json!({ "key": key, "title": title, "tab": tab, "done": is_done, "state": state });
    let (is_fitted, fit) = fit(session);
    let (has_effects, effects) = effects(session);
    let (is_tuned, tuning) = tuning(session);
    let is_running = session.tab_loop.is_some();
    let has_calibration = session.tuned.is_some() || is_running;
    let saved = session.saved.as_ref();
    let is_saved = saved.is_some_and(|saved| Arc::ptr_eq(saved, &session.present().evaluated));
    vec![
        step("data", "Data", "map", true, plural(runs, "run")),
        step("model", "Model", "model", true, subject.model.name.clone()),
        step("fit", "Fit", "model", is_fitted, fit),
        step("effects", "Effects", "missing", has_effects, effects),
        step(
            "calibration",
            "Calibration",
            "controller",
            has_calibration,
            (if has_calibration {
                "of the model"
            } else {
                "not used yet"
            })
            .to_owned(),
        ),
        step(
            "loop",
            "Closed loop",
            "loop",
            is_running,
            (if is_running { "running" } else { "not started" }).to_owned(),
        ),
        step("tuning", "Tuning", "controller", is_tuned, tuning),
        step(
            "save",
            "Save",
            "controller",
            is_saved,
            match (saved.is_some(), is_saved) {
                (_, true) => "saved",
                (true, false) => "changed since",
                (false, false) => "not saved",
            }
            .to_owned(),
        ),
    ]
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

/// The constants of the first model: which can be held in a fit, and the fit, if there was one.
pub fn constants(session: &Session) -> Value {
    let subject = session.subject();
    let row = |constant: &ShownConstant| json!({ "cells": constant.cells(), "beyond": constant.is_beyond() });
    let fitted = subject.fitted.as_ref().map(|fit| {
        let determined = fit.constants.iter().filter(|one| one.determined);
        json!({
            "error_before": fit.error_before,
            "error_after": fit.error_after,
            "headings": ShownConstant::HEADINGS,
            "rows": determined.map(row).collect::<Vec<_>>(),
            "not_determined": fit.not_determined,
            "at_an_end": fit.at_an_end,
        })
    });
    json!({ "names": names(subject.model.constants()), "fitted": fitted })
}

/// The tuned calibration; null if there is none for the present model.
pub fn tuned(session: &Session) -> Value {
    let Some(tuned) = session.present_tuned() else {
        return Value::Null;
    };
    let figure = |figure: &figures::Figure| json!({ "cells": figure.cells(), "met": figure.met });
    json!({
        "sentence": figures::sentence(&tuned.figures),
        "headings": figures::Figure::HEADINGS,
        "figures": tuned.figures.iter().map(figure).collect::<Vec<_>>(),
        "changes": tuned.changes,
    })
}
