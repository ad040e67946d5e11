//! JSON views of a session.
mod effects;
mod second;
mod way;

use std::sync::Arc;

use hitch_identification::data::problem::Problem;
use hitch_identification::data::ready_run::ReadyRun;
use hitch_identification::estimate::Estimate;
use hitch_identification::estimation::fit::evaluate_weighted;
use hitch_plant::simulation::Trace;
use hitch_plant::{AddedEffect, Channel, Parameter};
use serde_json::{Value, json};

use super::session::{Ranking, Session, Step};
use super::source::Subject;
use crate::comparison::{Comparison, Evaluated, Grouping};
use crate::report::run_views::conditions;
use crate::text::words;

pub use effects::tried;

/// Campaign, model, steps and error map.
pub fn state(session: &Session) -> Value {
    let subject = session.subject();
    let evaluated = &session.present().evaluated;
    let comparison = Comparison::of(evaluated, &subject.model);
    let grouping = |by: Grouping| json!({ "by": by, "title": by.title() });
    json!({
        "campaign": subject.experiment().name,
        "description": subject.description,
        "model": words::named(&subject.model),
        "earlier_model": session.earlier(),
        "way": way::steps(session),
        "constants": way::constants(session),
        "tuned": way::tuned(session),
        "words": words::ALL,
        "runs": runs(evaluated),
        "channels": channels(evaluated),
        "error": comparison.error,
        "noise_floor": comparison.noise_floor,
        "groupings": Grouping::ALL.map(grouping),
        "second": second::compared(session, &comparison),
        "cells": comparison.cells,
        "steps": session.steps().iter().map(step).collect::<Vec<_>>(),
        "at": session.at(),
        "effects": added(session),
        "ranking": effects::ranking(session),
        "explained": effects::explained(session),
        "job": session.job.as_ref().map(|job| &job.title),
    })
}

fn runs(evaluated: &Evaluated) -> Vec<Value> {
    let run = |(index, run): (usize, &ReadyRun)| {
        json!({
            "file": run.file,
            "conditions": conditions(run),
            "error": evaluated.run_error(index),
        })
    };
    let runs = evaluated.experiment.runs.iter();
    runs.enumerate().map(run).collect()
}

fn channels(evaluated: &Evaluated) -> Vec<Value> {
    let measured = |channel: &Channel| evaluated.experiment.measures(*channel);
    let channel = |channel: Channel| {
        json!({
            "key": channel.key(),
            "title": channel.title(),
            "unit": channel.unit(),
            "error": evaluated.fit.channel_error(channel.index()),
            "noise": evaluated.experiment.noise[channel.index()],
        })
    };
    let channels = Channel::ALL.into_iter().filter(measured);
    channels.map(channel).collect()
}

fn step(step: &Step) -> Value {
    json!({
        "title": step.title,
        "error": step.evaluated.fit.error(),
        "held_out": step.held_out,
    })
}

/// The effects of the present model, with the range of each parameter.
fn added(session: &Session) -> Vec<Value> {
    let estimate = &session.fit().estimate;
    let effect = |added: &AddedEffect| {
        let parameters = added.effect.parameters().iter().zip(&added.values);
        let parameter = |(index, (own, value)): (usize, (&Parameter, &f64))| {
            json!({
                "fixed": estimate.fixed.contains(&(added.effect.id(), index)),
                "name": own.name,
                "unit": own.unit,
                "meaning": own.meaning,
                "value": value,
                "low": own.low,
                "high": own.high,
                "scale": own.scale(),
                "by_magnitude": own.is_by_magnitude(),
            })
        };
        json!({
            "effect": effects::described(added.effect),
            "parameters": parameters.enumerate().map(parameter).collect::<Vec<_>>(),
        })
    };
    estimate.effects.iter().map(effect).collect()
}

/// A run simulated with manually set parameters; `None` if there is no such run.
pub fn preview(subject: &Subject, step: &Step, estimate: &Estimate, run: usize) -> Option<Value> {
    let ready = subject.experiment().runs.get(run)?;
    let weights = &step.evaluated.fit.weights.runs[run];
    let model = estimate.applied_to(&subject.model);
    let trace = ready.simulate(&model, estimate.nuisances[run], &estimate.clocks);
    let residuals = weights.whiten(ready, &trace);
    let channel = |channel: Channel| {
        ready.measured[channel.index()].as_ref()?;
        let part = channel.index() * ready.len()..(channel.index() + 1) * ready.len();
        let compared = residuals[part.clone()].iter().zip(&weights.scale[part]);
        let residual: Vec<f64> = compared
            .map(|(residual, &scale)| if scale > 0.0 { *residual } else { f64::NAN })
            .collect();
        let seen = residual.iter().filter(|residual| residual.is_finite());
        let square: f64 = seen.clone().map(|residual| residual * residual).sum();
        Some(json!({
            "simulated": trace.channel(channel),
            "residual": residual,
            "error": (square / seen.count() as f64).sqrt(),
        }))
    };
    let channels = Channel::ALL.into_iter().filter_map(channel);
    Some(json!({ "run": run, "channels": channels.collect::<Vec<_>>() }))
}

/// Errors of all runs with manually set parameters, with the weights of the step: in total, by channel, by run, and by cell.
pub fn preview_all(subject: &Subject, step: &Step, estimate: Estimate) -> Value {
    let (experiment, model) = (subject.experiment(), &subject.model);
    let weights = step.evaluated.fit.weights.clone();
    let fit = evaluate_weighted(Problem::new(experiment, model), estimate, weights);
    let evaluated = Evaluated::fitted(Arc::clone(&step.evaluated.experiment), fit, model);
    let runs = 0..experiment.runs.len();
    json!({
        "error": evaluated.fit.error(),
        "channels": channels(&evaluated),
        "runs": runs.map(|run| evaluated.run_error(run)).collect::<Vec<_>>(),
        "cells": evaluated.cells(),
    })
}

/// The part of a run's residuals that a candidate explains at its fitted size: residual without it minus residual with
/// it. `None` if the run or candidate does not exist.
pub fn signature(
    subject: &Subject,
    step: &Step,
    ranking: &Ranking,
    effect: &str,
    run: usize,
) -> Option<Value> {
    let ready = subject.experiment().runs.get(run)?;
    let candidate = ranking.candidate(effect)?;
    let fit = &step.evaluated.fit;
    let mut estimate = fit.estimate.clone();
    estimate.effects.push(AddedEffect {
        effect: candidate.effect,
        values: candidate.values().to_vec(),
    });
    let model = estimate.applied_to(&subject.model);
    let trace = ready.simulate(&model, fit.estimate.nuisances[run], &fit.estimate.clocks);
    let with = fit.weights.runs[run].whiten(ready, &trace);
    let channel = |channel: Channel| {
        ready.measured[channel.index()].as_ref()?;
        let with = &with[channel.index() * ready.len()..];
        let without = step.evaluated.residuals(run, channel);
        let explained: Vec<f64> = without.iter().zip(with).map(|(a, b)| a - b).collect();
        Some(json!({ "signature": explained }))
    };
    let channels = Channel::ALL.into_iter().filter_map(channel);
    Some(json!({ "run": run, "channels": channels.collect::<Vec<_>>() }))
}

/// The present model as a file, with the steps that led to it.
pub fn model_file(session: &Session) -> String {
    let mut text = String::from("# Made with hitch serve:\n");
    for (number, step) in session.steps()[..=session.at()].iter().enumerate() {
        let error = step.evaluated.fit.error();
        let title = step.title.replace(char::is_control, " ");
        text += &format!("# {number}. {title}: error {error:.2} sigma\n");
    }
    text + &hitch_model_file::to_toml(&session.rebuilt())
}

/// Measured and simulated channels of a run; `None` if there is no such run.
pub fn run(session: &Session, index: usize) -> Option<Value> {
    let subject = session.subject();
    let ready = subject.experiment().runs.get(index)?;
    let evaluated = &session.present().evaluated;
    let simulated = evaluated.simulated(&subject.model, index);
    let second = session.second.as_ref();
    let other = second.map(|second| second::lines(second, index));
    let shows_first = session.at() > 0 && second.is_none();
    let first = shows_first.then(|| subject.start.simulated(&subject.model, index));
    let channel = |channel: Channel| {
        let measured = ready.measured[channel.index()].as_ref()?;
        Some(json!({
            "key": channel.key(),
            "title": channel.title(),
            "unit": channel.unit(),
            "measured": measured,
            "simulated": simulated.channel(channel),
            "first": first.as_ref().map(|trace: &Trace| trace.channel(channel)),
            "residual": evaluated.residuals(index, channel),
            "error": evaluated.error(index, channel),
            "second": other.as_ref().map(|of| of(channel)),
        }))
    };
    let currents = &ready.drive.currents;
    Some(json!({
        "run": index,
        "file": ready.file,
        "conditions": conditions(ready),
        "names": second.map(|second| json!({ "second": second.title })),
        "time_s": ready.drive.time_s,
        "lift_current_a": currents.iter().map(|current| current.lift_a).collect::<Vec<_>>(),
        "lower_current_a": currents.iter().map(|current| current.lower_a).collect::<Vec<_>>(),
        "channels": Channel::ALL.into_iter().filter_map(channel).collect::<Vec<_>>(),
    }))
}
