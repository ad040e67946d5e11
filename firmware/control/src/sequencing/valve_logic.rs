//! Check-valve logic: which coil may be on, and how the speed ramps.
//!
//! At rest both coils are off and the check valve carries the load. Between any two moves there is a
//! dwell with both coils off, so that the check valve seats before the other spool opens.
//!
//! ```text
//!             demand                    speed ramped to zero, or cut
//! +---------+ -----> +-----------------------+ -----> +----------+
//! | Holding |        | Moving {Lift | Lower} |        | Settling |
//! +---------+        +-----------------------+        +----------+
//!      ^                                                   |
//!      +---------------------------------------------------+
//!                 dwell over and spools closed
//! ```

use hitch_quantities::calibration::design_parameters::{HoldParameters, PositionParameters};
use hitch_quantities::units::{MicrometrePerSecond, MillimetrePerSecondSquared, Millisecond};

use crate::valve::phase::{Demand, Direction, Phase};

impl Phase {
    /// One step with a demand (`None`: none). `available`: what the valve can give along the way;
    /// `still`: the spools are closed.
    #[must_use]
    pub fn step(
        self,
        demand: Option<Demand>,
        available: MicrometrePerSecond,
        still: bool,
        position: &PositionParameters,
        hold: &HoldParameters,
    ) -> Self {
        match self {
            Self::Holding => Self::start(demand),
            Self::Moving { direction, speed } => Self::ramp_speed(
                direction,
                speed,
                demand,
                available,
                position.abort_deceleration,
            ),
            Self::Settling { waited } if still && waited >= hold.dwell => Self::Holding,
            Self::Settling { waited } => Self::Settling {
                waited: waited.next(),
            },
        }
    }

    /// The same, but no faster than `before`: a ramp that waits.
    #[must_use]
    pub fn limited_to_speed_of(self, before: Self) -> Self {
        match (self, before) {
            (Self::Moving { direction, speed }, Self::Moving { speed: most, .. }) => Self::Moving {
                direction,
                speed: speed.min(most),
            },
            (phase, _) => phase,
        }
    }

    /// Cuts the coils at once.
    #[must_use]
    pub fn cut(self) -> Self {
        match self {
            Self::Moving { .. } => Self::Settling {
                waited: Millisecond::ZERO,
            },
            other => other,
        }
    }

    fn start(demand: Option<Demand>) -> Self {
        match demand {
            Some(demand) if demand.speed > MicrometrePerSecond::ZERO => Self::Moving {
                direction: demand.direction,
                speed: demand.speed.min(speed_change_per_step(demand.acceleration)),
            },
            _ => Self::Holding,
        }
    }

    fn ramp_speed(
        direction: Direction,
        speed: MicrometrePerSecond,
        demand: Option<Demand>,
        available: MicrometrePerSecond,
        abort: MillimetrePerSecondSquared,
    ) -> Self {
        let demand = demand.filter(|demand| demand.direction == direction);
        let goal = demand.map_or(MicrometrePerSecond::ZERO, |demand| {
            demand.speed.min(available)
        });
        let rise = demand.map_or(MicrometrePerSecond::ZERO, |demand| {
            speed_change_per_step(demand.acceleration)
        });
        let speed = goal
            .min(speed + rise)
            .max(speed - speed_change_per_step(abort));
        if speed <= MicrometrePerSecond::ZERO {
            return Self::Settling {
                waited: Millisecond::ZERO,
            };
        }
        Self::Moving { direction, speed }
    }
}

/// Change of speed in one millisecond: 1 mm/s2 is 1 um/s a millisecond.
fn speed_change_per_step(slope: MillimetrePerSecondSquared) -> MicrometrePerSecond {
    MicrometrePerSecond(slope.0.max(1))
}
