//! A second model on the campaign of a session, compared with the present one: an earlier step, or a model file.

use std::sync::Arc;

use axum::body::Bytes;
use axum::extract::{DefaultBodyLimit, Query, State};
use axum::routing::{get, post};
use axum::{Json, Router};
use hitch_identification::data::problem::Problem;
use hitch_identification::explanation::explain::fit_base;
use hitch_plant::Model;
use serde::Deserialize;
use serde_json::json;

use super::first::{LARGEST_MODEL, OfFile, parsed};
use super::jobs;
use super::routes::{Answer, Known, Of, OfCell, Refusal, blocking, find, lock};
use super::session::Session;
use super::sessions::Sessions;
use super::source::Subject;
use super::tasks::Task;
use crate::comparison::{Evaluated, largest_change_in_part};

/// A second model, evaluated on the campaign of the session.
#[derive(Debug, Clone)]
pub struct Second {
    /// Its title.
    pub title: String,
    /// The model.
    pub model: Model,
    /// Its evaluation.
    pub evaluated: Arc<Evaluated>,
    /// Whether changes are those from the present model to this one; else they are those to the present model.
    pub is_after: bool,
}

impl Second {
    /// A step of the session; `None` if it does not exist.
    pub fn of_step(session: &Session, at: usize) -> Option<Self> {
        let step = session.steps().get(at)?;
        Some(Self {
            title: format!("step {at}: {}", step.title),
            model: session.subject().model.clone(),
            evaluated: Arc::clone(&step.evaluated),
            is_after: false,
        })
    }

    /// A model evaluated on the campaign, with the noise and the groups of the session.
    pub fn evaluate(subject: &Subject, title: String, model: Model) -> Self {
        let experiment = Arc::clone(&subject.start.experiment);
        let fit = fit_base(Problem::new(&experiment, &model));
        Self {
            title,
            evaluated: Arc::new(Evaluated::fitted(experiment, fit, &subject.model)),
            model,
            is_after: false,
        }
    }

    /// The model before and the model after, of this and the present one.
    pub fn ordered<'a>(&'a self, present: &'a Evaluated) -> [&'a Evaluated; 2] {
        match self.is_after {
            true => [present, &self.evaluated],
            false => [&self.evaluated, present],
        }
    }
}

/// All routes of the second model.
pub fn routes() -> Router<Arc<Sessions>> {
    let file = post(file).layer(DefaultBodyLimit::max(LARGEST_MODEL));
    Router::new()
        .route("/{token}/api/second/step", post(step))
        .route("/{token}/api/second/file", file)
        .route("/{token}/api/second/swap", post(swap))
        .route("/{token}/api/second/close", post(close))
        .route("/{token}/api/second/largest", get(largest))
}

#[derive(Debug, Deserialize)]
struct OfStep {
    session: String,
    at: usize,
}

async fn step(State(sessions): Known, Json(of): Json<OfStep>) -> Answer {
    let session = find(&sessions, &of.session)?;
    let mut open = lock(&session);
    let second = Second::of_step(&open, of.at);
    let gone = || Refusal::conflict("the step no longer exists");
    open.second = Some(Arc::new(second.ok_or_else(gone)?));
    Ok(Json(json!({})))
}

/// Starts the evaluation of a model file.
async fn file(State(sessions): Known, Query(of): Query<OfFile>, body: Bytes) -> Answer {
    let session = find(&sessions, &of.session)?;
    let model = blocking(move || parsed(&of.name, &body).map(|model| (of.name, model)));
    let (title, model) = model.await??;
    let model = Box::new(model);
    jobs::start(&session, Task::Second { title, model })?;
    let title = lock(&session).job.as_ref().map(|job| job.title.clone());
    Ok(Json(json!({ "title": title })))
}

async fn swap(State(sessions): Known, Json(of): Json<Of>) -> Answer {
    let session = find(&sessions, &of.session)?;
    let mut open = lock(&session);
    let second = Arc::make_mut(open.second.as_mut().ok_or_else(none)?);
    second.is_after = !second.is_after;
    Ok(Json(json!({})))
}

async fn close(State(sessions): Known, Json(of): Json<Of>) -> Answer {
    lock(&find(&sessions, &of.session)?).second = None;
    Ok(Json(json!({})))
}

/// The stretch that contributes most to the change of a cell.
async fn largest(State(sessions): Known, Query(of): Query<OfCell>) -> Answer {
    let session = find(&sessions, &of.session)?;
    let (second, present) = {
        let session = lock(&session);
        let second = session.second.clone().ok_or_else(none)?;
        (second, Arc::clone(&session.present().evaluated))
    };
    let found = blocking(move || {
        let [before, after] = second.ordered(&present);
        largest_change_in_part(before, after, of.by, &of.part, of.channel()?)
    });
    let (run, stretch) = found.await?.ok_or_else(OfCell::no_data)?;
    Ok(Json(json!({ "run": run, "stretch": stretch })))
}

fn none() -> Refusal {
    Refusal::conflict("there is no second model; select one")
}
