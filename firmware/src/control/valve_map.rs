//! The valve map and its inverse: which current lets which flow through.
//!
//! A table holds flow over current from the threshold (the last current without flow) to saturation
//! (the first current with all of it), with the breakpoints where the valve has its kinks: straight
//! lines between them are the valve's curve, not an approximation on a grid.
//!
//! * No flow is no current, and no current is no flow.
//! * The smallest flow asks for just more than the threshold, any flow beyond saturation for the
//!   saturation current.
//! * Lifting is compensated: flow depends on the current alone. Lowering goes with the root of the
//!   pressure drop (turbulent orifice, `Q = Cd A sqrt(2 dp / rho)`), so a flow is brought to the
//!   drop at which the table was measured: `Q_ref = Q sqrt(dp_ref / dp)`.

use super::fixed::{Breakpoint, Divisor, interpolate, mul_shift_16, square_root_of_ratio_16};
use super::units::{MicroLitrePerSecond, MilliAmp, MilliBar, MillimetrePerSecondSquared};

/// Room for breakpoints in a valve table.
pub const VALVE_POINTS: usize = 32;

/// A breakpoint of a valve table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct ValvePoint {
    /// Flow through the valve.
    pub flow: MicroLitrePerSecond,
    /// Coil current that gives it.
    pub current: MilliAmp,
}

/// Flow over current of one valve, both strictly rising, from threshold to saturation.
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

    /// Current that lets `flow` through (at the table's own pressure drop).
    #[must_use]
    #[inline(never)]
    pub fn current(&self, flow: MicroLitrePerSecond) -> MilliAmp {
        if flow <= MicroLitrePerSecond::ZERO {
            return MilliAmp::ZERO;
        }
        let current = self.look_up(flow.0, |point| (point.flow.0, point.current.0));
        MilliAmp(current).max(self.threshold() + MilliAmp(1))
    }

    /// Flow that `current` lets through (at the table's own pressure drop).
    #[must_use]
    pub fn flow(&self, current: MilliAmp) -> MicroLitrePerSecond {
        self.flow_and_slope(current).0
    }

    /// The same flow, and its slope: how much more an ampere more would let through.
    #[must_use]
    #[inline(never)]
    pub fn flow_and_slope(&self, current: MilliAmp) -> (MicroLitrePerSecond, MicroLitrePerSecond) {
        let x = current.0;
        let Some((left, right)) = self.piece(x, by_current) else {
            let flow = self.end(x, by_current);
            return (MicroLitrePerSecond(flow), MicroLitrePerSecond::ZERO);
        };
        let run = Divisor::at_least_one(right.0.saturating_sub(left.0));
        let rise = right.1.saturating_sub(left.1);
        (
            MicroLitrePerSecond(interpolate(left, right, x)),
            MicroLitrePerSecond(run.divide(rise.saturating_mul(1000))),
        )
    }

    /// Interpolates along the axis that `axes` puts first; beyond the ends the end values hold.
    fn look_up(&self, x: i32, axes: impl Fn(&ValvePoint) -> Breakpoint) -> i32 {
        match self.piece(x, &axes) {
            Some((left, right)) => interpolate(left, right, x),
            None => self.end(x, axes),
        }
    }

    /// The value at the end that `x` is beyond.
    fn end(&self, x: i32, axes: impl Fn(&ValvePoint) -> Breakpoint) -> i32 {
        let (first, last) = (self.used().first(), self.used().last());
        let end = match first.map(&axes) {
            Some(first) if x <= first.0 => Some(first),
            _ => last.map(&axes),
        };
        end.map_or(0, |end| end.1)
    }

    /// The piece of the curve that `x` is in, if it is in one.
    fn piece(
        &self,
        x: i32,
        axes: impl Fn(&ValvePoint) -> Breakpoint,
    ) -> Option<(Breakpoint, Breakpoint)> {
        let points = self.used();
        let above = points.partition_point(|point| axes(point).0 < x);
        let left = points.get(above.checked_sub(1)?)?;
        Some((axes(left), axes(points.get(above)?)))
    }
}

fn by_current(point: &ValvePoint) -> Breakpoint {
    (point.current.0, point.flow.0)
}

/// `sqrt(dp_ref / dp)` of the lowering valve at its present pressure drop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DropScale {
    /// The ratio in units of 2^-16.
    ratio: i32,
    /// Its inverse in units of 2^-16.
    inverse: i32,
}

impl DropScale {
    /// The scale at pressure drop `drop` of a table that was measured at `reference`. Drops are limited to
    /// 1 mbar .. 524 bar.
    #[must_use]
    pub fn new(reference: MilliBar, drop: MilliBar) -> Self {
        let ratio = square_root_of_ratio_16(reference.0, drop.0).max(1);
        // 2^32 / ratio; the numerator is one short of it, far below what rounding changes.
        let inverse = u32::MAX
            .checked_div(ratio.unsigned_abs())
            .unwrap_or(u32::MAX);
        Self {
            ratio,
            inverse: i32::try_from(inverse).unwrap_or(i32::MAX),
        }
    }

    /// The flow at the reference drop that needs the same opening as `flow` does at the present one.
    #[must_use]
    pub fn to_reference(self, flow: MicroLitrePerSecond) -> MicroLitrePerSecond {
        MicroLitrePerSecond(mul_shift_16(flow.0, self.ratio))
    }

    /// The flow at the present drop through an opening that lets `flow` through at the reference one.
    #[must_use]
    pub fn to_present(self, flow: MicroLitrePerSecond) -> MicroLitrePerSecond {
        MicroLitrePerSecond(mul_shift_16(flow.0, self.inverse))
    }

    /// An acceleration of the reference drop at the present one: ramps take the same time whatever the valve can give.
    #[must_use]
    pub fn ramp_at_present(self, slope: MillimetrePerSecondSquared) -> MillimetrePerSecondSquared {
        MillimetrePerSecondSquared(mul_shift_16(slope.0, self.inverse))
    }
}

/// The inverse maps of both valves.
#[derive(Clone, Copy, Debug)]
pub struct ValveMap<'a> {
    /// Lift valve: compensated.
    pub lift: &'a ValveTable,
    /// Lowering valve at the reference drop.
    pub lower: &'a ValveTable,
    /// The lowering valve's present scale.
    pub scale: DropScale,
}

impl ValveMap<'_> {
    /// Lift current for a flow into the cylinder.
    #[must_use]
    pub fn lift_current(&self, flow: MicroLitrePerSecond) -> MilliAmp {
        self.lift.current(flow)
    }

    /// Lowering current for a flow out of the cylinder.
    #[must_use]
    pub fn lower_current(&self, flow: MicroLitrePerSecond) -> MilliAmp {
        if flow <= MicroLitrePerSecond::ZERO {
            return MilliAmp::ZERO;
        }
        self.lower
            .current(self.scale.to_reference(flow).max(MicroLitrePerSecond(1)))
    }

    /// Largest flow into the cylinder.
    #[must_use]
    pub fn lift_saturation(&self) -> MicroLitrePerSecond {
        self.lift.saturation()
    }

    /// Largest flow out of the cylinder at the present drop.
    #[must_use]
    pub fn lower_saturation(&self) -> MicroLitrePerSecond {
        self.scale.to_present(self.lower.saturation())
    }
}
