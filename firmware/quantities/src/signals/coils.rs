//! What the two coils are given.

use crate::units::{Duty, MilliAmp};

/// Currents of the two coils.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CoilCurrents {
    /// Lift coil.
    pub lift: MilliAmp,
    /// Lowering coil.
    pub lower: MilliAmp,
}

impl CoilCurrents {
    /// Both coils off.
    pub const OFF: Self = Self {
        lift: MilliAmp::ZERO,
        lower: MilliAmp::ZERO,
    };
}

/// Shares of the supply for both coils.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Duties {
    /// Lift coil.
    pub lift: Duty,
    /// Lowering coil.
    pub lower: Duty,
}
