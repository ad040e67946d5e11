//! The report of `hitch compare`.

use hitch_plant::Model;
use maud::{Markup, html};

use super::page;
use super::run_views::run_views;
use super::runs::runs;
use crate::comparison::{Comparison, Evaluated, Grouping};

/// The report as one HTML document.
pub fn page(comparison: &Comparison, evaluated: &Evaluated, model: &Model) -> String {
    let views = run_views(model, evaluated, None);
    let title = format!("{} against {}", comparison.model, comparison.campaign);
    let content = html! {
        h1 { (title) }
        p.lead { "Error " strong { (format!("{:.2}", comparison.error)) } " sigma; a perfect model has 1.00, the noise of the instruments." }
        h2 { "By channel" }
        (channels(comparison))
        (grids(comparison))
        h2 { "Measured against simulated" }
        (runs(&views))
    };
    page::page(&title, &content)
}

/// Tables of the error in sigma, one for each grouping.
pub fn grids(comparison: &Comparison) -> Markup {
    html! { @for by in Grouping::ALL {
        h2 { "Error in sigma " (by.title()) }
        (comparison.grid(by).table())
    } }
}

fn channels(comparison: &Comparison) -> Markup {
    let row = |channel: &crate::comparison::ChannelError| {
        let numbers =
            [channel.error, channel.rms, channel.noise].map(|number| format!("{number:.3}"));
        let rest = [channel.unit.to_owned(), channel.samples.to_string()];
        [channel.channel.to_owned()]
            .into_iter()
            .chain(numbers)
            .chain(rest)
            .collect()
    };
    let rows: Vec<Vec<String>> = comparison.channels.iter().map(row).collect();
    page::table(
        &["channel", "error, sigma", "rms", "noise", "unit", "samples"],
        &rows,
    )
}
