//! Options of a search for missing effects.

use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use hitch_identification::data::limit::Limit;
use hitch_identification::search::options::Options;

use crate::arguments::interruption::requested;

/// Time after which a search ends, s, unless another one is given.
pub const BUDGET_S: f64 = 60.0;

/// Arguments of a search.
#[derive(Debug, Clone, Copy, clap::Args)]
pub struct SearchArgs {
    /// Leave the effects that the model has as they are: look for new ones only
    #[arg(long)]
    frozen: bool,
    /// End after this time with the best account so far, s; Ctrl-C ends it at once
    #[arg(long, value_name = "SECONDS", value_parser = seconds, default_value_t = BUDGET_S)]
    budget: f64,
}

impl SearchArgs {
    /// The options of a search that starts now.
    pub fn options(&self) -> Options<'static> {
        Options {
            changes: !self.frozen,
            limit: limit(self.budget, requested()),
            ..Options::default()
        }
    }
}

/// The limit of a search that starts now: a time, s, and a request to end it.
#[must_use]
pub fn limit(budget_s: f64, requested: Option<&AtomicBool>) -> Limit<'_> {
    Limit {
        deadline: Some(Instant::now() + Duration::from_secs_f64(budget_s)),
        requested,
    }
}

/// A time in s, of up to a day.
fn seconds(text: &str) -> Result<f64, String> {
    let seconds: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (0.0..=86_400.0).contains(&seconds) {
        Ok(seconds)
    } else {
        Err("must be 0 to 86400".to_owned())
    }
}
