//! The implement, and its way into the soil.

use crate::draft::{DraftCoefficients, Texture, vertical_force_n};

/// A mounted implement. Distances are behind the rear axle.
#[derive(Debug, Clone, PartialEq)]
pub struct Implement {
    /// Row of the table of draft.
    pub draft: DraftCoefficients,
    /// Working width in m, or number of tools, as the row counts.
    pub width: f64,
    /// Length over which it follows the links into the soil, m: that of its share line.
    pub length_m: f64,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Centre of gravity, m.
    pub centre_m: f64,
    /// Middle of the shares, where the soil acts, m.
    pub share_m: f64,
    /// Effective rake angle, degree: [`vertical_force_n`].
    pub rake_deg: f64,
    /// Depth at which draft acts as part of the working depth, 1.
    pub resistance_depth_ratio: f64,
}

impl Implement {
    /// Mouldboard plough of three furrows of 40 cm, 600 kg. Mass, length and distances are those of its class; the rake is
    /// chosen for a downward pull of a fifth of the draft in loam. A single flat tool of 45° would be pulled down by
    /// 0.70 of it. Draft acts at two thirds of the depth, as usual in statics of tractors.
    #[must_use]
    pub fn three_furrow_plough() -> Self {
        Self {
            draft: DraftCoefficients::MOULDBOARD_PLOUGH,
            width: 1.2,
            length_m: 1.5,
            mass_kg: 600.0,
            centre_m: 1.9,
            share_m: 2.0,
            rake_deg: 68.0,
            resistance_depth_ratio: 2.0 / 3.0,
        }
    }

    /// Draft in uniform soil, N, at a depth in m and a speed in m/s.
    #[must_use]
    pub fn draft_n(&self, texture: Texture, depth_m: f64, speed_m_s: f64) -> f64 {
        self.draft.draft_n(texture, self.width, depth_m, speed_m_s)
    }

    /// Force of the soil upwards, N, at a draft in N.
    #[must_use]
    pub fn vertical_force_n(&self, draft_n: f64, texture: Texture) -> f64 {
        vertical_force_n(draft_n, self.rake_deg, texture)
    }
}

/// Working depth: it follows the depth that the links set, `dT/dx = (T_set - T) / L`, over the implement's length. Where the
/// links hold the share at the ground's height or above, it is out at once, at that height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Penetration {
    depth_m: f64,
}

impl Penetration {
    /// A share at a depth, m; negative above ground.
    #[must_use]
    pub fn new(depth_m: f64) -> Self {
        Self { depth_m }
    }

    /// Depth, m; negative above ground.
    #[must_use]
    pub fn depth_m(self) -> f64 {
        self.depth_m
    }

    /// Goes on by `travel_m`, m, with the links at `set_m`, m; exact for a set depth that is constant over the travel.
    pub fn advance(&mut self, set_m: f64, length_m: f64, travel_m: f64) {
        self.depth_m = if set_m <= 0.0 {
            set_m
        } else {
            let depth_m = self.depth_m.max(0.0);
            depth_m - (set_m - depth_m) * (-travel_m.max(0.0) / length_m).exp_m1()
        };
    }
}
