//! What the two valves are asked for, and what they do.

use hitch_quantities::units::{MicrometrePerSecond, MillimetrePerSecondSquared, Millisecond};

/// Way of the hitch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Up, by the lift valve.
    Lift,
    /// Down, by the lowering valve.
    Lower,
}

impl Direction {
    /// The way of a signed quantity; zero counts as up.
    #[must_use]
    pub const fn of(signed: i32) -> Self {
        if signed < 0 { Self::Lower } else { Self::Lift }
    }

    /// `value` as seen along this way: positive ahead.
    #[must_use]
    pub const fn sign(self, value: i32) -> i32 {
        match self {
            Self::Lift => value,
            Self::Lower => value.saturating_neg(),
        }
    }
}

/// What position or rate control asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Demand {
    /// Way to go.
    pub direction: Direction,
    /// Speed along it, not negative; zero asks to stop.
    pub speed: MicrometrePerSecond,
    /// How fast the speed may rise.
    pub acceleration: MillimetrePerSecondSquared,
}

/// What the valves do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Phase {
    /// Both coils off, the load rests on the check valve.
    #[default]
    Holding,
    /// One coil on.
    Moving {
        /// Which.
        direction: Direction,
        /// Ramped speed along the way.
        speed: MicrometrePerSecond,
    },
    /// Both coils off, waiting for the valves to close.
    Settling {
        /// Since when.
        waited: Millisecond,
    },
}

impl Phase {
    /// True while a coil is on.
    #[must_use]
    pub const fn is_moving(self) -> bool {
        matches!(self, Self::Moving { .. })
    }

    /// Signed speed that is asked of the valves.
    #[must_use]
    pub fn speed(self) -> MicrometrePerSecond {
        match self {
            Self::Moving { direction, speed } => MicrometrePerSecond(direction.sign(speed.0)),
            _ => MicrometrePerSecond::ZERO,
        }
    }
}
