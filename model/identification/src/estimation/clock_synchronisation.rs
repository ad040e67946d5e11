//! Global search for the clock offsets of ringing channels.
//!
//! A ringing pressure fits nearly as well one whole period late. A descent from a wrong stiffness or friction ends in
//! such a local minimum, and no gradient leads out of it. Shifting a channel of a simulated trace is cheap, so all
//! offsets on a grid are evaluated.

use crate::data::clocks::{Clocks, LARGEST_OFFSET_S, OFFSET_PRIOR_S};
use crate::data::nuisance::CurrentShift;
use crate::data::problem::Problem;
use crate::estimate::Estimate;
use crate::estimation::residual_columns::{dot, huber};
use crate::parallel;
use crate::residuals::whitening::Weights;

/// Grid step of the offsets, s: a tenth of the shortest period that a sampling time of 20 ms resolves.
const STEP_S: f64 = 0.004;

/// The estimate with the clock offsets of least cost, all other parameters fixed. Unchanged if nothing rings or the
/// clocks are known.
pub(crate) fn synchronised(
    problem: Problem<'_>,
    weights: &Weights,
    estimate: Estimate,
) -> Estimate {
    let Problem { experiment, .. } = problem;
    if !experiment.ringing || experiment.clocks_within_s == 0.0 {
        return estimate;
    }
    let steps = (LARGEST_OFFSET_S / STEP_S).round() as i32;
    let tried: Vec<Clocks> = (-steps..=steps)
        .map(|step| Clocks {
            offsets_s: [f64::from(step) * STEP_S; 4],
        })
        .chain([estimate.clocks])
        .collect();
    let costs = costs(problem, weights, &estimate, &tried);
    let mut better = estimate;
    for (channel, offset_s) in better.clocks.offsets_s.iter_mut().enumerate() {
        let best = costs
            .iter()
            .zip(&tried)
            .min_by(|a, b| a.0[channel].total_cmp(&b.0[channel]));
        if let Some((_, clocks)) = best {
            *offset_s = clocks.offsets_s[channel];
        }
    }
    better
}

/// Cost of each channel for each set of clock offsets, including their prior.
fn costs(
    problem: Problem<'_>,
    weights: &Weights,
    estimate: &Estimate,
    tried: &[Clocks],
) -> Vec<[f64; 4]> {
    let Problem {
        experiment, model, ..
    } = problem;
    let model = estimate.applied_to(model);
    let runs = experiment.runs.iter().enumerate();
    let of_runs: Vec<Vec<[f64; 4]>> = parallel::map(runs, |(index, run)| {
        let in_step = run.trace(&model, estimate.nuisances[index], CurrentShift::default());
        let cost = |clocks: &Clocks| {
            let trace = run.stamped(&in_step, clocks);
            let whitened = huber(vec![weights.runs[index].whiten(run, &trace)]).swap_remove(0);
            let of = |channel: usize| &whitened[channel * run.len()..(channel + 1) * run.len()];
            std::array::from_fn(|channel| dot(of(channel), of(channel)))
        };
        tried.iter().map(cost).collect()
    });
    let total = |(at, clocks): (usize, &Clocks)| {
        std::array::from_fn(|channel| {
            let prior = (clocks.offsets_s[channel] / OFFSET_PRIOR_S).powi(2);
            prior + of_runs.iter().map(|run| run[at][channel]).sum::<f64>()
        })
    };
    tried.iter().enumerate().map(total).collect()
}
