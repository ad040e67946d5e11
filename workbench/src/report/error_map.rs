//! The error map: on the screen, a cell leads to the run and the second in which it is worst; in print, tables.

use hitch_plant::Channel;
use maud::{Markup, html};
use serde_json::{Value, json};

use super::page::folded;
use super::plotted::embedded;
use super::run_views::State;
use crate::comparison::{Cell, Comparison, Evaluated, Grouping, WorstStretch, worst_by_part};

/// The map of the initial model, and of the final one if it differs.
pub fn error_map(before: State<'_>, after: Option<State<'_>>) -> Markup {
    let compared = |(model, evaluated): State<'_>| Comparison::of(evaluated, model);
    let of_after = after.map(compared);
    let of_before = compared(before);
    let mut models = vec![state("before", &of_before, before.1)];
    if let (Some(comparison), Some((_, evaluated))) = (&of_after, after) {
        models.push(state("after", comparison, evaluated));
    }
    html! {
        section #map.live-only aria-labelledby="map-title" {
            h2 #map-title { "Error map" }
            p.note { "Error in σ: the root mean square of measured − simulated, in units of the noise. 1: a perfect model. \
                Press a cell to see the run and the second where it is worst." }
            div #models role="group" aria-label="Model of the map" {}
            div #groupings role="group" aria-label="Rows of the map" {}
            div #cells.scroll {}
            (embedded(&json!(models)))
        }
        div.replaced { (grids(&of_before, of_after.as_ref())) }
    }
}

/// Tables of the errors in sigma by condition.
fn grids(before: &Comparison, after: Option<&Comparison>) -> Markup {
    html! { @for by in Grouping::ALL {
        h2 { "Error in sigma " (by.title()) }
        div.grid {
            div { @if after.is_some() { h3 { "Before" } } (table(before, by)) }
            @if let Some(after) = after { div { h3 { "After" } (table(after, by)) } }
        }
    } }
}

fn table(comparison: &Comparison, by: Grouping) -> Markup {
    let grid = comparison.grid(by);
    folded(&grid.table(), grid.rows.len())
}

/// A map in the form of the page of `hitch serve`; each cell with its worst second.
fn state(name: &str, comparison: &Comparison, evaluated: &Evaluated) -> Value {
    let grouping = |by: Grouping| json!({ "by": by, "title": by.title() });
    let measured = |channel: &Channel| evaluated.experiment.measures(*channel);
    let channel = |channel: Channel| {
        json!({
            "key": channel.key(),
            "title": channel.title(),
            "error": evaluated.fit.channel_error(channel.index()),
        })
    };
    let channels = Channel::ALL.into_iter().filter(measured).map(channel);
    let channels: Vec<Value> = channels.collect();
    let mut cells = Vec::new();
    for by in Grouping::ALL {
        for channel in Channel::ALL.into_iter().filter(measured) {
            let worst = worst_by_part(evaluated, by, channel);
            let own = |cell: &&Cell| cell.by == by && cell.channel == channel.key();
            for cell in comparison.cells.iter().filter(own) {
                let place = worst.iter().find(|(part, ..)| *part == cell.part);
                cells.push(shown(cell, place.map(|(_, run, stretch)| (*run, stretch))));
            }
        }
    }
    json!({
        "name": name,
        "groupings": Grouping::ALL.map(grouping),
        "channels": channels,
        "cells": cells,
    })
}

fn shown(cell: &Cell, place: Option<(usize, &WorstStretch)>) -> Value {
    let worst = place.map(|(run, stretch)| {
        json!({
            "run": run,
            "channel": stretch.channel,
            "from_s": stretch.from_s,
            "to_s": stretch.to_s,
            "error": stretch.error,
        })
    });
    json!({
        "by": cell.by,
        "part": cell.part,
        "channel": cell.channel,
        "error": cell.error,
        "samples": cell.samples,
        "worst": worst,
    })
}
