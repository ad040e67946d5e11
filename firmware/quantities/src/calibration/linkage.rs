//! The linkage: rocker angle to piston travel, as a table that comes with the calibration.
//!
//! Control happens in piston travel, where a flow is a speed whatever the geometry. The table's axis is
//! uniform in angle, so a look-up is a division and one interpolation.

use crate::fixed::{Divisor, interpolate};
use crate::units::{Micrometre, MicrometrePerSecond, MilliDegree, MilliDegreePerSecond};

/// Number of table points: 2 degrees apart, straight lines are within 17 um (0.01 degree) of the circles.
pub const LINKAGE_POINTS: usize = 47;

/// Piston travel at equally spaced rocker angles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct LinkageTable {
    /// Angle of the first point.
    pub first_angle: MilliDegree,
    /// Angle from point to point.
    pub angle_step: MilliDegree,
    /// Travel at each point, strictly rising.
    pub travel: [Micrometre; LINKAGE_POINTS],
}

/// One straight piece of the table.
struct Cell {
    start: (i32, i32),
    end: (i32, i32),
}

impl LinkageTable {
    /// Piston travel at a rocker angle; the end pieces are extended beyond the table.
    #[must_use]
    pub fn travel(&self, angle: MilliDegree) -> Micrometre {
        let cell = self.cell(angle);
        Micrometre(interpolate(cell.start, cell.end, angle.0))
    }

    /// Piston speed that turns the rocker at `rate` when it stands at `angle`.
    #[must_use]
    pub fn piston_speed(
        &self,
        angle: MilliDegree,
        rate: MilliDegreePerSecond,
    ) -> MicrometrePerSecond {
        let cell = self.cell(angle);
        let rise = cell.end.1.saturating_sub(cell.start.1);
        let run = Divisor::at_least_one(cell.end.0.saturating_sub(cell.start.0));
        MicrometrePerSecond(rate.0).scaled(rise, run)
    }

    /// Rocker angle at a piston travel (for display and telemetry).
    #[must_use]
    pub fn angle(&self, travel: Micrometre) -> MilliDegree {
        let above = self.travel.partition_point(|&point| point <= travel);
        let index = above.saturating_sub(1).min(LINKAGE_POINTS - 2);
        let cell = self.cell_at(index);
        let (start, end) = ((cell.start.1, cell.start.0), (cell.end.1, cell.end.0));
        MilliDegree(interpolate(start, end, travel.0))
    }

    fn cell(&self, angle: MilliDegree) -> Cell {
        let past = (angle - self.first_angle)
            .max(MilliDegree::ZERO)
            .0
            .unsigned_abs();
        let step = self.angle_step.0.max(1).unsigned_abs();
        let index = past.checked_div(step).unwrap_or(0);
        self.cell_at(usize::try_from(index).unwrap_or(0).min(LINKAGE_POINTS - 2))
    }

    fn cell_at(&self, index: usize) -> Cell {
        let offset = i32::try_from(index)
            .unwrap_or(0)
            .saturating_mul(self.angle_step.0);
        let left = self.first_angle.0.saturating_add(offset);
        let travel = |at: usize| self.travel.get(at).map_or(0, |point| point.0);
        Cell {
            start: (left, travel(index)),
            end: (
                left.saturating_add(self.angle_step.0),
                travel(index.saturating_add(1)),
            ),
        }
    }
}
