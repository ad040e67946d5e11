//! A static picture that the report's script replaces on the screen by an interactive plot of the same data.

use maud::{Markup, html};

use super::chart::{Chart, Line};
use super::columns::{Column, TIME_S, column};
use super::data::Data;
use super::scale::extent;
use crate::web::plot::{PlotLine, PlotRow, RowPlot};

/// A picture with the data of its plot; the picture alone without data. `label` names the plot for screen readers.
pub fn plotted(label: &str, data: Option<&Data>, picture: &Markup) -> Markup {
    html! { div.plotted {
        div.static { (picture) }
        @if let Some(data) = data {
            div.plot.interactive role="img" aria-label=(label) {}
            (data)
        }
    } }
}

/// Height of a chart that is a plot of its own, px. Charts in a common plot have the height of a channel of a run.
const ALONE_PX: f64 = 260.0;

/// Charts with a common abscissa: side by side as pictures, one below the other as a plot.
pub fn charts(label: &str, legend: &Markup, charts: &[Chart<'_>]) -> Markup {
    let picture = html! { (legend) div.grid { @for chart in charts { (chart.figure()) } } };
    let data = view(charts).and_then(|view| Data::of(&view));
    plotted(label, data.as_ref(), &picture)
}

fn view(charts: &[Chart<'_>]) -> Option<RowPlot<Column, Column>> {
    let lines = || charts.iter().flat_map(|chart| &chart.lines);
    let (first, last) = extent(lines().flat_map(|line| line.x.iter().copied()))?;
    let common = lines().next()?.x;
    let mut rows: Vec<_> = charts.iter().map(|chart| row(chart, common)).collect();
    if let [alone] = rows.as_mut_slice() {
        alone.height = Some(ALONE_PX);
    }
    Some(RowPlot {
        x_title: charts.first()?.x_title.to_owned(),
        span: [first, last],
        time_s: column(common, TIME_S),
        rows,
    })
}

fn row(chart: &Chart<'_>, common: &[f64]) -> PlotRow<Column, Column> {
    let line = |line: &Line<'_>| PlotLine {
        name: line.name.to_owned(),
        key: line.name.to_owned(),
        colour: line.stroke.colour(),
        dash: Some(line.stroke.dashes()),
        width: Some(line.stroke.width()),
        x: (line.x != common).then(|| column(line.x, TIME_S)),
        y: column(line.y, 0.0),
    };
    let unit = chart.y_title.rsplit(", ").next().unwrap_or_default();
    PlotRow {
        title: chart.caption.clone(),
        unit: unit.to_owned(),
        height: None,
        lines: chart.lines.iter().map(line).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::chart::Stroke;
    use super::*;

    #[test]
    fn a_line_has_its_own_abscissa_only_if_it_differs() {
        let (x, other, y) = ([0.0, 1.0], [0.0, 2.0], [3.0, 4.0]);
        let line = |x| Line {
            name: "angle",
            stroke: Stroke::After,
            x,
            y: &y,
        };
        let chart = Chart {
            caption: "Rocker angle".to_owned(),
            x_title: "time, s",
            y_title: "angle, deg",
            bands: Vec::new(),
            lines: vec![line(&x), line(&other)],
        };
        let view = view(&[chart]).unwrap();
        assert_eq!(view.span, [0.0, 2.0]);
        assert_eq!(view.rows[0].unit, "deg");
        let lines = &view.rows[0].lines;
        assert!(lines[0].x.is_none() && lines[1].x.is_some());
    }
}
