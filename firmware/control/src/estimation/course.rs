//! How far a whole move went, from rest to rest, and how far the valve's curve says that it should have gone.
//!
//! A curve that lies `d` further right gives less flow all the way; a spool that is slower delays the flow, but loses
//! none of it. So at rest the hitch is behind by what the curve is off, whatever the lag:
//!
//! ```text
//! expected way - measured way = d * sensitivity        sensitivity = integral of dv/dI over the move
//! ```

use hitch_quantities::fixed::Divisor;
use hitch_quantities::units::{MicroLitrePerSecond, Micrometre, Millisecond, SquareMillimetre};

use super::motion::Motion;
use crate::valve::drop_scale::DropScale;
use crate::valve::phase::{Direction, Phase};

/// How long a hitch has to hold until its place is read: its load has swung out, and a leak hasn't carried it far.
const REST: Millisecond = Millisecond(500);

/// A move under way, or just over.
#[derive(Clone, Copy, Debug)]
pub struct Course {
    direction: Direction,
    from: Micrometre,
    expected_nm: i32,
    /// The sensitivity as a volume at the drop of the valve's table, nl for each ampere.
    sensitivity_nl: i32,
    held: Millisecond,
}

/// What a move told.
#[derive(Clone, Copy, Debug)]
pub struct Told {
    /// Which valve made it.
    pub direction: Direction,
    /// Way that the valve's curve says, along the move.
    pub expected: Micrometre,
    /// ... and what is missing from it.
    pub missing: Micrometre,
    /// What would be missing for each ampere that the curve is off.
    pub sensitivity: Micrometre,
    /// The same as a volume at the drop of the valve's table, nl for each ampere.
    pub sensitivity_nl: i32,
}

impl Course {
    /// A move begins at `from`, where the hitch rested.
    #[must_use]
    pub fn begin(direction: Direction, from: Micrometre) -> Self {
        Self {
            direction,
            from,
            expected_nm: 0,
            sensitivity_nl: 0,
            held: Millisecond::ZERO,
        }
    }

    /// Way of the move.
    #[must_use]
    pub const fn direction(&self) -> Direction {
        self.direction
    }

    /// One step; true once the hitch has rested for long enough.
    pub fn step(&mut self, phase: Phase, motion: &Motion) -> bool {
        self.expected_nm = self.expected_nm.saturating_add(motion.model_speed().0);
        self.sensitivity_nl = self.sensitivity_nl.saturating_add(motion.slope().0);
        if phase == Phase::Holding {
            self.held = self.held.next();
        }
        self.held >= REST
    }

    /// The hitch has rested for long enough.
    pub fn end(&mut self) {
        self.held = REST;
    }

    /// What a move told that ended at `rest`, through a valve with this `scale` and into a cylinder of this `area`.
    #[must_use]
    pub fn told(&self, rest: Micrometre, scale: DropScale, area: SquareMillimetre) -> Told {
        let along = |way: i32| Micrometre(self.direction.sign(way));
        // nl over mm2 are um: a scale takes ways, where it would cut the volume short.
        let sensitivity = Divisor::at_least_one(area.0).divide(self.sensitivity_nl);
        let sensitivity = match self.direction {
            Direction::Lift => sensitivity,
            Direction::Lower => scale.to_present(MicroLitrePerSecond(sensitivity)).0,
        };
        let expected = along(Divisor::THOUSAND.divide(self.expected_nm));
        Told {
            direction: self.direction,
            expected,
            missing: expected - along((rest - self.from).0),
            sensitivity: Micrometre(sensitivity),
            sensitivity_nl: self.sensitivity_nl,
        }
    }
}

#[cfg(test)]
mod tests {
    use hitch_quantities::units::MilliBar;

    use super::*;
    use crate::valve::drop_scale::DropReference;

    #[test]
    fn a_lowering_valve_that_opens_fully_makes_its_offset_felt_at_any_drop() {
        // A third of a second on the rig's steep part, 616 ml/s for each ampere: 45 mm on 4537 mm2.
        let course = Course {
            sensitivity_nl: 333 * 616_000,
            ..Course::begin(Direction::Lower, Micrometre(100_000))
        };
        for drop in [5_000, 15_000, 25_000] {
            let scale = DropScale::new(&DropReference::new(MilliBar(15_000)), MilliBar(drop));
            let told = course.told(Micrometre(80_000), scale, SquareMillimetre(4_537));
            let exact = 333.0 * 616_000.0 / 4_537.0 * (f64::from(drop) / 15_000.0).sqrt();
            assert!(
                (f64::from(told.sensitivity.0) - exact).abs() < 10.0,
                "{drop} mbar: {:?}, not {exact} um/A",
                told.sensitivity
            );
        }
    }
}
