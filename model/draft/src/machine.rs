//! The implement and its soil, as a campaign names them.

use hitch_field::draft::{DraftCoefficients, Texture};

/// What the standard's table says of one kind of implement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kind {
    /// Its name in a campaign.
    pub name: &'static str,
    /// Its row.
    pub row: DraftCoefficients,
    /// Whether its width is a number of tools; else it is in m.
    pub counts_tools: bool,
}

/// The kinds of the table.
pub const KINDS: [Kind; 5] = [
    kind("subsoiler", DraftCoefficients::SUBSOILER, true),
    kind(
        "mouldboard-plough",
        DraftCoefficients::MOULDBOARD_PLOUGH,
        false,
    ),
    kind("chisel-plough", DraftCoefficients::CHISEL_PLOUGH, true),
    kind("sweep-plough", DraftCoefficients::SWEEP_PLOUGH, false),
    kind(
        "field-cultivator",
        DraftCoefficients::FIELD_CULTIVATOR,
        true,
    ),
];

const fn kind(name: &'static str, row: DraftCoefficients, counts_tools: bool) -> Kind {
    Kind {
        name,
        row,
        counts_tools,
    }
}

/// The textures of the standard with their names.
pub const TEXTURES: [(&str, Texture); 3] = [
    ("fine", Texture::Fine),
    ("medium", Texture::Medium),
    ("coarse", Texture::Coarse),
];

/// The name of a texture.
#[must_use]
pub fn texture_name(texture: Texture) -> &'static str {
    let mut known = TEXTURES.iter();
    known
        .find(|(_, other)| *other == texture)
        .map_or("", |(name, _)| name)
}

/// An implement in a soil.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Machine {
    /// Its kind.
    pub kind: Kind,
    /// Its width in m, or its number of tools.
    pub width: f64,
    /// Texture of the soil.
    pub texture: Texture,
}

impl Machine {
    /// `F A`, `F B`, `F C` of the standard: N per cm of depth and per m or tool, and per (km/h) to the power of the index.
    #[must_use]
    pub fn standard(&self) -> [f64; 3] {
        let row = &self.kind.row;
        let factor = row.soil_factor(self.texture);
        [
            row.constant_n_per_cm,
            row.linear_n_h_per_cm_km,
            row.square_n_h2_per_cm_km2,
        ]
        .map(|coefficient| factor * coefficient)
    }

    /// Unit of the width in words.
    #[must_use]
    pub fn width_unit(&self) -> &'static str {
        if self.kind.counts_tools { "tool" } else { "m" }
    }
}

/// `a + b S + c S²`, of three coefficients at a speed in km/h.
#[must_use]
pub fn at_speed(coefficients: &[f64; 3], speed_km_h: f64) -> f64 {
    let [a, b, c] = coefficients;
    a + speed_km_h * (b + speed_km_h * c)
}
