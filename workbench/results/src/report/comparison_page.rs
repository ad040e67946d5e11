//! The report of `hitch compare`.

use hitch_plant::Model;
use maud::{Markup, html};

use super::evidence::evidence;
use super::page;
use crate::comparison::{Comparison, Evaluated};

/// The report as one HTML document.
pub fn page(comparison: &Comparison, evaluated: &Evaluated, model: &Model) -> String {
    let title = format!("{} against {}", comparison.model, comparison.campaign);
    let content = html! {
        h1 { (title) }
        p.lead { "Error " strong { (format!("{:.2}", comparison.error)) } " sigma; a perfect model has 1.00, the noise of the instruments." }
        (evidence((model, evaluated), None))
        h2 { "By channel" }
        (channels(comparison))
    };
    page::page(&title, &content)
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
    };
    page::table(
        &["channel", "error, sigma", "rms", "noise", "unit", "samples"],
        comparison.channels.iter().map(row),
    )
}
