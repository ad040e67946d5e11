//! What the requests of a tab have in common.

use crate::comparison::Grouping;
use crate::serve::refusal::Refusal;
use crate::serve::session::Session;
use crate::serve::sessions::{Sessions, Shared};
use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use hitch_plant::Channel;
use serde::Deserialize;
use serde_json::{Map, Value};
use std::sync::{Arc, MutexGuard, PoisonError};

/// The sessions of all tabs.
pub(super) type Known = State<Arc<Sessions>>;

/// A view, or the refusal of a request.
pub(super) type Answer<T = Value> = Result<Json<T>, Refusal>;

/// The session of a request.
#[derive(Debug, Deserialize)]
pub(super) struct Of {
    /// Its id.
    pub(super) session: String,
}

/// A cell of an error map.
#[derive(Debug, Deserialize)]
pub struct OfCell {
    /// The session.
    pub session: String,
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
pub(super) fn find(sessions: &Sessions, id: &str) -> Result<Shared, Refusal> {
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
