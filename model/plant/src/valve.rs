//! The two solenoid valves, and the pair of their currents.

use crate::components::orifice_valve::OrificeValve;
use crate::constants::Constants;

/// One of the two solenoid valves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Valve {
    /// The lift valve, pump to cylinder.
    Lift,
    /// The lowering valve, cylinder to tank.
    Lower,
}

impl Valve {
    /// Both.
    pub const BOTH: [Self; 2] = [Self::Lift, Self::Lower];

    /// Its key in files.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::Lift => "lift_valve",
            Self::Lower => "lower_valve",
        }
    }

    /// The valve in a model's constants.
    #[must_use]
    pub fn of(self, constants: &Constants) -> &OrificeValve {
        match self {
            Self::Lift => &constants.lift_valve,
            Self::Lower => &constants.lower_valve,
        }
    }

    /// The valve in a model's constants, mutable.
    pub fn of_mut(self, constants: &mut Constants) -> &mut OrificeValve {
        match self {
            Self::Lift => &mut constants.lift_valve,
            Self::Lower => &mut constants.lower_valve,
        }
    }
}

/// The two coil currents, A.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Currents {
    /// Lift solenoid, A.
    pub lift_a: f64,
    /// Lowering solenoid, A.
    pub lower_a: f64,
}

impl Currents {
    /// The current of one valve, A; the other is off.
    #[inline(always)]
    #[must_use]
    pub fn only(valve: Valve, current_a: f64) -> Self {
        Self::default().map(|each, _| if each == valve { current_a } else { 0.0 })
    }

    /// Current of a valve, A.
    #[inline(always)]
    #[must_use]
    pub fn of(self, valve: Valve) -> f64 {
        match valve {
            Valve::Lift => self.lift_a,
            Valve::Lower => self.lower_a,
        }
    }

    /// Applies a function to both currents.
    #[inline(always)]
    #[must_use]
    pub fn map(self, mut change: impl FnMut(Valve, f64) -> f64) -> Self {
        Self {
            lift_a: change(Valve::Lift, self.lift_a),
            lower_a: change(Valve::Lower, self.lower_a),
        }
    }

    /// Linear interpolation between these currents and others.
    #[inline(always)]
    #[must_use]
    pub fn towards(self, to: Self, share: f64) -> Self {
        Self {
            lift_a: self.lift_a + (to.lift_a - self.lift_a) * share,
            lower_a: self.lower_a + (to.lower_a - self.lower_a) * share,
        }
    }

    /// Largest difference of a current, A.
    #[inline(always)]
    #[must_use]
    pub fn largest_difference_a(self, other: Self) -> f64 {
        let lift_a = (self.lift_a - other.lift_a).abs();
        lift_a.max((self.lower_a - other.lower_a).abs())
    }
}
