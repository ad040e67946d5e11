//! A run prepared for comparison and fitting.

use crate::data::clocks::Clocks;
use crate::data::condense::condensed;
use crate::data::conditioning::Drive;
use crate::data::defect_correction::DefectCorrection;
use crate::data::noise::median;
use crate::data::nuisance::{CurrentShift, Nuisance};
use crate::data::regime::{Regime, regimes};
use crate::data::trace_cache::Traces;
use hitch_campaign::{Bench, Run};
use hitch_plant::simulation::{Trace, simulate_in};
use hitch_plant::solver::dynamic::Steps;
use hitch_plant::{
    AddedEffect, Channel, Currents, Dynamics, Model, Plant, Rig, SizeResponse, units,
};
use std::sync::Arc;

/// Relative deviation from the port pressure within which a flow bench counts as settled.
const PORT_TOLERANCE: f64 = 0.05;

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

impl ReadyRun {
    /// A run of a campaign of `runs`.
    pub(super) fn new(
        run: &Run,
        model: &Model,
        sigma: Currents,
        slow_share: f64,
        runs: usize,
    ) -> Self {
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
    pub(super) fn coarse_in_time(&self, model: &Model, nuisance: Nuisance) -> Self {
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
    pub(super) fn condensed(&self, model: &Model, nuisance: Nuisance, noise: Currents) -> Self {
        let stretches = condensed(&self.drive, &self.regimes, noise, |one, other| {
            self.compares_alike(one, other)
        });
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
            widened: self.widened.each_ref().map(|all| {
                if all.is_empty() {
                    Vec::new()
                } else {
                    stretches.firsts().map(|first| all[first]).collect()
                }
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

/// Samples that a measured start angle is averaged over.
const START_SAMPLES: usize = 5;

/// Measured start angle, degree; `None` if the log has no angle.
fn measured_deg(run: &Run) -> Option<f64> {
    let angle = run.channel(Channel::RockerAngle)?;
    let finite = angle.iter().copied().filter(|angle| angle.is_finite());
    let seen: Vec<f64> = finite.take(START_SAMPLES).collect();
    (!seen.is_empty()).then(|| seen.iter().sum::<f64>() / seen.len() as f64)
}
