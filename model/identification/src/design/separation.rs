//! Expected likelihood ratio of a manoeuvre between two rival effects, before it is measured.
//!
//! The manoeuvre is simulated with one rival as the truth; the model with the other is then compared with that log
//! under the weights of a measured one. The other's parameters, the loads and the clocks are refitted, with the
//! campaign's normal matrix as the prior (T-optimality with refit, Atkinson & Fedorov 1975, to first order). The
//! remaining cost, in units of the residual variance and of its inflation by slow noise in the campaign, is the
//! expected likelihood ratio. Either rival may be the true one; the smaller ratio counts.

use hitch_campaign::{Campaign, Noise};
use hitch_plant::simulation::simulate;
use hitch_plant::{Effect, Model};
use nalgebra::DMatrix;

use crate::data::experiment::Experiment;
use crate::data::nuisance::Nuisance;
use crate::data::problem::Problem;
use crate::data::ready_run::ReadyRun;
use crate::design::plan::Manoeuvre;
use crate::estimate::{Estimate, Shared};
use crate::estimation::fit::Fit;
use crate::estimation::jacobian::Jacobian;
use crate::estimation::residual_columns::{square_sum, subtract};
use crate::residuals::whitening::Weights;
use crate::selection::evidence::{expected_inflation, persistence};

/// An effect, and the fit of the campaign that contains it.
#[derive(Debug, Clone, Copy)]
pub struct Rival<'a> {
    /// The effect.
    pub effect: &'static dyn Effect,
    /// The campaign's fit with it.
    pub fit: &'a Fit,
}

/// Two confounded effects.
#[derive(Debug, Clone, Copy)]
pub struct Pair<'a> {
    /// The named one.
    pub named: Rival<'a>,
    /// The confounded alternative.
    pub other: Rival<'a>,
}

impl<'a> Pair<'a> {
    /// Both rivals.
    #[must_use]
    pub fn rivals(&self) -> [Rival<'a>; 2] {
        [self.named, self.other]
    }
}

/// The campaign's instruments and noise, for the evaluation of manoeuvres.
pub struct TestBench<'a> {
    /// The measured data and the model.
    problem: Problem<'a>,
    rate_hz: f64,
    /// Mean square of the residuals of the named model, at least one.
    variance: f64,
    /// Autocorrelation of the residuals of the named model, by channel.
    persistence: [Vec<f64>; 4],
}

/// A pair with the campaign's information on the parameters of both.
pub struct PairPrior<'a> {
    pair: Pair<'a>,
    normals: [Normal; 2],
}

/// Normal matrix of a fit, with the parameters of its rows.
struct Normal {
    shared: Vec<Shared>,
    matrix: DMatrix<f64>,
}

impl<'a> TestBench<'a> {
    /// The test bench of a campaign whose best fit is `fit`.
    #[must_use]
    pub fn new(problem: Problem<'a>, fit: &Fit) -> Self {
        let experiment = problem.experiment;
        let compared = fit.weights.count().max(1) as f64;
        Self {
            problem,
            rate_hz: rate_hz(experiment),
            variance: (square_sum(&fit.residuals) / compared).max(1.0),
            persistence: persistence(experiment, &fit.residuals),
        }
    }

    /// A pair with the campaign's information on the parameters of both.
    #[must_use]
    pub fn known(&self, pair: Pair<'a>) -> PairPrior<'a> {
        let normals = pair.rivals().map(|rival| {
            let fit = rival.fit;
            let jacobian = Jacobian::new(self.problem, &fit.weights, &fit.estimate);
            Normal {
                matrix: jacobian.reduced(&fit.estimate).0,
                shared: jacobian.shared,
            }
        });
        PairPrior { pair, normals }
    }

    /// Expected likelihood ratio of a manoeuvre for each pair: the smaller one of either rival being true.
    #[must_use]
    pub fn likelihood_ratios(&self, manoeuvre: &Manoeuvre, pairs: &[PairPrior]) -> Vec<f64> {
        pairs
            .iter()
            .map(|known| {
                let [named, other] = known.pair.rivals();
                let [of_named, of_other] = &known.normals;
                let forth = self.likelihood_ratio(manoeuvre, named, other, of_other);
                let back = self.likelihood_ratio(manoeuvre, other, named, of_named);
                forth.min(back)
            })
            .collect()
    }

    /// The model with a rival's effects.
    #[must_use]
    pub fn with(&self, rival: Rival) -> Model {
        rival.fit.estimate.applied_to(self.problem.model)
    }

    /// The sample rate, Hz.
    #[must_use]
    pub fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    /// Whether the campaign measures each channel, by `Channel::index`.
    #[must_use]
    pub fn channels(&self) -> [bool; 4] {
        self.problem.experiment.noise.map(f64::is_finite)
    }

    /// Expected likelihood ratio against `wrong` if `truth` is true, after refitting `wrong`.
    fn likelihood_ratio(
        &self,
        manoeuvre: &Manoeuvre,
        truth: Rival,
        wrong: Rival,
        normal: &Normal,
    ) -> f64 {
        let logged = self.measured(manoeuvre, truth);
        let estimate = |rival: Rival| Estimate::new(&logged, rival.fit.estimate.effects.clone());
        let problem = self.problem.on(&logged);
        let weights = Weights::new(problem, &estimate(truth));
        let wrong = estimate(wrong);
        let jacobian = Jacobian::new(problem, &weights, &wrong);
        let Some((cost, left)) = adapted(&jacobian, &wrong, normal) else {
            return 0.0;
        };
        cost / (self.variance * expected_inflation(&logged, &self.persistence, &left))
    }

    /// Noise-free log of a manoeuvre by the campaign's instruments with a rival as the truth, with the campaign's noise
    /// declared.
    fn measured(&self, manoeuvre: &Manoeuvre, truth: Rival) -> Experiment {
        let noise = self.problem.experiment.noise;
        let sigma = self.problem.experiment.current_noise;
        let campaign = Campaign {
            name: manoeuvre.name.to_owned(),
            description: String::new(),
            sample_rate_hz: self.rate_hz,
            synchronous: self.problem.experiment.clocks_within_s == 0.0,
            noise: Noise {
                lift_current_a: Some(sigma.lift_a),
                lower_current_a: Some(sigma.lower_a),
                channels: noise.map(|sigma| sigma.is_finite().then_some(sigma)),
                oil_temperature_c: None,
            },
            runs: manoeuvre.log(&self.with(truth), self.rate_hz, self.channels()),
        };
        let mut logged = Experiment {
            current_persistence: self.problem.experiment.current_persistence,
            ..Experiment::new(&campaign, self.problem.model)
        };
        let truth = self.with(truth);
        for run in &mut logged.runs {
            with_conditioned_currents(run, &truth);
        }
        logged
    }
}

/// Replaces the measured channels of a run by a simulation of `truth` under the conditioned currents: conditioning
/// rounds corners by less than the noise of the currents, which must not count as a difference between rivals.
fn with_conditioned_currents(run: &mut ReadyRun, truth: &Model) {
    let (rig, drive) = (run.rig(Nuisance::default()), &run.drive);
    let trace = simulate(
        truth,
        rig,
        run.oil_temperature_c,
        &drive.time_s,
        &drive.currents,
    );
    for (measured, simulated) in run.measured.iter_mut().zip(trace.channels) {
        if let Some(measured) = measured {
            *measured = simulated;
        }
    }
}

/// Cost and residuals after refitting to first order: the effects' parameters and the clocks with the campaign's normal
/// matrix as the prior, each run's load with its own prior. `None` if the system is singular.
fn adapted(
    jacobian: &Jacobian,
    estimate: &Estimate,
    normal: &Normal,
) -> Option<(f64, Vec<Vec<f64>>)> {
    let (matrix, right) = jacobian.reduced(estimate);
    let known = normal.of(&jacobian.shared);
    let mut whole = matrix + &known;
    for k in 0..whole.nrows() {
        whole[(k, k)] += 1e-9;
    }
    let step = whole.cholesky()?.solve(&right);
    let mut cost = step.dot(&(known * &step));
    let left: Vec<Vec<f64>> = jacobian
        .runs
        .iter()
        .map(|run| {
            let mut left = run.residual.clone();
            for (column, &share) in run.shared.iter().zip(step.iter()) {
                subtract(&mut left, share, column);
            }
            if let Some((load, square, pull)) = run.load_pull(&left) {
                let share = pull / square;
                cost += share * share;
                subtract(&mut left, share, load);
            }
            left
        })
        .collect();
    cost += square_sum(&left);
    Some((cost, left))
}

impl Normal {
    /// The matrix in another order of the parameters; zero for a parameter that it does not contain.
    fn of(&self, shared: &[Shared]) -> DMatrix<f64> {
        let places: Vec<Option<usize>> = shared
            .iter()
            .map(|wanted| self.shared.iter().position(|has| has == wanted))
            .collect();
        DMatrix::from_fn(shared.len(), shared.len(), |row, column| {
            match (places[row], places[column]) {
                (Some(row), Some(column)) => self.matrix[(row, column)],
                _ => 0.0,
            }
        })
    }
}

/// Sample rate of a campaign, Hz: that of its first run.
fn rate_hz(experiment: &Experiment) -> f64 {
    const USUAL_HZ: f64 = 50.0;
    /// Range of the sample rates of loggers, Hz; a log may claim others.
    const LOGGERS_HZ: (f64, f64) = (1.0, 1000.0);
    let time_s = experiment.runs.first().map(|run| &run.drive.time_s);
    time_s
        .and_then(|time_s| Some((time_s.len(), time_s.first()?, time_s.last()?)))
        .filter(|(_, first, last)| last > first)
        .map_or(USUAL_HZ, |(samples, first, last)| {
            ((samples - 1) as f64 / (last - first)).clamp(LOGGERS_HZ.0, LOGGERS_HZ.1)
        })
}
