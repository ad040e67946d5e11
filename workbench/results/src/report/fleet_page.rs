//! The report of `hitch summary`: machine by effect.

use maud::{Markup, html};

use super::page;
use crate::fleet_summary::{EffectOfFleet, FleetSummary, Found, Machine, PRESENT};
use hitch_output::text::{known, significant};

/// Significant digits of a size.
const DIGITS: i32 = 3;

/// The report as one HTML document.
pub fn page(summary: &FleetSummary) -> String {
    let title = format!("What {} machines have", summary.machines.len());
    let content = html! {
        h1 { (title) }
        p.lead { (summary.sentence()) }
        h2 { "Effects" }
        (effects(&summary.effects))
        h2 { "Machines" }
        (machines(summary))
        p.note { (FleetSummary::MARK) " Paler: the confidence that it is this effect is below one half." }
        @if !summary.failed.is_empty() {
            h2 { "Without a result" }
            dl { @for failed in &summary.failed { dt { (failed.campaign) } dd { (failed.error) } } }
        }
    };
    page::page(&title, &content)
}

fn effects(effects: &[EffectOfFleet]) -> Markup {
    html! { div.scroll tabindex="0" role="group" aria-label="Effects" { table {
        thead { tr { @for name in EffectOfFleet::HEADINGS { th scope="col" { (name) } } } }
        tbody { @for effect in effects { tr {
            th scope="row" { (effect.effect) }
            td { (effect.machines) }
            @for size in [effect.median, effect.least, effect.most] { td { (significant(size, DIGITS)) } }
            td { (effect.unit) }
            td { (effect.differ) }
        } } }
    } } }
}

fn machines(summary: &FleetSummary) -> Markup {
    html! { div.scroll tabindex="0" role="group" aria-label="Machines by effect" { table {
        thead { tr {
            @for name in ["machine", "verdict", "before", "after"] { th scope="col" { (name) } }
            @for effect in &summary.effects { th scope="col" { (effect.effect) @if !effect.unit.is_empty() { ", " (effect.unit) } } }
        } }
        tbody { @for machine in &summary.machines { (row(machine, &summary.effects)) } }
    } } }
}

fn row(machine: &Machine, effects: &[EffectOfFleet]) -> Markup {
    html! { tr {
        th scope="row" { (machine.campaign) }
        td { (machine.verdict) }
        td { (known(machine.error_before, 2)) }
        td { (known(machine.error_after, 2)) }
        @for effect in effects { (cell(machine.effects.get(&effect.effect))) }
    } }
}

fn cell(found: Option<&Found>) -> Markup {
    let Some(found) = found else {
        return html! { td.none { "–" } };
    };
    let size = significant(found.size, DIGITS);
    let hint = match (found.low, found.high) {
        (Some(low), Some(high)) => format!(
            "{} to {}, confidence {:.2}",
            significant(low, DIGITS),
            significant(high, DIGITS),
            found.confidence
        ),
        _ => format!("confidence {:.2}", found.confidence),
    };
    let style = if found.confidence < PRESENT {
        "opacity:0.6"
    } else {
        ""
    };
    html! { td title=(hint) style=(style) { @if found.differs { strong { (size) "*" } } @else { (size) } } }
}
