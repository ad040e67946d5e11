//! Statics or dynamics: which form of a model a campaign shows.
//!
//! A missing effect changes levels, and a viscous friction of the dynamic form may take its place. Lags and inertia show in
//! the course after a valve was switched. So both forms are compared by the change of the residuals from sample to sample
//! there.

use hitch_campaign::Campaign;
use hitch_plant::Model;

use crate::data::experiment::Experiment;
use crate::data::problem::Problem;
use crate::data::regime::Regime;
use crate::estimation::fit::Fit;
use crate::explanation::explain::fit_base;

/// Smallest error of the declared form, as a multiple of the other one's, from which the other one is better. Where a
/// campaign shows no dynamics, both have the same error.
const BETTER: f64 = 1.05;

/// Both forms of a model on a campaign, with loads and clocks fitted.
#[derive(Debug, Clone)]
pub struct StartingPoint {
    /// Error of the declared form after switching, in sigma.
    pub declared: f64,
    /// The other form of the model.
    pub other: Model,
    /// The same of the other form.
    pub error_of_other: f64,
}

impl StartingPoint {
    /// Compares a model with its other form.
    #[must_use]
    pub fn new(campaign: &Campaign, model: &Model, other: Model) -> Self {
        let error = |model: &Model| {
            let experiment = Experiment::new(campaign, model);
            let fit = fit_base(Problem::new(&experiment, model));
            after_switching(&experiment, &fit)
        };
        Self {
            declared: error(model),
            error_of_other: error(&other),
            other,
        }
    }

    /// Whether the declared form is the wrong one.
    #[must_use]
    pub fn is_wrong(&self) -> bool {
        self.declared > BETTER * self.error_of_other
    }
}

/// Error after switching, in sigma: root mean square of the change of the whitened residuals from one sample to the next,
/// over the square root of two, with equal weight per channel. NaN if no valve is switched.
fn after_switching(experiment: &Experiment, fit: &Fit) -> f64 {
    let mut squares = [(0.0, 0.0); 4];
    for (index, run) in experiment.runs.iter().enumerate() {
        let (scales, residuals) = (&fit.weights.runs[index].scale, &fit.residuals[index]);
        for (channel, (sum, count)) in squares.iter_mut().enumerate() {
            let offset = channel * run.len();
            for sample in 1..run.len() {
                let (before, here) = (offset + sample - 1, offset + sample);
                let is_compared = scales[before] > 0.0 && scales[here] > 0.0;
                if run.regimes[sample] == Regime::Switching && is_compared {
                    *sum += 0.5 * (residuals[here] - residuals[before]).powi(2);
                    *count += 1.0;
                }
            }
        }
    }
    let channels = squares.iter().filter(|(_, count)| *count > 0.0);
    let means: Vec<f64> = channels.map(|(sum, count)| sum / count).collect();
    (means.iter().sum::<f64>() / means.len() as f64).sqrt()
}
