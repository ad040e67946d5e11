//! A lab that can measure a planned manoeuvre on a rig with hidden physics.
//!
//! The rig is the model's own plant with one more effect, another load and noise of its own: it proves what a search
//! makes of a manoeuvre, not the plant.

use fastrand::Rng;
use hitch_model::Model;
use hitch_model::campaign::{Bench, Campaign, Noise, Run};
use hitch_model::effects::AddedEffect;
use hitch_model::identification::design::plan::{RunPlan, Stand};
use hitch_model::identification::experiment::Experiment;
use hitch_model::identification::explain::{Explanation, explain};

/// Sample rate of the lab's logger, Hz.
pub const RATE_HZ: f64 = 50.0;

/// One sigma of pump pressure, cylinder pressure, flow and angle, in their units, and of the currents, A.
const SIGMA: [f64; 4] = [0.15, 0.1, 0.2, 0.05];
const CURRENT_SIGMA_A: f64 = 0.003;

/// Part of an instrument's variance that is slow, and its correlation from sample to sample.
const SLOW_SHARE: f64 = 0.2;
const SLOW_CORRELATION: f64 = 0.95;

/// Standard normal numbers (Box & Muller).
fn normal(rng: &mut Rng) -> f64 {
    let radius = (-2.0 * (1.0 - rng.f64()).ln()).sqrt();
    radius * (std::f64::consts::TAU * rng.f64()).cos()
}

/// A run as a rig like `rig` would give it: a load weighed to half a percent, partly slow noise, noisy currents.
fn measured(plan: &RunPlan, rig: &Model, channels: [bool; 4], rng: &mut Rng) -> Run {
    let mut actual = *plan;
    if let Stand::Hitch { load_kg, .. } = &mut actual.stand {
        *load_kg *= 1.0 + 0.005 * normal(rng);
    }
    let mut run = actual.log(rig, RATE_HZ, channels);
    if let Stand::Hitch { load_kg, .. } = plan.stand {
        run.bench = Bench::Hitch { load_kg };
    }
    for (values, sigma) in run.channels.iter_mut().zip(SIGMA) {
        let mut slow = normal(rng);
        for value in values.iter_mut().flatten() {
            let fresh = (1.0 - SLOW_CORRELATION * SLOW_CORRELATION).sqrt();
            slow = SLOW_CORRELATION * slow + fresh * normal(rng);
            *value += sigma * (SLOW_SHARE.sqrt() * slow + (1.0 - SLOW_SHARE).sqrt() * normal(rng));
        }
    }
    for current_a in run
        .lift_current_a
        .iter_mut()
        .chain(&mut run.lower_current_a)
    {
        *current_a += CURRENT_SIGMA_A * normal(rng);
    }
    run
}

fn campaign(runs: Vec<Run>) -> Campaign {
    Campaign {
        name: "bench".to_owned(),
        description: String::new(),
        sample_rate_hz: RATE_HZ,
        noise: Noise {
            lift_current_a: Some(CURRENT_SIGMA_A),
            lower_current_a: Some(CURRENT_SIGMA_A),
            channels: SIGMA.map(Some),
            oil_temperature_c: None,
        },
        runs,
    }
}

/// A rig with hidden physics and what is measured on it.
pub struct Lab {
    /// The model that is to explain it.
    pub model: Model,
    rig: Model,
    channels: [bool; 4],
    rng: Rng,
    runs: Vec<Run>,
}

impl Lab {
    /// A lab around `model` with `hidden` in its rig, after it has measured `plans` with some of the channels.
    #[must_use]
    pub fn new(model: Model, hidden: &AddedEffect, channels: [bool; 4], plans: &[RunPlan]) -> Self {
        let mut lab = Self {
            rig: model.with_effects(vec![hidden.clone()]),
            model,
            channels,
            rng: Rng::with_seed(7),
            runs: Vec::new(),
        };
        lab.measure(plans);
        lab
    }

    /// Measures more runs.
    pub fn measure(&mut self, plans: &[RunPlan]) {
        for plan in plans {
            let mut run = measured(plan, &self.rig, self.channels, &mut self.rng);
            run.file = format!("run_{}.csv", self.runs.len());
            self.runs.push(run);
        }
    }

    /// All that was measured, ready.
    #[must_use]
    pub fn experiment(&self) -> Experiment {
        Experiment::new(&campaign(self.runs.clone()), &self.model)
    }

    /// Explains all that was measured.
    #[must_use]
    pub fn explain(&self) -> Explanation {
        explain(&self.experiment(), &self.model, &|_| {})
    }
}
