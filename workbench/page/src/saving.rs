//! What a session saves: calibration, report, and all files as an archive.

use std::sync::Arc;

use axum::Router;

use axum::http::header;
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use hitch_controller_host::calibration_file;

use super::refusal::Refusal;
use super::request::{InQuery, blocking, lock};
use super::session::Session;
use super::sessions::{Sessions, Shared};
use hitch_closed_loop::driven::calibration;
use hitch_output::archive::zipped;
use hitch_output::error::Error;
use hitch_results::comparison::Comparison;
use hitch_results::explanation::Found;
use hitch_results::report::{comparison_page, explanation_page};

pub(super) const TOML: &str = "application/toml; charset=utf-8";

/// All routes of saved files.
pub fn routes() -> Router<Arc<Sessions>> {
    Router::new()
        .route("/{token}/api/model", get(model))
        .route("/{token}/api/save/tuned", get(tuned))
        .route("/{token}/api/save/report", get(report))
        .route("/{token}/api/save/all", get(all))
}

async fn model(InQuery(session, _): InQuery) -> Result<Response, Refusal> {
    let mut session = lock(&session);
    session.saved = Some(Arc::clone(&session.present().evaluated));
    Ok(attached(TOML, "model.toml", model_file(&session)))
}

async fn tuned(InQuery(session, _): InQuery) -> Result<Response, Refusal> {
    let tuned = lock(&session).present_tuned().cloned();
    let none = || Refusal::conflict("no calibration is tuned for the present model; tune it first");
    Ok(attached(
        TOML,
        "tuned.toml",
        tuned.ok_or_else(none)?.text.clone(),
    ))
}

async fn report(InQuery(session, _): InQuery) -> Result<Response, Refusal> {
    let page = blocking(move || page(&session)).await?;
    Ok(attached("text/html; charset=utf-8", "report.html", page))
}

async fn all(InQuery(session, _): InQuery) -> Result<Response, Refusal> {
    let bytes = blocking(move || archived(&session)).await??;
    Ok(attached("application/zip", "hitch.zip", bytes))
}

/// An answer that a browser saves as a file.
pub(super) fn attached(kind: &'static str, name: &str, content: impl IntoResponse) -> Response {
    let headers = [
        (header::CONTENT_TYPE, kind.to_owned()),
        (
            header::CONTENT_DISPOSITION,
            format!("attachment; filename=\"{name}\""),
        ),
    ];
    (headers, content).into_response()
}

/// The present model as a file, with the steps that led to it.
fn model_file(session: &Session) -> String {
    let mut text = String::from("# Made with hitch serve:\n");
    for (number, step) in session.steps()[..=session.at()].iter().enumerate() {
        let error = step.evaluated.fit.error();
        let title = step.title.replace(char::is_control, " ");
        text += &format!("# {number}. {title}: error {error:.2} sigma\n");
    }
    text + &hitch_model_file::to_toml(&session.rebuilt())
}

/// The calibration file of the present model.
fn calibration_text(session: &Session) -> Result<String, Error> {
    let calibration = calibration(&session.rebuilt())?;
    Ok(calibration_file::write(&calibration))
}

/// The report of the explanation; without one, of the present model against the campaign.
fn page(session: &Shared) -> String {
    let (explained, evaluated, first) = {
        let session = lock(session);
        (
            session.present_explanation().cloned(),
            Arc::clone(&session.present().evaluated),
            Arc::clone(session.subject()),
        )
    };
    let Some(explained) = explained else {
        let comparison = Comparison::of(&evaluated, &first.model);
        return comparison_page::page(&comparison, &evaluated, &first.model);
    };
    let (experiment, model) = (first.experiment().clone(), explained.model.clone());
    let found = explained.found.clone();
    explanation_page::page(&Found::finished(experiment, model, found))
}

/// Model, calibration, tuned calibration if there is one, and report.
fn archived(session: &Shared) -> Result<Vec<u8>, Error> {
    let (model, calibration, tuned) = {
        let mut session = lock(session);
        session.saved = Some(Arc::clone(&session.present().evaluated));
        (
            model_file(&session),
            calibration_text(&session)?,
            session.present_tuned().cloned(),
        )
    };
    let page = page(session);
    let mut entries = vec![
        ("model.toml".to_owned(), model.as_bytes()),
        ("calibration.toml".to_owned(), calibration.as_bytes()),
        ("report.html".to_owned(), page.as_bytes()),
    ];
    if let Some(tuned) = &tuned {
        entries.push(("tuned.toml".to_owned(), tuned.text.as_bytes()));
    }
    zipped(&entries)
}
