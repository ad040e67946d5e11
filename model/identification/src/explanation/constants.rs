//! Search with the declared constants and, if the data are evidence against those, with free constants.

use std::collections::BTreeMap;

use crate::constants::fitted::{CurvePoint, FittedConstant};
use crate::constants::free::FreeConstants;
use crate::constants::tolerances::Tolerances;
use crate::data::problem::Problem;
use crate::estimate::Estimate;
use crate::estimation::fit::{Fit, fit, refine};
use crate::explanation::suspected_constants::suspected;
use crate::search::candidates::Progress;
use crate::search::options::{Accuracy, Options};
use crate::search::subset::{Found, Search};
use crate::selection::constants_evidence::{Comparison, covariance};

/// Rounds of the search with the declared constants before the constants are suspected.
const FIRST_ROUNDS: usize = 2;

/// Most searches with free constants, each with another prior.
const SEARCHES: usize = 3;

/// Constants that differ from the declared ones.
#[derive(Debug, Clone)]
pub struct CorrectedConstants {
    /// The model with fitted constants and without further effects: the start of the steps.
    pub fit: Fit,
    /// The constants outside the flow curves, in the model with all effects.
    pub constants: Vec<FittedConstant>,
    /// The points of the flow curves in that model.
    pub curves: Vec<CurvePoint>,
}

impl CorrectedConstants {
    /// From the fit of the constants alone and that of the model with all effects. `None` if the constants are not
    /// free.
    pub(crate) fn new(problem: Problem<'_>, fit: Fit, after: &Fit) -> Option<Self> {
        let covariance = covariance(problem, after)?;
        let free = after.estimate.constants.as_ref()?;
        let (model, errors) = (free.corrected(Vec::new()), free.errors_of_unknowns());
        let (constants, curves) = free.fitted(&model, errors, &free.posterior(&covariance));
        Some(Self {
            fit,
            constants,
            curves,
        })
    }
}

/// The more probable of the two searches.
pub(crate) struct Searched {
    /// Its result.
    pub found: Found,
    /// The fit of the constants alone, if its constants are free.
    pub corrected: Option<Fit>,
    /// Probability of the other search, and those of the effects in it; `None` if there was none.
    other: Option<(f64, BTreeMap<&'static str, f64>)>,
}

impl Searched {
    /// The search with the declared constants only.
    pub fn declared(found: Found) -> Self {
        Self {
            found,
            corrected: None,
            other: None,
        }
    }

    /// Probability of an effect whose probability in the more probable search is `own`.
    pub fn averaged(&self, id: &str, own: f64) -> f64 {
        self.other.as_ref().map_or(own, |(weight, others)| {
            let other = others.get(id).copied().unwrap_or(0.0);
            own + weight * (other - own)
        })
    }
}

/// Searches from a fit of the model alone.
///
/// Constants that are off need many effects in their place, and the search for those is long. If the data are evidence
/// against the declared constants after the first rounds, the search with free constants comes first. The other one then
/// continues until it is stable, or its effects alone cost more than all that free constants need.
pub(crate) fn search_with_constants(
    problem: Problem<'_>,
    before: &Fit,
    options: Options<'_>,
    progress: Progress,
) -> Searched {
    let search = |start: Estimate| {
        let alone = Estimate {
            constants: start.constants.clone(),
            ..before.estimate.clone()
        };
        let corrected = fit(problem, alone);
        let mut free = Search::new(problem, &corrected, options, progress);
        free.consider(refine(problem, start));
        while free.advance(options.limit) {}
        (corrected, free)
    };
    if options.constants == Accuracy::DataSheet {
        progress("the constants of the model");
        let usual = Tolerances::default();
        let tolerances = options.tolerances.unwrap_or(&usual);
        let (corrected, free) = search(Estimate {
            constants: Some(FreeConstants::with(problem.model, tolerances)),
            ..before.estimate.clone()
        });
        return Searched {
            found: free.found(),
            corrected: Some(corrected),
            other: None,
        };
    }
    let mut declared = Search::new(problem, before, options, progress);
    let half = options.limit.after(0.5);
    let mut goes_on = true;
    for _ in 0..FIRST_ROUNDS {
        goes_on = goes_on && declared.advance(half);
    }
    let suspected = |search: &Search| {
        let fewer = search.slightly_worse_with_fewer();
        if problem.experiment.is_beside_baseline() || options.is_over() {
            None
        } else {
            suspected(problem, search.present(), &fewer)
        }
    };
    let mut found = suspected(&declared);
    if found.is_none() && !declared.is_stable() {
        while declared.advance(options.limit) {}
        found = suspected(&declared);
    }
    let Some(found) = found else {
        return Searched::declared(declared.found());
    };
    progress("the constants of the model");
    let (mut corrected, mut free) = search(found);
    for _ in 1..SEARCHES {
        match suspected(&free) {
            Some(better) => (corrected, free) = search(better),
            None => break,
        }
    }
    let mut free = free.found();
    while !options.is_over() && free.moves_to_fewer(problem, free.without_each(problem)) {}
    let comparison = Comparison::new(problem, &free.fit);
    while comparison.is_open(declared.present()) && declared.advance(options.limit) {}
    let off = comparison.probability_off(declared.present());
    let declared = declared.found();
    if off > 0.5 {
        Searched {
            found: free,
            corrected: Some(corrected),
            other: Some((1.0 - off, declared.probabilities(problem))),
        }
    } else {
        Searched {
            found: declared,
            corrected: None,
            other: Some((off, free.probabilities(problem))),
        }
    }
}
