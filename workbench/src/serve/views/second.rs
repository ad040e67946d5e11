//! JSON views of the comparison with a second model.

use std::sync::Arc;

use hitch_identification::estimation::fit::Fit;
use hitch_plant::Channel;
use serde_json::{Value, json};

use crate::comparison::{Comparison, Evaluated, changes};
use crate::serve::second::Second;
use crate::serve::session::Session;

/// Both models by channel and cell; null without a second model.
pub fn compared(session: &Session, present: &Comparison) -> Value {
    let Some(second) = &session.second else {
        return Value::Null;
    };
    let other = Comparison::of(&second.evaluated, &second.model);
    let [before, after] = if second.is_after {
        [present, &other]
    } else {
        [&other, present]
    };
    let mut steps = session.steps().iter();
    json!({
        "title": second.title,
        "model": second.model.name,
        "step": steps.position(|step| Arc::ptr_eq(&step.evaluated, &second.evaluated)),
        "is_after": second.is_after,
        "is_present": Arc::ptr_eq(&second.evaluated, &session.present().evaluated),
        "has_other_linkage": second.model.linkage() != session.subject().model.linkage(),
        "before": before.error,
        "after": after.error,
        "channels": channels(second, &session.present().evaluated),
        "changes": changes(&before.cells, &after.cells),
        "cells": other.cells,
    })
}

fn channels(second: &Second, present: &Evaluated) -> Vec<Value> {
    let [before, after] = second.ordered(present).map(|evaluated| &evaluated.fit);
    let error = |fit: &Fit, channel: Channel| fit.channel_error(channel.index());
    let channel = |channel: Channel| {
        json!({
            "key": channel.key(),
            "before": error(before, channel),
            "after": error(after, channel),
        })
    };
    let measured = |channel: &Channel| present.experiment.measures(*channel);
    let channels = Channel::ALL.into_iter().filter(measured);
    channels.map(channel).collect()
}

/// Simulated samples, residuals and error of a channel of a run with the second model.
pub fn lines(second: &Second, run: usize) -> impl Fn(Channel) -> Value {
    let trace = second.evaluated.simulated(&second.model, run);
    let evaluated = Arc::clone(&second.evaluated);
    move |channel| {
        json!({
            "simulated": trace.channel(channel),
            "residual": evaluated.residuals(run, channel),
            "error": evaluated.error(run, channel),
        })
    }
}
