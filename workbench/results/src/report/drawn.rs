//! Charts with a common abscissa and one legend.

use maud::Markup;

use super::chart::{Chart, Stroke, legend};
use super::plotted::charts;

/// Charts with a common abscissa and one legend; `label` names the plot for screen readers.
pub fn drawn(label: &str, drawn: &[Chart<'_>]) -> Markup {
    let mut entries: Vec<(Stroke, &str)> = Vec::new();
    for (name, stroke, _) in drawn.iter().flat_map(|chart| &chart.lines) {
        if !entries.contains(&(*stroke, name.as_str())) {
            entries.push((*stroke, name));
        }
    }
    charts(label, &legend(&entries), drawn)
}
