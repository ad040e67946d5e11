//! Measured and simulated channels, run by run.

use maud::{Markup, html};

use super::chart::{Chart, Stroke, legend};
use super::columns::{Column, TIME_S, column, plotted_column};
use super::data::Data;
use super::envelope::envelope;
use super::plotted::plotted;
use super::run_view::{ChannelView, RunView};
use crate::web::plot::{LineNames, RunChannel, RunPlot};

/// Number of runs that are initially unfolded.
const OPEN_RUNS: usize = 2;
/// Number of samples of the runs, the worst first, that have all their samples in the plot, for its zoom.
const WHOLE_SAMPLES: usize = 30_000;
/// Number of columns of a plot of the further runs, about four pixels each.
const COLUMNS: usize = 250;
/// Size of the data of all plots, bytes, which bounds the size of the file. Further runs have pictures.
const MOST_BYTES: usize = 2_000_000;
/// Resolution of the samples relative to the noise.
const OF_NOISE: f64 = 0.2;
/// Resolution of residuals, sigma: less than a pixel, as their axis has at least ten sigma.
const RESIDUAL: f64 = 0.1;
/// Resolution of currents, A.
const CURRENT_A: f64 = 1e-3;

/// All runs, in descending order of error; the first ones unfolded.
pub fn runs(views: &[RunView]) -> Markup {
    let sorted = by_error(views);
    let data = plots(&sorted);
    html! {
        p.note.live-only { "Grey: 95 % of the noise. Yellow: largest error. Drag over a plot to zoom in time; press an entry of \
            the legend to hide its lines." }
        @for (place, (view, data)) in sorted.iter().zip(&data).enumerate() { (run(view, place < OPEN_RUNS, data.as_ref())) }
    }
}

/// The data of the plots of some runs, the worst first: all samples of the first ones, what a screen shows of the others.
fn plots(sorted: &[&RunView]) -> Vec<Option<Data>> {
    let (mut whole, mut all) = (0, 0);
    let plot = |view: &&RunView| {
        if all > MOST_BYTES {
            return None;
        }
        whole += view.time_s.len();
        let drawn = if whole <= WHOLE_SAMPLES {
            (*view).clone()
        } else {
            envelope(view, COLUMNS)
        };
        let data = data(&drawn)?;
        all += data.bytes();
        (all <= MOST_BYTES).then_some(data)
    };
    sorted.iter().map(plot).collect()
}

fn by_error(views: &[RunView]) -> Vec<&RunView> {
    let worst = |view: &RunView| {
        let errors = view.channels.iter().map(|channel| channel.before.error);
        errors.fold(0.0, f64::max)
    };
    let mut sorted: Vec<&RunView> = views.iter().collect();
    sorted.sort_by(|a, b| worst(b).total_cmp(&worst(a)));
    sorted
}

fn run(view: &RunView, open: bool, data: Option<&Data>) -> Markup {
    let picture = html! {
        (legend(&entries(view)))
        div.grid { @for channel in &view.channels { (figure(view, channel)) } }
    };
    let label = format!(
        "Measured and simulated channels of {} over time, with residuals",
        view.file
    );
    html! { details.run open[open] id=(format!("run-{}", view.index)) {
        summary { (view.file) " " span.note { (view.conditions) } }
        output {}
        (plotted(&label, data, &picture))
    } }
}

fn is_changed(view: &RunView) -> bool {
    view.channels.iter().any(|channel| channel.after.is_some())
}

fn entries(view: &RunView) -> Vec<(Stroke, &'static str)> {
    let measured = (Stroke::Measured, "measured");
    if is_changed(view) {
        vec![
            measured,
            (Stroke::Before, "model before"),
            (Stroke::After, "model after"),
        ]
    } else {
        vec![measured, (Stroke::After, "simulated")]
    }
}

/// The run in the form of the page of `hitch serve`.
fn data(view: &RunView) -> Option<Data> {
    let names = is_changed(view).then_some(LineNames {
        first: Some("model before"),
        simulated: Some("model after"),
        second: None,
    });
    Data::of(&RunPlot {
        names,
        time_s: column(&view.time_s, TIME_S),
        lift_current_a: column(&view.lift_current_a, CURRENT_A),
        lower_current_a: column(&view.lower_current_a, CURRENT_A),
        channels: view.channels.iter().map(channel_data).collect(),
    })
}

fn channel_data(view: &ChannelView) -> RunChannel<Column> {
    let samples = |samples: &[f64]| plotted_column(samples, OF_NOISE * view.noise);
    let last = view.after.as_ref().unwrap_or(&view.before);
    let first = view.after.as_ref().map(|_| &view.before);
    RunChannel {
        key: view.channel.key(),
        title: view.channel.title(),
        unit: view.channel.unit(),
        error: last.error,
        measured: samples(&view.measured),
        simulated: samples(&last.simulated),
        residual: column(&last.residual, RESIDUAL),
        first: first.map(|first| samples(&first.simulated)),
        first_residual: first.map(|first| column(&first.residual, RESIDUAL)),
        second: None,
    }
}

fn figure(view: &RunView, channel: &ChannelView) -> Markup {
    let line = |name: &str, stroke, y: &Vec<f64>| {
        (name.to_owned(), stroke, (view.time_s.clone(), y.clone()))
    };
    let mut lines = vec![line("measured", Stroke::Measured, &channel.measured)];
    let before = &channel.before;
    let mut error = format!("{:.2}", before.error);
    match &channel.after {
        None => lines.push(line("simulated", Stroke::After, &before.simulated)),
        Some(after) => {
            lines.push(line("before", Stroke::Before, &before.simulated));
            lines.push(line("after", Stroke::After, &after.simulated));
            error += &format!(" → {:.2}", after.error);
        }
    }
    let title = format!("{}, {}", channel.channel.title(), channel.channel.unit());
    let caption = format!("{}: error {error} sigma", channel.channel.title());
    Chart::over_time(caption, &title, lines).figure()
}

#[cfg(test)]
mod tests {
    use hitch_plant::Channel;
    use rand::{Rng, SeedableRng};
    use rand_pcg::Pcg64;

    use super::*;
    use crate::web::plot::SimulatedChannel;

    /// A run of 30 s at 50 Hz with four channels, noise, and simulations of two models.
    fn long_run(random: &mut Pcg64, index: usize) -> RunView {
        let samples = 1500;
        let time_s: Vec<f64> = (0..samples).map(|i| f64::from(i) * 0.02).collect();
        let noise = 0.1;
        let curve = |size: f64| -> Vec<f64> {
            let value = |time_s: &f64| 90.0 + size * (0.7 * time_s).sin();
            time_s.iter().map(value).collect()
        };
        let mut noisy = |curve: Vec<f64>, noise: f64| -> Vec<f64> {
            let value = |value: f64| value + noise * random.random_range(-2.0..2.0);
            curve.into_iter().map(value).collect()
        };
        let channel = |channel| {
            let mut simulated = |size: f64| SimulatedChannel {
                simulated: curve(size),
                residual: noisy(vec![0.0; time_s.len()], 1.0),
                error: 1.0,
            };
            let (before, after) = (simulated(20.0), Some(simulated(22.0)));
            ChannelView {
                channel,
                noise,
                measured: noisy(curve(22.0), noise),
                before,
                after,
            }
        };
        RunView {
            index,
            file: format!("run-{index}.csv"),
            conditions: String::new(),
            channels: Channel::ALL.into_iter().map(channel).collect(),
            lift_current_a: curve(1.0),
            lower_current_a: curve(1.0),
            time_s,
        }
    }

    #[test]
    fn two_hundred_long_runs_have_less_than_five_megabytes() {
        let mut random = Pcg64::seed_from_u64(7);
        let mut views = vec![long_run(&mut random, 0); 200];
        for channel in views.iter_mut().flat_map(|view| &mut view.channels) {
            channel.after = None;
        }
        let bytes = runs(&views).into_string().len();
        println!("{bytes} bytes");
        assert!(bytes < 5_000_000, "{bytes}");
    }

    #[test]
    fn the_worst_runs_keep_all_samples() {
        let mut random = Pcg64::seed_from_u64(9);
        let views: Vec<RunView> = (0..30).map(|index| long_run(&mut random, index)).collect();
        let sorted: Vec<&RunView> = views.iter().collect();
        let drawn = plots(&sorted);
        let whole = |data: &Option<Data>| *data == super::data(&views[0]);
        assert!(drawn[0].is_some() && whole(&drawn[0]));
        let reduced = envelope(&views[29], COLUMNS);
        assert_eq!(reduced.time_s.len(), 2 * COLUMNS);
        assert_eq!(drawn[29], data(&reduced));
    }

    #[test]
    fn the_data_of_very_long_campaigns_are_bounded() {
        let mut random = Pcg64::seed_from_u64(8);
        let views = vec![long_run(&mut random, 0); 400];
        let text = runs(&views).into_string();
        let plots = text.matches("application/json").count();
        assert!(plots > 50 && plots < 400, "{plots}");
        assert_eq!(text.matches("<details").count(), 400);
    }
}
