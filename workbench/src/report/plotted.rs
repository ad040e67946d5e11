//! A static picture that the report's script replaces on the screen by an interactive plot of the same data.

use maud::{Markup, PreEscaped, html};
use serde_json::{Value, json};

use super::chart::{Chart, Line};
use super::columns::{TIME_S, column};
use super::scale::extent;

/// A picture with the data of its plot; the picture alone without data. `label` names the plot for screen readers.
pub fn plotted(label: &str, data: Option<&Value>, picture: &Markup) -> Markup {
    html! { div.plotted {
        div.static { (picture) }
        @if let Some(data) = data {
            div.plot.interactive role="img" aria-label=(label) {}
            (embedded(data))
        }
    } }
}

/// Height of a chart that is a plot of its own, px. Charts in a common plot have the height of a channel of a run.
const ALONE_PX: f64 = 260.0;

/// Charts with a common abscissa: side by side as pictures, one below the other as a plot.
pub fn charts(label: &str, legend: &Markup, charts: &[Chart<'_>]) -> Markup {
    let picture = html! { (legend) div.grid { @for chart in charts { (chart.figure()) } } };
    plotted(label, view(charts).as_ref(), &picture)
}

/// Data for a script, as an element of the document.
pub fn embedded(data: &Value) -> Markup {
    // A "<" could end the element.
    let text = data.to_string().replace('<', "\\u003c");
    html! { script type="application/json" { (PreEscaped(text)) } }
}

fn view(charts: &[Chart<'_>]) -> Option<Value> {
    let lines = || charts.iter().flat_map(|chart| &chart.lines);
    let span = extent(lines().flat_map(|line| line.x.iter().copied()))?;
    let common = lines().next()?.x;
    let mut rows: Vec<Value> = charts.iter().map(|chart| row(chart, common)).collect();
    if let [alone] = rows.as_mut_slice() {
        alone["height"] = json!(ALONE_PX);
    }
    Some(json!({
        "x_title": charts.first()?.x_title,
        "span": [span.0, span.1],
        "time_s": column(common, TIME_S),
        "rows": rows,
    }))
}

fn row(chart: &Chart<'_>, common: &[f64]) -> Value {
    let line = |line: &Line<'_>| {
        json!({
            "name": line.name,
            "key": line.name,
            "colour": line.stroke.colour(),
            "dash": line.stroke.dashes(),
            "width": line.stroke.width(),
            "x": (line.x != common).then(|| column(line.x, TIME_S)),
            "y": column(line.y, 0.0),
        })
    };
    let unit = chart.y_title.rsplit(", ").next();
    json!({
        "title": chart.caption,
        "unit": unit,
        "lines": chart.lines.iter().map(line).collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests {
    use super::super::chart::Stroke;
    use super::*;

    #[test]
    fn data_cannot_end_their_element() {
        let text = embedded(&json!({ "file": "</script><b>" })).into_string();
        assert_eq!(text.matches("</script>").count(), 1);
        let inner = text.split_once('>').unwrap().1;
        let inner = inner.strip_suffix("</script>").unwrap();
        let read: Value = serde_json::from_str(inner).unwrap();
        assert_eq!(read["file"], "</script><b>");
    }

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
        assert_eq!(view["span"], json!([0.0, 2.0]));
        assert_eq!(view["rows"][0]["unit"], "deg");
        let lines = &view["rows"][0]["lines"];
        assert!(lines[0]["x"].is_null() && !lines[1]["x"].is_null());
    }
}
