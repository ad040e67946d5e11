//! The error map: on the screen, a cell leads to the run and the second in which it is worst; in print, tables.

use hitch_plant::Channel;
use maud::{Markup, html};
use schemars::JsonSchema;
use serde::Serialize;

use super::data::Data;
use super::map_view::{GroupingTitle, Located, MeasuredChannel};
use super::page::folded;
use super::run_views::State;
use crate::comparison::{Cell, Comparison, Evaluated, Grouping, WorstStretch, worst_by_part};

/// The map of the initial model, and of the final one if it differs.
pub fn error_map(before: State<'_>, after: Option<State<'_>>) -> Markup {
    let compared = |(model, evaluated): State<'_>| Comparison::of(evaluated, model);
    let of_after = after.map(compared);
    let of_before = compared(before);
    let mut models = vec![ModelMap::new("before", &of_before, before.1)];
    if let (Some(comparison), Some((_, evaluated))) = (&of_after, after) {
        models.push(ModelMap::new("after", comparison, evaluated));
    }
    html! {
        section #map.live-only aria-labelledby="map-title" {
            h2 #map-title { "Error map" }
            p.note { "Error in σ: the root mean square of measured − simulated, in units of the noise. 1: a perfect model. \
                Press a cell to see the run and the second where it is worst." }
            div #models role="group" aria-label="Model of the map" {}
            div #groupings role="group" aria-label="Rows of the map" {}
            div #cells.scroll {}
            @if let Some(data) = Data::of(&models) { (data) }
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

/// The error map of a model; each cell with its worst second.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ModelMap {
    /// Which model it is.
    pub name: &'static str,
    /// Groupings of the cells.
    pub groupings: Vec<GroupingTitle>,
    /// The measured channels.
    pub channels: Vec<MeasuredChannel>,
    /// The cells.
    pub cells: Vec<LocatedCell>,
}

/// A cell of an error map.
#[derive(Debug, Serialize, JsonSchema)]
pub struct LocatedCell {
    /// The cell.
    #[serde(flatten)]
    pub cell: Cell,
    /// The stretch with its largest error.
    pub worst: Option<Located<WorstStretch>>,
}

impl ModelMap {
    fn new(name: &'static str, comparison: &Comparison, evaluated: &Evaluated) -> Self {
        let mut cells = Vec::new();
        for by in Grouping::ALL {
            for channel in Channel::ALL {
                let worst = worst_by_part(evaluated, by, channel);
                let own = |cell: &&Cell| cell.by == by && cell.channel == channel.key();
                for cell in comparison.cells.iter().filter(own) {
                    let place = worst.iter().find(|(part, ..)| *part == cell.part);
                    cells.push(LocatedCell {
                        cell: cell.clone(),
                        worst: place.map(|(_, run, stretch)| (*run, stretch.clone()).into()),
                    });
                }
            }
        }
        Self {
            name,
            groupings: GroupingTitle::all(),
            channels: MeasuredChannel::all(evaluated),
            cells,
        }
    }
}
