//! Sparse regression of residuals (SINDy for model discrepancy, Kaheman 2019): a library of terms, least squares,
//! removal of small coefficients, repeated until convergence (Brunton 2016).
//!
//! The regressed signals are the rate of the angle residual and the residuals of pressures and flow. The library has
//! one ideal term for each effect of the catalogue: the change of these signals by the effect at its typical size on
//! the same runs.

use hitch_campaign::Campaign;
use hitch_identification::data::experiment::Experiment;
use hitch_plant::{AddedEffect, Channel, Effect, Model};
use nalgebra::{DMatrix, DVector};

use super::answer::{Abilities, Answer, Method};
use super::residuals::Comparison;

/// Samples to either side that a rate is taken over.
const REACH: usize = 5;

/// A term is struck out if it contributes less than this, sigmas root mean square,
const SMALLEST: f64 = 0.1;
/// or less than this share of the largest.
const SMALLEST_SHARE: f64 = 0.1;

/// Ridge that keeps all but identical terms apart, as a share of a term's own square.
const RIDGE: f64 = 1e-3;

/// Sequentially thresholded least squares.
#[derive(Debug)]
pub struct SparseRegression;

impl Method for SparseRegression {
    fn name(&self) -> &'static str {
        "sparse regression"
    }

    fn abilities(&self) -> Abilities {
        Abilities {
            names: true,
            unknown: false,
            intervals: false,
        }
    }

    fn answer(&self, campaign: &Campaign, model: &Model) -> Answer {
        let experiment = Experiment::new(campaign, model);
        let comparison = Comparison::new(&experiment, model);
        let target = targets(&comparison, &[]);
        let effects: Vec<&'static dyn Effect> = comparison.effects().collect();
        let columns: Vec<DVector<f64>> = effects
            .iter()
            .map(|effect| {
                // The reduction of the residuals by the effect is the value of its term.
                let term = &target - targets(&comparison, &[AddedEffect::typical(*effect)]);
                let size = (term.norm_squared() / term.len() as f64).sqrt();
                if size > 0.0 { term / size } else { term }
            })
            .collect();
        let mut named: Vec<(f64, &str)> = strike_out(&columns, &target)
            .into_iter()
            .map(|(column, share)| (share.abs(), effects[column].id()))
            .collect();
        named.sort_by(|a, b| b.0.total_cmp(&a.0));
        Answer {
            named: named.into_iter().map(|(_, id)| id.to_owned()).collect(),
            ..Answer::default()
        }
    }
}

/// The signals to be regressed, in sigmas; zero where nothing was measured.
fn targets(comparison: &Comparison, effects: &[AddedEffect]) -> DVector<f64> {
    let mut values = Vec::new();
    for (run, trace) in comparison.traces(effects).iter().enumerate() {
        for channel in Channel::ALL {
            let residual = comparison.residuals(run, channel, trace);
            if channel == Channel::RockerAngle {
                values.extend(rates(&residual));
            } else {
                values.extend(residual);
            }
        }
    }
    for value in &mut values {
        if !value.is_finite() {
            *value = 0.0;
        }
    }
    DVector::from_vec(values)
}

/// Slope of a line through each sample and its neighbours (Savitzky & Golay), in its own sigmas.
fn rates(residual: &[f64]) -> Vec<f64> {
    let square: f64 = (1..=REACH).map(|k| 2.0 * (k * k) as f64).sum();
    (0..residual.len())
        .map(|sample| {
            if sample < REACH || sample + REACH >= residual.len() {
                return f64::NAN;
            }
            let rise: f64 = (1..=REACH)
                .map(|k| k as f64 * (residual[sample + k] - residual[sample - k]))
                .sum();
            rise / square.sqrt()
        })
        .collect()
}

/// Terms that are left, with their coefficients.
fn strike_out(columns: &[DVector<f64>], target: &DVector<f64>) -> Vec<(usize, f64)> {
    let mut kept: Vec<usize> = (0..columns.len())
        .filter(|&column| columns[column].norm_squared() > 0.0)
        .collect();
    loop {
        let shares = least_squares(columns, &kept, target);
        let largest = shares
            .iter()
            .fold(0.0_f64, |most, share| most.max(share.abs()));
        let smallest = SMALLEST.max(SMALLEST_SHARE * largest);
        let left: Vec<usize> = kept
            .iter()
            .zip(&shares)
            .filter(|(_, share)| share.abs() >= smallest)
            .map(|(&column, _)| column)
            .collect();
        if left.len() == kept.len() {
            return kept.into_iter().zip(shares).collect();
        }
        kept = left;
    }
}

fn least_squares(columns: &[DVector<f64>], kept: &[usize], target: &DVector<f64>) -> Vec<f64> {
    let samples = target.len() as f64;
    let normal = DMatrix::from_fn(kept.len(), kept.len(), |row, column| {
        let ridge = if row == column { RIDGE * samples } else { 0.0 };
        columns[kept[row]].dot(&columns[kept[column]]) + ridge
    });
    let pull = DVector::from_iterator(
        kept.len(),
        kept.iter().map(|&column| columns[column].dot(target)),
    );
    normal.cholesky().map_or_else(Vec::new, |factor| {
        factor.solve(&pull).iter().copied().collect()
    })
}
