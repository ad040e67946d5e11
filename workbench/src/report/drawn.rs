//! Charts that own their values.

use maud::Markup;

use super::chart::{Chart, Line, Stroke, legend};
use super::plotted::charts;

/// Values along the axis, and of a line.
pub type Points = (Vec<f64>, Vec<f64>);

/// One chart.
#[derive(Debug, Clone)]
pub struct Drawn {
    /// Caption.
    pub caption: String,
    /// Axis titles with unit.
    pub axes: [&'static str; 2],
    /// Name, style and values of each line.
    pub lines: Vec<(String, Stroke, Points)>,
}

/// Charts with a common abscissa and one legend; `label` names the plot for screen readers.
pub fn drawn(label: &str, drawn: &[Drawn]) -> Markup {
    let mut entries: Vec<(Stroke, &str)> = Vec::new();
    for (name, stroke, _) in drawn.iter().flat_map(|chart| &chart.lines) {
        if !entries.contains(&(*stroke, name.as_str())) {
            entries.push((*stroke, name));
        }
    }
    let drawn: Vec<Chart<'_>> = drawn
        .iter()
        .map(|drawn| Chart {
            caption: drawn.caption.clone(),
            x_title: drawn.axes[0],
            y_title: drawn.axes[1],
            bands: Vec::new(),
            lines: drawn.lines.iter().map(line).collect(),
        })
        .collect();
    charts(label, &legend(&entries), &drawn)
}

fn line((name, stroke, (x, y)): &(String, Stroke, Points)) -> Line<'_> {
    Line {
        name,
        stroke: *stroke,
        x,
        y,
    }
}
