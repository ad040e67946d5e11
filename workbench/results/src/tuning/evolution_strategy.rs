//! The evolution strategy with covariance matrix adaptation (CMA-ES), as in table 1 and equations 38 to 47 of N. Hansen, "The CMA
//! Evolution Strategy: A Tutorial", arXiv:1604.00772, with positive weights.
//!
//! No kept crate has it on the present nalgebra: `cmaes`, `haru_cmaes` and `fcmaes-core` bring an older one with its own random numbers.

use std::ops::ControlFlow;

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

/// The distribution that candidates are drawn from, and what it has learned.
pub struct EvolutionStrategy {
    mean: DVector<f64>,
    sigma: f64,
    covariance: DMatrix<f64>,
    path: DVector<f64>,
    sigma_path: DVector<f64>,
    generations: i32,
    rates: Rates,
    random: Pcg64Mcg,
}

/// Weights and learning rates, which follow from the number of dimensions.
struct Rates {
    candidates: usize,
    weights: Vec<f64>,
    effective: f64,
    sigma_path: f64,
    damping: f64,
    path: f64,
    rank_one: f64,
    rank_mu: f64,
    /// Expected length of a vector of independent standard normal values.
    expected_length: f64,
}

impl Rates {
    fn new(dimensions: usize) -> Self {
        let n = dimensions as f64;
        let candidates = 4 + (3.0 * n.ln()) as usize;
        let best = candidates / 2;
        let raw = |rank: usize| ((candidates as f64 + 1.0) / 2.0).ln() - (rank as f64 + 1.0).ln();
        let sum: f64 = (0..best).map(raw).sum();
        let weights: Vec<f64> = (0..best).map(|rank| raw(rank) / sum).collect();
        let effective = 1.0 / weights.iter().map(|weight| weight * weight).sum::<f64>();
        let sigma_path = (effective + 2.0) / (n + effective + 5.0);
        let excess = ((effective - 1.0) / (n + 1.0)).sqrt() - 1.0;
        let rank_one = 2.0 / ((n + 1.3).powi(2) + effective);
        let rank_mu =
            2.0 * (0.25 + effective + 1.0 / effective - 2.0) / ((n + 2.0).powi(2) + effective);
        Self {
            candidates,
            weights,
            effective,
            sigma_path,
            damping: 1.0 + 2.0 * excess.max(0.0) + sigma_path,
            path: (4.0 + effective / n) / (n + 4.0 + 2.0 * effective / n),
            rank_one,
            rank_mu: rank_mu.min(1.0 - rank_one),
            expected_length: n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n)),
        }
    }
}

impl EvolutionStrategy {
    /// Starts around the origin of `dimensions` coordinates with the standard deviation `sigma` of each.
    pub fn new(dimensions: usize, sigma: f64, seed: u64) -> Self {
        Self {
            mean: DVector::zeros(dimensions),
            sigma,
            covariance: DMatrix::identity(dimensions, dimensions),
            path: DVector::zeros(dimensions),
            sigma_path: DVector::zeros(dimensions),
            generations: 0,
            rates: Rates::new(dimensions),
            random: Pcg64Mcg::seed_from_u64(seed),
        }
    }

    /// Draws generations and adapts the distribution to the costs of their candidates, until `cost` ends the search.
    pub fn run(&mut self, mut cost: impl FnMut(&[f64]) -> ControlFlow<(), f64>) {
        while self.generation(&mut cost).is_continue() {}
    }

    /// Draws a generation of candidates, and adapts the distribution to their costs.
    fn generation(
        &mut self,
        mut cost: impl FnMut(&[f64]) -> ControlFlow<(), f64>,
    ) -> ControlFlow<()> {
        let eigen = SymmetricEigen::new(self.covariance.clone());
        let lengths = eigen.eigenvalues.map(|value| value.max(0.0).sqrt());
        let mut drawn = Vec::with_capacity(self.rates.candidates);
        for _ in 0..self.rates.candidates {
            let normal = lengths.map(|length| {
                let value: f64 = StandardNormal.sample(&mut self.random);
                length * value
            });
            let step = &eigen.eigenvectors * normal;
            let candidate = &self.mean + self.sigma * &step;
            drawn.push((cost(candidate.as_slice())?, step));
        }
        drawn.sort_by(|a, b| a.0.total_cmp(&b.0));
        let steps: Vec<DVector<f64>> = drawn.into_iter().map(|(_, step)| step).collect();
        let inverse_lengths = lengths.map(|length| if length > 0.0 { length.recip() } else { 0.0 });
        self.adapt(&steps, |step| {
            let along_axes = eigen.eigenvectors.tr_mul(step);
            &eigen.eigenvectors * along_axes.component_mul(&inverse_lengths)
        });
        ControlFlow::Continue(())
    }

    /// Adapts mean, step size and covariance to the steps of a generation, the best first.
    fn adapt(&mut self, steps: &[DVector<f64>], whiten: impl Fn(&DVector<f64>) -> DVector<f64>) {
        let rates = &self.rates;
        let weighted = || rates.weights.iter().copied().zip(steps);
        let mut mean_step = DVector::zeros(self.mean.len());
        weighted().for_each(|(weight, step)| mean_step.axpy(weight, step, 1.0));
        self.mean.axpy(self.sigma, &mean_step, 1.0);
        self.generations += 1;

        let scale = (rates.sigma_path * (2.0 - rates.sigma_path) * rates.effective).sqrt();
        self.sigma_path *= 1.0 - rates.sigma_path;
        self.sigma_path.axpy(scale, &whiten(&mean_step), 1.0);
        let length = self.sigma_path.norm() / rates.expected_length;

        // The path of the covariance pauses while the step size grows fast.
        let unbiased = (1.0 - (1.0 - rates.sigma_path).powi(2 * self.generations)).sqrt();
        let is_steady = length / unbiased < 1.4 + 2.0 / (self.mean.len() as f64 + 1.0);
        self.path *= 1.0 - rates.path;
        if is_steady {
            let scale = (rates.path * (2.0 - rates.path) * rates.effective).sqrt();
            self.path.axpy(scale, &mean_step, 1.0);
        }
        let pause = if is_steady {
            0.0
        } else {
            rates.path * (2.0 - rates.path)
        };
        self.covariance *= 1.0 - rates.rank_one * (1.0 - pause) - rates.rank_mu;
        self.covariance
            .ger(rates.rank_one, &self.path, &self.path, 1.0);
        for (weight, step) in weighted() {
            self.covariance.ger(rates.rank_mu * weight, step, step, 1.0);
        }
        self.sigma *= (rates.sigma_path / rates.damping * (length - 1.0)).exp();
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use super::EvolutionStrategy;

    /// The ellipsoid of Hansen's benchmarks: its axes differ by a factor of 1000, and none is along a coordinate.
    fn turned_ellipsoid(point: &[f64]) -> f64 {
        let (x, y) = (point[0] - 1.0, point[1] + 0.5);
        let (along, across) = (0.6 * x + 0.8 * y, 0.8 * x - 0.6 * y);
        along * along + 1e6 * across * across
    }

    #[test]
    fn the_least_cost_of_an_ill_conditioned_function_is_found() {
        for seed in 1..=5 {
            let (mut least, mut count) = (f64::INFINITY, 0);
            EvolutionStrategy::new(2, 0.3, seed).run(|point| {
                let cost = turned_ellipsoid(point);
                least = least.min(cost);
                count += 1;
                if count < 700 {
                    ControlFlow::Continue(cost)
                } else {
                    ControlFlow::Break(())
                }
            });
            println!("seed {seed}: {least:e}");
            assert!(least < 1e-8);
        }
    }
}
