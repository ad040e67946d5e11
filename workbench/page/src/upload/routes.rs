//! HTTP routes of uploads.

use std::path::Path;
use std::sync::{Arc, PoisonError};

use axum::body::Body;
use axum::extract::{DefaultBodyLimit, State};
use axum::http::{HeaderMap, StatusCode, header};
use axum::routing::post;
use axum::{Json, Router};
use hitch_campaign::Campaign;
use hitch_input::input_error::InputError;
use hitch_plant::Model;
use serde::Deserialize;
use serde_json::json;

use super::assignment::Assignment;
use super::folder::{Upload, plain_name, too_much};
use super::incoming::receive;
use super::limits::{LARGEST_ASSIGNMENT, LIFETIME, LONGEST, MOST_BYTES, MOST_FILES};
use super::proposal::Proposal;
use super::surveyed::Surveyed;
use crate::refusal::Refusal;
use crate::request::{Answer, InBody, InQuery, Known, blocking, done, idle, lock};
use crate::sessions::{Sessions, Shared};
use crate::source::{Origin, Subject};
use hitch_output::error::Error;

/// All routes of uploads.
pub fn routes() -> Router<Arc<Sessions>> {
    let open = post(open).layer(DefaultBodyLimit::max(LARGEST_ASSIGNMENT));
    Router::new()
        .route("/{token}/api/upload/begin", post(begin))
        .route("/{token}/api/upload/file", post(file))
        .route("/{token}/api/upload/survey", post(survey))
        .route("/{token}/api/upload/discard", post(discard))
        .route("/{token}/api/upload/open", open)
}

/// Number and size of the files to come.
#[derive(Debug, Deserialize)]
struct Begin {
    files: usize,
    bytes: u64,
}

/// Starts an upload; deletes the files of an earlier one.
async fn begin(State(sessions): Known, InBody(session, wanted): InBody<Begin>) -> Answer {
    if wanted.files == 0 {
        return Err(Refusal::wrong("there is no file".to_owned()));
    }
    if wanted.files > MOST_FILES || wanted.bytes > MOST_BYTES {
        return Err(too_much());
    }
    let upload = Arc::new(sessions.folders.begin()?);
    let id = upload.id.clone();
    let (late, of) = (Arc::downgrade(&session), id.clone());
    tokio::spawn(async move {
        tokio::time::sleep(LIFETIME).await;
        if let Some(session) = late.upgrade() {
            lock(&session).upload.take_if(|upload| upload.id == of);
        }
    });
    lock(&session).upload = Some(upload);
    Ok(Json(json!({ "upload": id })))
}

/// An upload of a tab.
#[derive(Debug, Deserialize)]
struct OfUpload {
    upload: String,
}

/// A file of an upload.
#[derive(Debug, Deserialize)]
struct OfFile {
    upload: String,
    name: String,
}

async fn file(InQuery(session, of): InQuery<OfFile>, headers: HeaderMap, body: Body) -> Answer {
    let upload = upload(&session, &of.upload)?;
    let name = plain_name(&of.name)?;
    let length = headers.get(header::CONTENT_LENGTH);
    let length: Option<u64> = length.and_then(|length| length.to_str().ok()?.parse().ok());
    if length.is_some_and(|length| length > MOST_BYTES) {
        return Err(too_much());
    }
    receive(&upload, name, body.into_data_stream(), LONGEST).await?;
    Ok(Json(json!({ "file": name })))
}

/// The proposed assignment.
async fn survey(InBody(session, of): InBody<OfUpload>) -> Answer<Surveyed> {
    let upload = upload(&session, &of.upload)?;
    let subject = Arc::clone(lock(&session).subject());
    let view = blocking(move || {
        let incomplete = || Refusal::conflict("a file is still being received");
        let files = upload.files().ok_or_else(incomplete)?;
        let proposal = Proposal::new(upload.path(), &files, subject.model.linkage());
        let proposal = proposal.map_err(|error| named(&upload, error))?;
        let view = Surveyed::of(&proposal);
        let mut known = upload
            .proposal
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        *known = Some(proposal);
        Ok::<_, Refusal>(view)
    });
    Ok(Json(view.await??))
}

/// Deletes the files.
async fn discard(InBody(session, _): InBody) -> Answer {
    lock(&session).upload = None;
    done()
}

/// The edited assignment of an upload.
#[derive(Debug, Deserialize)]
struct Open {
    upload: String,
    #[serde(flatten)]
    assignment: Assignment,
}

/// A campaign that was opened from an upload; its files are kept as long as it is open, as another first model reads them again.
#[derive(Debug)]
struct Opened {
    upload: Arc<Upload>,
    assignment: Assignment,
}

impl Opened {
    /// The campaign for a model, and which logs are joined, split or cut.
    fn campaign(&self, model: &Model) -> Result<(Campaign, Vec<String>), Error> {
        let upload = &self.upload;
        let proposal = upload.proposal.lock();
        let proposal = proposal.unwrap_or_else(PoisonError::into_inner);
        let unknown = || Error::Usage("the files have not been surveyed".to_owned());
        let proposal = proposal.as_ref().ok_or_else(unknown)?;
        let read = self
            .assignment
            .campaign(upload.path(), proposal, model.linkage());
        read.map_err(|error| named(upload, error))
    }
}

impl Origin for Opened {
    fn subject(self: Arc<Self>, model: Model) -> Result<Subject, Error> {
        let (campaign, _) = self.campaign(&model)?;
        Ok(Subject::new(self, &campaign, model))
    }
}

/// Opens the campaign in the session. Answers which logs are joined, split or cut.
async fn open(InBody(session, wanted): InBody<Open>) -> Answer {
    let upload = upload(&session, &wanted.upload)?;
    let model = {
        let session = lock(&session);
        idle(&session)?;
        session.subject().model.clone()
    };
    let from = Arc::clone(&upload);
    let subject = blocking(move || {
        let proposal = from.proposal.lock().unwrap_or_else(PoisonError::into_inner);
        let unknown = || Refusal::conflict("the files have not been surveyed");
        proposal.as_ref().ok_or_else(unknown)?;
        drop(proposal);
        let opened = Arc::new(Opened {
            upload: from,
            assignment: wanted.assignment,
        });
        let (campaign, notes) = opened.campaign(&model)?;
        Ok::<_, Refusal>((Subject::new(opened, &campaign, model), notes))
    });
    let (subject, notes) = subject.await??;
    let subject = Arc::new(subject);
    let mut session = lock(&session);
    idle(&session)?;
    session.open(subject);
    session.upload.take_if(|known| known.id == upload.id);
    Ok(Json(json!({ "notes": notes })))
}

fn upload(session: &Shared, id: &str) -> Result<Arc<Upload>, Refusal> {
    let session = lock(session);
    let known = session.upload.as_ref().filter(|upload| upload.id == id);
    let unknown = || Refusal::of(StatusCode::GONE, "the files are deleted; open them again");
    known.cloned().ok_or_else(unknown)
}

/// An error with the names of files as the user knows them.
fn named(upload: &Upload, error: Error) -> Error {
    let within = |text: &str| {
        let mut text = text.to_owned();
        for folder in [
            Some(upload.path().to_path_buf()),
            upload.path().canonicalize().ok(),
        ] {
            let folder = folder.unwrap_or_default().join("");
            text = text.replace(&*folder.to_string_lossy(), "");
        }
        text
    };
    match error {
        Error::Input(input) => Error::Input(InputError {
            file: Path::new(&within(&input.file.to_string_lossy())).to_path_buf(),
            what: within(&input.what),
            hint: within(&input.hint),
            ..input
        }),
        Error::Usage(text) => Error::Usage(within(&text)),
        other => other,
    }
}
