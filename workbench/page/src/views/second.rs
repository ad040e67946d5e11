//! The comparison with a second model.

use std::sync::Arc;

use hitch_plant::Channel;
use schemars::JsonSchema;
use serde::Serialize;

use crate::second::Second;
use crate::session::Session;
use hitch_results::comparison::{Cell, Change, Comparison, Evaluated, changes};

/// Both models by channel and cell; errors in sigma.
#[derive(Debug, Serialize, JsonSchema)]
pub struct SecondModel {
    /// Title of the second model.
    pub title: String,
    /// Its name.
    pub model: String,
    /// Index of the step that it is; `null` if it is another one.
    pub step: Option<usize>,
    /// Whether changes are those from the present model to it.
    pub is_after: bool,
    /// Whether it is the present model.
    pub is_present: bool,
    /// Whether its linkage is another one.
    pub has_other_linkage: bool,
    /// Error of the model before.
    pub before: f64,
    /// Error of the model after.
    pub after: f64,
    /// The measured channels.
    pub channels: Vec<ChangedChannel>,
    /// The cells of both models.
    pub changes: Vec<Change>,
    /// The error map of the second model.
    pub cells: Vec<Cell>,
}

/// Errors of both models in a channel, sigma.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ChangedChannel {
    /// Key of the channel.
    pub key: &'static str,
    /// Error of the model before.
    pub before: f64,
    /// Error of the model after.
    pub after: f64,
}

impl SecondModel {
    /// The comparison of the second model with the present one; `None` without a second model.
    pub fn of(session: &Session, present: &Comparison) -> Option<Self> {
        let second = session.second.as_ref()?;
        let other = Comparison::of(&second.evaluated, &second.model);
        let [before, after] = if second.is_after {
            [present, &other]
        } else {
            [&other, present]
        };
        let evaluated = &session.present().evaluated;
        let mut steps = session.steps().iter();
        Some(Self {
            title: second.title.clone(),
            model: second.model.name.clone(),
            step: steps.position(|step| Arc::ptr_eq(&step.evaluated, &second.evaluated)),
            is_after: second.is_after,
            is_present: Arc::ptr_eq(&second.evaluated, evaluated),
            has_other_linkage: second.model.linkage() != session.subject().model.linkage(),
            before: before.error,
            after: after.error,
            channels: channels(second, evaluated),
            changes: changes(&before.cells, &after.cells),
            cells: other.cells,
        })
    }
}

fn channels(second: &Second, present: &Evaluated) -> Vec<ChangedChannel> {
    let [before, after] = second.ordered(present).map(|evaluated| &evaluated.fit);
    let channel = |channel: Channel| ChangedChannel {
        key: channel.key(),
        before: before.channel_error(channel.index()),
        after: after.channel_error(channel.index()),
    };
    let channels = Channel::ALL.into_iter();
    let measured = channels.filter(|channel| present.experiment.measures(*channel));
    measured.map(channel).collect()
}
