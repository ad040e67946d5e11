//! What the requests of a tab have in common.

use crate::refusal::Refusal;
use crate::session::Session;
use crate::sessions::{Sessions, Shared};
use axum::Json;
use axum::extract::{FromRequest, FromRequestParts, Query, Request, State};
use axum::http::StatusCode;
use axum::http::request::Parts;
use axum::response::{IntoResponse, Response};
use hitch_plant::Channel;
use hitch_results::comparison::Grouping;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::sync::{Arc, MutexGuard, PoisonError};

/// The sessions of all tabs.
pub(super) type Known = State<Arc<Sessions>>;

/// A view, or the refusal of a request.
pub(super) type Answer<T = Value> = Result<Json<T>, Refusal>;

/// The session of a request by its query, and what else the query says.
pub(super) struct InQuery<T = Nothing>(pub(super) Shared, pub(super) T);

/// The session of a request by its body, and what else the body says.
pub(super) struct InBody<T = Nothing>(pub(super) Shared, pub(super) T);

/// Nothing but the session.
#[derive(Debug, Deserialize)]
pub(super) struct Nothing {}

/// The id of a session, with what is asked of it.
#[derive(Debug, Deserialize)]
struct OfSession<T> {
    session: String,
    #[serde(flatten)]
    asked: T,
}

impl<T: DeserializeOwned> FromRequestParts<Arc<Sessions>> for InQuery<T> {
    type Rejection = Response;

    async fn from_request_parts(
        parts: &mut Parts,
        sessions: &Arc<Sessions>,
    ) -> Result<Self, Response> {
        // A text of a query becomes a number only outside a flattened structure.
        let of = Query::<OfSession<Nothing>>::try_from_uri(&parts.uri);
        let Query(of) = of.map_err(IntoResponse::into_response)?;
        let asked = Query::<T>::try_from_uri(&parts.uri);
        let Query(asked) = asked.map_err(IntoResponse::into_response)?;
        let session = find(sessions, &of.session).map_err(IntoResponse::into_response)?;
        Ok(Self(session, asked))
    }
}

impl<T: DeserializeOwned> FromRequest<Arc<Sessions>> for InBody<T> {
    type Rejection = Response;

    async fn from_request(request: Request, sessions: &Arc<Sessions>) -> Result<Self, Response> {
        let body = Json::<OfSession<T>>::from_request(request, sessions).await;
        let Json(of) = body.map_err(IntoResponse::into_response)?;
        let session = find(sessions, &of.session).map_err(IntoResponse::into_response)?;
        Ok(Self(session, of.asked))
    }
}

/// A step of a session.
#[derive(Debug, Deserialize)]
pub(super) struct OfStep {
    /// Its index.
    pub(super) at: usize,
}

/// A cell of an error map.
#[derive(Debug, Deserialize)]
pub struct OfCell {
    /// Grouping of the map's rows.
    pub by: Grouping,
    /// Row.
    pub part: String,
    channel: String,
}

impl OfCell {
    /// The channel of its column; `None` if there is no such channel.
    pub fn channel(&self) -> Option<Channel> {
        let mut channels = Channel::ALL.into_iter();
        channels.find(|channel| channel.key() == self.channel)
    }

    /// The refusal of a cell without data.
    pub fn no_data() -> Refusal {
        Refusal::of(StatusCode::NOT_FOUND, "this cell has no data")
    }
}

/// The session of a tab.
fn find(sessions: &Sessions, id: &str) -> Result<Shared, Refusal> {
    let unknown = || Refusal::of(StatusCode::GONE, "the session has expired; reload the page");
    sessions.get(id).ok_or_else(unknown)
}

/// A session to look at or to change; a computation that failed leaves it as it was.
pub(super) fn lock(session: &Shared) -> MutexGuard<'_, Session> {
    session.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Refuses a request that a running computation forbids.
pub(super) fn idle(session: &Session) -> Result<(), Refusal> {
    match session.job {
        None => Ok(()),
        Some(_) => Err(Refusal::conflict(
            "a computation is running; wait for it or cancel it",
        )),
    }
}

/// The page has nothing more to learn.
pub(super) fn done() -> Answer {
    Ok(Json(Value::Object(Map::new())))
}

/// Computes off the threads that answer requests.
pub(super) async fn blocking<T: Send + 'static>(
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, Refusal> {
    let failed = |_| {
        let what = "the computation failed; undo the last step, or reload the page";
        Refusal::of(StatusCode::INTERNAL_SERVER_ERROR, what)
    };
    tokio::task::spawn_blocking(work).await.map_err(failed)
}
