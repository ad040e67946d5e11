//! The fit of a campaign: coefficients with intervals, and the probability of each hidden effect.

use hitch_identification::selection::evidence::shares;

use crate::block::{Block, Run, blocks};
use crate::evidence::{Estimate, Evidence};
use crate::machine::{Machine, at_speed};
use crate::next_run::{Knowledge, NextRun, next_run};
use crate::term::{Prior, Reference, TWO_SIDED_95, Term, column, prior};
use crate::whitening::{Row, Shape};

/// A value with its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimated {
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub deviation: f64,
}

impl Estimated {
    /// The 95 % interval.
    #[must_use]
    pub fn interval(&self) -> [f64; 2] {
        [-TWO_SIDED_95, TWO_SIDED_95].map(|times| self.mean + times * self.deviation)
    }
}

/// A hidden effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Effect {
    /// Which one.
    pub term: Term,
    /// Its probability.
    pub probability: f64,
    /// Its size if it is present, in the unit of the term.
    pub size: Estimated,
    /// Its prior.
    pub prior: Prior,
}

/// Result of a fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Implement and soil.
    pub machine: Machine,
    /// What the priors refer to.
    pub reference: Reference,
    /// `F A`, `F B`, `F C`: N per cm and m or tool, and per (km/h) to the power of the index.
    pub coefficients: [Estimated; 3],
    /// Covariance of these.
    pub covariance: [[f64; 3]; 3],
    /// The effects that were weighed.
    pub effects: Vec<Effect>,
    /// The lanes of the campaign in the order of their index.
    pub lanes: Vec<String>,
    /// Most probable shape of the soil's variation.
    pub shape: Shape,
    /// Coefficient of variation of the draft between blocks, 1.
    pub variation: f64,
    /// Number of independent samples that determine the level of the draft as well.
    pub effective_samples: f64,
    /// The run that says most of the effects that are neither present nor absent; `None` if there are none.
    pub next_run: Option<NextRun>,
    /// Pairs of effects, of which at least one is present, and the campaign does not say which.
    pub confounded: Vec<(Term, Term)>,
    /// The blocks of the campaign.
    pub blocks: Vec<Block>,
}

impl Fit {
    /// Specific draft, N per cm and m or tool, at a speed in km/h.
    #[must_use]
    pub fn specific_draft(&self, speed_km_h: f64) -> Estimated {
        let powers = [1.0, speed_km_h, speed_km_h * speed_km_h];
        let means = self.coefficients.map(|coefficient| coefficient.mean);
        let mut variance = 0.0;
        for (left, row) in powers.iter().zip(&self.covariance) {
            for (right, value) in powers.iter().zip(row) {
                variance += left * right * value;
            }
        }
        Estimated {
            mean: at_speed(&means, speed_km_h),
            deviation: variance.max(0.0).sqrt(),
        }
    }

    /// The draft over that of the standard at the campaign's mean speed, 1.
    #[must_use]
    pub fn over_the_standard(&self) -> Estimated {
        let speed_km_h = self.reference.speed_km_h;
        let standard = at_speed(&self.machine.standard(), speed_km_h);
        let Estimated { mean, deviation } = self.specific_draft(speed_km_h);
        Estimated {
            mean: mean / standard,
            deviation: deviation / standard,
        }
    }
}

/// Probability from which on an effect counts as present, and below whose complement as absent: that of the intervals.
pub const CERTAIN: f64 = 0.95;

/// What a campaign says of an effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// It is present.
    Present,
    /// It is absent.
    Absent,
    /// The campaign does not decide.
    Open,
}

impl Effect {
    /// What the campaign says of it.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        match self.probability {
            probability if probability >= CERTAIN => Verdict::Present,
            probability if probability <= 1.0 - CERTAIN => Verdict::Absent,
            _ => Verdict::Open,
        }
    }
}

/// Probability of an effect before the campaign. That of wheel tracks is the probability of any lane.
const PRESENT: f64 = 0.5;

/// Fits in which the expected draft, and the coefficients of the terms that multiply others, are those of the fit before.
const ROUNDS: usize = 4;

/// Fits a campaign; `None` without any block in the soil.
#[must_use]
pub fn fit(machine: &Machine, runs: &[Run]) -> Option<Fit> {
    let blocks: Vec<Block> = runs
        .iter()
        .enumerate()
        .flat_map(|(index, run)| blocks(run, index))
        .collect();
    let reference = Reference::of(&blocks)?;
    let mut lanes: Vec<String> = Vec::new();
    let mut lane_of = Vec::new();
    for run in runs {
        let known = lanes.iter().position(|lane| *lane == run.lane);
        lane_of.push(known.unwrap_or_else(|| {
            lanes.push(run.lane.clone());
            lanes.len() - 1
        }));
    }
    let campaign = Data {
        machine,
        blocks: &blocks,
        lane_of: &lane_of,
        reference,
        terms: terms(&blocks, &lane_of, lanes.len()),
    };
    let mut coefficients = machine.standard();
    let mut mixture = None;
    for _ in 0..ROUNDS {
        let weighed = Mixture::of(&campaign, coefficients)?;
        coefficients = [0, 1, 2].map(|power| weighed.of_term(power).1.mean);
        mixture = Some(weighed);
    }
    let mixture = mixture?;
    let (shape, variation) = mixture.variation()?;
    let effects = campaign.effects().map(|index| {
        let (probability, size) = mixture.of_term(index);
        Effect {
            term: campaign.terms[index],
            probability,
            size,
            prior: campaign.prior(index),
        }
    });
    let effects: Vec<Effect> = effects.collect();
    let open: Vec<usize> = campaign
        .effects()
        .zip(&effects)
        .filter(|(_, effect)| effect.verdict() == Verdict::Open)
        .map(|(index, _)| index)
        .collect();
    Some(Fit {
        machine: *machine,
        reference,
        coefficients: [0, 1, 2].map(|power| mixture.of_term(power).1),
        covariance: mixture.covariance(),
        lanes,
        shape,
        variation,
        effective_samples: mixture
            .evidence
            .effective_samples(shape, campaign.terms.len()),
        next_run: campaign.next_run(&mixture, &open, shape, coefficients),
        confounded: mixture
            .confounded(&open)
            .map(|(left, right)| (campaign.terms[left], campaign.terms[right]))
            .collect(),
        effects,
        blocks: blocks.clone(),
    })
}

/// The terms of a campaign: those of wheel tracks only if there are several lanes in work.
fn terms(blocks: &[Block], lane_of: &[usize], lanes: usize) -> Vec<Term> {
    let mut terms: Vec<Term> = (0..3).map(Term::Coefficient).collect();
    terms.extend([Term::DraftZero, Term::DepthZero, Term::BluntShare]);
    let is_worked = |lane: &usize| {
        let mut blocks = blocks.iter();
        blocks.any(|block| block.in_soil && lane_of.get(block.run) == Some(lane))
    };
    let worked: Vec<usize> = (0..lanes).filter(is_worked).collect();
    if worked.len() > 1 {
        terms.extend(worked.into_iter().map(Term::WheelTrack));
    }
    terms
}

/// What is fitted.
struct Data<'a> {
    machine: &'a Machine,
    blocks: &'a [Block],
    lane_of: &'a [usize],
    reference: Reference,
    terms: Vec<Term>,
}

impl Data<'_> {
    fn prior(&self, index: usize) -> Prior {
        prior(self.terms[index], self.machine, &self.reference)
    }

    /// Indices of the hidden effects.
    fn effects(&self) -> std::ops::Range<usize> {
        3..self.terms.len()
    }

    /// The models that are weighed, as indices of their terms, with the logarithm of their prior probability: every subset of
    /// the effects, with at most one lane in wheel tracks.
    fn models(&self) -> Vec<(Vec<usize>, f64)> {
        let is_track = |index: &usize| matches!(self.terms[*index], Term::WheelTrack(_));
        let tracks: Vec<usize> = self.effects().filter(is_track).collect();
        let others: Vec<usize> = self.effects().filter(|index| !is_track(index)).collect();
        let with = PRESENT.ln();
        let without = (1.0 - PRESENT).ln();
        let mut models = Vec::new();
        for subset in 0..1_usize << others.len() {
            let mut chosen = vec![0, 1, 2];
            let mut log_prior = 0.0;
            for (bit, index) in others.iter().enumerate() {
                let is_in = subset >> bit & 1 == 1;
                log_prior += if is_in { with } else { without };
                chosen.extend(is_in.then_some(*index));
            }
            models.push((chosen.clone(), log_prior + without));
            for track in &tracks {
                let mut chosen = chosen.clone();
                chosen.push(*track);
                models.push((chosen, log_prior + with - (tracks.len() as f64).ln()));
            }
        }
        models
    }

    /// The run that says most of the open terms.
    fn next_run(
        &self,
        mixture: &Mixture,
        open: &[usize],
        shape: Shape,
        coefficients: [f64; 3],
    ) -> Option<NextRun> {
        let terms: Vec<usize> = (0..3).chain(open.iter().copied()).collect();
        let estimates = mixture.evidence.estimates(&terms);
        let estimate = estimates.iter().find(|estimate| estimate.shape == shape)?;
        let places: Vec<usize> = (3..terms.len()).collect();
        let terms: Vec<Term> = terms.iter().map(|index| self.terms[*index]).collect();
        next_run(&Knowledge {
            machine: self.machine,
            reference: self.reference,
            terms: &terms,
            open: &places,
            estimate,
            coefficients,
            noise_n: noise_above_n(self.blocks),
        })
    }

    /// The evidence of all models, with the expected draft of these coefficients.
    fn evidence(&self, coefficients: [f64; 3]) -> Evidence {
        let mut in_soil = Vec::new();
        let mut log_scale = 0.0;
        let mut above = Vec::new();
        let noise_n = noise_above_n(self.blocks);
        for block in self.blocks {
            let lane = self.lane_of[block.run];
            let value = |term: &Term| column(*term, block, lane, self.machine, &coefficients);
            let expected_n: f64 = (0..3)
                .map(|power| coefficients[power] * value(&Term::Coefficient(power)))
                .sum();
            let scale = if block.in_soil {
                // A draft that vanishes is not expected of any implement in the soil.
                let standard = self.machine.standard();
                let least_n = 0.05
                    * (0..3)
                        .map(|power| standard[power] * value(&Term::Coefficient(power)))
                        .sum::<f64>();
                expected_n.max(least_n)
            } else {
                noise_n
            };
            let mut values: Vec<f64> = self.terms.iter().map(|term| value(term) / scale).collect();
            values.push(if block.in_soil {
                expected_n / scale
            } else {
                0.0
            });
            values.push(block.draft_n / scale);
            if block.in_soil {
                log_scale += scale.ln();
                in_soil.push(Row {
                    run: block.run,
                    at_m: block.at_m,
                    values,
                });
            } else {
                above.push(values);
            }
        }
        let mut priors: Vec<Prior> = (0..self.terms.len())
            .map(|index| self.prior(index))
            .collect();
        // The column of the expected draft belongs to no model.
        priors.push(Prior {
            mean: 0.0,
            deviation: 1.0,
        });
        Evidence::new(&in_soil, log_scale, &above, priors)
    }
}

/// Deviation of a mean above the soil, N: the larger of what the scatter of samples and that between blocks show.
fn noise_above_n(blocks: &[Block]) -> f64 {
    /// A sensor without visible noise is read to this, N.
    const LEAST_N: f64 = 10.0;
    let above: Vec<&Block> = blocks.iter().filter(|block| !block.in_soil).collect();
    let count = above.len() as f64;
    let within = above
        .iter()
        .map(|block| block.scatter_n.powi(2) / block.samples as f64);
    let within = within.sum::<f64>() / count.max(1.0);
    let mean = above.iter().map(|block| block.draft_n).sum::<f64>() / count.max(1.0);
    let between = above.iter().map(|block| (block.draft_n - mean).powi(2));
    let between = between.sum::<f64>() / (count - 1.0).max(1.0);
    within.max(between).sqrt().max(LEAST_N)
}

/// All models with all shapes, weighed.
struct Mixture {
    evidence: Evidence,
    /// Terms, estimate and weight; the weights add up to one.
    parts: Vec<(Vec<usize>, Estimate, f64)>,
}

impl Mixture {
    fn of(data: &Data<'_>, coefficients: [f64; 3]) -> Option<Self> {
        let evidence = data.evidence(coefficients);
        let mut parts = Vec::new();
        for (terms, log_prior) in data.models() {
            for estimate in evidence.estimates(&terms) {
                let log_weight = log_prior + estimate.log_evidence;
                parts.push((terms.clone(), estimate, log_weight));
            }
        }
        let logs: Vec<f64> = parts.iter().map(|part| part.2).collect();
        for (part, share) in parts.iter_mut().zip(shares(&logs)) {
            part.2 = share;
        }
        (!parts.is_empty()).then_some(Self { evidence, parts })
    }

    /// Probability of a term, and its value in the models that have it.
    fn of_term(&self, index: usize) -> (f64, Estimated) {
        let (mut total, mut first, mut second) = (0.0, 0.0, 0.0);
        for (terms, estimate, weight) in &self.parts {
            if let Some(place) = terms.iter().position(|term| *term == index) {
                let mean = estimate.means[place];
                total += weight;
                first += weight * mean;
                second += weight * (mean * mean + estimate.covariance[(place, place)]);
            }
        }
        let mean = first / total;
        let deviation = (second / total - mean * mean).max(0.0).sqrt();
        (total, Estimated { mean, deviation })
    }

    /// Pairs of open terms, of which at least one is present.
    fn confounded(&self, open: &[usize]) -> impl Iterator<Item = (usize, usize)> {
        let pairs = open.iter().enumerate().flat_map(|(place, left)| {
            let later = open[place + 1..].iter();
            later.map(move |right| (*left, *right))
        });
        pairs.filter(|(left, right)| {
            let any = self
                .parts
                .iter()
                .filter(|(terms, ..)| terms.contains(left) || terms.contains(right));
            any.map(|(.., weight)| weight).sum::<f64>() >= CERTAIN
        })
    }

    /// Covariance of the coefficients, with that between models and shapes.
    fn covariance(&self) -> [[f64; 3]; 3] {
        let means = [0, 1, 2].map(|power| self.of_term(power).1.mean);
        let mut covariance = [[0.0; 3]; 3];
        for (_, estimate, weight) in &self.parts {
            for (i, row) in covariance.iter_mut().enumerate() {
                for (j, value) in row.iter_mut().enumerate() {
                    let between = (estimate.means[i] - means[i]) * (estimate.means[j] - means[j]);
                    *value += weight * (estimate.covariance[(i, j)] + between);
                }
            }
        }
        covariance
    }

    /// The most probable shape, and the mean variation.
    fn variation(&self) -> Option<(Shape, f64)> {
        let most = self
            .parts
            .iter()
            .max_by(|left, right| left.2.total_cmp(&right.2))?;
        let variation = self
            .parts
            .iter()
            .map(|(_, estimate, weight)| weight * estimate.variation);
        Some((most.1.shape, variation.sum()))
    }
}
