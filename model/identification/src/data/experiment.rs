//! A campaign prepared for comparison and fitting: conditioned currents, instrument noise, regimes, masks.

use std::sync::Arc;

use hitch_campaign::{Bench, Campaign, Run};
use hitch_plant::simulation::{Trace, simulate_in};
use hitch_plant::solver::dynamic::Steps;
use hitch_plant::{
    AddedEffect, Channel, Currents, Dynamics, Model, Plant, Rig, SizeResponse, units,
};
use rayon::prelude::*;

use crate::data::clocks::{Clocks, LARGEST_OFFSET_S};
use crate::data::condense::Stretches;
use crate::data::conditioning::{Drive, jumps_within_s};
use crate::data::defect_correction::DefectCorrection;
use crate::data::noise::{
    channel_noise, current_noise, current_persistence, median, persistence_block,
};
use crate::data::regime::{Regime, regimes};
use crate::data::start_angle::{likely_deg, measured_deg};
use crate::data::trace_cache::{CurrentShift, Traces};

/// Relative deviation from the port pressure within which a flow bench counts as settled.
const PORT_TOLERANCE: f64 = 0.05;

/// Nuisance parameters of a run: errors of the set-up, fitted with a prior.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Nuisance {
    /// Error of the weighed load, relative.
    pub load: f64,
}

/// Prior sigma of [`Nuisance::load`]: a load is weighed to about half a percent (docs/campaigns.md).
pub const LOAD_PRIOR: f64 = 0.005;

/// What a baseline adds to the noise of a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Widening {
    /// Factor on the standard deviation: noise of the baseline, and discrepancy of the model.
    pub factor: f64,
    /// Share of the variance that is a discrepancy of the model; `None` in a state that the baseline does not show.
    pub discrepancy: Option<f64>,
}

/// A prepared run.
#[derive(Debug, Clone)]
pub struct ReadyRun {
    /// File name, for reports.
    pub file: String,
    /// Test stand of the run.
    pub bench: Bench,
    /// Oil temperature, degree Celsius.
    pub oil_temperature_c: f64,
    /// Whether the oil temperature was stated or logged, and not assumed.
    pub oil_temperature_known: bool,
    /// Conditioned currents.
    pub drive: Drive,
    /// Measured channels by [`Channel::index`], in their units; NaN for samples that are not compared.
    pub measured: [Option<Vec<f64>>; 4],
    /// Regime of each sample.
    pub regimes: Vec<Regime>,
    /// Rocker angle at the start, degree; NaN on a flow bench.
    pub start_angle_deg: f64,
    /// Number of log samples that each sample is the mean of; one except in a condensed run.
    pub averaged: Vec<f64>,
    /// What a baseline adds to the noise of each sample by [`Channel::index`]; empty without one.
    pub widened: [Vec<Widening>; 4],
    /// Number of samples left out before a flow bench reached its pressure.
    pub settling_samples: usize,
    traces: Traces,
    /// Correction of simulations with coarse time steps; `None` if the run is simulated with fine steps.
    defect_correction: Option<Arc<DefectCorrection>>,
}

/// A prepared campaign.
#[derive(Debug, Clone)]
pub struct Experiment {
    /// Name of the campaign.
    pub name: String,
    /// The runs.
    pub runs: Vec<ReadyRun>,
    /// One sigma of each channel by [`Channel::index`], in its unit; NaN for a channel that no run has.
    pub noise: [f64; 4],
    /// One sigma of the logged currents, A.
    pub current_noise: Currents,
    /// Largest common time error of all jumps of the logged currents, s.
    pub jumps_within_s: f64,
    /// Variance of the mean of the currents' noise over half a second relative to that of white noise; at least one.
    pub current_persistence: f64,
    /// Largest clock offset between a channel and the currents, s; zero if one clock stamps all.
    pub clocks_within_s: f64,
    /// Whether the model's pressures ring, so that errors of the ringing's phase and amplitude are tolerated.
    pub ringing: bool,
}

impl Experiment {
    /// Whether what the model leaves on a baseline has been subtracted. Its constants are then as they were on the baseline.
    #[must_use]
    pub fn is_beside_baseline(&self) -> bool {
        let mut widened = self.runs.iter().flat_map(|run| &run.widened);
        widened.any(|samples| !samples.is_empty())
    }

    /// Prepares a campaign; `model` defines the valves' thresholds and the ends of the stroke.
    #[must_use]
    pub fn new(campaign: &Campaign, model: &Model) -> Self {
        let noise = Channel::ALL.map(|channel| channel_noise(campaign, channel));
        let sigma = current_noise(campaign);
        let persistence = current_persistence(campaign, sigma);
        // Share of the noise variance that averaging over half a second does not remove.
        let slow_share = (persistence - 1.0) / persistence_block(campaign) as f64;
        let runs: Vec<_> = campaign
            .runs
            .par_iter()
            .map(|run| ReadyRun::new(run, model, sigma, slow_share, campaign.runs.len()))
            .map(|run| run.started(model, noise))
            .collect();
        let jumps_within_s = jumps_within_s(runs.iter().map(|run| &run.drive));
        Self {
            name: campaign.name.clone(),
            runs,
            noise,
            current_noise: sigma,
            jumps_within_s,
            current_persistence: persistence,
            clocks_within_s: match campaign.synchronous {
                true => 0.0,
                false => LARGEST_OFFSET_S,
            },
            ringing: model.constants().dynamics == Dynamics::Dynamic,
        }
    }

    /// The experiment with coarse time steps, corrected around a fitted model with one nuisance per run: exact at this
    /// model and accurate near it.
    #[must_use]
    pub fn coarse_in_time(&self, model: &Model, nuisances: &[Nuisance]) -> Self {
        let runs = self.runs.par_iter().zip(nuisances);
        Self {
            runs: runs
                .map(|(run, &nuisance)| run.coarse_in_time(model, nuisance))
                .collect(),
            ..self.without_runs()
        }
    }

    /// The experiment with condensed runs, corrected around a fitted model with one nuisance per run. Unchanged if that
    /// would not remove most of the samples, or if pressures ring between the remaining ones.
    #[must_use]
    pub fn condensed(&self, model: &Model, nuisances: &[Nuisance]) -> Self {
        if self.ringing {
            return self.clone();
        }
        let runs = self.runs.par_iter().zip(nuisances);
        let runs: Vec<ReadyRun> = runs
            .map(|(run, &nuisance)| run.condensed(model, nuisance, self.current_noise))
            .collect();
        let condensed = Self {
            runs,
            ..self.without_runs()
        };
        match 2 * condensed.samples() < self.samples() {
            true => condensed,
            false => self.clone(),
        }
    }

    /// Number of samples of all runs.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.runs.iter().map(ReadyRun::len).sum()
    }

    /// Whether any run measures a channel.
    #[must_use]
    pub fn measures(&self, channel: Channel) -> bool {
        let mut runs = self.runs.iter();
        runs.any(|run| run.measured[channel.index()].is_some())
    }

    /// The experiment without its runs.
    #[must_use]
    pub fn without_runs(&self) -> Self {
        Self {
            name: self.name.clone(),
            runs: Vec::new(),
            ..*self
        }
    }
}

impl ReadyRun {
    /// A run of a campaign of `runs`.
    fn new(run: &Run, model: &Model, sigma: Currents, slow_share: f64, runs: usize) -> Self {
        let drive = Drive::new(
            &run.time_s,
            &run.lift_current_a,
            &run.lower_current_a,
            sigma,
            slow_share,
        );
        let mut measured = run.channels.clone();
        let settling_samples = settling_samples(run);
        for values in measured.iter_mut().flatten() {
            for value in values.iter_mut().take(settling_samples) {
                *value = f64::NAN;
            }
        }
        let regimes = regimes(model, &drive, run.channel(Channel::RockerAngle));
        let samples = run.time_s.len();
        Self {
            file: run.file.clone(),
            bench: run.bench,
            oil_temperature_c: run.oil_temperature_c,
            oil_temperature_known: run.oil_temperature_known,
            drive,
            start_angle_deg: measured_deg(run).unwrap_or(f64::NAN),
            measured,
            regimes,
            settling_samples,
            widened: Default::default(),
            averaged: vec![1.0; samples],
            traces: Traces::new(samples, runs),
            defect_correction: None,
        }
    }

    /// The run, with an estimated start angle if its log has no angle.
    fn started(self, model: &Model, noise: [f64; 4]) -> Self {
        if self.on_hitch() && self.start_angle_deg.is_nan() {
            self.started_at(likely_deg(&self, model, noise))
        } else {
            self
        }
    }

    /// The run with another start angle, degree.
    #[must_use]
    pub(crate) fn started_at(&self, start_angle_deg: f64) -> Self {
        Self {
            start_angle_deg,
            traces: self.traces.emptied(self.len()),
            ..self.clone()
        }
    }

    /// The run with other measured values, and factors on their standard deviations.
    #[must_use]
    pub(crate) fn with_measured(
        &self,
        measured: [Option<Vec<f64>>; 4],
        widened: [Vec<Widening>; 4],
    ) -> Self {
        Self {
            measured,
            widened,
            ..self.clone()
        }
    }

    /// The run with a load error as a part of its load.
    #[must_use]
    pub(crate) fn loaded(self, nuisance: Nuisance) -> Self {
        let bench = match self.bench {
            Bench::Hitch { load_kg } => Bench::Hitch {
                load_kg: load_kg * (1.0 + nuisance.load),
            },
            flow @ Bench::Flow { .. } => flow,
        };
        Self {
            bench,
            traces: self.traces.emptied(self.len()),
            ..self
        }
    }

    /// The run with coarse time steps, corrected around a model and a nuisance. Unchanged on a flow bench, for a
    /// quasi-static model, and for a hitch that bounces.
    fn coarse_in_time(&self, model: &Model, nuisance: Nuisance) -> Self {
        // A model without inertia takes long steps anyway.
        let rings = model.constants().dynamics == Dynamics::Dynamic;
        if !self.on_hitch() || !rings || bounces(model) {
            return self.clone();
        }
        let in_step = CurrentShift::default();
        let fine = self.trace(model, nuisance, in_step);
        let coarse_in_time = self.driven(Steps::COARSE, model, nuisance, in_step);
        Self {
            traces: self.traces.emptied(self.len()),
            defect_correction: Some(Arc::new(DefectCorrection::new(&fine, &coarse_in_time))),
            ..self.clone()
        }
    }

    /// The run condensed and corrected around a model and a nuisance.
    fn condensed(&self, model: &Model, nuisance: Nuisance, noise: Currents) -> Self {
        let stretches = Stretches::of(self, noise);
        let measured = self.measured.each_ref();
        let mut condensed = Self {
            file: self.file.clone(),
            drive: self.drive.condensed(&stretches),
            measured: measured.map(|values| values.as_ref().map(|all| stretches.means(all))),
            regimes: stretches
                .firsts()
                .map(|first| self.regimes[first])
                .collect(),
            averaged: stretches.sizes(),
            widened: self.widened.each_ref().map(|all| match all.is_empty() {
                true => Vec::new(),
                false => stretches.firsts().map(|first| all[first]).collect(),
            }),
            traces: self.traces.emptied(stretches.len()),
            defect_correction: None,
            ..*self
        };
        let in_step = CurrentShift::default();
        let all = stretches.mean_trace(&self.trace(model, nuisance, in_step));
        let few = condensed.driven(Steps::COARSE, model, nuisance, in_step);
        condensed.defect_correction = Some(Arc::new(DefectCorrection::new(&all, &few)));
        condensed
    }

    /// Whether two samples have the same measured channels.
    #[must_use]
    pub(crate) fn compares_alike(&self, one: usize, other: usize) -> bool {
        let mut channels = self.measured.iter().flatten();
        channels.all(|values| values[one].is_finite() == values[other].is_finite())
    }

    /// Share of the variance of a residual, by its index, that is a discrepancy of the model known from a baseline; `None` in a
    /// state that the baseline does not show.
    #[must_use]
    pub(crate) fn discrepancy(&self, at: usize) -> Option<f64> {
        let widened = self.widened[at / self.len()].get(at % self.len());
        widened.map_or(Some(0.0), |widened| widened.discrepancy)
    }

    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.drive.time_s.len()
    }

    /// Whether the run has no samples; a campaign that was read from files has no such run.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.drive.time_s.is_empty()
    }

    /// Whether the run is on the hitch, and thus has a load error and a start angle.
    #[must_use]
    pub fn on_hitch(&self) -> bool {
        matches!(self.bench, Bench::Hitch { .. })
    }

    /// The rig with the load error of `nuisance`.
    #[must_use]
    pub fn rig(&self, nuisance: Nuisance) -> Rig {
        let bench = match self.bench {
            Bench::Hitch { load_kg } => Bench::Hitch {
                load_kg: load_kg * (1.0 + nuisance.load),
            },
            flow @ Bench::Flow { .. } => flow,
        };
        bench.rig(self.start_angle_deg.to_radians())
    }

    /// One sigma of the cylinder pressure of a piston that dry friction holds, bar: the force that it carries is anywhere
    /// between both directions.
    #[must_use]
    pub fn stuck_bar(&self, model: &Model, nuisance: Nuisance) -> f64 {
        let at_rest = Currents::default();
        let plant = Plant::new(model, self.rig(nuisance), self.oil_temperature_c, at_rest);
        units::bar_from_pa(plant.dry_friction_pa()) / 3f64.sqrt()
    }

    /// Simulated trace without clock offsets, driven by the conditioned currents shifted by `shift`.
    #[must_use]
    pub fn trace(&self, model: &Model, nuisance: Nuisance, shift: CurrentShift) -> Arc<Trace> {
        // A flow bench has no load error.
        let nuisance = if self.on_hitch() {
            nuisance
        } else {
            Nuisance::default()
        };
        let simulated = || self.simulated(model, nuisance, shift);
        self.traces.trace(model, nuisance, shift, simulated)
    }

    /// [`ReadyRun::trace`] without the cache.
    #[must_use]
    pub fn simulated(&self, model: &Model, nuisance: Nuisance, shift: CurrentShift) -> Trace {
        match &self.defect_correction {
            Some(defect_correction) if !bounces(model) => {
                defect_correction.added_to(self.driven(Steps::COARSE, model, nuisance, shift))
            }
            _ => self.driven(Steps::FINE, model, nuisance, shift),
        }
    }

    /// Simulates the run with the given time steps.
    fn driven(
        &self,
        steps: Steps,
        model: &Model,
        nuisance: Nuisance,
        shift: CurrentShift,
    ) -> Trace {
        let currents = self.drive.shifted(shift.later_s, shift.spreads);
        let rig = self.rig(nuisance);
        let course_s = self.drive.course_s();
        let mut trace = simulate_in(
            steps,
            model,
            rig,
            self.oil_temperature_c,
            course_s,
            &currents,
        );
        trace.keep(self.drive.samples());
        trace
    }

    /// Simulated trace with these clock offsets.
    #[must_use]
    pub fn simulate(&self, model: &Model, nuisance: Nuisance, clocks: &Clocks) -> Trace {
        self.stamped(
            &self.trace(model, nuisance, CurrentShift::default()),
            clocks,
        )
    }

    /// A trace as logged with these clock offsets.
    #[must_use]
    pub fn stamped(&self, in_step: &Trace, clocks: &Clocks) -> Trace {
        clocks.stamped(&self.drive.time_s, in_step)
    }
}

/// Whether a hitch may bounce on stiff ground: coarse steps resolve the ringing of the load on the oil, but not that.
fn bounces(model: &Model) -> bool {
    let lands = |added: &AddedEffect| {
        added.effect.size_response() == SizeResponse::Located && !added.is_null()
    };
    model.constants().dynamics == Dynamics::Dynamic && model.effects.iter().any(lands)
}

/// Number of samples at the start of a flow-bench run before the port reaches its steady pressure, by the measured
/// pressure, which need not agree with the declared one.
fn settling_samples(run: &Run) -> usize {
    if !matches!(run.bench, Bench::Flow { .. }) {
        return 0;
    }
    let Some(pressure) = run.channel(Channel::CylinderPressure) else {
        return 0;
    };
    let finite = pressure.iter().copied().filter(|bar| bar.is_finite());
    let Some(kept_bar) = median(finite.collect()) else {
        return 0;
    };
    let tolerance_bar = (PORT_TOLERANCE * kept_bar).max(1.0);
    let settled = pressure
        .iter()
        .position(|bar| (bar - kept_bar).abs() <= tolerance_bar);
    // A bench that takes longer has a fault, which has to stay visible.
    settled
        .filter(|&samples| samples <= run.time_s.len() / 4)
        .unwrap_or(0)
}
