//! Classes of calibration values: who may change which value, when, and in which direction without the key.
//!
//! Each scalar is declared with its class; one without it does not compile. The tables of valves and linkage are of the class
//! [`Class::Machine`].

/// Direction in which a value of the safety class becomes stricter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tightening {
    /// A larger value is stricter.
    Up,
    /// A smaller value is stricter.
    Down,
    /// Neither direction is always stricter: changed with the key only.
    None,
}

impl Tightening {
    /// Whether `new` is looser than `present`, or not known to be stricter.
    #[must_use]
    pub const fn loosens(self, present: i32, new: i32) -> bool {
        match self {
            Self::Up => new < present,
            Self::Down => new > present,
            Self::None => new != present,
        }
    }
}

/// Class of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// Ramps and gains, which the controller takes up from wherever it is: tuned while the hitch moves.
    Live,
    /// What the machine is: written at rest, with the service contact closed.
    Machine,
    /// Limits, thresholds and times of the envelope, of the sensors and of the travel: as [`Self::Machine`], stored in
    /// an own block, and loosened with the key only.
    Safety(Tightening),
}

impl Class {
    /// Safety class, stricter if larger.
    pub const UP: Self = Self::Safety(Tightening::Up);
    /// Safety class, stricter if smaller.
    pub const DOWN: Self = Self::Safety(Tightening::Down);
    /// Safety class, changed with the key only.
    pub const KEY_ONLY: Self = Self::Safety(Tightening::None);

    /// Whether a value of this class may be changed while the hitch moves.
    #[must_use]
    pub const fn is_live(self) -> bool {
        matches!(self, Self::Live)
    }

    /// Whether a value of this class belongs to the safety block.
    #[must_use]
    pub const fn is_safety(self) -> bool {
        matches!(self, Self::Safety(_))
    }

    /// Whether changing a value from `present` to `new` requires the key.
    #[must_use]
    pub const fn requires_key(self, present: i32, new: i32) -> bool {
        match self {
            Self::Safety(tightening) => tightening.loosens(present, new),
            Self::Live | Self::Machine => false,
        }
    }
}
