//! What a unit simulates.

/// What is simulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// The plant of a model file.
    Plant,
    /// The firmware's controller with a calibration file.
    Controller,
}

impl Kind {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Plant, Self::Controller];

    /// Name of the library in a unit.
    #[must_use]
    pub const fn identifier(self) -> &'static str {
        match self {
            Self::Plant => "hitch_plant",
            Self::Controller => "hitch_controller",
        }
    }

    /// Name of the file in the `resources` folder.
    #[must_use]
    pub const fn file(self) -> &'static str {
        match self {
            Self::Plant => "model.toml",
            Self::Controller => "calibration.toml",
        }
    }
}
