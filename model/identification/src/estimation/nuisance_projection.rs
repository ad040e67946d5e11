//! Projection of the free nuisance parameters out of residuals and signatures.

use std::borrow::Borrow;
use std::ops::Range;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::estimate::Estimate;
use crate::estimation::bounded_minimum::minimum_within;
use crate::estimation::jacobian::{Jacobian, RunJacobian};
use crate::estimation::residual_columns::{dot, square_sum, subtract};

/// The free columns of a Jacobian and each run's load, prepared for projection.
pub struct NuisanceProjection<J> {
    jacobian: J,
    kept: Vec<usize>,
    /// Normal matrix of the kept columns with the loads eliminated, and its Cholesky factor.
    matrix: DMatrix<f64>,
    normal: Option<Cholesky<f64, Dyn>>,
    /// Distances of each kept parameter to the ends of its range, in scales.
    room: Vec<(f64, f64)>,
    /// Each run's load.
    loads: Vec<Option<Load>>,
    /// Gradient of the priors of the shared parameters.
    priors: DVector<f64>,
    /// Products of the projection's own residuals.
    own: Products,
    /// [`NuisanceProjection::cost_after`] of the projection's own residuals.
    here: f64,
}

/// A run's load column in a projection.
struct Load {
    /// Squared norm of its column plus the unit prior.
    square: f64,
    /// Present load error, in prior sigmas.
    value: f64,
    /// Dot products with the kept columns.
    coupling: DVector<f64>,
}

/// Dot products of residuals with the columns of a projection; linear in the residuals.
#[derive(Clone)]
struct Products {
    /// With each run's load.
    loads: Vec<f64>,
    /// With the kept columns.
    columns: DVector<f64>,
}

impl Products {
    /// Products of twice the residuals of these minus those of others.
    fn mirrored(&self, less: &Self) -> Self {
        let loads = self.loads.iter().zip(&less.loads);
        Self {
            loads: loads.map(|(own, less)| 2.0 * own - less).collect(),
            columns: 2.0 * &self.columns - &less.columns,
        }
    }
}

impl<J: Borrow<Jacobian>> NuisanceProjection<J> {
    /// Keeps all shared parameters of the Jacobian except the columns `left_out` and those at an end of their range: a
    /// clock that cannot move absorbs nothing.
    #[must_use]
    pub fn new(owner: J, estimate: &Estimate, left_out: Range<usize>) -> Self {
        Self::keeping(owner, estimate, |column| !left_out.contains(&column))
    }

    /// Keeps the columns selected by `keeps`, except those at an end of their range.
    #[must_use]
    pub fn keeping(owner: J, estimate: &Estimate, keeps: impl Fn(usize) -> bool) -> Self {
        let jacobian: &Jacobian = owner.borrow();
        let (mut matrix, right) = jacobian.reduced(estimate);
        for k in 0..matrix.nrows() {
            matrix[(k, k)] += 1e-9;
        }
        let kept: Vec<usize> = (0..jacobian.shared.len())
            .filter(|&column| keeps(column))
            .filter(|&column| !estimate.is_at_an_end(jacobian.shared[column]))
            .collect();
        let matrix = matrix.select_rows(&kept).select_columns(&kept);
        let room = |&column: &usize| estimate.room(jacobian.shared[column]);
        let room = kept.iter().map(room).collect();
        let load = |run: &RunJacobian| {
            let column = run.load.as_deref()?;
            let products = kept.iter().map(|&kept| dot(&run.shared[kept], column));
            Some(Load {
                square: dot(column, column) + 1.0,
                value: run.load_value,
                coupling: DVector::from_iterator(kept.len(), products),
            })
        };
        let loads = jacobian.runs.iter().map(load).collect();
        let nothing = Products {
            loads: Vec::new(),
            columns: DVector::zeros(kept.len()),
        };
        let mut projection = Self {
            jacobian: owner,
            normal: matrix.clone().cholesky(),
            matrix,
            room,
            loads,
            priors: DVector::zeros(kept.len()),
            own: nothing,
            here: 0.0,
            kept,
        };
        let runs = &projection.jacobian().runs;
        let own: Vec<&[f64]> = runs.iter().map(|run| run.residual.as_slice()).collect();
        let square = own.iter().map(|run| dot(run, run)).sum();
        let products = projection.products(own);
        projection.priors = right.select_rows(&projection.kept) - projection.pull(&products);
        projection.here = projection.cost(square, &products);
        projection.own = products;
        projection
    }

    /// Removes the component of a signature that the free parameters and the loads can reproduce.
    #[must_use]
    pub fn project(&self, signature: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
        self.project_with_penalty(signature).0
    }

    /// [`NuisanceProjection::project`], and the prior cost of the removed component: a load far from the weighed one
    /// counts against it.
    #[must_use]
    pub fn project_with_penalty(&self, signature: Vec<Vec<f64>>) -> (Vec<Vec<f64>>, f64) {
        let shares = self.shares(&self.coupling(&signature));
        self.without(signature, &shares)
    }

    /// [`NuisanceProjection::project_with_penalty`] of an actual change instead of a direction: every parameter stays
    /// within its range.
    #[must_use]
    pub fn project_within_range(&self, signature: Vec<Vec<f64>>) -> (Vec<Vec<f64>>, f64) {
        let coupling = self.coupling(&signature);
        let shares = minimum_within(&self.matrix, &coupling, &self.room);
        self.without(
            signature,
            &shares.unwrap_or_else(|| DVector::zeros(coupling.len())),
        )
    }

    /// A signature minus given shares of the free columns and minus the optimal shares of the loads, and the prior cost
    /// of both.
    fn without(&self, mut signature: Vec<Vec<f64>>, shares: &DVector<f64>) -> (Vec<Vec<f64>>, f64) {
        let with_prior = |&(&kept, _): &(&usize, &f64)| self.jacobian().shared[kept].has_prior();
        let clocks = self.kept.iter().zip(shares.iter()).filter(with_prior);
        let mut penalty: f64 = clocks.map(|(_, share)| share * share).sum();
        let runs = self.jacobian().runs.iter().zip(&self.loads);
        for ((run, load), left) in runs.zip(&mut signature) {
            for (&kept, &share) in self.kept.iter().zip(shares.iter()) {
                subtract(left, share, &run.shared[kept]);
            }
            if let (Some(column), Some(load)) = (&run.load, load) {
                let share = dot(column, left) / load.square;
                subtract(left, share, column);
                penalty += share * share;
            }
        }
        (signature, penalty)
    }

    /// Cost of `residuals` once the free parameters have been re-optimised, to first order. `residuals` belong to the
    /// projection's estimate with something else changed.
    #[must_use]
    pub fn cost_after(&self, residuals: &[Vec<f64>]) -> f64 {
        self.cost(square_sum(residuals), &self.products(residuals))
    }

    /// [`NuisanceProjection::cost_after`] of the projection's own residuals.
    #[must_use]
    pub fn here(&self) -> f64 {
        self.here
    }

    /// Share of the way from the projection's own residuals to `residuals` that minimises
    /// [`NuisanceProjection::cost_after`], within `low` to `high`, and that cost. The cost is a parabola through both
    /// ends and the mirrored end.
    #[must_use]
    pub fn along(&self, residuals: &[Vec<f64>], low: f64, high: f64) -> (f64, f64) {
        let (mut own, mut mixed, mut moved) = (0.0, 0.0, 0.0);
        for (run, residual) in self.jacobian().runs.iter().zip(residuals) {
            own += dot(&run.residual, &run.residual);
            mixed += dot(&run.residual, residual);
            moved += dot(residual, residual);
        }
        let products = self.products(residuals);
        let ahead = self.cost(moved, &products);
        let behind = self.cost(4.0 * (own - mixed) + moved, &self.own.mirrored(&products));
        let here = self.here;
        let (slope, bend) = (0.5 * (ahead - behind), 0.5 * (ahead + behind) - here);
        if bend <= 0.0 {
            return (1.0, ahead);
        }
        let share = (-0.5 * slope / bend).clamp(low, high);
        (share, here + share * (slope + share * bend))
    }

    /// [`NuisanceProjection::cost_after`] of residuals with this sum of squares and these products.
    fn cost(&self, square: f64, products: &Products) -> f64 {
        let runs = self.jacobian().runs.iter();
        let mut cost = square + runs.map(|run| run.load_value.powi(2)).sum::<f64>();
        for (load, product) in self.loads.iter().zip(&products.loads) {
            if let Some(load) = load {
                cost -= (product - load.value).powi(2) / load.square;
            }
        }
        let pull = self.pull(products) + &self.priors;
        cost - pull.dot(&self.shares(&pull))
    }

    fn products<R: AsRef<[f64]>>(&self, residuals: impl AsRef<[R]>) -> Products {
        let runs = self.jacobian().runs.iter().zip(residuals.as_ref());
        let mut columns = DVector::zeros(self.kept.len());
        let loads = runs
            .map(|(run, residual)| {
                let residual = residual.as_ref();
                for (sum, &kept) in columns.iter_mut().zip(&self.kept) {
                    *sum += dot(&run.shared[kept], residual);
                }
                run.load.as_ref().map_or(0.0, |load| dot(load, residual))
            })
            .collect();
        Products { loads, columns }
    }

    /// Gradient of residuals with these products along the free parameters, with the loads eliminated.
    fn pull(&self, products: &Products) -> DVector<f64> {
        let mut pull = products.columns.clone();
        for (load, product) in self.loads.iter().zip(&products.loads) {
            if let Some(load) = load {
                pull -= &load.coupling * ((product - load.value) / load.square);
            }
        }
        pull
    }

    /// Dot products of a signature with the free columns, with the loads eliminated.
    fn coupling(&self, signature: &[Vec<f64>]) -> DVector<f64> {
        let products = self.products(signature);
        let mut coupling = products.columns;
        for (load, product) in self.loads.iter().zip(&products.loads) {
            if let Some(load) = load {
                coupling -= &load.coupling * (product / load.square);
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
