//! The remaining error: residuals over the signal that they correlate with, and a suggested term.

use hitch_identification::adequacy::localization::{Bin, ErrorProfile};
use hitch_identification::adequacy::signal::Signal;
use maud::{Markup, html};

use super::chart::{Band, Chart, Stroke};
use crate::explanation::Suggested;
use hitch_output::text::{joined, known};

/// Residuals of the worst channel over a signal: mean and scatter of every bin.
pub fn picture(profile: &ErrorProfile) -> Markup {
    let column = |value: fn(&Bin) -> f64| profile.bins.iter().map(value).collect::<Vec<f64>>();
    let x = column(|bin| bin.centre);
    let (mean, above, below) = (
        column(|bin| bin.mean),
        column(|bin| bin.mean + bin.deviation),
        column(|bin| bin.mean - bin.deviation),
    );
    let chart = Chart {
        caption: format!(
            "Remaining error of the {}: mean; band: plus and minus the scatter",
            profile.channel.title().to_lowercase()
        ),
        axes: [axis_title(profile.signal), "measured - simulated, sigma"],
        lines: vec![("mean".to_owned(), Stroke::After, (x.clone(), mean))],
    };
    let band = Band {
        name: "mean plus and minus scatter",
        x: &x,
        low: &below,
        high: &above,
    };
    html! {
        h2 { "Remaining error" }
        p { "It is largest at " strong { (profile.to_string()) } "." }
        (chart.figure_with(&[band]))
    }
}

/// Title of a signal's axis, with its unit.
fn axis_title(signal: Signal) -> &'static str {
    match signal {
        Signal::RockerAngle => "rocker angle, deg",
        Signal::CylinderPressure => "cylinder pressure, bar",
        Signal::Flow => "flow, l/min",
        Signal::LiftCurrent => "current of the lift valve, A",
        Signal::LowerCurrent => "current of the lowering valve, A",
        Signal::Load => "load, kg",
        Signal::OilTemperature => "oil temperature, °C",
        Signal::Time => "time, s",
    }
}

/// A suggested term, as text for a model file.
pub fn suggestion(term: &Suggested) -> Markup {
    html! {
        h3 { "Suggested term" }
        p { code { (term.place) " = " (term.formula) } ", " (joined(&term.parameters, ", ")) }
        p {
            "It reduces the error on held-out runs from "
            strong { (known(term.held_out_before, 2)) } " to "
            strong { (known(term.held_out_after, 2)) } " sigma"
            @if !term.replaces.is_empty() { ", in place of " (term.replaces.join(", ")) }
            ". It describes the error; it is not an identified cause. For a model file:"
        }
        pre { (term.model_file) }
    }
}

#[cfg(test)]
mod tests {
    use hitch_plant::Channel;

    use super::*;

    #[test]
    fn the_picture_has_mean_and_scatter() {
        let bin = |centre: f64| Bin {
            centre,
            samples: 50,
            mean: -2.0,
            deviation: 1.0,
        };
        let profile = ErrorProfile {
            signal: Signal::RockerAngle,
            channel: Channel::Flow,
            bins: vec![bin(50.0), bin(60.0)],
            stretch: (45.0, 65.0),
            motion: Some("lowering"),
            end: Some("near the bottom"),
        };
        let text = picture(&profile).into_string();
        assert!(text.contains("rocker_angle_deg 45 to 65, near the bottom while lowering"));
        assert_eq!(text.matches("<path class=\"band").count(), 1);
        assert_eq!(text.matches("<path class=\"line").count(), 1);
    }
}
