//! The report of `hitch diagnose`.

use hitch_identification::data::experiment::Experiment;
use hitch_identification::estimation::fit::Fit;
use hitch_identification::explanation::diagnosis;
use hitch_identification::selection::candidate;
use hitch_identification::selection::evidence::SIGNIFICANT;
use hitch_plant::Model;
use maud::{Markup, html};

use super::evidence::evidence;
use super::explanation_page::channels;
use super::next_figure::next_figure;
use super::staircase::staircase;
use super::{page, staircase};
use crate::comparison::Evaluated;
use crate::explanation::{Candidate, Diagnosis, UNSUITABLE_BASE};
use hitch_output::text::{joined, words};

/// Number of candidates that are shown as bars, and in the unfolded table.
const BARS: usize = 8;

/// The report as one HTML document.
pub fn page(
    shown: &Diagnosis,
    found: &diagnosis::Diagnosis,
    experiment: &Experiment,
    model: &Model,
) -> String {
    let title = format!(
        "Single effects that {} may lack on {}",
        shown.head.model, shown.head.campaign
    );
    let evaluated = |fit: &Fit| Evaluated::of(experiment, fit, model);
    let before = evaluated(&found.base);
    let accepted = |best: &&candidate::Candidate| best.likelihood_ratio >= SIGNIFICANT;
    let after = found.candidates.first().filter(accepted);
    let after = after.map(|best| evaluated(&best.fit));
    let (before, after) = ((model, &before), after.as_ref().map(|after| (model, after)));
    let content = html! {
        h1 { (title) }
        (verdict(shown))
        h2 { "Error with each effect added alone" }
        (staircase(&bars(shown)))
        (candidates(&shown.candidates))
        (next_figure(&shown.next))
        (evidence(before, after))
        h2 { "By channel" }
        (channels(&shown.head))
    };
    page::page(&title, &content)
}

fn verdict(shown: &Diagnosis) -> Markup {
    let head = &shown.head;
    html! {
        @if head.unsuitable_base { p { strong { (UNSUITABLE_BASE) } } }
        p.lead {
            "Verdict with the best effect alone: " strong { (head.verdict) } ". Error "
            strong { (format!("{:.2}", head.error_before)) } " → " strong { (format!("{:.2}", head.error_after)) }
            " sigma; a perfect model has 1.00, the noise of the instruments."
        }
        @if let Some(hint) = shown.constants_hint() { p { (hint) } }
        @if let Some(next) = &shown.next.next_experiment {
            p { strong { "Next experiment: " } (next) "." }
        }
    }
}

fn bars(shown: &Diagnosis) -> Vec<staircase::Step> {
    let none = staircase::Step {
        name: shown.head.model.clone(),
        error: shown.head.error_before,
    };
    let added = shown.candidates.iter().take(BARS);
    let added = added.map(|candidate| staircase::Step {
        name: format!("+ {}", candidate.name()),
        error: candidate.error_after,
    });
    [none].into_iter().chain(added).collect()
}

fn candidates(candidates: &[Candidate]) -> Markup {
    let row = |candidate: &Candidate| {
        [
            page::with_twins(candidate.name(), &candidate.indistinguishable),
            joined(&candidate.parameters, "\n"),
            format!("{:.1} %", 100.0 * candidate.explains),
            format!("{:.2}", candidate.error_after),
            words::probable(candidate.confidence),
            format!("{:.2}", candidate.detectability),
        ]
    };
    let header = [
        "effect",
        "parameters, 95 %",
        "explains",
        "error after",
        "confidence",
        "detectability",
    ];
    let rows: Vec<_> = candidates.iter().map(row).collect();
    let (first, others) = rows.split_at(BARS.min(rows.len()));
    html! {
        (page::table(&header, first))
        @if !others.is_empty() {
            details { summary { (others.len()) " other effects" } (page::table(&header, others)) }
        }
        (page::meanings(candidates.iter().map(|one| (one.name(), one.parameters.as_slice()))))
        p.note { (words::sentences(&[words::EXPLAINS, words::CONFIDENCE, words::DETECTABILITY, words::SIGMA])) }
    }
}
