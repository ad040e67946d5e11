//! The first model of a session: exchanged for a file, a starting point or the values of data sheets, without a restart.

use std::path::Path;
use std::sync::Arc;

use axum::body::Bytes;
use axum::extract::DefaultBodyLimit;
use axum::routing::{get, post};
use axum::{Json, Router};
use hitch_input::source_file::SourceFile;
use hitch_model_file::Template;
use hitch_plant::Model;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::refusal::Refusal;
use super::request::{Answer, InBody, InQuery, blocking, done, idle, lock};
use super::sessions::{Sessions, Shared};
use hitch_output::error::Error;
use hitch_results::arguments::known_constants::{ConstantFault, KnownConstants};
use hitch_results::base_model::data_sheet::{self, ENDS, QUESTIONS, VALVES};

/// Maximum size of a model file, bytes.
pub const LARGEST_MODEL: usize = 1 << 20;

/// All routes of the first model.
pub fn routes() -> Router<Arc<Sessions>> {
    let file = post(file).layer(DefaultBodyLimit::max(LARGEST_MODEL));
    Router::new()
        .route("/{token}/api/first/file", file)
        .route("/{token}/api/first/named", post(named))
        .route("/{token}/api/first/sheet", get(sheet).post(from_sheet))
        .route("/{token}/api/first/back", post(back))
        .route("/{token}/api/first/known", post(known))
}

/// A model file for a session.
#[derive(Debug, Deserialize)]
pub(super) struct OfFile {
    pub name: String,
}

async fn file(InQuery(session, of): InQuery<OfFile>, body: Bytes) -> Answer {
    let model = blocking(move || parsed(&of.name, &body)).await??;
    exchange(session, model).await
}

/// The model of a file.
///
/// # Errors
/// If it is no model.
pub fn parsed(name: &str, bytes: &[u8]) -> Result<Model, Error> {
    let path = Path::new(name);
    Ok(hitch_model_file::parse(&SourceFile::of(path, bytes)?)?)
}

/// The model of a template; `what` makes it.
///
/// # Errors
/// If it is no model.
pub fn made(what: &str, template: &Template, name: &str) -> Result<Model, Error> {
    let text = template.text().map_err(|error| {
        let (fault, hint) = (error.what, error.hint);
        Error::Usage(format!("{what} no machine: {fault}; {hint}"))
    })?;
    parsed(name, text.as_bytes())
}

/// A model of the program.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum StartingPoint {
    Nominal,
    Dynamic,
}

#[derive(Debug, Deserialize)]
struct Named {
    name: StartingPoint,
}

async fn named(InBody(session, wanted): InBody<Named>) -> Answer {
    let model = match wanted.name {
        StartingPoint::Nominal => hitch_model_file::nominal(),
        StartingPoint::Dynamic => hitch_model_file::dynamic(),
    };
    exchange(session, model).await
}

/// The questions of data sheets.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct Sheet {
    /// The questions in their order.
    questions: Vec<Question>,
}

/// A question, with the value of the first model.
#[derive(Debug, Serialize, JsonSchema)]
struct Question {
    /// Name of the constant.
    name: String,
    /// The question.
    question: String,
    /// The value, as in a model file.
    value: String,
}

/// The questions of data sheets, with the values of the first model.
async fn sheet(InQuery(session, _): InQuery) -> Answer<Sheet> {
    let model = lock(&session).subject().model.clone();
    let template = Template::of(&model.name, &model);
    let constant = |(name, question): &(&str, &str)| {
        // A machine does not have every constant.
        let value = template.get(name).ok()?;
        Some(Question {
            name: (*name).to_owned(),
            question: (*question).to_owned(),
            value,
        })
    };
    let mut questions: Vec<Question> = QUESTIONS.iter().filter_map(constant).collect();
    for (valve, title) in VALVES {
        let ends = data_sheet::ends(template.curve(valve));
        questions.extend(ENDS.iter().zip(ends).map(|((key, what), value)| Question {
            name: format!("{}.{key}", valve.key()),
            question: format!("{title}, {what}"),
            value: format!("{value:.3}"),
        }));
    }
    Ok(Json(Sheet { questions }))
}

/// The answers to changed questions, in the order of the questions.
#[derive(Debug, Deserialize)]
struct Answers {
    name: String,
    values: Vec<(String, String)>,
}

async fn from_sheet(InBody(session, answers): InBody<Answers>) -> Answer {
    let before = lock(&session).subject().model.clone();
    let model = blocking(move || answers.model(&before)).await??;
    exchange(session, model).await
}

impl Answers {
    /// The model with these values.
    fn model(&self, before: &Model) -> Result<Model, Error> {
        let name = self.name.trim();
        let name = if name.is_empty() { "data-sheet" } else { name };
        let mut template = Template::of(name, before);
        let mut ends = VALVES.map(|(valve, _)| data_sheet::ends(template.curve(valve)));
        for (name, value) in &self.values {
            match end(name) {
                Some((valve, end)) => {
                    ends[valve][end] = data_sheet::positive(value)
                        .map_err(|why| Error::Usage(format!("{name}: {why}")))?;
                }
                None => template.set(name, value).map_err(Error::Usage)?,
            }
        }
        for ((valve, title), ends) in VALVES.into_iter().zip(ends) {
            if ends != data_sheet::ends(template.curve(valve)) {
                let curve = data_sheet::curve(template.curve(valve), ends)
                    .map_err(|why| Error::Usage(format!("{title}: {why}")))?;
                template.set_curve(valve, curve);
            }
        }
        made("the values make", &template, name)
    }
}

/// Index of the valve and of the end of its curve that a question is about.
fn end(name: &str) -> Option<(usize, usize)> {
    let (table, key) = name.split_once('.')?;
    let valve = VALVES.iter().position(|(valve, _)| valve.key() == table)?;
    let end = ENDS.iter().position(|(known, _)| *known == key)?;
    Some((valve, end))
}

/// What is known of constants, to look at.
#[derive(Debug, Deserialize)]
struct Draft {
    known: KnownConstants,
}

/// The answer about what is known of constants.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct CheckedConstants {
    /// What is wrong with it.
    faults: Vec<ConstantFault>,
}

/// What is wrong with what is known of constants of the present model.
async fn known(InBody(session, draft): InBody<Draft>) -> Answer<CheckedConstants> {
    let model = lock(&session).rebuilt();
    let faults = blocking(move || draft.known.faults(&model)).await?;
    Ok(Json(CheckedConstants { faults }))
}

async fn back(InBody(session, _): InBody) -> Answer {
    let mut open = lock(&session);
    idle(&open)?;
    if open.back() {
        done()
    } else {
        Err(Refusal::conflict("there is no earlier first model"))
    }
}

/// Evaluates another first model on the campaign of the session.
pub(super) async fn exchange(session: Shared, model: Model) -> Answer {
    let subject = {
        let open = lock(&session);
        idle(&open)?;
        Arc::clone(open.subject())
    };
    let exchanged = blocking(move || subject.exchanged(model)).await??;
    let mut open = lock(&session);
    idle(&open)?;
    open.exchange(Arc::new(exchanged));
    done()
}
