//! Gaussian noise from a seed.

use rand::{Rng, SeedableRng};
use rand_distr::StandardNormal;
use rand_pcg::Pcg64Mcg;

/// Independent standard normal numbers, the same for the same seed.
#[derive(Debug, Clone)]
pub struct Noise(Pcg64Mcg);

impl Noise {
    /// The numbers of a seed. Users of one seed take different `stream`s, so that they are independent.
    #[must_use]
    pub fn new(seed: u64, stream: u64) -> Self {
        // The golden ratio in 64 bits spreads neighbouring streams.
        let mixed = seed ^ stream.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        Self(Pcg64Mcg::seed_from_u64(mixed))
    }

    /// The next number of mean 0 and variance 1.
    pub fn normal(&mut self) -> f64 {
        self.0.sample(StandardNormal)
    }

    /// The next number, uniform from 0 to 1.
    pub fn uniform(&mut self) -> f64 {
        self.0.random()
    }
}
