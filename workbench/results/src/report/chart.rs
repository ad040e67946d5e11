//! Line charts as inline SVG.
use std::fmt::Write as _;

use maud::{Markup, html};

use super::scale::{Scale, extent};
use hitch_output::text::joined;

const WIDTH_PX: f64 = 520.0;
const HEIGHT_PX: f64 = 220.0;
const LEFT_PX: f64 = 54.0;
const RIGHT_PX: f64 = 10.0;
const TOP_PX: f64 = 10.0;
const BOTTOM_PX: f64 = 38.0;
const X_TICKS: usize = 6;
const Y_TICKS: usize = 4;
/// Number of columns to which a long log is reduced, three pixels each; each keeps its minimum and maximum, so no peak is lost.
const BUCKETS: usize = 150;

/// Style of a line; the colours are those of the page of `hitch serve`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    /// Measured.
    Measured,
    /// Simulated by the initial model.
    Before,
    /// Simulated by the final model.
    After,
    /// A further line.
    Other,
    /// Of the lift valve.
    Lift,
    /// Of the lowering valve.
    Lower,
    /// Of the pump.
    Pump,
}

impl Stroke {
    /// Styles of runs with several calibrations, in their order.
    pub const SERIES: [Self; 6] = [
        Self::Before,
        Self::After,
        Self::Other,
        Self::Lift,
        Self::Lower,
        Self::Pump,
    ];

    /// Name of the colour in both themes.
    pub const fn colour(self) -> &'static str {
        match self {
            Self::Measured => "measured",
            Self::Before => "first",
            Self::After => "simulated",
            Self::Other => "good",
            Self::Lift => "lift",
            Self::Lower => "lower",
            Self::Pump => "signature",
        }
    }

    /// Width, px.
    pub const fn width(self) -> f64 {
        if matches!(self, Self::Measured) {
            1.0
        } else {
            1.8
        }
    }

    /// Dashes of an interactive plot.
    pub const fn dashes(self) -> &'static str {
        match self {
            Self::Measured | Self::After | Self::Lift | Self::Pump => "solid",
            Self::Before => "dot",
            Self::Other | Self::Lower => "dash",
        }
    }

    /// Class of a line in the style sheet.
    fn class(self) -> String {
        format!("line {} {}", self.colour(), self.dashes())
    }
}

/// Values along the axis, and of a line: NaN where missing.
pub type Points = (Vec<f64>, Vec<f64>);

/// A line of a chart: its name, its style and its values.
pub type Line = (String, Stroke, Points);

/// A filled band between two lines.
#[derive(Debug, Clone)]
pub struct Band<'a> {
    /// Name, for screen readers.
    pub name: &'a str,
    /// Values along the axis.
    pub x: &'a [f64],
    /// Lower limit; finite.
    pub low: &'a [f64],
    /// Upper limit; finite.
    pub high: &'a [f64],
}

/// A chart of lines over a common axis.
#[derive(Debug, Clone)]
pub struct Chart<'a> {
    /// Caption, below the chart.
    pub caption: String,
    /// Titles of the axes, with unit.
    pub axes: [&'a str; 2],
    /// The lines, in drawing order.
    pub lines: Vec<Line>,
}

impl<'a> Chart<'a> {
    /// A chart over the time in s; `y_title` has the unit.
    pub fn over_time(
        caption: impl Into<String>,
        y_title: &'a str,
        lines: impl IntoIterator<Item = Line>,
    ) -> Self {
        Self {
            caption: caption.into(),
            axes: ["time, s", y_title],
            lines: lines.into_iter().collect(),
        }
    }
}

impl Chart<'_> {
    /// The chart as a figure; empty if no line has a value.
    pub fn figure(&self) -> Markup {
        self.figure_with(&[])
    }

    /// The chart as a figure with bands behind the lines; empty if no line has a value.
    pub fn figure_with(&self, bands: &[Band<'_>]) -> Markup {
        let lines = || self.lines.iter().map(|(.., (x, y))| (x, y));
        let xs = extent(lines().flat_map(|(x, _)| x.iter().copied()));
        let limits = bands.iter().flat_map(|band| [band.low, band.high]);
        let values = lines().map(|(_, y)| y.as_slice()).chain(limits);
        let ys = extent(values.flatten().copied());
        let (Some(xs), Some(ys)) = (xs, ys) else {
            return html! { figure { figcaption { (self.caption) ": no values" } } };
        };
        let x = Scale::new(xs, (LEFT_PX, WIDTH_PX - RIGHT_PX));
        let y = Scale::new(ys, (HEIGHT_PX - BOTTOM_PX, TOP_PX));
        let names = self.lines.iter().map(|(name, ..)| name.as_str());
        let names = joined(names.chain(bands.iter().map(|band| band.name)), ", ");
        html! { figure {
            svg viewBox=(format!("0 0 {WIDTH_PX} {HEIGHT_PX}")) role="img"
                aria-label=(format!("{}: {names}", self.caption)) {
                (self.axes(&x, &y))
                @for band in bands { path.band d=(area(band, &x, &y)) {} }
                @for line in &self.lines { (draw(line, &x, &y)) }
            }
            figcaption { (self.caption) }
        } }
    }

    fn axes(&self, x: &Scale, y: &Scale) -> Markup {
        let (right, base) = (WIDTH_PX - RIGHT_PX, HEIGHT_PX - BOTTOM_PX);
        let middle = (TOP_PX + base) / 2.0;
        let grid = y.ticks(Y_TICKS).into_iter();
        let grid: String = grid
            .map(|tick| format!("M{LEFT_PX} {}H{right}", px(y.px(tick))))
            .collect();
        let marks = x.ticks(X_TICKS).into_iter();
        let marks: String = marks
            .map(|tick| format!("M{} {base}v4", px(x.px(tick))))
            .collect();
        html! {
            path.grid-line d=(grid) {}
            path.axis d=(format!("M{LEFT_PX} {base}H{right}{marks}")) {}
            g.soft text-anchor="end" dominant-baseline="middle" { @for tick in y.ticks(Y_TICKS) {
                text x=(LEFT_PX - 6.0) y=(px(y.px(tick))) { (y.label(tick, Y_TICKS)) }
            } }
            g.soft text-anchor="middle" { @for tick in x.ticks(X_TICKS) {
                text x=(px(x.px(tick))) y=(base + 17.0) { (x.label(tick, X_TICKS)) }
            } }
            text x=((LEFT_PX + right) / 2.0) y=(HEIGHT_PX - 4.0) text-anchor="middle" { (self.axes[0]) }
            text x="12" y=(middle) text-anchor="middle" transform=(format!("rotate(-90 12 {middle})")) {
                (self.axes[1])
            }
        }
    }
}

/// Legend of the charts below.
pub fn legend(entries: &[(Stroke, &str)]) -> Markup {
    html! { div.legend { @for (stroke, name) in entries { span {
        svg viewBox="0 0 28 10" aria-hidden="true" {
            line class=(stroke.class()) x1="0" x2="28" y1="5" y2="5" stroke-width=(stroke.width()) {}
        }
        (name)
    } } } }
}

fn draw((_, stroke, points): &Line, x: &Scale, y: &Scale) -> Markup {
    html! {
        path class=(stroke.class()) d=(path(points, x, y)) stroke-width=(stroke.width()) {}
    }
}

/// The outline of a band as SVG path data.
fn area(band: &Band<'_>, x: &Scale, y: &Scale) -> String {
    let upper = band.x.iter().zip(band.high);
    let lower = band.x.iter().zip(band.low).rev();
    let points = upper.chain(lower);
    let points = points.map(|(at, value)| format!("{} {}", px(x.px(*at)), px(y.px(*value))));
    let points: Vec<String> = points.collect();
    if points.is_empty() {
        String::new()
    } else {
        format!("M{}Z", points.join("L"))
    }
}

/// The line as SVG path data in whole pixels, relative to the point before; interrupted at dropouts. Points on the straight
/// line through their neighbours are left out.
fn path((along, values): &Points, x: &Scale, y: &Scale) -> String {
    let mut data = String::new();
    let mut piece: Vec<(i32, i32)> = Vec::new();
    for i in thinned(values) {
        let (Some(at), value) = (along.get(i), values[i]) else {
            break;
        };
        if !value.is_finite() {
            push_piece(&mut data, &piece);
            piece.clear();
            continue;
        }
        let point = (x.px(*at).round() as i32, y.px(value).round() as i32);
        if let [.., before, last] = piece[..]
            && goes_on(before, last, point)
        {
            piece.pop();
        }
        if piece.last() != Some(&point) {
            piece.push(point);
        }
    }
    push_piece(&mut data, &piece);
    data
}

/// Whether the way from `before` to `last` goes on to `point` in the same direction.
fn goes_on(before: (i32, i32), last: (i32, i32), point: (i32, i32)) -> bool {
    let first = (last.0 - before.0, last.1 - before.1);
    let second = (point.0 - last.0, point.1 - last.1);
    let (cross, along) = (
        first.0 * second.1 - first.1 * second.0,
        first.0 * second.0 + first.1 * second.1,
    );
    cross == 0 && along >= 0
}

/// Appends a line without interruption.
fn push_piece(data: &mut String, piece: &[(i32, i32)]) {
    let Some(first) = piece.first() else { return };
    // Writing to a string cannot fail.
    let _ = write!(data, "M{} {}", first.0, first.1);
    for (place, pair) in piece.windows(2).enumerate() {
        let (right, down) = (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1);
        // A sign separates numbers too.
        let start = match (place, right < 0) {
            (0, _) => "l",
            (_, true) => "",
            (_, false) => " ",
        };
        let between = if down < 0 { "" } else { " " };
        let _ = write!(data, "{start}{right}{between}{down}");
    }
}

/// The drawn samples: all of a short log; of a long one, the minimum and the maximum of each bucket and the first
/// sample of each dropout.
fn thinned(values: &[f64]) -> Vec<usize> {
    if values.len() <= 2 * BUCKETS {
        return (0..values.len()).collect();
    }
    let size = values.len().div_ceil(BUCKETS);
    let mut kept = Vec::with_capacity(3 * BUCKETS);
    for start in (0..values.len()).step_by(size) {
        let bucket = start..(start + size).min(values.len());
        let known = |i: &usize| values[*i].is_finite();
        let by_value = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
        let least = bucket.clone().filter(known).min_by(by_value);
        let greatest = bucket.clone().filter(known).max_by(by_value);
        let gap = bucket.clone().find(|i| !known(i));
        let mut chosen: Vec<usize> = [least, greatest, gap].into_iter().flatten().collect();
        chosen.sort_unstable();
        chosen.dedup();
        kept.extend(chosen);
    }
    kept
}

/// A pixel position, rounded to a tenth.
fn px(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_logs_are_thinned_but_keep_their_peaks() {
        let mut values = vec![0.0; 10_000];
        values[7_321] = 5.0;
        let kept = thinned(&values);
        assert!(kept.contains(&7_321) && kept.len() <= 3 * BUCKETS);
    }

    #[test]
    fn a_line_breaks_at_a_dropout() {
        let line = (vec![0.0, 1.0, 2.0, 3.0], vec![0.0, 1.0, f64::NAN, 1.0]);
        let (sx, sy) = (
            Scale::new((0.0, 3.0), (0.0, 30.0)),
            Scale::new((0.0, 1.0), (10.0, 0.0)),
        );
        assert_eq!(path(&line, &sx, &sy), "M0 10l10-10M30 0");
    }

    #[test]
    fn a_straight_line_has_two_points_and_a_peak_stays() {
        let x: Vec<f64> = (0..100).map(f64::from).collect();
        let mut y = vec![0.0; 100];
        y[40] = 1.0;
        let line = (x, y);
        let (sx, sy) = (
            Scale::new((0.0, 99.0), (0.0, 99.0)),
            Scale::new((0.0, 1.0), (10.0, 0.0)),
        );
        assert_eq!(path(&line, &sx, &sy), "M0 10l39 0 1-10 1 10 58 0");
    }

    #[test]
    fn a_band_is_closed() {
        let band = Band {
            name: "scatter",
            x: &[0.0, 1.0],
            low: &[0.0, 0.5],
            high: &[1.0, 1.0],
        };
        let (sx, sy) = (
            Scale::new((0.0, 1.0), (0.0, 10.0)),
            Scale::new((0.0, 1.0), (10.0, 0.0)),
        );
        assert_eq!(area(&band, &sx, &sy), "M0 0L10 0L10 5L0 10Z");
    }

    #[test]
    fn a_chart_of_nothing_says_so() {
        let chart = Chart {
            caption: "c".into(),
            axes: ["t", "q"],
            lines: vec![("flow".into(), Stroke::After, (vec![0.0], vec![f64::NAN]))],
        };
        assert!(chart.figure().into_string().contains("no values"));
    }
}
