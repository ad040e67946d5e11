//! The short moves of a lab campaign, for tests with ringing pressures, which take long to simulate.

use hitch_campaign::Campaign;

use crate::seeds::cases;

/// Keeps the single moves of a lab campaign: eight runs of a few seconds, without flow bench, hold and duty cycles.
#[must_use]
pub fn short_moves(mut campaign: Campaign) -> Campaign {
    campaign.runs.retain(|run| {
        ["lift", "lower"]
            .iter()
            .any(|kind| run.file.starts_with(kind))
    });
    campaign
}

/// The short moves, or the whole campaign with `HITCH_THOROUGH`.
#[must_use]
pub fn few_runs(campaign: Campaign) -> Campaign {
    if cases(true, false) {
        short_moves(campaign)
    } else {
        campaign
    }
}
