//! The proposed next experiment: what the models expect of it, and its currents as files.

use std::sync::Arc;

use axum::response::Response;
use axum::routing::get;
use axum::{Json, Router};
use hitch_identification::design::Proposal;
use serde::Deserialize;

use super::refusal::Refusal;
use super::request::{Answer, InQuery, blocking, lock};
use super::saving::attached;
use super::session::Session;
use super::sessions::Sessions;
use super::views::next_experiment::ExpectedRuns;
use hitch_output::archive::zipped;
use hitch_results::explanation::{planned, planned_files};

/// All routes of the next experiment.
pub fn routes() -> Router<Arc<Sessions>> {
    Router::new()
        .route("/{token}/api/next/expected", get(expected))
        .route("/{token}/api/next/currents", get(currents))
}

/// The result of a session that proposes an experiment.
#[derive(Debug, Deserialize)]
struct OfResult {
    of: Proposing,
}

/// A result that may propose an experiment.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Proposing {
    Explanation,
    Ranking,
}

impl Proposing {
    /// The proposal of a present result.
    fn proposal(self, session: &Session) -> Result<Proposal, Refusal> {
        let next = match self {
            Self::Explanation => session
                .present_explanation()
                .map(|explained| &explained.found.shown.next),
            Self::Ranking => session.present_ranking().map(|ranking| &ranking.shown.next),
        };
        let none =
            || Refusal::conflict("the model has changed; this experiment is no longer proposed");
        let proposal = next.and_then(|next| next.proposal.clone());
        proposal.ok_or_else(none)
    }
}

async fn expected(InQuery(session, of): InQuery<OfResult>) -> Answer<ExpectedRuns> {
    let proposal = of.of.proposal(&lock(&session))?;
    let view = blocking(move || ExpectedRuns::of(&proposal, &planned(&proposal)));
    Ok(Json(view.await?))
}

async fn currents(InQuery(session, of): InQuery<OfResult>) -> Result<Response, Refusal> {
    let proposal = of.of.proposal(&lock(&session))?;
    let bytes = blocking(move || {
        let files = planned_files(&proposal);
        let entries = files
            .iter()
            .map(|(name, text)| (name.clone(), text.as_bytes()));
        zipped(&entries.collect::<Vec<_>>())
    });
    Ok(attached("application/zip", "next.zip", bytes.await??))
}
