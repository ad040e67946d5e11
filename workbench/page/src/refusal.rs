//! Why a request of the page is refused.

use super::fault::Fault;
use axum::Json;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use hitch_closed_loop::driven::MachineError;
use hitch_output::error::Error;
use serde_json::json;

/// Refusal of a request, with the fault that the page shows.
#[derive(Debug, PartialEq, Eq)]
pub struct Refusal {
    /// Status of the answer.
    pub status: StatusCode,
    fault: Fault,
}

impl Refusal {
    /// A request for something that does not exist.
    pub(super) fn of(status: StatusCode, what: &str) -> Self {
        Self {
            status,
            fault: what.to_owned().into(),
        }
    }

    /// A request with invalid content.
    pub(super) fn wrong(fault: impl Into<Fault>) -> Self {
        Self {
            status: StatusCode::UNPROCESSABLE_ENTITY,
            fault: fault.into(),
        }
    }

    /// A request that conflicts with the state of the session.
    pub(super) fn conflict(what: &str) -> Self {
        Self::of(StatusCode::CONFLICT, what)
    }
}

impl From<MachineError> for Refusal {
    fn from(error: MachineError) -> Self {
        Error::from(error).into()
    }
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Self {
        Self::wrong(&error)
    }
}

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        (self.status, Json(json!({ "fault": self.fault }))).into_response()
    }
}
