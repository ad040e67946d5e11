//! What the logger and its instruments resolve: sample interval, steps of a channel, ripple of the currents, temperature within a run.

use hitch_campaign::Run;
use hitch_plant::Channel;

use crate::finding::{Evidence, Finding, Kind};
use crate::logs::{CURRENTS, Logs, Open, currents, extremes};
use crate::statistics::{median, noise, quantile};

/// Longest sample interval, s: the time constants of spools and the oscillations of air in the oil are of this size.
const LONGEST_S: f64 = 0.05;
/// Ripple, in sigma of the logged current, that is not its noise: laboratories state it within a factor of two.
const RIPPLE: f64 = 4.0;
/// Fewest steps in the range of a channel that moves.
const FEWEST_STEPS: f64 = 20.0;
/// Change of the oil temperature, degrees, that changes the viscosity by about a fifth.
const WARMING_C: f64 = 5.0;

/// What the logger does not resolve.
pub(crate) fn findings(logs: &Logs) -> Vec<Finding> {
    let runs = logs.runs().iter().enumerate();
    let warmed = runs.filter_map(|(at, run)| temperature(logs, at, run));
    let rippled = (0..2).filter_map(|current| ripple(logs, current));
    let coarse = Channel::ALL
        .into_iter()
        .filter_map(|channel| resolution(logs, channel));
    warmed
        .chain(rippled)
        .chain(interval(logs))
        .chain(coarse)
        .collect()
}

/// Samples too far apart.
fn interval(logs: &Logs) -> Option<Finding> {
    let steps = logs
        .runs()
        .iter()
        .flat_map(|run| run.time_s.windows(2).map(|pair| pair[1] - pair[0]));
    let step_s = median(steps);
    let seen = format!(
        "The samples are {step_s:.2} s apart: lags, the motion of spools and air in the oil stay undecided."
    );
    let cure = "Log every 10 ms, at most every 50 ms.";
    let evidence = Evidence::new(step_s, 0.01 * step_s, "s");
    (step_s > 1.001 * LONGEST_S).then(|| Finding::new(Kind::SampleInterval, evidence, seen, cure))
}

/// Steps of a channel that are larger than its noise. Rounding to a step has the noise of the step by the root of twelve; without a
/// stated noise, the steps hide the noise and are those of a converter with less than eight bits.
fn resolution(logs: &Logs, channel: Channel) -> Option<Finding> {
    let step = logs.step[channel.index()];
    let logged = logs.runs().iter().filter_map(|run| run.channel(channel));
    let (low, high) = extremes(&logged.flatten().copied().collect::<Vec<f64>>());
    let range = high - low;
    let (limit, than) = match logs.campaign.noise.of(channel) {
        Some(sigma) => (sigma * 12f64.sqrt(), format!("stated noise is {sigma}")),
        None => (
            (range / 256.0).max(logs.noise_of(channel)),
            format!("range is {range:.0}"),
        ),
    };
    // Of a channel that hardly moves, no range is known.
    if step <= limit || range < FEWEST_STEPS * step {
        return None;
    }
    let (title, unit) = (channel.title(), channel.unit());
    let seen = format!("The {title} has steps of {step:.3} {unit}, and its {than} {unit}.");
    let cure = "Log with more digits or bits, or state at least a third of a step as the noise.";
    let evidence = Evidence::of(step, 0.01 * step, channel);
    Some(Finding::new(Kind::Resolution, evidence, seen, cure).of(channel.key()))
}

/// A current that scatters while it is constant.
fn ripple(logs: &Logs, current: usize) -> Option<Finding> {
    let open = [Open::Lift, Open::Lower][current];
    let parts = logs.runs().iter().enumerate().flat_map(|(at, run)| {
        let settled = logs.settled(at, open).into_iter();
        settled.map(move |stretch| &currents(run)[current][stretch])
    });
    let sigma_a = noise(parts);
    let largest_a = RIPPLE * logs.current_noise_a[current];
    let seen =
        format!("The current scatters by {sigma_a:.3} A while it flows, above {largest_a:.3} A.");
    let cure = "Log the mean over a period of the dither, or state this noise.";
    let evidence = Evidence::new(sigma_a, 0.2 * sigma_a, "A");
    (sigma_a > largest_a)
        .then(|| Finding::new(Kind::CurrentRipple, evidence, seen, cure).of(CURRENTS[current]))
}

/// A run in which the oil warms.
fn temperature(logs: &Logs, at: usize, run: &Run) -> Option<Finding> {
    let log = run.oil_temperature_log_c.as_ref()?;
    let share = |share: f64| quantile(log.iter().copied(), share);
    let change_c = share(0.95) - share(0.05);
    // The middle 90 % of normal noise are 3.3 sigma wide.
    let noise_c = 3.3 * logs.campaign.noise.oil_temperature_c.unwrap_or(0.0);
    let seen =
        format!("The oil temperature changes by {change_c:.1} degrees Celsius within the run.");
    let cure = "Warm the oil before the run, or cut the run into shorter ones.";
    let evidence = Evidence::new(change_c, noise_c, "C");
    (change_c > WARMING_C + noise_c)
        .then(|| Finding::new(Kind::OilTemperature, evidence, seen, cure).in_run(logs.campaign, at))
}
