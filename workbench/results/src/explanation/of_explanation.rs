//! Converts the identification's explanation into its display form.

use hitch_identification::adequacy::signal::Signal;
use hitch_identification::adequacy::unsuitable_base::is_unsuitable;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::design;
use hitch_identification::estimation::fit::Fit;
use hitch_identification::explanation::explain;
use hitch_identification::explanation::undetected::Undetected;
use hitch_plant::{Channel, Effect, Model};
use indexmap::IndexMap;

use super::channel_figures::{CLOCK, SUM};
use super::{
    Alternative, ChannelFigures, Corrected, Explanation, Head, NotVisible, Parameter, Step,
    Unexplained,
};
use crate::comparison::raw_errors;

impl Explanation {
    /// The display form of an explanation of a campaign, with the initial model.
    pub fn new(experiment: &Experiment, model: &Model, found: &explain::Explanation) -> Self {
        Self {
            head: Head::new(
                (experiment, model),
                [&found.before, &found.after],
                found.verdict,
            ),
            error_refitted: found.refitted.as_ref().map(Fit::error),
            corrected_constants: found
                .corrected
                .as_ref()
                .map(|constants| Corrected::new(constants, found.verdict, found.after.error())),
            steps: found.steps.iter().map(step).collect(),
            doubtful: found.doubtful.iter().map(step).collect(),
            unexplained: Unexplained {
                share: found.rest.share,
                depends_on: found
                    .rest
                    .depends_on
                    .iter()
                    .map(Signal::to_string)
                    .collect(),
                whereabouts: None,
                suggested_term: None,
                suggested: None,
            },
            not_visible: found.undetected.iter().map(not_visible).collect(),
            unfinished: found.unfinished,
            next: found.next_experiment.clone().into(),
        }
    }
}

impl Head {
    /// The head of a result: a campaign and the initial model, the fits before and after, and the verdict.
    pub(super) fn new(
        (experiment, model): (&Experiment, &Model),
        [before, after]: [&Fit; 2],
        verdict: explain::Verdict,
    ) -> Self {
        Self {
            campaign: experiment.name.clone(),
            model: model.name.clone(),
            error_before: before.error(),
            error_after: after.error(),
            noise_floor: 1.0,
            channels: channels(experiment, model, before, after),
            verdict: verdict.name(),
            unsuitable_base: is_unsuitable(experiment, before, after),
        }
    }
}

fn step(step: &explain::ExplanationStep) -> Step {
    Step {
        effect: step.effect.id(),
        form: step.effect.form(),
        form_undetermined: !step.other_forms.is_empty(),
        other_forms: step.other_forms.clone(),
        changed_from: step.changed_from,
        error_before: step.error_before,
        error_after: step.error_after,
        held_out_before: step.held_out_before.error,
        held_out_after: step.held_out_after.error,
        held_out_loss_before: step.held_out_before.loss,
        held_out_loss_after: step.held_out_after.loss,
        confidence: step.confidence,
        explained_share: step.explained_share,
        indistinguishable: step
            .indistinguishable
            .iter()
            .map(|alternative| alternative.effect.id())
            .collect(),
        alternatives: step.indistinguishable.iter().map(alternative).collect(),
        detectability: step.detectability,
        parameters: parameters(step.effect, &step.values, &step.intervals),
    }
}

fn not_visible(unseen: &Undetected) -> NotVisible {
    NotVisible {
        effect: unseen.effect.id(),
        detectability: unseen.detectability,
        missing_channels: unseen.missing.iter().map(|channel| channel.key()).collect(),
        shows: unseen.effect.shows(),
    }
}

fn alternative(alternative: &design::Alternative) -> Alternative {
    Alternative {
        effect: alternative.effect.id(),
        angle_deg: alternative.angle_deg,
        error_after: alternative.error_after,
    }
}

/// Parameters of an effect with their values and intervals.
pub fn parameters(effect: &dyn Effect, values: &[f64], intervals: &[(f64, f64)]) -> Vec<Parameter> {
    let fitted = values.iter().zip(intervals);
    let parameter =
        |(parameter, (value, (low, high))): (&hitch_plant::Parameter, (&f64, &(f64, f64)))| {
            Parameter {
                name: parameter.name,
                meaning: parameter.meaning,
                unit: parameter.unit,
                value: *value,
                low: *low,
                high: *high,
                at_its_limit: parameter.is_at_a_limit(*value),
            }
        };
    effect
        .parameters()
        .iter()
        .zip(fitted)
        .map(parameter)
        .collect()
}

/// Errors by channel before and after, in the channel's unit, with the noise of the instrument and the offset of the
/// channel's clock relative to the currents, s, followed by the contributions to the channel's delay behind the
/// currents, s.
///
/// The errors are those in sigma times sigma, so that they add up to the total error. The effect of current noise on
/// the simulation is not a model error and is excluded.
fn channels(
    experiment: &Experiment,
    model: &Model,
    before: &Fit,
    after: &Fit,
) -> IndexMap<&'static str, ChannelFigures> {
    let spool_lag_s = model.spool_lag_s();
    let measured = |channel: &Channel| experiment.noise[channel.index()].is_finite();
    let (raw_before, raw_after) = (
        raw_errors(experiment, before, model),
        raw_errors(experiment, after, model),
    );
    let entry = |channel: Channel| {
        let noise = experiment.noise[channel.index()];
        let error = |fit: &Fit| fit.channel_error(channel.index()) * noise;
        (
            channel.key(),
            ChannelFigures {
                before: error(before),
                after: error(after),
                rms_before: raw_before[channel.index()].rms,
                rms_after: raw_after[channel.index()].rms,
                noise,
                late_s: after.estimate.clocks.offsets_s[channel.index()],
                delay_s: delays(after, spool_lag_s, channel),
            },
        )
    };
    Channel::ALL
        .into_iter()
        .filter(measured)
        .map(entry)
        .collect()
}

/// Contributions to a channel's delay behind the currents, s: its clock offset, the declared spool lag, and effects
/// whose size is a time and that the channel shows; and their sum.
fn delays(fit: &Fit, spool_lag_s: f64, channel: Channel) -> IndexMap<&'static str, f64> {
    let shown = fit.estimate.effects.iter().filter(|added| {
        added.effect.parameters()[0].unit == "s" && added.effect.channels().contains(&channel)
    });
    let effects = shown.map(|added| (added.effect.id(), added.values[0]));
    let clock_s = fit.estimate.clocks.offsets_s[channel.index()];
    let known = [(CLOCK, clock_s), ("declared spool lag", spool_lag_s)];
    let parts: Vec<(&str, f64)> = known
        .into_iter()
        .chain(effects)
        .filter(|(_, part_s)| *part_s != 0.0)
        .collect();
    let sum_s: f64 = parts.iter().map(|(_, part_s)| part_s).sum();
    let whole = std::iter::once((SUM, sum_s));
    parts.into_iter().chain(whole).collect()
}
