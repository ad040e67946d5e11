//! Strength of the soil along the field: `1 + c w(x)`, with `w` a sum of two first-order (Ornstein-Uhlenbeck) processes in
//! metres and clods without correlation.
//!
//! A first-order process of length `L` and deviation `σ` has the covariance `σ² e^(-d/L)`, which is the exponential
//! semivariogram that fields show (J. Terramechanics 42 (2005) 339: first scale below 9 m). It is advanced exactly:
//! `w(x + d) = w(x) e^(-d/L) + σ √(1 - e^(-2 d/L)) n`, with a standard normal `n`, for a step `d` of any length.
//!
//! The coefficient of variation of plough draft was 8 to 19 % in 19 passes (40(3) (2014) 161, "Postprocess analysis of plow
//! draft"). The lengths and the deviations relative to each other are chosen; no measured spectrum could be read.
//!
//! The processes are drawn at nodes, and the strength is linear between them. Between nodes of the correlation `ρ` the
//! variance is `σ² (2 + ρ) / 3` on average; the deviations are larger by the root of this, so that the coefficient of
//! variation along the field is the requested one.

use crate::noise::Noise;

/// A first-order process along a distance.
#[derive(Debug, Clone, PartialEq)]
pub struct OrnsteinUhlenbeck {
    length_m: f64,
    deviation: f64,
    value: f64,
}

impl OrnsteinUhlenbeck {
    /// A process with a correlation length in m and a standard deviation, begun in its stationary state.
    #[must_use]
    pub fn new(length_m: f64, deviation: f64, noise: &mut Noise) -> Self {
        let value = deviation * noise.normal();
        Self {
            length_m,
            deviation,
            value,
        }
    }

    /// Present value.
    #[must_use]
    pub fn value(&self) -> f64 {
        self.value
    }

    /// Goes on by `step_m`, m, zero or more.
    pub fn advance(&mut self, step_m: f64, noise: &mut Noise) {
        let lengths = step_m / self.length_m;
        let fresh = (-(-2.0 * lengths).exp_m1()).sqrt();
        self.value = self.value * (-lengths).exp() + self.deviation * fresh * noise.normal();
    }
}

/// Constants of the variation.
#[derive(Debug, Clone, PartialEq)]
pub struct StrengthConstants {
    /// Coefficient of variation that the deviations below are scaled to, 1.
    pub coefficient_of_variation: f64,
    /// Correlation length of the long process, m.
    pub long_length_m: f64,
    /// Its deviation before scaling, 1.
    pub long_deviation: f64,
    /// Correlation length of the short process, m.
    pub short_length_m: f64,
    /// Its deviation before scaling, 1.
    pub short_deviation: f64,
    /// Deviation of the clods before scaling, 1.
    pub clod_deviation: f64,
    /// Distance of the nodes, m.
    pub node_m: f64,
}

impl Default for StrengthConstants {
    /// 12 %; nodes each 5 cm, the step that the cross-section of tilled soil needs (Soil & Tillage Res. 159 (2016) 73).
    fn default() -> Self {
        Self {
            coefficient_of_variation: 0.12,
            long_length_m: 6.0,
            long_deviation: 0.10,
            short_length_m: 0.5,
            short_deviation: 0.06,
            clod_deviation: 0.04,
            node_m: 0.05,
        }
    }
}

impl StrengthConstants {
    /// Factor of the deviations that gives the coefficient of variation.
    #[must_use]
    pub fn scale(&self) -> f64 {
        let squares = [
            self.long_deviation,
            self.short_deviation,
            self.clod_deviation,
        ]
        .map(|deviation| deviation * deviation);
        let total = squares.iter().sum::<f64>().sqrt();
        if total > 0.0 {
            self.coefficient_of_variation / total
        } else {
            0.0
        }
    }
}

/// Nodes that are drawn one after the other; a longer jump is one exact step.
const NODES_IN_TURN: f64 = 1000.0;

/// The strength along one pass: a function of the distance, whatever the steps between its readings.
#[derive(Debug, Clone)]
pub struct Strength {
    scale: f64,
    node_m: f64,
    clod_deviation: f64,
    long: OrnsteinUhlenbeck,
    short: OrnsteinUhlenbeck,
    noise: Noise,
    /// Number of the node before the present distance.
    node: f64,
    /// Variation at this node and the next.
    variations: [f64; 2],
}

impl Strength {
    /// The strength of a seed, from distance 0 on.
    #[must_use]
    pub fn new(constants: &StrengthConstants, mut noise: Noise) -> Self {
        let between =
            |deviation: f64, correlation: f64| deviation * (3.0 / (2.0 + correlation)).sqrt();
        let mut process = |length_m: f64, deviation: f64| {
            let correlation = (-constants.node_m / length_m).exp();
            OrnsteinUhlenbeck::new(length_m, between(deviation, correlation), &mut noise)
        };
        let long = process(constants.long_length_m, constants.long_deviation);
        let short = process(constants.short_length_m, constants.short_deviation);
        let mut strength = Self {
            scale: constants.scale(),
            node_m: constants.node_m,
            clod_deviation: between(constants.clod_deviation, 0.0),
            long,
            short,
            noise,
            node: 0.0,
            variations: [0.0; 2],
        };
        strength.variations = [strength.variation(0.0), strength.variation(1.0)];
        strength
    }

    /// Factor of the draft at a distance, m; not below 0. Distances do not decrease: one before the present node gives the
    /// factor at that node.
    pub fn factor_at(&mut self, distance_m: f64) -> f64 {
        let nodes = distance_m / self.node_m;
        let passed = nodes.floor() - self.node;
        if passed > NODES_IN_TURN {
            self.variations = [self.variation(passed - 1.0), self.variation(1.0)];
            self.node += passed;
        } else {
            // Distances before the present node count as 0.
            for _ in 0..passed as u32 {
                self.variations = [self.variations[1], self.variation(1.0)];
                self.node += 1.0;
            }
        }
        let part = (nodes - self.node).clamp(0.0, 1.0);
        let [before, behind] = self.variations;
        (1.0 + self.scale * (before + part * (behind - before))).max(0.0)
    }

    /// Goes on by a number of nodes and draws the variation there.
    fn variation(&mut self, nodes: f64) -> f64 {
        let step_m = nodes * self.node_m;
        self.long.advance(step_m, &mut self.noise);
        self.short.advance(step_m, &mut self.noise);
        self.long.value() + self.short.value() + self.clod_deviation * self.noise.normal()
    }
}
