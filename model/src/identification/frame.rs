//! What the parameters that are already free could absorb, taken out of residuals and signatures.

use std::borrow::Borrow;
use std::ops::Range;

use nalgebra::{Cholesky, DVector, Dyn};

use super::estimate::Estimate;
use super::jacobian::{Jacobian, dot, subtract};

/// Columns of a Jacobian that are free, ready to be projected out, with every run's load.
pub struct Frame<J> {
    jacobian: J,
    kept: Vec<usize>,
    normal: Option<Cholesky<f64, Dyn>>,
    /// Pull of the priors of the shared parameters.
    priors: DVector<f64>,
    /// [`Frame::cost_after`] of the frame's own residuals.
    here: f64,
}

impl<J: Borrow<Jacobian>> Frame<J> {
    /// All shared parameters of the Jacobian but the columns `left_out`, and but those that stand at an end of their
    /// range: a clock that cannot move on absorbs nothing.
    #[must_use]
    pub fn new(owner: J, estimate: &Estimate, left_out: Range<usize>) -> Self {
        let jacobian: &Jacobian = owner.borrow();
        let (mut matrix, right) = jacobian.reduced(estimate);
        for k in 0..matrix.nrows() {
            matrix[(k, k)] += 1e-9;
        }
        let kept: Vec<usize> = (0..jacobian.shared.len())
            .filter(|column| !left_out.contains(column))
            .filter(|&column| !estimate.is_at_an_end(jacobian.shared[column]))
            .collect();
        let normal = matrix.select_rows(&kept).select_columns(&kept).cholesky();
        let own: Vec<Vec<f64>> = jacobian
            .runs
            .iter()
            .map(|run| run.residual.clone())
            .collect();
        let mut frame = Self {
            jacobian: owner,
            normal,
            priors: DVector::zeros(kept.len()),
            here: 0.0,
            kept,
        };
        frame.priors = right.select_rows(&frame.kept) - frame.pull(&own);
        frame.here = frame.cost_after(&own);
        frame
    }

    /// Removes from a signature what the free parameters and the loads can imitate.
    #[must_use]
    pub fn project(&self, signature: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
        self.project_at_a_price(signature).0
    }

    /// [`Frame::project`], and what the imitation costs in priors: a load far from what was weighed speaks against it.
    #[must_use]
    pub fn project_at_a_price(&self, mut signature: Vec<Vec<f64>>) -> (Vec<Vec<f64>>, f64) {
        let shares = self.shares(&self.coupling(&signature));
        let with_prior = |&(&kept, _): &(&usize, &f64)| self.jacobian().shared[kept].has_prior();
        let clocks = self.kept.iter().zip(shares.iter()).filter(with_prior);
        let mut price: f64 = clocks.map(|(_, share)| share * share).sum();
        for (run, column) in self.jacobian().runs.iter().zip(&mut signature) {
            for (&kept, &share) in self.kept.iter().zip(shares.iter()) {
                subtract(column, share, &run.shared[kept]);
            }
            if let Some(load) = &run.load {
                let share = dot(load, column) / (dot(load, load) + 1.0);
                subtract(column, share, load);
                price += share * share;
            }
        }
        (signature, price)
    }

    /// Cost that would be left if the free parameters took from `residuals` what they can, to first order; `residuals`
    /// belong to the frame's estimate with something else changed.
    #[must_use]
    pub fn cost_after(&self, residuals: &[Vec<f64>]) -> f64 {
        let mut cost = 0.0;
        for (run, residual) in self.jacobian().runs.iter().zip(residuals) {
            cost += dot(residual, residual) + run.load_value * run.load_value;
            if let Some((_, square, load_pull)) = run.load_pull(residual) {
                cost -= load_pull * load_pull / square;
            }
        }
        let pull = self.pull(residuals) + &self.priors;
        cost - pull.dot(&self.shares(&pull))
    }

    /// [`Frame::cost_after`] of the frame's own residuals: what there is without anything changed.
    #[must_use]
    pub fn here(&self) -> f64 {
        self.here
    }

    /// How far to go from the frame's own residuals to `residuals` for the least [`Frame::cost_after`], within `low` to
    /// `high` times the way, and that cost: a parabola through both ends and the same way backwards.
    #[must_use]
    pub fn along(&self, residuals: &[Vec<f64>], low: f64, high: f64) -> (f64, f64) {
        let own = |run: usize| &self.jacobian().runs[run].residual;
        let backwards: Vec<Vec<f64>> = residuals
            .iter()
            .enumerate()
            .map(|(run, moved)| {
                own(run)
                    .iter()
                    .zip(moved)
                    .map(|(o, m)| 2.0 * o - m)
                    .collect()
            })
            .collect();
        let (ahead, behind) = (self.cost_after(residuals), self.cost_after(&backwards));
        let here = self.here;
        let (slope, bend) = (0.5 * (ahead - behind), 0.5 * (ahead + behind) - here);
        if bend <= 0.0 {
            return (1.0, ahead);
        }
        let share = (-0.5 * slope / bend).clamp(low, high);
        (share, here + share * (slope + share * bend))
    }

    /// Pull of residuals on the free parameters, the loads eliminated.
    fn pull(&self, residuals: &[Vec<f64>]) -> DVector<f64> {
        let mut pull = DVector::zeros(self.kept.len());
        for (run, residual) in self.jacobian().runs.iter().zip(residuals) {
            let through_load = run
                .load_pull(residual)
                .map(|(load, square, load_pull)| (load, load_pull / square));
            for (row, &kept) in self.kept.iter().enumerate() {
                pull[row] += dot(&run.shared[kept], residual);
                if let Some((load, share)) = through_load {
                    pull[row] -= share * dot(&run.shared[kept], load);
                }
            }
        }
        pull
    }

    /// Products of a signature with the free columns, the loads eliminated.
    fn coupling(&self, signature: &[Vec<f64>]) -> DVector<f64> {
        let mut coupling = DVector::zeros(self.kept.len());
        for (run, column) in self.jacobian().runs.iter().zip(signature) {
            let through_load = run.load.as_ref().map(|load| {
                let share = dot(load, column) / (dot(load, load) + 1.0);
                (load, share)
            });
            for (row, &kept) in self.kept.iter().enumerate() {
                coupling[row] += dot(&run.shared[kept], column);
                if let Some((load, share)) = through_load {
                    coupling[row] -= share * dot(&run.shared[kept], load);
                }
            }
        }
        coupling
    }

    fn shares(&self, pull: &DVector<f64>) -> DVector<f64> {
        self.normal
            .as_ref()
            .map_or_else(|| DVector::zeros(pull.len()), |normal| normal.solve(pull))
    }

    fn jacobian(&self) -> &Jacobian {
        self.jacobian.borrow()
    }
}
