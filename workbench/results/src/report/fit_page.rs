//! The report of `hitch model fit`: flow curves and constants with their intervals, and the runs before and after.

use hitch_identification::base::BaseFit;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::estimation::fit::Fit;
use hitch_plant::units::{bar_from_pa, lpm_from_m3_s};
use hitch_plant::{Model, Valve};
use maud::{Markup, html};

use super::chart::{Chart, Line, Points, Stroke};
use super::drawn::drawn;
use super::evidence::evidence;
use super::page;
use crate::base_model::data_sheet::VALVES;
use crate::base_model::fit::{ShownBaseFit, ShownConstant, ShownPoint, digits};
use crate::comparison::Evaluated;

/// A fitted base model.
#[derive(Debug, Clone, Copy)]
pub struct Shown<'a> {
    /// The campaign.
    pub experiment: &'a Experiment,
    /// The declared model.
    pub declared: &'a Model,
    /// The fit.
    pub fit: &'a BaseFit,
    /// The values and intervals that the command prints.
    pub told: &'a ShownBaseFit,
}

/// The report as one HTML document.
#[must_use]
pub fn page(shown: &Shown<'_>) -> String {
    let title = format!(
        "Constants of {} fitted to {}",
        shown.told.model, shown.told.campaign
    );
    let content = html! { h1 { (title) } (sections(shown)) };
    page::page(&title, &content)
}

fn sections(shown: &Shown<'_>) -> Markup {
    let told = shown.told;
    let evaluated = |fit: &Fit| Evaluated::of(shown.experiment, fit, shown.declared);
    let (before, after) = (evaluated(&shown.fit.before), evaluated(&shown.fit.after));
    let before = (shown.declared, &before);
    let after = Some((&shown.fit.model, &after));
    html! {
        p.lead {
            "Error " strong { (format!("{:.2}", told.error_before)) } " → " strong { (format!("{:.2}", told.error_after)) }
            " sigma; a perfect model has 1.00, the noise of the instruments."
        }
        @if !told.at_an_end.is_empty() {
            p { strong { "At the limit of the allowed deviation, check the data sheet: " } (told.at_an_end.join(", ")) "." }
        }
        h2 { "Flow curves" }
        p {
            "Flow at the reference drop, which is proportional to the area of the valve. Bars: 95 % intervals of the fitted \
             points. A point that the campaign does not determine follows its neighbours. Deviations are those of the points \
             beside the shift of the whole curve with its threshold."
        }
        @for (valve, title) in VALVES {
            h3 { (title) }
            (curve(shown, valve, title))
            (deviation(told, valve, title))
        }
        (page::table(
            &["valve and current, A", "declared, l/min", "fitted, l/min", "95 % interval, l/min", "determined"],
            told.curves.iter().map(point),
        ))
        h2 { "Constants" }
        (page::table(
            &["constant", "unit", "declared", "tolerance, ±1 σ", "fitted", "95 % interval", "determined", "moved"],
            told.constants.iter().map(constant),
        ))
        p.note {
            "Tolerance: that of data sheets, the prior of the fit. A constant that the campaign does not determine keeps its \
             declared value; its interval is that of the data sheet, or little less."
        }
        (evidence(before, after))
    }
}

/// A value of a point, by its flow, l/min.
type Of = fn(&ShownPoint, f64) -> f64;

/// The declared and the fitted curve of a valve, with the intervals of the fitted points.
fn curve(shown: &Shown<'_>, valve: Valve, title: &str) -> Markup {
    let of = |model: &Model| -> Points {
        let curve = &valve.of(model.constants()).curve;
        let flows = curve.flows_m3_s().iter().map(|flow| lpm_from_m3_s(*flow));
        (curve.currents_a().to_vec(), flows.collect())
    };
    let curves = [
        ("declared", Stroke::Before, of(shown.declared)),
        ("fitted", Stroke::After, of(&shown.fit.model)),
    ];
    let drop_bar = bar_from_pa(valve.of(shown.declared.constants()).reference_drop_pa);
    let chart = Chart {
        caption: format!("{title}, flow at {drop_bar:.0} bar"),
        axes: ["current, A", "flow, l/min"],
        lines: lines(curves.into(), shown.told, valve, |_, flow_lpm| flow_lpm),
    };
    let label = format!("{title}: declared and fitted flow over the current, with intervals");
    drawn(&label, &[chart])
}

/// The deviation of the fitted points of a valve from their declared flows, with intervals, which are too small to be
/// seen beside the curve.
fn deviation(told: &ShownBaseFit, valve: Valve, title: &str) -> Markup {
    let of: Of = |point, flow_lpm| 100.0 * (flow_lpm / point.declared_lpm - 1.0);
    let points = told
        .curves
        .iter()
        .filter(|point| point.valve == valve.key());
    let fitted = points.map(|point| (point.current_a, of(point, point.fitted_lpm)));
    let curves = vec![("fitted", Stroke::After, fitted.unzip())];
    let chart = Chart {
        caption: format!("{title}, deviation of the points"),
        axes: ["current, A", "deviation, %"],
        lines: lines(curves, told, valve, of),
    };
    let label = format!("{title}: deviation of the fitted points from the declared ones");
    drawn(&label, &[chart])
}

/// Curves, and the intervals of a valve's points, by whether the campaign determines them.
fn lines(
    curves: Vec<(&str, Stroke, Points)>,
    told: &ShownBaseFit,
    valve: Valve,
    of: Of,
) -> Vec<Line> {
    let intervals = |determined: bool| {
        let points = told.curves.iter();
        let own = points.filter(|point| point.valve == valve.key() && point.low_lpm.is_finite());
        bars(own.filter(move |point| point.determined == determined), of)
    };
    let bars = [
        ("95 % interval", Stroke::Measured, intervals(true)),
        ("not determined, 95 %", Stroke::Other, intervals(false)),
    ];
    let all = curves.into_iter().chain(bars);
    let known = all.filter(|(.., (x, _))| !x.is_empty());
    known
        .map(|(name, stroke, points)| (name.to_owned(), stroke, points))
        .collect()
}

/// A vertical bar over each interval, as one interrupted line.
fn bars<'a>(points: impl Iterator<Item = &'a ShownPoint>, of: Of) -> Points {
    let ends = |point: &ShownPoint| {
        let ends = [
            of(point, point.low_lpm),
            of(point, point.high_lpm),
            f64::NAN,
        ];
        ends.map(|end| (point.current_a, end))
    };
    points.flat_map(ends).unzip()
}

fn point(point: &ShownPoint) -> Vec<String> {
    vec![
        format!("{} {:.3}", point.valve, point.current_a),
        digits(point.declared_lpm),
        digits(point.fitted_lpm),
        format!("{} to {}", digits(point.low_lpm), digits(point.high_lpm)),
        determined(point.determined),
    ]
}

fn constant(constant: &ShownConstant) -> Vec<String> {
    vec![
        constant.name.clone(),
        constant.unit.to_owned(),
        digits(constant.declared),
        digits(constant.tolerance),
        digits(constant.fitted),
        format!("{} to {}", digits(constant.low), digits(constant.high)),
        determined(constant.determined),
        constant.mark().to_owned(),
    ]
}

fn determined(determined: bool) -> String {
    let word = if determined { "yes" } else { "no" };
    word.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_interval_is_a_bar_of_its_own() {
        let point = |current_a: f64, low_lpm: f64| ShownPoint {
            valve: "lift_valve",
            current_a,
            declared_lpm: 1.0,
            fitted_lpm: low_lpm + 1.0,
            low_lpm,
            high_lpm: low_lpm + 2.0,
            determined: true,
        };
        let (x, y) = bars([point(0.5, 3.0), point(0.7, 9.0)].iter(), |_, flow| flow);
        assert_eq!(x, [0.5, 0.5, 0.5, 0.7, 0.7, 0.7]);
        assert_eq!((y[0], y[1], y[3], y[4]), (3.0, 5.0, 9.0, 11.0));
        assert!(y[2].is_nan() && y[5].is_nan());
    }
}
