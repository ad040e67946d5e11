//! What the logger and its instruments resolve: sample interval, steps of a channel, ripple of the currents, temperature within a run.

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

/// Samples too far apart.
pub(crate) fn interval(logs: &Logs) -> Vec<Finding> {
    let steps = logs
        .runs()
        .iter()
        .flat_map(|run| run.time_s.windows(2).map(|pair| pair[1] - pair[0]));
    let step_s = median(steps);
    if step_s <= 1.001 * LONGEST_S {
        return Vec::new();
    }
    let seen = format!(
        "The samples are {step_s:.2} s apart: lags, the motion of spools and air in the oil stay undecided."
    );
    let cure = "Log every 10 ms, at most every 50 ms.";
    vec![Finding::new(
        Kind::SampleInterval,
        Evidence::new(step_s, 0.01 * step_s, "s"),
        seen,
        cure,
    )]
}

/// Channels whose steps are larger than their noise. Rounding to a step has the noise of the step by the root of twelve; without a
/// stated noise, the steps hide the noise and are those of a converter with less than eight bits.
pub(crate) fn resolution(logs: &Logs) -> Vec<Finding> {
    let coarse = |channel: Channel| {
        let step = logs.step[channel.index()];
        let logged = logs.runs().iter().filter_map(|run| run.channel(channel));
        let (low, high) = extremes(&logged.flatten().copied().collect::<Vec<f64>>());
        let (limit, than) = match logs.campaign.noise.of(channel) {
            Some(sigma) => (sigma * 12f64.sqrt(), format!("its stated noise is {sigma}")),
            None => (
                ((high - low) / 256.0).max(logs.noise_of(channel)),
                format!("its range is {:.0}", high - low),
            ),
        };
        // Of a channel that hardly moves, no range is known.
        if step <= limit || high - low < FEWEST_STEPS * step {
            return None;
        }
        let (title, unit) = (channel.title(), channel.unit());
        let seen = format!("The {title} has steps of {step:.3} {unit}, and {than} {unit}.");
        let cure =
            "Log with more digits or bits, or state at least a third of a step as the noise.";
        let evidence = Evidence::of(step, 0.01 * step, channel);
        Some(Finding::new(Kind::Resolution, evidence, seen, cure).of(channel.key()))
    };
    Channel::ALL.into_iter().filter_map(coarse).collect()
}

/// Currents that scatter while they are constant.
pub(crate) fn ripple(logs: &Logs) -> Vec<Finding> {
    let rippled = |current: usize| {
        let open = [Open::Lift, Open::Lower][current];
        let mut parts = Vec::new();
        for (at, run) in logs.runs().iter().enumerate() {
            let settled = logs.settled(at, open).into_iter();
            parts.extend(settled.map(|stretch| &currents(run)[current][stretch]));
        }
        let sigma_a = noise(parts);
        let largest_a = RIPPLE * logs.current_noise_a[current];
        let seen = format!(
            "The current scatters by {sigma_a:.3} A while it flows, above {largest_a:.3} A."
        );
        let cure = "Log the mean over a period of the dither, or state this noise.";
        let evidence = Evidence::new(sigma_a, 0.2 * sigma_a, "A");
        (sigma_a > largest_a)
            .then(|| Finding::new(Kind::CurrentRipple, evidence, seen, cure).of(CURRENTS[current]))
    };
    (0..2).filter_map(rippled).collect()
}

/// Runs in which the oil warms.
pub(crate) fn temperature(logs: &Logs) -> Vec<Finding> {
    let warmed = |(at, run): (usize, &hitch_campaign::Run)| {
        let log = run.oil_temperature_log_c.as_ref()?;
        let share = |share: f64| quantile(log.iter().copied(), share);
        let change_c = share(0.95) - share(0.05);
        let sigma_c = logs.campaign.noise.oil_temperature_c.unwrap_or(0.0);
        // The middle 90 % of normal noise are 3.3 sigma wide.
        if change_c.is_nan() || change_c <= WARMING_C + 3.3 * sigma_c {
            return None;
        }
        let seen =
            format!("The oil temperature changes by {change_c:.1} degrees Celsius within the run.");
        let cure = "Warm the oil before the run, or cut the run into shorter ones.";
        let evidence = Evidence::new(change_c, 3.3 * sigma_c, "C");
        Some(Finding::new(Kind::OilTemperature, evidence, seen, cure).in_run(logs.campaign, at))
    };
    logs.runs().iter().enumerate().filter_map(warmed).collect()
}
