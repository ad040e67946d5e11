//! A lab that measures a planned manoeuvre on the second rig with a hidden effect, and explains its campaign.

use hitch_campaign::{Campaign, Run};
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::design::plan::RunPlan;
use hitch_identification::explanation::explain::{Explanation, explain};
use hitch_plant::Model;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

use crate::hidden_effects::starting_point;
use crate::second_rig::campaign_writer::{LOAD_SIGMA, PlannedRun, log};
use crate::second_rig::draw::{Case, Kind, Wish, draw};
use crate::second_rig::hidden::Fidelity;
use crate::second_rig::hideable::find;
use crate::second_rig::instruments::stated_noise;
use crate::second_rig::manoeuvres::Plan;
use crate::second_rig::on_order::on_order;
use crate::second_rig::test_stand::{Circumstances, Family, SAMPLE_RATE_HZ};

/// A rig with one hidden effect, on rough terms: slow noise, wrong weights, noisy currents, unnamed physics.
pub struct Lab {
    /// The model that is to explain it.
    pub model: Model,
    case: Case,
    channels: [bool; 4],
    random: Pcg64,
    since_s: f64,
    runs: Vec<Run>,
}

impl Lab {
    /// A lab whose rig hides an effect of the catalogue of a size, after it has measured `plans` with some channels.
    ///
    /// # Panics
    /// If nothing of that id can be hidden.
    #[must_use]
    pub fn new(
        family: Family,
        (id, size): (&str, f64),
        channels: [bool; 4],
        plans: &[RunPlan],
    ) -> Self {
        let wish = Wish {
            family,
            plan: Plan::Lab,
            fidelity: Some(Fidelity::Faithful),
            rough: Some(true),
            kind: Some(Kind::Single),
            effect: Some((find(id).expect("can be hidden"), Some(size))),
            known: |_| true,
        };
        let mut lab = Self {
            model: starting_point(family),
            case: draw(SEED, &wish),
            channels,
            random: Pcg64::seed_from_u64(SEED),
            since_s: 0.0,
            runs: Vec::new(),
        };
        lab.measure(plans);
        lab
    }

    /// Measures more runs.
    pub fn measure(&mut self, plans: &[RunPlan]) {
        let physics = self.case.physics();
        for plan in plans {
            let error: f64 = StandardNormal.sample(&mut self.random);
            let run = PlannedRun {
                manoeuvre: on_order(plan, &self.model),
                circumstances: Circumstances {
                    since_s: self.since_s,
                    load_factor: 1.0 + LOAD_SIGMA * error,
                },
            };
            self.since_s += plan.duration_s();
            let mut log = log(&self.case, &physics, &run, &mut self.random);
            log.file = format!("run_{}.csv", self.runs.len());
            for (channel, has) in log.channels.iter_mut().zip(self.channels) {
                *channel = channel.take().filter(|_| has);
            }
            self.runs.push(log);
        }
    }

    /// All that was measured, ready.
    #[must_use]
    pub fn experiment(&self) -> Experiment {
        let campaign = Campaign {
            name: "lab".to_owned(),
            description: String::new(),
            sample_rate_hz: SAMPLE_RATE_HZ,
            synchronous: false,
            noise: stated_noise(self.case.instruments.current_sigma_a),
            runs: self.runs.clone(),
        };
        Experiment::new(&campaign, &self.model)
    }

    /// Explains all that was measured.
    #[must_use]
    pub fn explain(&self) -> Explanation {
        explain(Problem::new(&self.experiment(), &self.model), &|_| {})
    }
}

/// Seed of the rig's structural details and of all noise.
const SEED: u64 = 7;
