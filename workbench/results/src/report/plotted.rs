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
    let abscissas = || {
        charts
            .iter()
            .flat_map(|chart| &chart.lines)
            .map(|(.., (x, _))| x)
    };
    let (first, last) = extent(abscissas().flatten().copied())?;
    let common = abscissas().next()?;
    let mut rows: Vec<_> = charts.iter().map(|chart| row(chart, common)).collect();
    if let [alone] = rows.as_mut_slice() {
        alone.height = Some(ALONE_PX);
    }
    Some(RowPlot {
        x_title: charts.first()?.axes[0].to_owned(),
        span: [first, last],
        time_s: column(common, TIME_S),
        rows,
    })
}

fn row(chart: &Chart<'_>, common: &[f64]) -> PlotRow<Column, Column> {
    let line = |(name, stroke, (x, y)): &Line| PlotLine {
        name: name.clone(),
        key: name.clone(),
        colour: stroke.colour(),
        dash: Some(stroke.dashes()),
        width: Some(stroke.width()),
        x: (x != common).then(|| column(x, TIME_S)),
        y: column(y, 0.0),
    };
    let unit = chart.axes[1].rsplit(", ").next().unwrap_or_default();
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
        let line = |x| ("angle".to_owned(), Stroke::After, (x, vec![3.0, 4.0]));
        let chart = Chart {
            caption: "Rocker angle".to_owned(),
            axes: ["time, s", "angle, deg"],
            lines: vec![line(vec![0.0, 1.0]), line(vec![0.0, 2.0])],
        };
        let view = view(&[chart]).unwrap();
        assert_eq!(view.span, [0.0, 2.0]);
        assert_eq!(view.rows[0].unit, "deg");
        let lines = &view.rows[0].lines;
        assert!(lines[0].x.is_none() && lines[1].x.is_some());
    }
}
