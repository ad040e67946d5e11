//! What a running computation says to its tab.

use schemars::JsonSchema;
use serde::Serialize;

use super::candidate::ShownCandidate;

/// A message of a computation to its tab.
#[derive(Debug, Clone, Serialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Message {
    /// How far it is.
    Progress {
        /// The current stage.
        text: String,
        /// The completed fraction, 0 to 1; `null` if unknown.
        fraction: Option<f64>,
        /// The error of a fit, sigma.
        error: Option<f64>,
    },
    /// An effect of a ranking was evaluated.
    Candidate {
        /// The effect.
        candidate: ShownCandidate,
        /// The completed fraction, 0 to 1.
        fraction: f64,
    },
    /// It ended; the state has its result.
    Done,
    /// It failed.
    Failed {
        /// The reason.
        text: String,
    },
}
