//! Why a request of the page is refused.

use crate::error::Error;
use axum::Json;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use hitch_closed_loop::driven::MachineError;
use serde_json::Value;
use serde_json::json;

/// Refusal of a request, with the fault that the page shows.
pub(super) struct Refusal {
    status: StatusCode,
    fault: Value,
}

impl Refusal {
    /// A request for something that does not exist.
    pub(super) fn of(status: StatusCode, what: &str) -> Self {
        Self {
            status,
            fault: json!({ "what": what }),
        }
    }

    /// A request with invalid content.
    pub(super) fn wrong(fault: Value) -> Self {
        Self {
            status: StatusCode::UNPROCESSABLE_ENTITY,
            fault,
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
        Self {
            status: StatusCode::UNPROCESSABLE_ENTITY,
            fault: fault(&error),
        }
    }
}

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        (self.status, Json(json!({ "fault": self.fault }))).into_response()
    }
}

/// A fault, with file and position if a file is its cause.
fn fault(error: &Error) -> Value {
    match error {
        Error::Input(input) => json!({
            "file": input.file.display().to_string(),
            "line": input.place.map(|place| place.line),
            "column": input.place.map(|place| place.column),
            "what": input.what,
            "hint": input.hint,
        }),
        other => json!({ "what": other.to_string() }),
    }
}
