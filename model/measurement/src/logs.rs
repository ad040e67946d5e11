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
/// Pressure, bar, that the zero of a sensor may have.
pub(crate) const ZERO_BAR: f64 = 1.0;
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
        let noise_and_step = Channel::ALL.map(|channel| noise_and_step(campaign, channel));
        let level = |run: &Run| {
            let of =
                |current: usize| lowest_level(currents(run)[current], current_noise_a[current]);
            [of(0), of(1)]
        };
        Self {
            campaign,
            model,
            noise: noise_and_step.map(|both| both.0),
            step: noise_and_step.map(|both| both.1),
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
        let [lift_a, lower_a] = [0, 1].map(|current| {
            let standing_a = Some(self.level_a[run][current]).filter(|level_a| *level_a < SHUT_A);
            currents(&self.runs()[run])[current][at] - standing_a.unwrap_or(0.0)
        });
        let far_a = self.current_noise_a.map(|sigma_a| FAR * sigma_a);
        let shut = [lift_a <= far_a[0], lower_a <= far_a[1]];
        match shut {
            [true, true] => Open::Neither,
            [false, true] if lift_a > SHUT_A => Open::Lift,
            [true, false] if lower_a > SHUT_A => Open::Lower,
            _ => Open::Unclear,
        }
    }

    /// The stretches of a run in which the same valve is open.
    pub fn stretches(&self, run: usize, open: Open) -> Vec<Range<usize>> {
        let count = self.runs()[run].time_s.len();
        stretches(count, 2, |at| self.open(run, at) == open)
    }

    /// The same, without the time in which the hydraulics settle.
    pub fn settled(&self, run: usize, open: Open) -> Vec<Range<usize>> {
        let settling = self.samples(run, SETTLING_S);
        let mut found = self.stretches(run, open);
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

/// Noise and smallest step of a channel, in its unit; NaN and zero without samples.
fn noise_and_step(campaign: &Campaign, channel: Channel) -> (f64, f64) {
    /// Differences below this share of the range are rounding of the numbers.
    const ROUNDING: f64 = 1e-7;
    let logged = || campaign.runs.iter().filter_map(|run| run.channel(channel));
    let values = sorted(logged().flatten().copied());
    let (low, high) = extremes(&values);
    let steps = values.windows(2).map(|pair| pair[1] - pair[0]);
    let steps = steps.filter(|step| *step > ROUNDING * (high - low));
    let step = steps.reduce(f64::min).unwrap_or(0.0);
    let stated = campaign.noise.of(channel);
    let sigma = stated.unwrap_or_else(|| noise(logged()));
    (sigma.max(step / 12f64.sqrt()), step)
}
