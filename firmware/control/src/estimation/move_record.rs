//! Distance of a whole move, from rest to rest: measured, and expected by the valve curve.
//!
//! A valve curve that is shifted by `d` gives less flow during the whole move. A slower spool delays the flow, but does
//! not reduce its volume. The position error at rest therefore depends on the shift only, not on the lag:
//!
//! ```text
//! expected distance - measured distance = d * sensitivity        sensitivity = integral of dv/dI over the move
//! ```

use hitch_quantities::fixed::Divisor;
use hitch_quantities::units::{
    MicroLitrePerSecond, Micrometre, MicrometrePerSecond, Millisecond, SquareMillimetre,
};

use crate::valve::drop_scale::DropScale;
use crate::valve::phase::Direction;

/// Time at rest before the final position is read: oscillations of the load have decayed, and leakage is still small.
const SETTLING_TIME: Millisecond = Millisecond(500);

/// Records a move that is in progress or has just ended.
#[derive(Clone, Copy, Debug)]
pub struct MoveRecorder {
    direction: Direction,
    from: Micrometre,
    expected_nm: i32,
    /// Sensitivity as a volume at the reference drop of the valve table, nl/A.
    sensitivity_nl: i32,
    held: Millisecond,
}

/// The result of a move.
#[derive(Clone, Copy, Debug)]
pub struct MoveRecord {
    /// Direction of the move.
    pub direction: Direction,
    /// Distance that the valve curve predicts, positive in the direction of the move.
    pub expected: Micrometre,
    /// Expected less measured distance.
    pub missing: Micrometre,
    /// Position error for each ampere of shift of the curve.
    pub sensitivity: Micrometre,
    /// The same as a volume at the reference drop of the valve table, nl/A.
    pub sensitivity_nl: i32,
}

impl MoveRecorder {
    /// Starts a record at the rest position `from`.
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

    /// Direction of the move.
    #[must_use]
    pub const fn direction(&self) -> Direction {
        self.direction
    }

    /// One step with the speed of the model and its slope over the current, for each ampere. `rests`: the hitch rests, and
    /// its position is known. True once that was so for the settling time.
    pub fn step(
        &mut self,
        rests: bool,
        speed: MicrometrePerSecond,
        slope: MicroLitrePerSecond,
    ) -> bool {
        self.expected_nm = self.expected_nm.saturating_add(speed.0);
        self.sensitivity_nl = self.sensitivity_nl.saturating_add(slope.0);
        if rests {
            self.held = self.held.next();
        }
        self.held >= SETTLING_TIME
    }

    /// Ends the record without waiting for the settling time.
    pub fn finish(&mut self) {
        self.held = SETTLING_TIME;
    }

    /// The result of a move that ended at `rest`. `scale`: flow scale of the lowering valve; `area`: piston area.
    #[must_use]
    pub fn result(&self, rest: Micrometre, scale: DropScale, area: SquareMillimetre) -> MoveRecord {
        let along = |distance: i32| Micrometre(self.direction.sign(distance));
        // nl / mm2 = um. The distance is scaled, because the volume would saturate.
        let sensitivity = Divisor::at_least_one(area.0).divide(self.sensitivity_nl);
        let sensitivity = match self.direction {
            Direction::Lift => sensitivity,
            Direction::Lower => scale.to_present(MicroLitrePerSecond(sensitivity)).0,
        };
        let expected = along(Divisor::THOUSAND.divide(self.expected_nm));
        MoveRecord {
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
    fn the_sensitivity_of_the_lowering_valve_scales_with_the_drop() {
        // A third of a second on the rig's steep part, 616 ml/s for each ampere: 45 mm on 4537 mm2.
        let recorder = MoveRecorder {
            sensitivity_nl: 333 * 616_000,
            ..MoveRecorder::begin(Direction::Lower, Micrometre(100_000))
        };
        for drop in [5_000, 15_000, 25_000] {
            let scale = DropScale::new(&DropReference::new(MilliBar(15_000)), MilliBar(drop));
            let record = recorder.result(Micrometre(80_000), scale, SquareMillimetre(4_537));
            let exact = 333.0 * 616_000.0 / 4_537.0 * (f64::from(drop) / 15_000.0).sqrt();
            assert!(
                (f64::from(record.sensitivity.0) - exact).abs() < 10.0,
                "{drop} mbar: {:?}, not {exact} um/A",
                record.sensitivity
            );
        }
    }
}
