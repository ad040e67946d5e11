//! Versions of the standard.

/// A version of the Functional Mock-up Interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Version {
    /// FMI 2.0.
    Two,
    /// FMI 3.0.
    Three,
}

impl Version {
    /// All, the oldest one first.
    pub const ALL: [Self; 2] = [Self::Two, Self::Three];

    /// Its number, as units state it.
    #[must_use]
    pub const fn number(self) -> &'static str {
        match self {
            Self::Two => "2.0",
            Self::Three => "3.0",
        }
    }
}
