//! Selection of the manoeuvre with the largest expected likelihood ratio per minute of rig time.

use std::cmp::Ordering;
use std::fmt;
use std::sync::OnceLock;

use hitch_plant::{Effect, Model};

use crate::data::problem::Problem;
use crate::design::feasibility::{is_liftable, is_within_proof};
use crate::design::levels::Levels;
use crate::design::manoeuvre::TEMPLATES;
use crate::design::plan::Manoeuvre;
use crate::design::proposal::{Expecting, Proposal};
use crate::design::sensor::additional_instrument;
use crate::design::separation::{Pair, PairPrior, Rival, TestBench};
use crate::parallel;
use crate::selection::evidence::DISTINGUISHABLE;

/// Expected likelihood ratio that is decisive: a measured one has a standard deviation of twice its square root, and
/// with this expectation exceeds [`DISTINGUISHABLE`] in 19 of 20 measurements.
const DECISIVE: f64 = 26.0;

/// The next experiment.
#[derive(Debug, Clone)]
pub struct NextExperiment {
    /// The instruction, a sentence without its full stop.
    pub manoeuvre: String,
    /// The reason, a sentence without its full stop; empty if the instruction is sufficient.
    pub why: String,
    /// The pairs of effects that it would distinguish.
    pub separates: Vec<(&'static dyn Effect, &'static dyn Effect)>,
    /// Smallest expected likelihood ratio of these pairs; a measured one has a standard deviation of twice its square
    /// root. If no manoeuvre separates any pair, the largest one of all manoeuvres; NaN if nothing was simulated.
    pub expected_likelihood_ratio: f64,
    /// Rig time, minutes, with set-up; NaN if no manoeuvre is proposed.
    pub minutes: f64,
    /// The manoeuvre in full; `None` if no listed one is proposed.
    pub proposal: Option<Proposal>,
}

impl fmt::Display for NextExperiment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.manoeuvre)?;
        if !self.why.is_empty() {
            write!(f, ": {}", self.why)?;
        }
        Ok(())
    }
}

impl NextExperiment {
    /// A manoeuvre that the campaign lacks, without which nothing can be simulated.
    #[must_use]
    pub fn missing(what: &str) -> Self {
        Self {
            manoeuvre: what.to_owned(),
            why: String::new(),
            separates: Vec::new(),
            expected_likelihood_ratio: f64::NAN,
            minutes: f64::NAN,
            proposal: None,
        }
    }

    /// A manoeuvre for a reason other than the separation of effects.
    #[must_use]
    pub fn exploring(proposal: Proposal, why: &str) -> Self {
        let manoeuvre = &proposal.manoeuvre;
        Self {
            manoeuvre: manoeuvre.instruction.clone(),
            why: format!("{why} (about {} minutes)", rounded(manoeuvre.minutes())),
            separates: Vec::new(),
            expected_likelihood_ratio: f64::NAN,
            minutes: manoeuvre.minutes(),
            proposal: Some(proposal),
        }
    }

    fn of(
        bench: &TestBench,
        manoeuvre: &Manoeuvre,
        judged: &Judged,
        pairs: &[Pair],
        bar: f64,
        instrument: Option<&str>,
    ) -> Self {
        let distinguished = |above: bool| {
            let ratios = pairs.iter().zip(&judged.likelihood_ratios);
            let chosen = ratios.filter(move |(_, ratio)| (**ratio >= bar) == above);
            chosen.map(|(pair, _)| (pair.named.effect, pair.other.effect))
        };
        let (ratio, minutes) = (judged.smallest(bar), manoeuvre.minutes());
        let left = distinct(distinguished(false).map(|(a, b)| either(a, b)));
        let mut why = format!(
            "it would distinguish {} (expected likelihood ratio {}, about {} minutes)",
            distinct(distinguished(true).map(|(a, b)| both(a, b))).join(", and "),
            rounded(ratio),
            rounded(minutes),
        );
        if !left.is_empty() {
            why += &format!("; it would still leave open {}", left.join(" and "));
        }
        if let Some(name) = instrument {
            why += &format!("; that is little, {name} would show more");
        }
        Self {
            manoeuvre: manoeuvre.instruction.clone(),
            why,
            separates: distinguished(true).collect(),
            expected_likelihood_ratio: ratio,
            minutes,
            proposal: judged
                .first(bar)
                .map(|index| between(bench, manoeuvre, pairs[index])),
        }
    }

    fn none(best: f64, pairs: &[Pair], instrument: Option<&str>) -> Self {
        let named = pairs.iter();
        let named = distinct(named.map(|pair| both(pair.named.effect, pair.other.effect)));
        let instead = instrument.map_or_else(
            || "and in every quantity of the plant, so that either name will do".to_owned(),
            |name| format!("an additional sensor is needed: {name}"),
        );
        Self {
            manoeuvre: format!(
                "none of the listed manoeuvres would distinguish {}",
                named.join(", or ")
            ),
            why: format!("they act alike on every channel that is measured; {instead}"),
            separates: Vec::new(),
            expected_likelihood_ratio: best,
            minutes: f64::NAN,
            proposal: None,
        }
    }
}

/// The expected likelihood ratios of a manoeuvre, one per pair.
struct Judged {
    likelihood_ratios: Vec<f64>,
}

impl Judged {
    fn distinguished(&self, bar: f64) -> impl Iterator<Item = f64> {
        let ratios = self.likelihood_ratios.iter().copied();
        ratios.filter(move |ratio| *ratio >= bar)
    }

    /// Index of the first pair that is distinguished.
    fn first(&self, bar: f64) -> Option<usize> {
        let mut ratios = self.likelihood_ratios.iter();
        ratios.position(|ratio| *ratio >= bar)
    }

    /// Smallest ratio of the pairs that are distinguished.
    fn smallest(&self, bar: f64) -> f64 {
        self.distinguished(bar).fold(f64::INFINITY, f64::min)
    }

    fn largest(&self) -> f64 {
        self.distinguished(0.0).fold(0.0, f64::max)
    }
}

/// The manoeuvre that distinguishes the most pairs, and of these the one with the largest value of smallest likelihood
/// ratio per minute. Only manoeuvres that the machine can carry out are proposed. If none distinguishes any pair, the
/// result names an additional sensor instead. `None` without pairs.
#[must_use]
pub fn next_experiment(problem: Problem<'_>, pairs: &[Pair]) -> Option<NextExperiment> {
    let bench = TestBench::new(problem, pairs.first()?.named.fit);
    let known: Vec<PairPrior> = pairs.iter().map(|pair| bench.known(*pair)).collect();
    let listed = Listed::new(problem, bench.with(pairs[0].named), bench.rate_hz());
    let judged = parallel::map(&listed.manoeuvres, |manoeuvre| Judged {
        likelihood_ratios: bench.likelihood_ratios(manoeuvre, &known),
    });
    let largest = listed.first_possible(|a, b| judged[a].largest().total_cmp(&judged[b].largest()));
    let best = largest.map_or(0.0, |index| judged[index].largest());
    let instrument = (best < DECISIVE)
        .then(|| additional_instrument(&bench, &listed.all_possible(), pairs[0]))
        .flatten();
    if best < DISTINGUISHABLE {
        return Some(NextExperiment::none(best, pairs, instrument));
    }
    let bar = if best >= DECISIVE {
        DECISIVE
    } else {
        DISTINGUISHABLE
    };
    let merit = |index: usize| {
        let (judged, minutes) = (&judged[index], listed.manoeuvres[index].minutes());
        (
            judged.distinguished(bar).count(),
            judged.smallest(bar) / minutes,
        )
    };
    let chosen = listed.first_possible(|a, b| {
        let ((a_count, a_rate), (b_count, b_rate)) = (merit(a), merit(b));
        a_count.cmp(&b_count).then(a_rate.total_cmp(&b_rate))
    });
    // The one with the largest ratio distinguishes a pair, so that the one of most merit does.
    chosen.map(|index| {
        let (manoeuvre, judged) = (&listed.manoeuvres[index], &judged[index]);
        NextExperiment::of(&bench, manoeuvre, judged, pairs, bar, instrument)
    })
}

/// A manoeuvre with what the rivals of a pair expect of it.
fn between(bench: &TestBench, manoeuvre: &Manoeuvre, pair: Pair) -> Proposal {
    let expecting = |rival: Rival| Expecting {
        title: rival.effect.title().to_owned(),
        model: bench.with(rival),
    };
    Proposal {
        manoeuvre: manoeuvre.clone(),
        models: pair.rivals().map(expecting).into(),
        channels: bench.channels(),
    }
}

/// The listed manoeuvres with loads that the machine can lift. Their pressures are simulated only for those that are
/// chosen.
struct Listed {
    levels: Levels,
    manoeuvres: Vec<Manoeuvre>,
    /// The best model of the machine.
    machine: Model,
    rate_hz: f64,
    /// Whether the machine can carry out each manoeuvre.
    possible: Vec<OnceLock<bool>>,
}

impl Listed {
    fn new(problem: Problem<'_>, machine: Model, rate_hz: f64) -> Self {
        let levels = Levels::new(problem.experiment, problem.model);
        let manoeuvres = TEMPLATES.iter().map(|template| template.on(&levels));
        let manoeuvres: Vec<Manoeuvre> = manoeuvres
            .filter(|manoeuvre| is_liftable(manoeuvre, &levels))
            .collect();
        Self {
            possible: manoeuvres.iter().map(|_| OnceLock::new()).collect(),
            levels,
            manoeuvres,
            machine,
            rate_hz,
        }
    }

    fn is_possible(&self, index: usize) -> bool {
        let manoeuvre = &self.manoeuvres[index];
        *self.possible[index]
            .get_or_init(|| is_within_proof(manoeuvre, &self.levels, &self.machine, self.rate_hz))
    }

    /// The greatest manoeuvre by an order that the machine can carry out; of equal ones the last.
    fn first_possible(&self, order: impl Fn(usize, usize) -> Ordering) -> Option<usize> {
        let mut indices: Vec<usize> = (0..self.manoeuvres.len()).rev().collect();
        indices.sort_by(|&a, &b| order(b, a));
        indices.into_iter().find(|&index| self.is_possible(index))
    }

    fn all_possible(&self) -> Vec<Manoeuvre> {
        let possible = parallel::map(0..self.manoeuvres.len(), |index| self.is_possible(index));
        let manoeuvres = self.manoeuvres.iter().zip(possible);
        let kept = manoeuvres.filter(|(_, is_possible)| *is_possible);
        kept.map(|(manoeuvre, _)| manoeuvre.clone()).collect()
    }
}

/// Texts without duplicates: two forms of an effect have the same name.
fn distinct(texts: impl Iterator<Item = String>) -> Vec<String> {
    let mut distinct: Vec<String> = Vec::new();
    for text in texts {
        if !distinct.contains(&text) {
            distinct.push(text);
        }
    }
    distinct
}

fn both(a: &dyn Effect, b: &dyn Effect) -> String {
    format!("{} and {}", a.id(), b.id())
}

fn either(a: &dyn Effect, b: &dyn Effect) -> String {
    format!("{} or {}", a.id(), b.id())
}

/// A number rounded to two digits, the precision of an expectation.
fn rounded(value: f64) -> String {
    if value < 10.0 {
        return format!("{value:.1}");
    }
    let unit = 10_f64.powf(value.log10().floor() - 1.0);
    format!("{:.0}", (value / unit).round() * unit)
}

#[cfg(test)]
mod tests {
    use super::rounded;

    #[test]
    fn expectations_have_two_digits() {
        assert_eq!(rounded(6.42), "6.4");
        assert_eq!(rounded(26.4), "26");
        assert_eq!(rounded(12_345.0), "12000");
    }
}
