//! Whitening of residuals: measured minus simulated, in units of their standard deviation.
//!
//! * Pressures and flow: the standard deviation of a sample combines, in quadrature, the instrument's noise and the
//!   effect of the uncertainty of the logged current and of the sampling time on the simulated value. Samples that a
//!   log cannot resolve (a pressure edge that may lie on either side of the sample) are left out.
//! * Cylinder pressure at rest in a dynamic model: dry friction holds the piston anywhere in its band, depending on the phase
//!   at which the ringing ended. The standard deviation of a uniform distribution over the band is added.
//! * Angle: it integrates the flow, so errors of the logged current accumulate as a random walk with known step
//!   variance. A scalar Kalman filter removes the walk: each sample is compared with its prediction from the model and
//!   the previous samples (Kristensen, Madsen & Jorgensen 2004, with known instead of fitted diffusion). Drift without
//!   flow through a valve is not removed. The uncertainty of the start angle is the walk's first step.
//!
//! Both are linear in the difference, so sensitivities pass through the same filter.

use std::sync::Arc;

use hitch_plant::simulation::Trace;
use hitch_plant::{Channel, Model};

use crate::data::experiment::Experiment;
use crate::data::nuisance::CurrentShift;
use crate::data::problem::Problem;
use crate::data::ready_run::{ReadyRun, Widening};
use crate::data::regime::Regime;
use crate::estimate::Estimate;
use crate::parallel;
use crate::residuals::contact_mask::contact_mask;
use crate::residuals::phase::timing_errors_s;
use crate::residuals::walk::Walk;

/// Samples whose standard deviation exceeds this multiple of the instrument's noise are left out.
const LARGEST_DEVIATION: f64 = 8.0;

/// Uncertainty of the sampling time, one sigma, s: a twentieth of a 50 Hz sample. On ramps it changes the flow, after a
/// switch the phase of a ringing pressure.
const TIMING_S: f64 = 0.001;

/// Error of a ringing pressure, as a share of its standard deviation within [`RINGING_S`] (s) of a sample, in a dynamic
/// model: frequency and damping depend on oil, hose, seals and stops, whose constants are known only to some percent.
const RINGING_SHARE: f64 = 0.07;
const RINGING_S: f64 = 0.1;

/// Whitening of one run's differences.
#[derive(Debug, Clone)]
pub struct RunWeights {
    /// Reciprocal standard deviation of every sample, channel after channel; zero for samples that are left out.
    pub scale: Vec<f64>,
    /// Gain of the angle's filter at every sample.
    gain: Vec<f64>,
    /// Samples that count; the others only update the angle's filter.
    kept: Vec<bool>,
}

/// Whitening of all differences.
#[derive(Debug, Clone)]
pub struct Weights {
    /// One entry per run.
    pub runs: Vec<RunWeights>,
    /// Compared samples of each channel by [`Channel::index`].
    pub counts: [usize; 4],
}

impl Weights {
    /// Weights at `estimate`.
    #[must_use]
    pub fn new(problem: Problem<'_>, estimate: &Estimate) -> Self {
        let Problem {
            experiment, model, ..
        } = problem;
        let model = estimate.applied_to(model);
        let runs = parallel::map(0..experiment.runs.len(), |index| {
            RunWeights::new(experiment, index, &model, estimate)
        });
        Self::counted(runs)
    }

    /// The weights of the runs `picked`.
    #[must_use]
    pub fn of_runs(&self, picked: &[usize]) -> Self {
        let runs = picked.iter().map(|&run| self.runs[run].clone()).collect();
        Self::counted(runs)
    }

    /// The same weights, for some samples only, chosen by their index in the run.
    #[must_use]
    pub fn of_samples(&self, chosen: impl Fn(usize) -> bool) -> Self {
        let mut runs = self.runs.clone();
        for run in &mut runs {
            for (sample, kept) in run.kept.iter_mut().enumerate() {
                *kept = chosen(sample);
            }
        }
        Self::counted(runs)
    }

    fn counted(runs: Vec<RunWeights>) -> Self {
        let mut counts = [0; 4];
        for run in &runs {
            for (channel, count) in counts.iter_mut().enumerate() {
                *count += run.compared(channel);
            }
        }
        Self { runs, counts }
    }

    /// The wider standard deviation of either at each sample; a sample that one of them leaves out is left out.
    #[must_use]
    pub fn wider(&self, other: &Self) -> Self {
        let pairs = self.runs.iter().zip(&other.runs);
        Self::counted(pairs.map(|(own, its)| own.wider(its)).collect())
    }

    /// Residuals that were whitened with these weights, whitened with `others` instead, which leave out the same samples or
    /// more.
    #[must_use]
    pub fn whitened_with(&self, others: &Self, residuals: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let runs = self.runs.iter().zip(&others.runs).zip(residuals);
        runs.map(|((own, its), residual)| own.whitened_with(its, residual))
            .collect()
    }

    /// Number of compared samples.
    #[must_use]
    pub fn count(&self) -> usize {
        self.counts.iter().sum()
    }

    /// The same weights, multiplied by a factor per channel.
    #[must_use]
    pub fn scaled(mut self, factors: [f64; 4]) -> Self {
        for run in &mut self.runs {
            let samples = run.gain.len();
            for (channel, factor) in factors.into_iter().enumerate() {
                for scale in &mut run.scale[channel * samples..(channel + 1) * samples] {
                    *scale *= factor;
                }
            }
        }
        self
    }
}

impl RunWeights {
    fn new(experiment: &Experiment, index: usize, model: &Model, estimate: &Estimate) -> Self {
        let run = &experiment.runs[index];
        let nuisance = estimate.nuisances[index];
        let clocks = &estimate.clocks;
        let trace = |later_s: f64, spreads: f64| {
            run.trace(model, nuisance, CurrentShift { later_s, spreads })
        };
        let [below, above] = [-1.0, 1.0].map(|spreads| trace(0.0, spreads));
        let edges = run.measured[Channel::PumpPressure.index()]
            .as_ref()
            .map(|_| pump_edges(run, [-EDGE_SPREADS, EDGE_SPREADS].map(|s| trace(0.0, s))));
        let [below, above] = [below, above].map(|trace| run.stamped(&trace, clocks));
        let [early, late] =
            [-TIMING_S, TIMING_S].map(|later_s| run.stamped(&trace(later_s, 0.0), clocks));
        let mut weights = Self {
            scale: vec![0.0; 4 * run.len()],
            gain: vec![0.0; run.len()],
            kept: vec![true; run.len()],
        };
        let at_an_edge = |sample: usize| edges.as_ref().is_some_and(|edges| edges[sample]);
        let walk = Walk::new(experiment, run, model, [&below, &above]);
        let contact_mask = contact_mask(run, model, [&below, &above]);
        let is_discontinuous = |sample: usize| walk.at_a_stop[sample] || contact_mask[sample];
        let ringing = experiment.ringing;
        let late_s = if ringing && run.on_hitch() {
            timing_errors_s(run, model, &below, &walk.deg)
        } else {
            vec![0.0; run.len()]
        };
        for channel in [
            Channel::PumpPressure,
            Channel::CylinderPressure,
            Channel::Flow,
        ] {
            let Some(measured) = &run.measured[channel.index()] else {
                continue;
            };
            let sigma = experiment.noise[channel.index()];
            let offset = channel.index() * run.len();
            let tolerance = if ringing && channel != Channel::Flow {
                ringing_tolerance(&run.drive.time_s, below.channel(channel))
            } else {
                vec![0.0; run.len()]
            };
            let stuck = match channel {
                Channel::CylinderPressure if ringing => run.stuck_bar(model, nuisance),
                _ => 0.0,
            };
            for (sample, value) in measured.iter().enumerate() {
                let spread =
                    0.5 * (above.channel(channel)[sample] - below.channel(channel)[sample]);
                let shift = 0.5 * (late.channel(channel)[sample] - early.channel(channel)[sample]);
                let shift = match channel {
                    Channel::CylinderPressure => shift * (late_s[sample] / TIMING_S).hypot(1.0),
                    _ => shift,
                };
                let noise = sigma / run.averaged[sample].sqrt();
                let at_rest = match run.regimes[sample] {
                    Regime::Holding => stuck,
                    _ => 0.0,
                };
                let deviation = noise.hypot(spread).hypot(shift);
                let deviation = deviation.hypot(tolerance[sample]).hypot(at_rest);
                let known = deviation <= LARGEST_DEVIATION * sigma
                    && !is_discontinuous(sample)
                    && !(channel == Channel::PumpPressure && at_an_edge(sample));
                if value.is_finite() && known {
                    weights.scale[offset + sample] = 1.0 / deviation;
                }
            }
        }
        weights.filter_angle(experiment, run, &walk.steps_deg);
        weights.widen(&run.widened);
        weights
    }

    /// Multiplies the standard deviations. The gains of the angle's filter stay: sensor noise and walk widen alike.
    fn widen(&mut self, widened: &[Vec<Widening>; 4]) {
        let samples = self.gain.len();
        for (channel, widened) in widened.iter().enumerate() {
            let scales = &mut self.scale[channel * samples..];
            for (scale, widened) in scales.iter_mut().zip(widened) {
                *scale /= widened.factor;
            }
        }
    }

    /// Gains of the scalar Kalman filter for the random walk of the angle.
    fn filter_angle(&mut self, experiment: &Experiment, run: &ReadyRun, steps_deg: &[f64]) {
        let Some(measured) = &run.measured[Channel::RockerAngle.index()] else {
            return;
        };
        let of_sample = experiment.noise[Channel::RockerAngle.index()].powi(2);
        let offset = Channel::RockerAngle.index() * run.len();
        // The initial start angle has the uncertainty of one sensor reading.
        let mut variance = of_sample;
        for (sample, value) in measured.iter().enumerate() {
            variance += steps_deg[sample] * steps_deg[sample];
            let noise = of_sample / run.averaged[sample];
            if value.is_finite() {
                let total = variance + noise;
                self.scale[offset + sample] = 1.0 / total.sqrt();
                self.gain[sample] = variance / total;
                variance *= noise / total;
            }
        }
    }

    /// The wider standard deviation of either at each sample, and the filter that has it.
    fn wider(&self, other: &Self) -> Self {
        let mut wider = self.clone();
        let samples = self.gain.len();
        let angle = Channel::RockerAngle.index() * samples;
        for (place, scale) in wider.scale.iter_mut().enumerate() {
            let its = other.scale[place];
            if its < *scale {
                *scale = its;
                if let Some(sample) = place.checked_sub(angle).filter(|sample| *sample < samples) {
                    wider.gain[sample] = other.gain[sample];
                }
            }
        }
        wider
    }

    /// Residuals that were whitened with these weights, whitened with `others` instead, which leave out the same samples or
    /// more.
    fn whitened_with(&self, others: &Self, residual: &[f64]) -> Vec<f64> {
        let samples = self.gain.len();
        let mut moved = vec![0.0; residual.len()];
        for channel in Channel::ALL {
            let offset = channel.index() * samples;
            let is_angle = channel == Channel::RockerAngle;
            let (mut walk, mut its_walk) = (0.0, 0.0);
            for sample in 0..samples {
                let (own, its) = (self.scale[offset + sample], others.scale[offset + sample]);
                if own > 0.0 {
                    let innovation = residual[offset + sample] / own;
                    let difference = innovation + walk;
                    moved[offset + sample] = (difference - its_walk) * its;
                    if is_angle {
                        walk += self.gain[sample] * innovation;
                        its_walk += others.gain[sample] * (difference - its_walk);
                    }
                }
            }
        }
        moved
    }

    /// Number of compared samples of a channel.
    #[must_use]
    pub fn compared(&self, channel: usize) -> usize {
        let samples = self.gain.len();
        let part = &self.scale[channel * samples..(channel + 1) * samples];
        let counts = part.iter().zip(&self.kept);
        counts
            .filter(|(scale, kept)| **scale > 0.0 && **kept)
            .count()
    }

    /// Whitened residuals of the run, channel after channel; zero for samples that are left out.
    #[must_use]
    pub fn whiten(&self, run: &ReadyRun, trace: &Trace) -> Vec<f64> {
        let mut residual = vec![0.0; 4 * run.len()];
        for channel in Channel::ALL {
            let Some(measured) = &run.measured[channel.index()] else {
                continue;
            };
            let offset = channel.index() * run.len();
            let simulated = trace.channel(channel);
            let mut walk = 0.0;
            for sample in 0..run.len() {
                let scale = self.scale[offset + sample];
                if scale > 0.0 {
                    let innovation = measured[sample] - simulated[sample] - walk;
                    if self.kept[sample] {
                        residual[offset + sample] = innovation * scale;
                    }
                    if channel == Channel::RockerAngle {
                        walk += self.gain[sample] * innovation;
                    }
                }
            }
        }
        residual
    }
}

/// Tolerance of a ringing pressure at each sample, in its unit: a share of its local standard deviation.
fn ringing_tolerance(time_s: &[f64], pressure: &[f64]) -> Vec<f64> {
    let step_s = (time_s[time_s.len() - 1] - time_s[0]) / (time_s.len() - 1) as f64;
    let reach = (RINGING_S / step_s).round().max(1.0) as usize;
    (0..pressure.len())
        .map(|sample| {
            let last = (sample + reach).min(pressure.len() - 1);
            let near = &pressure[sample.saturating_sub(reach)..=last];
            let count = near.len() as f64;
            let mean = near.iter().sum::<f64>() / count;
            let variance = near.iter().map(|p| (p - mean).powi(2)).sum::<f64>() / count;
            RINGING_SHARE * variance.sqrt()
        })
        .collect()
}

/// Samples on either side of a jump of the pump pressure that are left out: channels of a log may be offset by one
/// sample.
const EDGE_SAMPLES: usize = 2;

/// Uncertainty of the current, in sigmas, for deciding whether the lift valve opens at all: a plateau of a staircase at
/// the threshold carries no information on the pump pressure.
const EDGE_SPREADS: f64 = 3.0;

/// Mask of the samples next to a jump of the pump pressure between idle and load pressure.
fn pump_edges(run: &ReadyRun, traces: [Arc<Trace>; 2]) -> Vec<bool> {
    let last = run.len() - 1;
    let lifts = |sample: usize| {
        let high = |trace: &Arc<Trace>| {
            (trace.channel(Channel::PumpPressure)[sample] - trace.idle_pressure_bar).abs() > 1e-6
        };
        traces.each_ref().map(high)
    };
    (0..=last)
        .map(|sample| {
            let around = sample.saturating_sub(EDGE_SAMPLES)..=(sample + EDGE_SAMPLES).min(last);
            let number = 2 * around.clone().count();
            let on = around.flat_map(lifts).filter(|&lifting| lifting).count();
            on != 0 && on != number
        })
        .collect()
}
