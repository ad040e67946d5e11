//! Eighths of a millisecond, for lags.

use hitch_quantities::fixed::Divisor;
use hitch_quantities::units::{Microsecond, Millisecond};

/// A time in milliseconds as a fixed-point number with three fractional bits (Q3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct MillisecondQ3(pub i32);

impl MillisecondQ3 {
    /// Units in a second.
    pub const IN_SECOND: Divisor = Divisor::at_least_one(8_000);

    /// The time rounded to milliseconds, at least one, as a divisor.
    #[must_use]
    pub const fn divisor(self) -> Divisor {
        Divisor::at_least_one(self.0.saturating_add(4) >> 3)
    }

    /// The time in whole milliseconds.
    #[must_use]
    pub const fn rounded(self) -> Millisecond {
        Millisecond(self.0.saturating_add(4) >> 3)
    }

    pub(super) fn limited(self, limit: Self) -> Self {
        self.max(Self(limit.0.saturating_neg())).min(limit)
    }
}

impl From<Microsecond> for MillisecondQ3 {
    fn from(time: Microsecond) -> Self {
        Self(time.0 / 125)
    }
}

impl From<Millisecond> for MillisecondQ3 {
    fn from(time: Millisecond) -> Self {
        // Milliseconds of a calibration are few.
        Self(time.0 << 3)
    }
}

impl core::ops::Sub for MillisecondQ3 {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0.saturating_sub(other.0))
    }
}

impl core::ops::Add for MillisecondQ3 {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0.saturating_add(other.0))
    }
}
