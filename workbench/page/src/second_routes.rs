//! Requests about the second model.

use std::sync::Arc;

use axum::body::Bytes;
use axum::extract::DefaultBodyLimit;
use axum::routing::{get, post};
use axum::{Json, Router};
use serde_json::json;

use super::first::{LARGEST_MODEL, OfFile, parsed};
use super::jobs;
use super::refusal::Refusal;
use super::request::{Answer, InBody, InQuery, OfCell, OfStep, blocking, done, lock};
use super::session::Session;
use super::sessions::Sessions;
use super::tasks::Task;
use crate::second::Second;
use hitch_results::comparison::{ChangedStretch, largest_change_in_part};
use hitch_results::report::map_view::Located;

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

async fn step(InBody(session, of): InBody<OfStep>) -> Answer {
    let mut open = lock(&session);
    let second = of_step(&open, of.at);
    let gone = || Refusal::conflict("the step no longer exists");
    open.second = Some(Arc::new(second.ok_or_else(gone)?));
    done()
}

/// Starts the evaluation of a model file.
async fn file(InQuery(session, of): InQuery<OfFile>, body: Bytes) -> Answer {
    let model = blocking(move || parsed(&of.name, &body).map(|model| (of.name, model)));
    let (title, model) = model.await??;
    let model = Box::new(model);
    jobs::start(&session, Task::Second { title, model })?;
    let title = lock(&session).job.as_ref().map(|job| job.title.clone());
    Ok(Json(json!({ "title": title })))
}

async fn swap(InBody(session, _): InBody) -> Answer {
    let mut open = lock(&session);
    let second = Arc::make_mut(open.second.as_mut().ok_or_else(none)?);
    second.is_after = !second.is_after;
    done()
}

async fn close(InBody(session, _): InBody) -> Answer {
    lock(&session).second = None;
    done()
}

/// The stretch that contributes most to the change of a cell.
async fn largest(InQuery(session, of): InQuery<OfCell>) -> Answer<Located<ChangedStretch>> {
    let (second, present) = {
        let session = lock(&session);
        let second = session.second.clone().ok_or_else(none)?;
        (second, Arc::clone(&session.present().evaluated))
    };
    let found = blocking(move || {
        let [before, after] = second.ordered(&present);
        largest_change_in_part(before, after, of.by, &of.part, of.channel()?)
    });
    let found = found.await?.ok_or_else(OfCell::no_data)?;
    Ok(Json(found.into()))
}

fn none() -> Refusal {
    Refusal::conflict("there is no second model; select one")
}

/// A step of the session; `None` if it does not exist.
fn of_step(session: &Session, at: usize) -> Option<Second> {
    let step = session.steps().get(at)?;
    Some(Second {
        title: format!("step {at}: {}", step.title),
        model: session.subject().model.clone(),
        evaluated: Arc::clone(&step.evaluated),
        is_after: false,
    })
}
