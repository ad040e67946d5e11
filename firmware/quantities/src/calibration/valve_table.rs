//! The curve of a valve: which current lets which flow through.
//!
//! A table holds flow over current from the threshold (the last current without flow) to saturation
//! (the first current with all of it), with the breakpoints where the valve has its kinks: straight
//! lines between them are the valve's curve, not an approximation on a grid.

use crate::fixed::Divisor;
use crate::units::{MicroLitrePerSecond, MilliAmp};

/// Room for breakpoints in a valve table.
pub const VALVE_POINTS: usize = 32;

/// Least distance of two points of a table in flow: with so much, flows are whole numbers finely enough for a table of any
/// range.
const LEAST_GAP: MicroLitrePerSecond = MicroLitrePerSecond(5);

/// Bits behind the point of a slope of the curve in ul/s/mA: with the largest flow they fill a word.
const SLOPE_BITS: u32 = 8;

/// A breakpoint of a valve table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct ValvePoint {
    /// Flow through the valve.
    pub flow: MicroLitrePerSecond,
    /// Coil current that gives it.
    pub current: MilliAmp,
}

/// Flow over current of one valve, both strictly rising, from threshold to saturation; flows are at least
/// [`ValveTable::least_gap`] apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct ValveTable {
    /// Number of points in use.
    pub count: u32,
    /// The points; those not in use are zero.
    pub points: [ValvePoint; VALVE_POINTS],
}

impl ValveTable {
    /// The points in use.
    #[must_use]
    pub fn used(&self) -> &[ValvePoint] {
        let count = usize::try_from(self.count)
            .unwrap_or(VALVE_POINTS)
            .min(VALVE_POINTS);
        self.points.get(..count).unwrap_or(&[])
    }

    /// Largest current without flow.
    #[must_use]
    pub fn threshold(&self) -> MilliAmp {
        self.used()
            .first()
            .map_or(MilliAmp::ZERO, |point| point.current)
    }

    /// Largest flow.
    #[must_use]
    pub fn saturation(&self) -> MicroLitrePerSecond {
        self.used()
            .last()
            .map_or(MicroLitrePerSecond::ZERO, |point| point.flow)
    }

    /// How far apart in flow two of its points have to be at least: 0.25 % of the largest flow, and 5 ul/s. Then no two are
    /// in one cell of the inverse map (`inverse_curve` of hitch-control), and a kink is found with one comparison.
    #[must_use]
    pub fn least_gap(&self) -> MicroLitrePerSecond {
        Self::least_gap_of(self.saturation())
    }

    /// The same for a table with this largest flow.
    #[must_use]
    pub fn least_gap_of(saturation: MicroLitrePerSecond) -> MicroLitrePerSecond {
        const SHARES: u32 = 400;
        let gap = saturation.0.unsigned_abs().div_ceil(SHARES);
        MicroLitrePerSecond(gap.cast_signed().max(LEAST_GAP.0))
    }

    /// Flow that `current` lets through (at the table's own pressure drop).
    #[must_use]
    pub fn flow(&self, current: MilliAmp) -> MicroLitrePerSecond {
        self.flow_and_slope(current).0
    }

    /// The same flow, and its slope: how much more an ampere more would let through.
    #[must_use]
    pub fn flow_and_slope(&self, current: MilliAmp) -> (MicroLitrePerSecond, MicroLitrePerSecond) {
        if current <= self.threshold() {
            return (MicroLitrePerSecond::ZERO, MicroLitrePerSecond::ZERO);
        }
        let Some((left, right)) = self.piece(current) else {
            return (self.saturation(), MicroLitrePerSecond::ZERO);
        };
        let run = Divisor::at_least_one((right.current - left.current).0);
        let slope = run.quotient((right.flow - left.flow).0.cast_unsigned() << SLOPE_BITS);
        let along = (current - left.current).0.cast_unsigned();
        // Not above the rise, since it is rounded down: it fits.
        let rise = along.wrapping_mul(slope) >> SLOPE_BITS;
        let by_ampere = u64::from(slope).wrapping_mul(1000) >> SLOPE_BITS;
        (
            left.flow + MicroLitrePerSecond(rise.cast_signed()),
            MicroLitrePerSecond(i32::try_from(by_ampere).unwrap_or(i32::MAX)),
        )
    }

    /// Least current that lets `flow` through, or the saturation's.
    #[must_use]
    pub fn current(&self, flow: MicroLitrePerSecond) -> MilliAmp {
        let points = self.used();
        let above = points.partition_point(|point| point.flow < flow);
        let Some(right) = points.get(above) else {
            return points.last().map_or(MilliAmp::ZERO, |point| point.current);
        };
        let Some(left) = above.checked_sub(1).and_then(|below| points.get(below)) else {
            return right.current;
        };
        let run = Divisor::at_least_one((right.flow - left.flow).0);
        let share = (flow - left.flow)
            .0
            .saturating_mul((right.current - left.current).0);
        left.current + MilliAmp(run.divide(share))
    }

    /// The piece of the curve that `current` is in, if it is in one.
    fn piece(&self, current: MilliAmp) -> Option<(&ValvePoint, &ValvePoint)> {
        let points = self.used();
        let above = points.partition_point(|point| point.current < current);
        let left = points.get(above.checked_sub(1)?)?;
        Some((left, points.get(above)?))
    }
}
