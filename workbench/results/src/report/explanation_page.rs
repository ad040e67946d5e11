//! The report of `hitch explain`.

use hitch_identification::estimation::fit::Fit;
use maud::{Markup, html};

use super::evidence::evidence;
use super::next_figure::next_figure;
use super::rest_figure::{picture, suggestion};
use super::staircase::staircase;
use super::{page, staircase};
use crate::base_model::fit::ShownConstant;
use crate::comparison::Evaluated;
use crate::explanation::{ChannelFigures, Corrected, Explanation, Found, Head, Step};
use hitch_output::text::{joined, known, words};

/// The report as one HTML document.
pub fn page(found: &Found) -> String {
    let head = &found.shown.head;
    let title = format!("What {} lacks on {}", head.model, head.campaign);
    page::page(
        &title,
        &html! { h1 { (title) } (findings(found)) (details(found)) },
    )
}

/// The result: verdict, error after each step, effects.
pub fn findings(found: &Found) -> Markup {
    html! {
        (verdict(&found.shown))
        h2 { "The error, step by step" }
        (staircase(&stairs(&found.shown)))
        @if let Some(corrected) = &found.shown.corrected_constants {
            (corrected_constants(corrected, found.shown.head.error_before))
        }
        @if !found.shown.steps.is_empty() { (steps(&found.shown.steps)) }
        @if let Some(rest) = &found.rest { (picture(rest)) }
        @if let Some(term) = &found.shown.unexplained.suggested { (suggestion(term)) }
        (next_figure(&found.shown.next))
    }
}

/// The evidence: error map, all runs, and errors by channel.
pub fn details(found: &Found) -> Markup {
    let evaluated = |fit: &Fit| Evaluated::of(&found.experiment, fit, &found.model);
    let (before, after) = (
        evaluated(&found.explanation.before),
        evaluated(&found.explanation.after),
    );
    let is_changed = !found.shown.steps.is_empty() || found.shown.corrected_constants.is_some();
    let changed = is_changed.then_some((&found.model, &after));
    let before = (&found.model, &before);
    html! {
        (evidence(before, changed))
        h2 { "By channel" }
        (channels(&found.shown.head))
    }
}

fn verdict(shown: &Explanation) -> Markup {
    let head = &shown.head;
    html! {
        p.lead {
            strong { (head.verdict) } ". " (shown.meaning()) " Error "
            strong { (format!("{:.2}", head.error_before)) } " → " strong { (format!("{:.2}", head.error_after)) }
            " sigma; a perfect model has 1.00, the noise of the instruments."
        }
        @for step in &shown.doubtful { p { (step.doubt()) } }
        @if !shown.unexplained.depends_on.is_empty() {
            p { (format!("{:.1} % of the squared error above the noise remains; it correlates with ", 100.0 * shown.unexplained.share))
                (shown.unexplained.depends_on.join(", ")) "." }
        }
        @if let Some(next) = &shown.next.next_experiment {
            p { strong { "Next experiment: " } (next) "." }
        }
        @if !shown.not_visible.is_empty() {
            details {
                summary { (shown.blind_spots()) }
                ul { @for effect in &shown.not_visible { li { (effect) } } }
            }
        }
    }
}

fn stairs(shown: &Explanation) -> Vec<staircase::Step> {
    let first = staircase::Step {
        name: shown.head.model.clone(),
        error: shown.head.error_before,
    };
    let added = shown.steps.iter().map(|step| staircase::Step {
        name: format!("+ {}", step.name()),
        error: step.error_after,
    });
    let corrected = shown.corrected_constants.iter();
    let corrected = corrected.map(|corrected| staircase::Step {
        name: "fitted constants".to_owned(),
        error: corrected.error_after,
    });
    [first].into_iter().chain(corrected).chain(added).collect()
}

/// Constants that the explanation corrected.
fn corrected_constants(corrected: &Corrected, error_before: f64) -> Markup {
    let moved = corrected.moved().map(ShownConstant::cells);
    let moved: Vec<_> = moved.collect();
    html! {
        p { (corrected.sentence(error_before)) }
        @if let Some(reason) = &corrected.withheld {
            p { (reason) }
        }
        ul {
            @for (valve, low, high) in corrected.flow_changes() {
                li { (valve) ": flow " (format!("{:+.1} to {:+.1}", 100.0 * low, 100.0 * high)) " % of the declared curve" }
            }
        }
        @if !moved.is_empty() {
            (page::table(&ShownConstant::HEADINGS, &moved))
        }
    }
}

fn steps(steps: &[Step]) -> Markup {
    let row = |step: &Step| {
        [
            page::with_twins(step.name(), &step.alternatives),
            joined(&step.parameters, "\n"),
            format!("{:.2} → {:.2}", step.error_before, step.error_after),
            format!(
                "{} → {}",
                known(step.held_out_before, 2),
                known(step.held_out_after, 2)
            ),
            words::probable(step.confidence),
            format!("{:.2}", step.detectability),
        ]
    };
    let header = [
        "effect",
        "parameters, 95 %",
        "error",
        "held-out error",
        "confidence",
        "detectability",
    ];
    html! {
        (page::table(&header, steps.iter().map(row)))
        (page::meanings(steps.iter().map(|step| (step.name(), step.parameters.as_slice()))))
        p.note { (words::sentences(&[words::HELD_OUT, words::CONFIDENCE, words::DETECTABILITY, words::ANGLE, words::SIGMA])) }
    }
}

/// Table of the errors by channel.
pub fn channels(head: &Head) -> Markup {
    let row = |(channel, values): (&&str, &ChannelFigures)| {
        let names = [(*channel).to_owned()].into_iter();
        names.chain(values.cells())
    };
    let header: Vec<&str> = ["channel"]
        .into_iter()
        .chain(ChannelFigures::HEADINGS)
        .collect();
    page::table(&header, head.channels.iter().map(row))
}
