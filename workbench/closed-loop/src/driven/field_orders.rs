//! The orders of a page for the work on a field: soil, ground, speed, and the function of the hitch.

use std::ops::RangeInclusive;

use hitch_field::draft::Texture;
use hitch_field::noise::Noise;
use hitch_field::soil::SoilPlan;
use hitch_field::terrain::{RoughnessConstants, Terrain, Undulation};
use hitch_quantities::Function;
use serde::Deserialize;

use crate::field::Settings;

/// Demanded ground speeds, m/s.
pub const SPEEDS_M_S: RangeInclusive<f64> = 0.0..=4.0;
/// Set points of the draft, N.
pub const DRAFTS_N: RangeInclusive<f64> = 0.0..=40_000.0;
/// Set points of the depth, m.
pub const DEPTHS_M: RangeInclusive<f64> = 0.0..=0.4;
/// Positions of the mix dial, 1.
const MIXES: RangeInclusive<f64> = 0.0..=1.0;
/// Slip limits, 1.
pub const SLIP_LIMITS: RangeInclusive<f64> = 0.05..=0.3;
/// Stream of the roughness, beside those of the tractor.
const ROUGHNESS_STREAM: u64 = 16;

/// Texture of the soil.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SoilOrder {
    /// Sand.
    Coarse,
    /// Loam.
    Medium,
    /// Clay.
    Fine,
}

impl SoilOrder {
    /// As the field names it.
    pub const fn texture(self) -> Texture {
        match self {
            Self::Coarse => Texture::Coarse,
            Self::Medium => Texture::Medium,
            Self::Fine => Texture::Fine,
        }
    }
}

/// Shape of the ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GroundOrder {
    /// Level.
    Flat,
    /// A sine of 10 m and 100 mm between trough and crest.
    Undulating,
    /// Roughness of class D.
    Rough,
}

/// Function of the hitch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FunctionOrder {
    /// The lever is the position.
    Position,
    /// The draft is regulated.
    Draft,
    /// Draft and position are weighted by the mix dial.
    Mix,
    /// The draft is regulated above the lever.
    DepthLimit,
    /// The depth is regulated.
    Depth,
}

impl FunctionOrder {
    const fn function(self) -> Function {
        match self {
            Self::Position => Function::Position,
            Self::Draft => Function::Draft,
            Self::Mix => Function::Mix,
            Self::DepthLimit => Function::DepthLimit,
            Self::Depth => Function::Depth,
        }
    }
}

/// Field and function of a step.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct FieldOrders {
    /// Texture; another one begins in front of the tractor.
    pub soil: SoilOrder,
    /// Whether the strength of the soil varies; as it is at the start.
    pub varies: bool,
    /// Shape of the ground; as it is at the start.
    pub ground: GroundOrder,
    /// Number of times that a soft patch of 20 m was asked for: one more lays it in front of the tractor. A count is not lost
    /// between two requests, as a short press would be.
    #[serde(default)]
    pub soft_patches: u32,
    /// Demanded ground speed, m/s.
    pub speed_m_s: f64,
    /// Function of the hitch.
    pub function: FunctionOrder,
    /// Set point of the draft, N.
    pub draft_n: f64,
    /// Set point of the depth, m.
    pub depth_m: f64,
    /// Mix dial, 0 is position, 1 is draft.
    pub mix: f64,
    /// Slip limit, 1.
    pub slip_limit: f64,
    /// The switch of quick engagement is held.
    #[serde(default)]
    pub engage: bool,
}

impl FieldOrders {
    /// Names, values and ranges of the numbers.
    pub(super) fn ranged(&self) -> [(&'static str, f64, RangeInclusive<f64>); 5] {
        [
            ("speed_m_s", self.speed_m_s, SPEEDS_M_S),
            ("draft_n", self.draft_n, DRAFTS_N),
            ("depth_m", self.depth_m, DEPTHS_M),
            ("mix", self.mix, MIXES),
            ("slip_limit", self.slip_limit, SLIP_LIMITS),
        ]
    }

    /// What the controller is told.
    pub(super) fn settings(&self) -> Settings {
        Settings {
            function: self.function.function(),
            draft_n: Some(self.draft_n),
            depth_m: Some(self.depth_m),
            mix: Some(self.mix),
            slip_limit: Some(self.slip_limit),
            engage: self.engage,
        }
    }

    /// The soil at the start.
    pub(super) fn plan(&self) -> SoilPlan {
        let texture = self.soil.texture();
        if self.varies {
            SoilPlan::varying(texture)
        } else {
            SoilPlan::uniform(texture)
        }
    }

    /// The ground at the start; a seed determines its roughness.
    pub(super) fn terrain(&self, seed: u64) -> Terrain {
        match self.ground {
            GroundOrder::Flat => Terrain::flat(),
            GroundOrder::Undulating => Terrain::flat().with_undulation(Undulation {
                wavelength_m: 10.0,
                amplitude_m: 0.05,
            }),
            GroundOrder::Rough => {
                let mut noise = Noise::new(seed, ROUGHNESS_STREAM);
                Terrain::flat().with_roughness(&RoughnessConstants::class_d(), &mut noise)
            }
        }
    }
}
