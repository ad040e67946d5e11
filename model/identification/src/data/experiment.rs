//! A campaign prepared for comparison and fitting: conditioned currents, instrument noise, regimes, masks.

use hitch_campaign::Campaign;
use hitch_plant::{Channel, Currents, Dynamics, Model};

use crate::data::clocks::LARGEST_OFFSET_S;
use crate::data::conditioning::jumps_within_s;
use crate::data::noise::{channel_noise, current_noise, current_persistence, persistence_block};
use crate::data::nuisance::Nuisance;
use crate::data::ready_run::ReadyRun;
use crate::data::start_angle::started;
use crate::parallel;

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
        let runs: Vec<_> = parallel::map(&campaign.runs, |run| {
            let run = ReadyRun::new(run, model, sigma, slow_share, campaign.runs.len());
            started(run, model, noise)
        });
        let jumps_within_s = jumps_within_s(runs.iter().map(|run| &run.drive));
        Self {
            name: campaign.name.clone(),
            runs,
            noise,
            current_noise: sigma,
            jumps_within_s,
            current_persistence: persistence,
            clocks_within_s: if campaign.synchronous {
                0.0
            } else {
                LARGEST_OFFSET_S
            },
            ringing: model.constants().dynamics == Dynamics::Dynamic,
        }
    }

    /// The experiment with coarse time steps, corrected around a fitted model with one nuisance per run: exact at this
    /// model and accurate near it.
    #[must_use]
    pub fn coarse_in_time(&self, model: &Model, nuisances: &[Nuisance]) -> Self {
        let runs = self.runs.iter().zip(nuisances);
        Self {
            runs: parallel::map(runs, |(run, &nuisance)| run.coarse_in_time(model, nuisance)),
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
        let runs = self.runs.iter().zip(nuisances);
        let runs = parallel::map(runs, |(run, &nuisance)| {
            run.condensed(model, nuisance, self.current_noise)
        });
        let condensed = Self {
            runs,
            ..self.without_runs()
        };
        if 2 * condensed.samples() < self.samples() {
            condensed
        } else {
            self.clone()
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
