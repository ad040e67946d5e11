//! Residual-energy localisation with an exhaustive hold-out selection of one term (LISDD, arXiv 2606.23215), with the
//! effects of the catalogue as the library of terms.
//!
//! The regime with the largest residual energy per sample is located first. Each term is then fitted alone to half of
//! the runs, and the one with the smallest energy in that regime of the other half is selected, if it is below that of
//! the model.

use std::collections::BTreeMap;

use hitch_campaign::Campaign;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::regime::Regime;
use hitch_plant::{AddedEffect, Channel, Model};

use super::answer::{Abilities, Answer, Method};
use super::information_criterion::started_and_fitted;
use super::residuals::Comparison;

/// Share of the energy in the regime that a term has to take away in held-out runs.
const WORTHWHILE: f64 = 0.05;

/// Fewest samples that make a regime.
const FEWEST: usize = 30;

/// Localised residual energy, one term by exhaustive hold-out.
#[derive(Debug)]
pub struct LocalisedHoldOut;

impl Method for LocalisedHoldOut {
    fn name(&self) -> &'static str {
        "localised hold-out"
    }

    fn abilities(&self) -> Abilities {
        Abilities {
            names: true,
            unknown: false,
            intervals: false,
        }
    }

    fn answer(&self, campaign: &Campaign, model: &Model) -> Answer {
        let whole = Experiment::new(campaign, model);
        let [train, test] = halves(&whole);
        if train.runs.is_empty() || test.runs.is_empty() {
            return Answer::default();
        }
        let (train, test) = (
            Comparison::new(&train, model),
            Comparison::new(&test, model),
        );
        let Some(regime) = worst(&Comparison::new(&whole, model)) else {
            return Answer::default();
        };
        let before = energies(&test, &[]).mean(regime);
        let terms = train.effects().filter_map(|effect| {
            let added = started_and_fitted(&train, effect)?;
            let after = energies(&test, std::slice::from_ref(&added)).mean(regime);
            Some((after, added))
        });
        let best = terms.min_by(|a, b| a.0.total_cmp(&b.0));
        match best {
            Some((after, added)) if after < (1.0 - WORTHWHILE) * before => Answer {
                named: vec![added.effect.id().to_owned()],
                held_out: Some((before.sqrt(), after.sqrt())),
                ..Answer::default()
            },
            _ => Answer::default(),
        }
    }
}

/// Every other run, and the rest.
fn halves(whole: &Experiment) -> [Experiment; 2] {
    [0, 1].map(|half| {
        let mut part = whole.clone();
        let mut index = 0;
        part.runs.retain(|_| {
            index += 1;
            index % 2 == half
        });
        part
    })
}

/// Sums of squares of the residuals in sigmas and numbers of samples, by regime.
struct Energies(BTreeMap<Regime, (f64, usize)>);

impl Energies {
    /// Energy per sample in a regime.
    fn mean(&self, regime: Regime) -> f64 {
        let (square, count) = self.0.get(&regime).copied().unwrap_or_default();
        square / count.max(1) as f64
    }
}

/// Residual energy of a model with some effects, by regime.
fn energies(comparison: &Comparison, effects: &[AddedEffect]) -> Energies {
    let mut sums = BTreeMap::new();
    for (run, trace) in comparison.traces(effects).iter().enumerate() {
        let regimes = &comparison.experiment.runs[run].regimes;
        for channel in Channel::ALL {
            let residuals = comparison.filtered(run, channel, trace);
            for (residual, regime) in residuals.iter().zip(regimes) {
                if residual.is_finite() {
                    let sum: &mut (f64, usize) = sums.entry(*regime).or_default();
                    sum.0 += residual * residual;
                    sum.1 += 1;
                }
            }
        }
    }
    Energies(sums)
}

/// The regime with the most energy per sample.
fn worst(comparison: &Comparison) -> Option<Regime> {
    let energies = energies(comparison, &[]);
    let regimes = energies.0.iter().filter(|(_, (_, count))| *count >= FEWEST);
    let regimes = regimes.map(|(regime, _)| *regime);
    regimes.max_by(|a, b| energies.mean(*a).total_cmp(&energies.mean(*b)))
}
