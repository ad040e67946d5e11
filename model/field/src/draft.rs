//! Draft and vertical force of a tool in uniform soil.
//!
//! Draft (ASABE D497.5): `D = F (A + B S + C S²) W T`, with the speed `S` in km/h, the width `W` in m or in tools, and
//! the depth `T` in cm. The standard states a range of 30 to 50 % for single fields.
//!
//! Vertical force: `V = -D cos(α + δ) / sin(α + δ)` upwards, with the rake angle `α` and the soil-metal friction angle
//! `δ` (help of the implement block of simscape/Tractor-Simscape, which cites ASABE).

/// Texture of the soil, as the standard groups it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Texture {
    /// Clay.
    Fine,
    /// Loam.
    Medium,
    /// Sand.
    Coarse,
}

impl Texture {
    /// Soil-metal friction angle, degree (same source as the vertical force).
    #[must_use]
    pub fn friction_deg(self) -> f64 {
        match self {
            Self::Fine => 6.0,
            Self::Medium => 10.0,
            Self::Coarse => 22.0,
        }
    }
}

/// A row of the standard's table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DraftCoefficients {
    /// `A`, N per cm of depth and per m of width or tool.
    pub constant_n_per_cm: f64,
    /// `B`, the same per km/h.
    pub linear_n_h_per_cm_km: f64,
    /// `C`, the same per (km/h)².
    pub square_n_h2_per_cm_km2: f64,
    /// `F` of fine soil, 1.
    pub fine: f64,
    /// `F` of medium soil, 1.
    pub medium: f64,
    /// `F` of coarse soil, 1.
    pub coarse: f64,
    /// Range of single fields, ±%.
    pub range_percent: f64,
}

impl DraftCoefficients {
    /// Subsoiler with narrow points; width in tools.
    pub const SUBSOILER: Self = Self::row([226.0, 0.0, 1.8], [1.0, 0.70, 0.45], 50.0);
    /// Mouldboard plough; width in m.
    pub const MOULDBOARD_PLOUGH: Self = Self::row([652.0, 0.0, 5.1], [1.0, 0.70, 0.45], 40.0);
    /// Chisel plough with straight points of 5 cm; width in tools.
    pub const CHISEL_PLOUGH: Self = Self::row([91.0, 5.4, 0.0], [1.0, 0.85, 0.65], 50.0);
    /// Sweep plough, primary tillage; width in m.
    pub const SWEEP_PLOUGH: Self = Self::row([390.0, 19.0, 0.0], [1.0, 0.85, 0.65], 45.0);
    /// Field cultivator, primary tillage; width in tools.
    pub const FIELD_CULTIVATOR: Self = Self::row([46.0, 2.8, 0.0], [1.0, 0.85, 0.65], 30.0);

    const fn row(abc: [f64; 3], factors: [f64; 3], range_percent: f64) -> Self {
        Self {
            constant_n_per_cm: abc[0],
            linear_n_h_per_cm_km: abc[1],
            square_n_h2_per_cm_km2: abc[2],
            fine: factors[0],
            medium: factors[1],
            coarse: factors[2],
            range_percent,
        }
    }

    /// Soil factor `F` of a texture, 1.
    #[must_use]
    pub fn soil_factor(&self, texture: Texture) -> f64 {
        match texture {
            Texture::Fine => self.fine,
            Texture::Medium => self.medium,
            Texture::Coarse => self.coarse,
        }
    }

    /// Draft, N, of a width in m or tools, at a depth in m and a forward speed in m/s. Zero at depths that are not
    /// positive. A speed below zero counts as zero.
    #[must_use]
    pub fn draft_n(&self, texture: Texture, width: f64, depth_m: f64, speed_m_s: f64) -> f64 {
        let km_h = 3.6 * speed_m_s.max(0.0);
        let depth_cm = 100.0 * depth_m.max(0.0);
        let per_width_and_cm = self.constant_n_per_cm
            + km_h * (self.linear_n_h_per_cm_km + km_h * self.square_n_h2_per_cm_km2);
        self.soil_factor(texture) * per_width_and_cm * width * depth_cm
    }
}

/// Force of the soil on a tool, upwards, N: negative where the soil pulls it down. `rake_deg` is above 0 and below 158, so
/// that with friction it stays below 180.
#[must_use]
pub fn vertical_force_n(draft_n: f64, rake_deg: f64, texture: Texture) -> f64 {
    let (sine, cosine) = (rake_deg + texture.friction_deg()).to_radians().sin_cos();
    -draft_n * cosine / sine
}
