//! Options of a search for missing effects.

use std::time::{Duration, Instant};

use hitch_identification::data::limit::Limit;
use hitch_identification::search::subset::Options;

use crate::interruption::requested;

/// Arguments of a search.
#[derive(Debug, Clone, Copy, clap::Args)]
pub struct SearchArgs {
    /// Leave the effects that the model has as they are: look for new ones only
    #[arg(long)]
    frozen: bool,
    /// End after this time with the best account so far, s; Ctrl-C ends it at once
    #[arg(long, value_name = "SECONDS", value_parser = seconds, default_value = "60")]
    budget: f64,
}

impl SearchArgs {
    /// The options of a search that starts now.
    pub fn options(&self) -> Options<'static> {
        let budget = Duration::from_secs_f64(self.budget);
        Options {
            changes: !self.frozen,
            limit: Limit {
                deadline: Some(Instant::now() + budget),
                requested: requested(),
            },
            ..Options::default()
        }
    }
}

/// A time in s, of up to a day.
fn seconds(text: &str) -> Result<f64, String> {
    let seconds: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    match (0.0..=86_400.0).contains(&seconds) {
        true => Ok(seconds),
        false => Err("must be 0 to 86400".to_owned()),
    }
}
