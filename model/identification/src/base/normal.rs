//! Residuals of a campaign with corrected constants, their sensitivities, and the normal equations with each run's load
//! error eliminated.
//!
//! The unknowns are the corrections of the constants and then the clock offsets, in prior sigmas. Lags of the machine and
//! offsets of the clocks shift the same channels, so a descent that moved them in turns would hardly advance, and an
//! interval of a lag with the clocks fixed would be too narrow.

use hitch_plant::Model;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::constants::correction::corrected;
use crate::constants::parameter::Parameter;
use crate::constants::prior::Prior;
use crate::data::experiment::Experiment;
use crate::data::nuisance::CurrentShift;
use crate::data::nuisance::{LOAD_PRIOR, Nuisance};
use crate::data::problem::Problem;
use crate::estimate::{CLOCKS, Estimate};
use crate::estimation::residual_columns::{dot, huber, huber_residuals, quotient, square_sum};
use crate::estimation::slow_columns::{STEP_OF_CONSTANTS, offset_columns_of_run};
use crate::residuals::whitening::Weights;

/// The least-squares problem: a campaign and a declared model whose constants are unknown.
pub struct BaseProblem<'a> {
    /// The campaign.
    pub experiment: &'a Experiment,
    /// The declared model with its effects.
    pub declared: &'a Model,
    /// The unknowns.
    pub parameters: &'a [Parameter],
    /// Prior of the unknowns.
    pub prior: &'a Prior,
    /// Whether each unknown is fixed.
    pub held: &'a [bool],
}

/// Values of the unknowns with their cost.
#[derive(Debug, Clone)]
pub struct Point {
    /// Corrections.
    pub theta: DVector<f64>,
    /// Loads and clocks.
    pub estimate: Estimate,
    /// Cost with all priors; infinite if the constants are not valid.
    pub cost: f64,
}

/// Models to either side of a point.
struct Sides {
    down: Model,
    up: Model,
    /// Difference of the unknown between the two.
    apart: f64,
}

/// Sensitivities of one run.
pub struct RunColumns {
    residual: Vec<f64>,
    /// One column per unknown: the constants, then the clocks.
    pub columns: Vec<Vec<f64>>,
    load: Option<Vec<f64>>,
    load_value: f64,
}

/// Normal equations of one run.
struct RunNormal {
    matrix: DMatrix<f64>,
    right: DVector<f64>,
    load: Option<LoadRow>,
}

/// Coupling of a run's load error to the unknowns.
struct LoadRow {
    coupling: DVector<f64>,
    square: f64,
    pull: f64,
}

/// Normal equations of all runs, without the prior of the unknowns.
pub struct Normal {
    matrix: DMatrix<f64>,
    right: DVector<f64>,
    loads: Vec<Option<LoadRow>>,
}

impl BaseProblem<'_> {
    /// The corrected model; `None` if its dimensions form no valid linkage.
    pub fn model(&self, theta: &DVector<f64>) -> Option<Model> {
        corrected(self.declared, self.parameters, theta)
    }

    /// The cost of corrections, loads and clocks.
    pub fn point(&self, weights: &Weights, theta: DVector<f64>, estimate: Estimate) -> Point {
        let Some(model) = self.model(&theta) else {
            return Point {
                theta,
                estimate,
                cost: f64::INFINITY,
            };
        };
        let estimate = with_effects_of(&model, estimate);
        let residuals = huber_residuals(Problem::new(self.experiment, &model), weights, &estimate);
        let cost = square_sum(&residuals) + estimate.prior_cost() + self.prior.cost(&theta);
        Point {
            theta,
            estimate,
            cost,
        }
    }

    /// Precision of the prior of all unknowns, given that of the constants.
    pub fn precision(&self, of_constants: &DMatrix<f64>) -> DMatrix<f64> {
        let (constants, clocks) = (of_constants.nrows(), CLOCKS.len());
        let mut precision = DMatrix::identity(constants + clocks, constants + clocks);
        let mut block = precision.view_mut((0, 0), (constants, constants));
        block.copy_from(of_constants);
        precision
    }

    /// All unknowns at a point, in the order of the columns.
    pub fn unknowns(&self, point: &Point) -> DVector<f64> {
        let clocks = CLOCKS.map(|clock| point.estimate.get(clock) / point.estimate.scale(clock));
        let all = point.theta.iter().copied().chain(clocks);
        DVector::from_iterator(point.theta.len() + CLOCKS.len(), all)
    }

    /// Corrections and estimate at given unknowns, within their ranges.
    pub fn within_ranges(
        &self,
        unknowns: &DVector<f64>,
        estimate: &Estimate,
    ) -> (DVector<f64>, Estimate) {
        let constants = self.parameters.len();
        let theta = self
            .prior
            .bounded(&unknowns.rows(0, constants).into_owned());
        let mut estimate = estimate.clone();
        for (clock, &sigmas) in CLOCKS.into_iter().zip(unknowns.iter().skip(constants)) {
            estimate.set(clock, sigmas * estimate.scale(clock));
        }
        (theta, estimate)
    }

    /// Whether each unknown is fixed.
    pub fn fixed(&self, point: &Point) -> Vec<bool> {
        let clocks = CLOCKS.map(|clock| point.estimate.range(clock) == (0.0, 0.0));
        self.held.iter().copied().chain(clocks).collect()
    }

    /// Whether an unknown is at an end of its range.
    pub fn is_at_an_end(&self, point: &Point, unknown: usize) -> bool {
        match unknown.checked_sub(self.parameters.len()) {
            None => self.prior.is_at_an_end(&point.theta, unknown),
            Some(clock) => point.estimate.is_at_an_end(CLOCKS[clock]),
        }
    }

    /// Models a step down and up in each unknown; `None` if it is fixed or one of the models is not valid. Quotients are
    /// central: some directions are hardly determined (cracking pressure against flow), and the curvature error of a
    /// one-sided quotient would appear to determine them.
    fn moved(&self, theta: &DVector<f64>) -> Vec<Option<Sides>> {
        (0..theta.len())
            .into_par_iter()
            .map(|unknown| {
                if self.held[unknown] {
                    return None;
                }
                let step = STEP_OF_CONSTANTS * self.prior.sigma[unknown];
                let side = |step: f64| {
                    let mut moved = theta.clone();
                    moved[unknown] += step;
                    self.model(&moved)
                };
                Some(Sides {
                    down: side(-step)?,
                    up: side(step)?,
                    apart: 2.0 * step,
                })
            })
            .collect()
    }

    /// Sensitivities of all runs at a point; `None` if its model is not valid.
    pub fn columns(&self, weights: &Weights, point: &Point) -> Option<Vec<RunColumns>> {
        let model = self.model(&point.theta)?;
        let moved = self.moved(&point.theta);
        let runs = (0..self.experiment.runs.len()).into_par_iter();
        Some(
            runs.map(|run| self.run_columns(weights, point, run, &model, &moved))
                .collect(),
        )
    }

    fn run_columns(
        &self,
        weights: &Weights,
        point: &Point,
        index: usize,
        model: &Model,
        moved: &[Option<Sides>],
    ) -> RunColumns {
        let run = &self.experiment.runs[index];
        let estimate = &point.estimate;
        let residual = |model: &Model, nuisance: Nuisance| {
            let trace = run.simulate(model, nuisance, &estimate.clocks);
            huber(vec![weights.runs[index].whiten(run, &trace)]).swap_remove(0)
        };
        let nuisance = estimate.nuisances[index];
        let here = residual(model, nuisance);
        let mut columns: Vec<Vec<f64>> = moved
            .par_iter()
            .map(|moved| match moved {
                Some(Sides { down, up, apart }) => {
                    quotient(&residual(down, nuisance), residual(up, nuisance), *apart)
                }
                None => vec![0.0; here.len()],
            })
            .collect();
        let plain = run.trace(model, nuisance, CurrentShift::default());
        let clocks = estimate.clocks;
        columns.extend(offset_columns_of_run(
            self.experiment,
            index,
            weights,
            &plain,
            clocks,
        ));
        let load = run.on_hitch().then(|| {
            let [down, up] = [-0.5, 0.5].map(|sigmas| {
                let load = nuisance.load + sigmas * LOAD_PRIOR;
                residual(model, Nuisance { load })
            });
            quotient(&down, up, 1.0)
        });
        RunColumns {
            columns,
            load,
            load_value: estimate.load(index),
            residual: here,
        }
    }
}

/// An estimate of loads and clocks with the effects of a model, held in a fit.
pub fn with_effects_of(model: &Model, estimate: Estimate) -> Estimate {
    let effects = model.effects.clone();
    Estimate {
        effects,
        ..estimate
    }
    .with_adopted()
}

impl RunColumns {
    fn normal(&self) -> RunNormal {
        let size = self.columns.len();
        let mut matrix = DMatrix::zeros(size, size);
        for i in 0..size {
            for j in 0..=i {
                let value = dot(&self.columns[i], &self.columns[j]);
                matrix[(i, j)] = value;
                matrix[(j, i)] = value;
            }
        }
        let pulls = self.columns.iter().map(|c| dot(c, &self.residual));
        let right = DVector::from_iterator(size, pulls);
        let load = self.load.as_ref().map(|load| LoadRow {
            coupling: DVector::from_iterator(size, self.columns.iter().map(|c| dot(c, load))),
            square: dot(load, load) + 1.0,
            pull: dot(load, &self.residual) - self.load_value,
        });
        RunNormal {
            matrix,
            right,
            load,
        }
    }
}

impl Normal {
    /// The normal equations of all runs.
    pub fn of(runs: &[RunColumns]) -> Self {
        let size = runs.first().map_or(0, |run| run.columns.len());
        let mut normal = Self {
            matrix: DMatrix::zeros(size, size),
            right: DVector::zeros(size),
            loads: Vec::new(),
        };
        let parts: Vec<RunNormal> = runs.par_iter().map(RunColumns::normal).collect();
        for run in parts {
            normal.matrix += run.matrix;
            normal.right += run.right;
            normal.loads.push(run.load);
        }
        normal
    }

    /// Information matrix and gradient of the unknowns, with the load errors eliminated. The damping of a step holds for the
    /// load errors too.
    pub fn reduced(&self, damping: f64) -> (DMatrix<f64>, DVector<f64>) {
        let (mut matrix, mut right) = (self.matrix.clone(), self.right.clone());
        for load in self.loads.iter().flatten() {
            let square = load.square * (1.0 + damping);
            matrix -= &load.coupling * load.coupling.transpose() / square;
            right -= &load.coupling * (load.pull / square);
        }
        (matrix, right)
    }

    /// An estimate with the load errors that follow from a damped step of the unknowns.
    pub fn with_loads(&self, estimate: &Estimate, step: &DVector<f64>, damping: f64) -> Estimate {
        let mut moved = estimate.clone();
        for (run, load) in self.loads.iter().enumerate() {
            if let Some(load) = load {
                let square = load.square * (1.0 + damping);
                let sigmas = (load.pull - load.coupling.dot(step)) / square;
                moved.set_load(run, estimate.load(run) + sigmas);
            }
        }
        moved
    }
}
