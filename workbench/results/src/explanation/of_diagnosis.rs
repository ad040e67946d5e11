//! Converts the identification's diagnosis into its display form.

use std::cmp::Ordering;

use hitch_identification::adequacy::attribution::attribute;
use hitch_identification::adequacy::lack_of_fit::{adequate, cells};
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::design::exploration::exploring;
use hitch_identification::design::{NextExperiment, Pair, Rival, next_experiment};
use hitch_identification::estimation::fit::Fit;
use hitch_identification::explanation::diagnosis;
use hitch_identification::explanation::explain::{Verdict, missing_manoeuvre};
use hitch_identification::selection::candidate;
use hitch_identification::selection::evidence::{DISTINGUISHABLE, SIGNIFICANT};
use hitch_plant::Model;

use super::of_explanation::parameters;
use super::{Candidate, Diagnosis, Head};

impl Diagnosis {
    /// The display form of a diagnosis.
    pub fn new(experiment: &Experiment, model: &Model, found: &diagnosis::Diagnosis) -> Self {
        let believed = found
            .candidates
            .first()
            .filter(|best| best.likelihood_ratio >= SIGNIFICANT);
        let after = believed.map_or(&found.base, |best| &best.fit);
        let candidates = found.candidates.iter().zip(&found.confidences);
        let mut candidates: Vec<Candidate> = candidates
            .map(|(candidate, share)| shown(found, candidate, *share))
            .collect();
        // Head and verdict refer to the accepted candidate.
        let settled = usize::from(believed.is_some());
        candidates[settled..].sort_by(as_shown);
        let verdict = verdict(experiment, found, believed);
        Self {
            head: Head::new((experiment, model), [&found.base, after], verdict),
            candidates,
            constants_off: found.constants_off,
            next: next(Problem::new(experiment, model), found, believed, verdict).into(),
        }
    }
}

/// Order of display: by confidence, then by remaining error.
fn as_shown(a: &Candidate, b: &Candidate) -> Ordering {
    /// Confidence below which a candidate is displayed as 0 %.
    const SHOWN: f64 = 0.005;
    let confidence = |candidate: &Candidate| match candidate.confidence {
        confidence if confidence >= SHOWN => confidence,
        _ => 0.0,
    };
    let by_error = a.error_after.total_cmp(&b.error_after);
    confidence(b).total_cmp(&confidence(a)).then(by_error)
}

/// Result with one more effect.
fn verdict(
    experiment: &Experiment,
    found: &diagnosis::Diagnosis,
    believed: Option<&candidate::Candidate>,
) -> Verdict {
    let fit = believed.map_or(&found.base, |best| &best.fit);
    let cells = cells(experiment, fit);
    if fit.weights.count() == 0 || cells.is_empty() {
        return Verdict::NotEnoughData;
    }
    match (adequate(experiment, &cells, fit), believed) {
        (false, _) => Verdict::Unexplained,
        (true, None) => Verdict::NothingMissing,
        (true, Some(best)) if twins(found, best).is_empty() => Verdict::Explained,
        (true, Some(_)) => Verdict::Ambiguous,
    }
}

/// The next experiment, unless the model is adequate with at most one effect.
fn next(
    problem: Problem<'_>,
    found: &diagnosis::Diagnosis,
    believed: Option<&candidate::Candidate>,
    verdict: Verdict,
) -> Option<NextExperiment> {
    let fit = believed.map_or(&found.base, |best| &best.fit);
    match verdict {
        Verdict::NothingMissing | Verdict::Explained => None,
        Verdict::Ambiguous => separating(problem, found, believed?),
        Verdict::NotEnoughData => {
            let missing = missing_manoeuvre(problem.experiment, fit);
            Some(missing.map_or_else(|| exploring(problem, fit, &[]), NextExperiment::missing))
        }
        Verdict::Unexplained => {
            let rest = attribute(problem.experiment, &found.base, fit);
            Some(exploring(problem, fit, &rest.depends_on))
        }
    }
}

/// The experiment that separates the best candidate from the next best of those that fit equally well.
fn separating(
    problem: Problem<'_>,
    found: &diagnosis::Diagnosis,
    best: &candidate::Candidate,
) -> Option<NextExperiment> {
    let twin = *twins(found, best).first()?;
    let [named, other] = [best, twin].map(|candidate| Rival {
        effect: candidate.effect,
        fit: &candidate.fit,
    });
    let pair = Pair { named, other };
    next_experiment(problem, &[pair])
}

fn shown(
    found: &diagnosis::Diagnosis,
    candidate: &candidate::Candidate,
    confidence: f64,
) -> Candidate {
    Candidate {
        effect: candidate.effect.id(),
        form: candidate.effect.form(),
        explains: explained(&found.base, &candidate.fit),
        error_after: candidate.fit.error(),
        confidence,
        indistinguishable: twins(found, candidate)
            .iter()
            .map(|twin| twin.effect.id())
            .collect(),
        detectability: candidate.detectability,
        parameters: parameters(candidate.effect, candidate.values(), &candidate.intervals),
    }
}

/// Share of the squared error above the noise that a fit explains.
pub fn explained(base: &Fit, with: &Fit) -> f64 {
    let excess = |fit: &Fit| (fit.error().powi(2) - 1.0).max(0.0);
    if excess(base) > 0.0 {
        (1.0 - excess(with) / excess(base)).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// Other effects that fit these data as well as an accepted candidate.
fn twins<'a>(
    found: &'a diagnosis::Diagnosis,
    candidate: &candidate::Candidate,
) -> Vec<&'a candidate::Candidate> {
    if candidate.likelihood_ratio < SIGNIFICANT {
        return Vec::new();
    }
    let unit = (found.base.cost - candidate.fit.cost) / candidate.likelihood_ratio;
    let as_good = |other: &&candidate::Candidate| {
        other.effect.id() != candidate.effect.id()
            && other.likelihood_ratio >= SIGNIFICANT
            && (other.fit.cost - candidate.fit.cost).abs() < DISTINGUISHABLE * unit
    };
    found.candidates.iter().filter(as_good).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_no_confidence_is_sorted_by_what_is_left() {
        let candidate = |effect, confidence, error_after| Candidate {
            effect,
            form: None,
            explains: 0.0,
            error_after,
            confidence,
            indistinguishable: Vec::new(),
            detectability: 0.0,
            parameters: Vec::new(),
        };
        let mut candidates = [
            candidate("spool-stiction", 1e-80, 11.79),
            candidate("solenoid-hysteresis", 1e-90, 11.64),
            candidate("flow-force", 0.2, 12.0),
            candidate("spool-lag", 0.7, 11.9),
        ];
        candidates.sort_by(as_shown);
        let order = candidates.map(|candidate| candidate.effect);
        let wanted = [
            "spool-lag",
            "flow-force",
            "solenoid-hysteresis",
            "spool-stiction",
        ];
        assert_eq!(order, wanted);
    }
}
