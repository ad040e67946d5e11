//! The logs of a campaign with what every check needs: noise, resolution, and where the valves are open.

use std::ops::Range;

use hitch_campaign::{Bench, Campaign, Run};
use hitch_plant::{Channel, Model};

use crate::statistics::{median, noise, quantile, sorted, stretches};

/// Largest current of a shut valve, A; `hitch import` has the same limit.
pub(crate) const SHUT_A: f64 = 0.3;
/// Deviation in sigma that normal noise does not reach in the million samples of a campaign, with half a sigma of slow noise.
pub(crate) const FAR: f64 = 6.0;
/// Time after a change of the currents in which hydraulics settle, s; ringing with soft oil lasts about as long.
pub(crate) const SETTLING_S: f64 = 0.4;
/// Least noise of a logged current, A: its usual resolution.
const LEAST_CURRENT_NOISE_A: f64 = 0.003;

/// Keys of the currents of the lift and the lowering valve.
pub(crate) const CURRENTS: [&str; 2] = ["lift_current_a", "lower_current_a"];

/// What moves a hitch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Open {
    /// Neither valve has a current.
    Neither,
    /// Only the lift valve has one.
    Lift,
    /// Only the lowering valve has one.
    Lower,
    /// Both have one, or one too small to tell.
    Unclear,
}

/// A campaign, and figures that several checks use.
pub(crate) struct Logs<'a> {
    /// The campaign.
    pub campaign: &'a Campaign,
    /// The model, for the weight at rest.
    pub model: Option<&'a Model>,
    /// Standard deviation of the noise of each channel, in its unit; stated, but at least that of its resolution.
    pub noise: [f64; 4],
    /// Smallest step of each channel, in its unit.
    pub step: [f64; 4],
    /// Standard deviation of the noise of each current, A.
    pub current_noise_a: [f64; 2],
    /// Lowest level of each current, A, by run.
    pub level_a: Vec<[f64; 2]>,
}

impl<'a> Logs<'a> {
    /// Prepares a campaign.
    pub fn new(campaign: &'a Campaign, model: Option<&'a Model>) -> Self {
        let stated = [
            campaign.noise.lift_current_a,
            campaign.noise.lower_current_a,
        ];
        let current_noise_a = stated.map(|s| s.unwrap_or(0.0).max(LEAST_CURRENT_NOISE_A));
        let step = Channel::ALL.map(|channel| smallest_step(campaign, channel));
        let noise = Channel::ALL.map(|channel| channel_noise(campaign, channel, step));
        let level = |run: &Run| {
            let of =
                |current: usize| lowest_level(currents(run)[current], current_noise_a[current]);
            [of(0), of(1)]
        };
        Self {
            campaign,
            model,
            noise,
            step,
            current_noise_a,
            level_a: campaign.runs.iter().map(level).collect(),
        }
    }

    /// The runs.
    pub fn runs(&self) -> &'a [Run] {
        &self.campaign.runs
    }

    /// The runs on a hitch, with index and load in kg.
    pub fn hitches(&self) -> impl Iterator<Item = (usize, &'a Run, f64)> {
        let hitch = |(at, run): (usize, &'a Run)| match run.bench {
            Bench::Hitch { load_kg } => Some((at, run, load_kg)),
            Bench::Flow { .. } => None,
        };
        self.runs().iter().enumerate().filter_map(hitch)
    }

    /// Noise of a channel, in its unit.
    pub fn noise_of(&self, channel: Channel) -> f64 {
        self.noise[channel.index()]
    }

    /// Samples of a run in a time, at least two.
    pub fn samples(&self, run: usize, time_s: f64) -> usize {
        let run = &self.runs()[run];
        let step_s = run.duration_s() / (run.time_s.len() - 1) as f64;
        ((time_s / step_s).ceil() as usize).max(2)
    }

    /// Which valve has a current at a sample. A standing current below 0.3 A, which is the same throughout the run, is none.
    pub fn open(&self, run: usize, at: usize) -> Open {
        let flows = |current: usize| {
            let base_a = self.level_a[run][current];
            let base_a = if base_a < SHUT_A { base_a } else { 0.0 };
            let above_a = currents(&self.runs()[run])[current][at] - base_a;
            (
                above_a > FAR * self.current_noise_a[current],
                above_a > SHUT_A,
            )
        };
        match (flows(0), flows(1)) {
            ((false, _), (false, _)) => Open::Neither,
            ((_, true), (false, _)) => Open::Lift,
            ((false, _), (_, true)) => Open::Lower,
            _ => Open::Unclear,
        }
    }

    /// The stretches of a run in which the same valve is open, without the time in which the hydraulics settle.
    pub fn settled(&self, run: usize, open: Open) -> Vec<Range<usize>> {
        let (count, settling) = (self.runs()[run].time_s.len(), self.samples(run, SETTLING_S));
        let mut found = stretches(count, 2, |at| self.open(run, at) == open);
        for stretch in found.iter_mut().filter(|stretch| stretch.start > 0) {
            stretch.start += settling;
        }
        found.retain(|stretch| stretch.len() > 4);
        found
    }

    /// Whether both currents stay within their noise over a stretch.
    pub fn currents_constant(&self, run: usize, stretch: Range<usize>) -> bool {
        (0..2).all(|current| {
            let values = &currents(&self.runs()[run])[current][stretch.clone()];
            let (low, high) = extremes(values);
            high - low <= 2.0 * FAR * self.current_noise_a[current]
        })
    }
}

/// The currents of the lift and the lowering valve, A.
pub(crate) fn currents(run: &Run) -> [&[f64]; 2] {
    [&run.lift_current_a, &run.lower_current_a]
}

/// Smallest and largest finite value; infinities of the other sign without one.
pub(crate) fn extremes(values: &[f64]) -> (f64, f64) {
    let known = values.iter().filter(|v| v.is_finite());
    known.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| {
        (low.min(v), high.max(v))
    })
}

/// Median of the samples that are as low as the lowest twentieth, within noise.
fn lowest_level(values: &[f64], noise_a: f64) -> f64 {
    let low = quantile(values.iter().copied(), 0.05);
    let near = |v: &f64| *v <= low + FAR * noise_a;
    median(values.iter().copied().filter(near))
}

fn logged(campaign: &Campaign, channel: Channel) -> impl Iterator<Item = &[f64]> {
    campaign
        .runs
        .iter()
        .filter_map(move |run| run.channel(channel))
}

fn channel_noise(campaign: &Campaign, channel: Channel, step: [f64; 4]) -> f64 {
    let stated = campaign.noise.of(channel);
    let sigma = stated.unwrap_or_else(|| noise(logged(campaign, channel)));
    let rounding = step[channel.index()] / 12f64.sqrt();
    if sigma.is_finite() {
        sigma.max(rounding)
    } else {
        rounding
    }
}

/// Smallest difference of two values of a channel; zero without a difference.
fn smallest_step(campaign: &Campaign, channel: Channel) -> f64 {
    /// Differences below this share of the range are rounding of the numbers.
    const ROUNDING: f64 = 1e-7;
    let values = sorted(logged(campaign, channel).flatten().copied());
    let range = values
        .last()
        .zip(values.first())
        .map_or(0.0, |(high, low)| high - low);
    let steps = values.windows(2).map(|pair| pair[1] - pair[0]);
    let least = steps
        .filter(|step| *step > ROUNDING * range)
        .fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}
