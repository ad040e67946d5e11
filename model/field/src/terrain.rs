//! Height of the ground along the field: flat, a sine, roughness, or both.
//!
//! Roughness has the spectrum of ISO 8608, `G(n) = G₀ (n/n₀)^-w` in m³ over the spatial frequency `n` in cycles per m, in a
//! band. It is a sum of cosines with random phases, one for each of equal parts of the logarithm of `n`, and each with
//! the variance of its part of the spectrum: their sum has the variance of the band exactly,
//! `G₀ n₀^w (n₁^(1-w) - n₂^(1-w)) / (w - 1)`. The tracks of ISO 5008 are tables, and not included.

use std::f64::consts::TAU;

use crate::noise::Noise;

/// A sine.
#[derive(Debug, Clone, PartialEq)]
pub struct Undulation {
    /// Length of a period, m, above 0.
    pub wavelength_m: f64,
    /// Half of the height between trough and crest, m.
    pub amplitude_m: f64,
}

/// Spectrum of roughness.
#[derive(Debug, Clone, PartialEq)]
pub struct RoughnessConstants {
    /// Spectral density at the reference, m³.
    pub density_m3: f64,
    /// Reference, cycles per m.
    pub reference_per_m: f64,
    /// Exponent of the waves, 1.
    pub exponent: f64,
    /// Lowest spatial frequency, cycles per m, above 0.
    pub lowest_per_m: f64,
    /// Highest spatial frequency, cycles per m.
    pub highest_per_m: f64,
}

impl RoughnessConstants {
    /// Class D of ISO 8608 (1024·10⁻⁶ m³ at 0.1 cycles per m, exponent 2), waves from 0.5 to 20 m: 14 mm root mean square.
    /// Its use for a field is chosen.
    #[must_use]
    pub fn class_d() -> Self {
        Self {
            density_m3: 1024e-6,
            reference_per_m: 0.1,
            exponent: 2.0,
            lowest_per_m: 0.05,
            highest_per_m: 2.0,
        }
    }

    /// Variance of the heights, m².
    #[must_use]
    pub fn variance_m2(&self) -> f64 {
        self.variance_between_m2(self.lowest_per_m, self.highest_per_m)
    }

    fn variance_between_m2(&self, low_per_m: f64, high_per_m: f64) -> f64 {
        let [low, high] = [low_per_m, high_per_m].map(|n| n / self.reference_per_m);
        let power = 1.0 - self.exponent;
        let integral = if power == 0.0 {
            (high / low).ln()
        } else {
            (high.powf(power) - low.powf(power)) / power
        };
        self.density_m3 * self.reference_per_m * integral
    }
}

/// Number of waves of which roughness is made.
const WAVES: u32 = 96;

#[derive(Debug, Clone)]
struct Wave {
    per_m: f64,
    amplitude_m: f64,
    phase_rad: f64,
}

/// Heights of the ground.
#[derive(Debug, Clone, Default)]
pub struct Terrain {
    undulation: Option<Undulation>,
    waves: Vec<Wave>,
}

impl Terrain {
    /// Flat ground of height 0.
    #[must_use]
    pub fn flat() -> Self {
        Self::default()
    }

    /// Ground with a sine.
    #[must_use]
    pub fn with_undulation(mut self, undulation: Undulation) -> Self {
        self.undulation = Some(undulation);
        self
    }

    /// Ground with roughness, whose phases the noise draws.
    #[must_use]
    pub fn with_roughness(mut self, constants: &RoughnessConstants, noise: &mut Noise) -> Self {
        let octaves = (constants.highest_per_m / constants.lowest_per_m).ln();
        let edge_per_m = |index: u32| {
            constants.lowest_per_m * (octaves * f64::from(index) / f64::from(WAVES)).exp()
        };
        self.waves = (0..WAVES)
            .map(|index| {
                let [low_per_m, high_per_m] = [index, index + 1].map(edge_per_m);
                let variance_m2 = constants.variance_between_m2(low_per_m, high_per_m);
                Wave {
                    per_m: (low_per_m * high_per_m).sqrt(),
                    amplitude_m: (2.0 * variance_m2).sqrt(),
                    phase_rad: TAU * noise.uniform(),
                }
            })
            .collect();
        self
    }

    /// Height at a distance, m.
    #[must_use]
    pub fn height_m(&self, distance_m: f64) -> f64 {
        let sine = self.undulation.as_ref().map_or(0.0, |undulation| {
            undulation.amplitude_m * (TAU * distance_m / undulation.wavelength_m).sin()
        });
        let rough = self
            .waves
            .iter()
            .map(|wave| wave.amplitude_m * (TAU * wave.per_m * distance_m + wave.phase_rad).cos());
        sine + rough.sum::<f64>()
    }
}
