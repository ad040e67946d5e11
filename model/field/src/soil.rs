//! The soil along the field: texture, strength, stones, and stretches that differ, as functions of the distance.

use crate::draft::Texture;
use crate::noise::Noise;
use crate::strength::{Strength, StrengthConstants};

/// A stretch that differs from the rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Stretch {
    /// Begin, m.
    pub from_m: f64,
    /// End, m.
    pub to_m: f64,
    /// Factor of the draft, 1.
    pub draft_factor: f64,
    /// Factor of the cone index, and with it of the mobility number of the tyres, 1.
    pub cone_factor: f64,
    /// Whether implements are raised here.
    pub is_headland: bool,
}

impl Stretch {
    /// A soft patch: half the cone index, and unchanged draft.
    #[must_use]
    pub fn soft_patch(from_m: f64, length_m: f64) -> Self {
        Self {
            from_m,
            to_m: from_m + length_m,
            draft_factor: 1.0,
            cone_factor: 0.5,
            is_headland: false,
        }
    }

    /// A headland, compacted by turning: 30 % more draft (Tullberg, J. agric. Engng Res. 2000, 75, 375: total draft with
    /// wheel traffic).
    #[must_use]
    pub fn headland(from_m: f64, length_m: f64) -> Self {
        Self {
            from_m,
            to_m: from_m + length_m,
            draft_factor: 1.3,
            cone_factor: 1.0,
            is_headland: true,
        }
    }

    fn contains(&self, distance_m: f64) -> bool {
        (self.from_m..self.to_m).contains(&distance_m)
    }
}

/// A stone: half a sine of force over its length, at shares that are as deep as it.
#[derive(Debug, Clone, PartialEq)]
pub struct Stone {
    /// Where the share meets it, m.
    pub at_m: f64,
    /// Its length along the field, m.
    pub length_m: f64,
    /// Depth of its top, m.
    pub top_m: f64,
    /// Largest force, N. The work done is `2/π` of force times length.
    pub peak_n: f64,
}

impl Stone {
    fn force_n(&self, share_m: f64, depth_m: f64) -> f64 {
        let part = (share_m - self.at_m) / self.length_m;
        if (0.0..1.0).contains(&part) && depth_m > 0.0 && depth_m >= self.top_m {
            self.peak_n * (std::f64::consts::PI * part).sin()
        } else {
            0.0
        }
    }
}

/// What a field is like.
#[derive(Debug, Clone, PartialEq)]
pub struct SoilPlan {
    /// Texture at the start.
    pub texture: Texture,
    /// Distances, m, ascending, and the texture from each on.
    pub texture_changes: Vec<(f64, Texture)>,
    /// Cone index outside of stretches, kPa.
    pub cone_index_kpa: f64,
    /// Variation of the strength.
    pub strength: StrengthConstants,
    /// Stretches; the factors of those that overlap multiply.
    pub stretches: Vec<Stretch>,
    /// Stones.
    pub stones: Vec<Stone>,
}

impl SoilPlan {
    /// A field of one texture with the usual variation. The cone index of 700 kPa is chosen: a mobility number of 28 with
    /// the tractor of this crate, between tilled (20) and firm (55) soil.
    #[must_use]
    pub fn varying(texture: Texture) -> Self {
        Self {
            texture,
            texture_changes: Vec::new(),
            cone_index_kpa: 700.0,
            strength: StrengthConstants::default(),
            stretches: Vec::new(),
            stones: Vec::new(),
        }
    }

    /// A field of one texture without variation.
    #[must_use]
    pub fn uniform(texture: Texture) -> Self {
        let mut plan = Self::varying(texture);
        plan.strength.coefficient_of_variation = 0.0;
        plan
    }
}

/// The soil along one pass.
#[derive(Debug, Clone)]
pub struct Soil {
    plan: SoilPlan,
    strength: Strength,
}

impl Soil {
    /// The soil of a plan; the noise draws its strength.
    #[must_use]
    pub fn new(plan: SoilPlan, noise: Noise) -> Self {
        let strength = Strength::new(&plan.strength, noise);
        Self { plan, strength }
    }

    /// Gives the field another texture from a distance on, m.
    pub fn change_texture(&mut self, from_m: f64, texture: Texture) {
        let changes = &mut self.plan.texture_changes;
        changes.retain(|(known_m, _)| *known_m < from_m);
        changes.push((from_m, texture));
    }

    /// Adds a stretch that differs.
    pub fn add_stretch(&mut self, stretch: Stretch) {
        self.plan.stretches.push(stretch);
    }

    /// Texture at a distance, m.
    #[must_use]
    pub fn texture(&self, distance_m: f64) -> Texture {
        let changes = self.plan.texture_changes.iter();
        changes
            .take_while(|(from_m, _)| *from_m <= distance_m)
            .last()
            .map_or(self.plan.texture, |(_, texture)| *texture)
    }

    /// Factor of the draft at a distance, m, which does not decrease from call to call.
    pub fn draft_factor(&mut self, distance_m: f64) -> f64 {
        let stretches = self.stretches_at(distance_m);
        let factor: f64 = stretches.map(|stretch| stretch.draft_factor).product();
        factor * self.strength.factor_at(distance_m)
    }

    /// Force of stones on a share at a distance and a depth, m, in N.
    #[must_use]
    pub fn stone_force_n(&self, distance_m: f64, depth_m: f64) -> f64 {
        let stones = self.plan.stones.iter();
        stones.map(|stone| stone.force_n(distance_m, depth_m)).sum()
    }

    /// Cone index at a distance, m, in kPa.
    #[must_use]
    pub fn cone_index_kpa(&self, distance_m: f64) -> f64 {
        let stretches = self.stretches_at(distance_m);
        self.plan.cone_index_kpa
            * stretches
                .map(|stretch| stretch.cone_factor)
                .product::<f64>()
    }

    /// Whether the cone index at a distance, m, is below that of the field.
    #[must_use]
    pub fn is_soft(&self, distance_m: f64) -> bool {
        self.cone_index_kpa(distance_m) < self.plan.cone_index_kpa
    }

    /// Whether a distance, m, is in a headland.
    #[must_use]
    pub fn is_headland(&self, distance_m: f64) -> bool {
        self.stretches_at(distance_m)
            .any(|stretch| stretch.is_headland)
    }

    fn stretches_at(&self, distance_m: f64) -> impl Iterator<Item = &Stretch> {
        let stretches = self.plan.stretches.iter();
        stretches.filter(move |stretch| stretch.contains(distance_m))
    }
}
