//! HTTP routes of the page.

use std::sync::Arc;

use axum::extract::{Path, State};
use axum::http::StatusCode;
use axum::response::sse::{Event, KeepAlive, Sse};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use axum::{Json, Router};
use futures_util::stream::{Stream, unfold};
use hitch_identification::estimate::Estimate;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;
use tokio::sync::broadcast::error::RecvError;

use super::fault::Fault;
use super::own_term::{FormulaElements, TermForm};
use super::parameters::moved;
use super::session::Step;
use super::sessions::{Sessions, Shared};
use super::source::Subject;
use super::tasks::Task;
use super::views::run::RunView;
use super::views::state::{Begun, State as SessionState};
use super::views::trial::{RunParts, Signature, TriedRuns};
use super::{assets, first, first_table, jobs, live, next_routes, saving, second_routes, upload};
use crate::refusal::Refusal;
use crate::request::{Answer, InBody, InQuery, Known, OfCell, OfStep, blocking, done, idle, lock};
use hitch_output::error::Error;
use hitch_results::comparison::{WorstStretch, worst_in_part};
use hitch_results::report::map_view::Located;
use hitch_results::web::plot::{Samples, SimulatedChannel};

/// All routes, protected by the token.
pub fn routes() -> Router<Arc<Sessions>> {
    Router::new()
        .route("/{token}/", get(page))
        .route("/{token}/{file}", get(file))
        .route("/{token}/api/begin", post(begin))
        .route("/{token}/api/state", get(state))
        .route("/{token}/api/run", get(run))
        .route("/{token}/api/worst", get(worst))
        .route("/{token}/api/signature", get(signature))
        .route("/{token}/api/formulas", get(formulas))
        .route("/{token}/api/check", post(check))
        .route("/{token}/api/preview", post(preview))
        .route("/{token}/api/preview/all", post(preview_all))
        .route("/{token}/api/start", post(start))
        .route("/{token}/api/cancel", post(cancel))
        .route("/{token}/api/go", post(go))
        .route("/{token}/api/events", get(events))
        .merge(first::routes())
        .merge(first_table::routes())
        .merge(live::routes())
        .merge(next_routes::routes())
        .merge(saving::routes())
        .merge(second_routes::routes())
        .merge(upload::routes())
}

async fn page() -> Response {
    named("")
}

async fn file(Path((_, name)): Path<(String, String)>) -> Response {
    named(&name)
}

fn named(name: &str) -> Response {
    assets::file(name).unwrap_or_else(|| StatusCode::NOT_FOUND.into_response())
}

async fn begin(State(sessions): Known) -> Answer<Begun> {
    let begun = blocking(move || {
        let (id, session) = sessions.begin()?;
        let state = SessionState::of(&lock(&session));
        Ok::<_, Error>(Begun { session: id, state })
    });
    Ok(Json(begun.await??))
}

async fn state(InQuery(session, _): InQuery) -> Answer<SessionState> {
    let view = blocking(move || SessionState::of(&lock(&session)));
    Ok(Json(view.await?))
}

#[derive(Debug, Deserialize)]
struct OfRun {
    run: usize,
}

async fn run(InQuery(session, of): InQuery<OfRun>) -> Answer<RunView> {
    let view = blocking(move || RunView::of(&lock(&session), of.run));
    let no_run = || Refusal::of(StatusCode::NOT_FOUND, "the run is not in the campaign");
    Ok(Json(view.await?.ok_or_else(no_run)?))
}

async fn worst(InQuery(session, of): InQuery<OfCell>) -> Answer<Located<WorstStretch>> {
    let evaluated = Arc::clone(&lock(&session).present().evaluated);
    let worst = move || worst_in_part(&evaluated, of.by, &of.part, of.channel()?);
    let found = blocking(worst).await?.ok_or_else(OfCell::no_data)?;
    Ok(Json(found.into()))
}

/// A candidate of the ranking, and the run to show its signature in.
#[derive(Debug, Deserialize)]
struct OfCandidate {
    run: usize,
    effect: String,
}

async fn signature(InQuery(session, of): InQuery<OfCandidate>) -> Answer<RunParts<Signature>> {
    let (subject, step, ranking) = {
        let session = lock(&session);
        (
            Arc::clone(session.subject()),
            session.present().clone(),
            session.present_ranking().cloned(),
        )
    };
    let unranked = || Refusal::conflict("the model has changed; rank the effects again");
    let ranking = ranking.ok_or_else(unranked)?;
    let view = blocking(move || RunParts::signature(&subject, &step, &ranking, &of.effect, of.run));
    let none = || Refusal::of(StatusCode::NOT_FOUND, "the run or candidate does not exist");
    Ok(Json(view.await?.ok_or_else(none)?))
}

/// A run to redraw with a parameter set by hand.
#[derive(Debug, Deserialize)]
struct TrialOfRun {
    run: usize,
    #[serde(flatten)]
    trial: Trial,
}

/// A parameter of an effect set by hand.
#[derive(Debug, Deserialize)]
struct Trial {
    effect: usize,
    parameter: usize,
    value: f64,
}

impl Trial {
    /// The model of the trial: the campaign, the present step, and its estimate with the parameter set.
    fn applied(&self, session: &Shared) -> Result<(Arc<Subject>, Step, Estimate), Refusal> {
        let session = lock(session);
        let step = session.present().clone();
        let estimate = &step.evaluated.fit.estimate;
        let estimate = moved(estimate, self.effect, self.parameter, self.value);
        let gone = || Refusal::conflict("the parameter is no longer in the model");
        Ok((
            Arc::clone(session.subject()),
            step,
            estimate.ok_or_else(gone)?,
        ))
    }
}

async fn preview(
    InBody(session, TrialOfRun { run, trial }): InBody<TrialOfRun>,
) -> Answer<RunParts<SimulatedChannel<Samples>>> {
    let (subject, step, estimate) = trial.applied(&session)?;
    let view = blocking(move || RunParts::preview(&subject, &step, &estimate, run));
    let none = || Refusal::conflict("the run does not exist");
    Ok(Json(view.await?.ok_or_else(none)?))
}

async fn preview_all(InBody(session, trial): InBody<Trial>) -> Answer<TriedRuns> {
    let (subject, step, estimate) = trial.applied(&session)?;
    let view = blocking(move || TriedRuns::of(&subject, &step, estimate));
    Ok(Json(view.await?))
}

async fn formulas() -> Json<FormulaElements> {
    Json(FormulaElements::all())
}

/// A term to look at.
#[derive(Debug, Deserialize)]
struct Draft {
    term: TermForm,
}

/// The answer about a term.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct Checked {
    /// What is wrong with it.
    fault: Option<Fault>,
}

/// What is wrong with a term; nothing if it is right.
async fn check(Json(draft): Json<Draft>) -> Answer<Checked> {
    let fault = blocking(move || draft.term.check()).await?;
    Ok(Json(Checked { fault }))
}

async fn start(InBody(session, task): InBody<Task>) -> Answer {
    jobs::start(&session, task)?;
    let title = lock(&session).job.as_ref().map(|job| job.title.clone());
    Ok(Json(json!({ "title": title })))
}

async fn cancel(InBody(session, _): InBody) -> Answer {
    lock(&session).cancel();
    done()
}

async fn go(InBody(session, to): InBody<OfStep>) -> Answer {
    let mut open = lock(&session);
    idle(&open)?;
    if open.go(to.at) {
        done()
    } else {
        Err(Refusal::conflict("the step no longer exists"))
    }
}

async fn events(
    InQuery(session, _): InQuery,
) -> Result<Sse<impl Stream<Item = Result<Event, axum::Error>>>, Refusal> {
    let messages = lock(&session).messages.subscribe();
    let events = unfold(messages, |mut messages| async {
        let message = loop {
            match messages.recv().await {
                Ok(message) => break message,
                // A slow tab loses messages. The state that it requests at the end contains their results.
                Err(RecvError::Lagged(_)) => {}
                Err(RecvError::Closed) => return None,
            }
        };
        Some((Event::default().json_data(message), messages))
    });
    Ok(Sse::new(events).keep_alive(KeepAlive::default()))
}
