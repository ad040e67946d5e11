//! Units as types: each quantity is a signed 32-bit integer that knows what it counts.
//!
//! Ranges of a hitch fit with room to spare (travel 158 000 um, flow 2 000 000 ul/s, pressure
//! 250 000 mbar), and the arithmetic saturates, so an absurd input gives an absurd but bounded number
//! instead of a wrapped sign. A millampere is 19 ul/s .. 37 ul/s of flow per step of the coil current:
//! finer than the milliampere to which the inverse valve map is held.

use super::fixed::{Divisor, mul_div};

/// What every quantity has in common: its raw integer, and how tools show it.
pub trait Quantity: Copy {
    /// Suffix of the engineering unit, as in the keys of a calibration file (`deg`, `bar`, ...).
    const SUFFIX: &'static str;
    /// Raw counts in one engineering unit.
    const COUNTS_PER_UNIT: i32;
    /// The quantity of `counts`.
    fn from_counts(counts: i32) -> Self;
    /// The raw integer.
    fn counts(self) -> i32;
}

/// Declares quantities: `Name, "suffix of the engineering unit", raw counts in one;`.
macro_rules! quantities {
    ($($(#[$doc:meta])* $name:ident, $suffix:literal, $counts:literal;)+) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(transparent)]
        pub struct $name(pub i32);

        impl $name {
            /// Nothing of it.
            pub const ZERO: Self = Self(0);

            /// Magnitude; the most negative count gives the largest positive one.
            #[must_use]
            pub const fn magnitude(self) -> Self {
                Self(self.0.saturating_abs())
            }

            /// The value, brought between `low` and `high` (`high` wins if they are crossed).
            #[must_use]
            pub fn limited(self, low: Self, high: Self) -> Self {
                self.max(low).min(high)
            }

            /// `self * numerator / denominator`, rounded to nearest, saturating.
            #[must_use]
            pub fn scaled(self, numerator: i32, denominator: Divisor) -> Self {
                Self(mul_div(self.0, numerator, denominator))
            }
        }

        impl core::ops::Add for $name {
            type Output = Self;
            fn add(self, other: Self) -> Self {
                Self(self.0.saturating_add(other.0))
            }
        }

        impl core::ops::Sub for $name {
            type Output = Self;
            fn sub(self, other: Self) -> Self {
                Self(self.0.saturating_sub(other.0))
            }
        }

        impl core::ops::Neg for $name {
            type Output = Self;
            fn neg(self) -> Self {
                Self(self.0.saturating_neg())
            }
        }

        impl Quantity for $name {
            const SUFFIX: &'static str = $suffix;
            const COUNTS_PER_UNIT: i32 = $counts;
            fn from_counts(counts: i32) -> Self {
                Self(counts)
            }
            fn counts(self) -> i32 {
                self.0
            }
        }
    )+};
}

quantities! {
    /// Angle of the rocker arm (grows as the hitch rises), in millidegrees.
    MilliDegree, "deg", 1000;
    /// Angular speed of the rocker arm (positive: rising), in millidegrees a second.
    MilliDegreePerSecond, "deg_per_s", 1000;
    /// Piston travel (grows as the hitch rises), in micrometres.
    Micrometre, "mm", 1000;
    /// Piston speed (positive: rising), in micrometres a second.
    MicrometrePerSecond, "mm_per_s", 1000;
    /// Piston acceleration, in millimetres per second squared.
    MillimetrePerSecondSquared, "mm_per_s2", 1;
    /// Piston area, in square millimetres.
    SquareMillimetre, "mm2", 1;
    /// Oil flow, in microlitres (cubic millimetres) a second; 1 l/min is 16 667 of them.
    MicroLitrePerSecond, "ul_per_s", 1;
    /// Coil current, in milliamperes.
    MilliAmp, "a", 1000;
    /// Slope of a coil current, in amperes a second, which is milliamperes a millisecond.
    AmperePerSecond, "a_per_s", 1;
    /// Slow slope of a coil current, in milliamperes a second, which is microamperes a millisecond.
    MilliAmpPerSecond, "a_per_s", 1000;
    /// Pressure above ambient, in millibars.
    MilliBar, "bar", 1000;
    /// Temperature, in thousandths of a degree Celsius.
    MilliCelsius, "c", 1000;
    /// Supply voltage, in millivolts.
    MilliVolt, "v", 1000;
    /// Time, in milliseconds: the controller's own steps.
    Millisecond, "ms", 1;
    /// Time by a free-running clock, in microseconds.
    Microsecond, "us", 1;
    /// Share of the supply voltage, in thousandths of a percent.
    Duty, "percent", 1000;
    /// Resistance, in milliohms; also a gain from current to voltage.
    MilliOhm, "ohm", 1000;
    /// Change of a resistance, in milliohms a second.
    MilliOhmPerSecond, "ohm_per_s", 1000;
    /// A share, in thousandths.
    PerMille, "percent", 10;
    /// Speed of the engine, in revolutions a minute.
    RevolutionPerMinute, "rpm", 1;
    /// A number of occurrences.
    Count, "count", 1;
    /// A gain from distance to speed, in 1/s.
    PerSecond, "per_s", 1;
    /// Output of a ratiometric sensor over its supply, in thousandths of a percent.
    SupplyShare, "percent", 1000;
    /// Force, in newtons; a draft is positive when the implement is pulled.
    Newton, "n", 1;
    /// Change of a force with the angle of the rocker arm, in newtons a degree.
    NewtonPerDegree, "n_per_deg", 1;
    /// A gain from pressure to piston speed, in micrometres a second for a bar.
    MicrometrePerSecondPerBar, "mm_per_s_per_bar", 1000;
    /// Frequency, in millihertz.
    MilliHertz, "hz", 1000;
    /// Length along the ground, in millimetres.
    Millimetre, "m", 1000;
    /// Speed over the ground or of the wheels, in millimetres a second.
    MillimetrePerSecond, "m_per_s", 1000;
}

impl PerMille {
    /// The whole.
    pub const WHOLE: Self = Self(1_000);
}

impl Duty {
    /// On throughout.
    pub const WHOLE: Self = Self(100_000);
}

impl Millisecond {
    /// One controller step later.
    #[must_use]
    pub fn next(self) -> Self {
        self + Self(1)
    }

    /// For how long a condition has held, one controller step later: zero after a step in which it does not hold.
    #[must_use]
    pub fn counted_while(self, holds: bool) -> Self {
        if holds { self.next() } else { Self::ZERO }
    }

    /// This time as a divisor (at least one step).
    #[must_use]
    pub fn divisor(self) -> Divisor {
        Divisor::at_least_one(self.0)
    }
}
