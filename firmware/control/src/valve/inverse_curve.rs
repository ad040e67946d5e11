//! Inverse of a valve curve with the look-up cost of one evenly spaced table.
//!
//! ```text
//!   flow -> cell of the range (of 512) -> piece of the curve in which the cell begins, or the next one
//!   current = base of the piece + flow * slope of the piece
//! ```
//!
//! The breakpoints of the curve are kept: on an even grid the current would be wrong by milliamperes. They are further
//! apart than a cell is wide ([`ValveTable::least_gap`]), so that one comparison finds the piece. The first piece is
//! "no flow, no current", the last one begins at saturation. Flows outside the range are in the first or the last cell,
//! so no limiter is needed.
//!
//! The base of a piece is the current of its straight line at no flow, with an offset for rounding. Slopes are limited
//! to a milliampere per step, three hundred times that of the rig's valves; a steeper piece has this slope and ends
//! with a jump.

use hitch_quantities::calibration::valve_table::{VALVE_POINTS, ValvePoint, ValveTable};
use hitch_quantities::units::{MicroLitrePerSecond, MilliAmp};

/// Cells of the range: a power of two, for a saturating instruction.
const CELLS: usize = 512;
/// The last cell.
const LAST_CELL: i32 = CELLS as i32 - 1;
/// One piece per point, and the one without flow.
const PIECES: usize = VALVE_POINTS + 1;

/// Fractional bits of a base and of a slope.
const CURRENT_BITS: u32 = 32;
/// Half a milliampere.
const HALF: u64 = 1 << (CURRENT_BITS - 1);

/// Unit of flows on the axis of a curve: steps per microlitre per second, in 2^-26.
#[derive(Clone, Copy, Debug)]
pub struct FlowSteps(pub u32);

impl FlowSteps {
    /// Microlitres per second.
    pub const MICROLITRES: Self = Self(1 << Self::BITS);
    const BITS: u32 = 26;

    /// It fits a word for flows and reference drops within their limits.
    const fn of(self, flow: MicroLitrePerSecond) -> i32 {
        let steps = (flow.0 as u64).wrapping_mul(self.0 as u64);
        (steps.wrapping_add(1 << (Self::BITS - 1)) >> Self::BITS) as i32
    }

    /// A breakpoint, raised by half a milliampere, because the result is rounded down.
    const fn place(self, point: &ValvePoint) -> CurvePoint {
        let current = (point.current.0 as u64) << CURRENT_BITS;
        (self.of(point.flow), current.wrapping_add(HALF))
    }
}

/// The inverse of one valve's curve.
/// In this order each field is within reach of a load instruction from the address of the curve.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct InverseCurve {
    /// The piece that contains the lower end of each cell.
    first_piece: [u8; CELLS],
    /// Cells per step, in 2^-32.
    cells_per_step: i32,
    saturation: MicroLitrePerSecond,
    pieces: [Piece; PIECES],
}

/// A straight piece of the curve, up to `end`.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
struct Piece {
    /// Current of the line of the piece at no flow: milliamperes, and the remainder in 2^-32 mA, which wraps below
    /// zero.
    base: (u32, u32),
    /// In 2^-32 mA per step.
    slope: u32,
    end: i32,
}

/// A point of the curve: steps, and current in 2^-32 mA.
type CurvePoint = (i32, u64);

impl Piece {
    /// The first one with flow is raised by half a milliampere, so that the current of the smallest flow is just above
    /// the threshold; the last one is not raised.
    fn first(threshold: u64, to: CurvePoint) -> Self {
        let from = (1, threshold.wrapping_add(HALF));
        Self::between(from, (to.0, to.1.wrapping_add(HALF - 1)))
    }

    /// The slope is rounded down, so that the end is not exceeded.
    fn between(from: CurvePoint, to: CurvePoint) -> Self {
        let run = to.0.wrapping_sub(from.0).cast_unsigned().max(1);
        let slope = to.1.wrapping_sub(from.1) / u64::from(run);
        let slope = u32::try_from(slope).unwrap_or(u32::MAX);
        let rise = u64::from(from.0.cast_unsigned()).wrapping_mul(u64::from(slope));
        let base = from.1.wrapping_sub(rise);
        Self {
            base: ((base >> CURRENT_BITS) as u32, base as u32),
            slope,
            end: to.0,
        }
    }
}

impl InverseCurve {
    /// No curve: no flow at any current.
    pub const EMPTY: Self = Self {
        first_piece: [0; CELLS],
        cells_per_step: 0,
        saturation: MicroLitrePerSecond::ZERO,
        pieces: [Piece {
            base: (0, 0),
            slope: 0,
            end: 0,
        }; PIECES],
    };

    /// Computes the inverse of the curve in a valid `table` over an axis in `steps`, in place: a copy would need a
    /// large part of the stack.
    #[inline(never)]
    pub fn fill(&mut self, table: &ValveTable, steps: FlowSteps) {
        let points = table.used();
        self.saturation = table.saturation();
        let range = steps.of(self.saturation).cast_unsigned().wrapping_add(1);
        let cells_per_step = ((CELLS as u64) << 32) / u64::from(range.max(1));
        self.cells_per_step = i32::try_from(cells_per_step).unwrap_or(i32::MAX);
        let threshold = points.first().map_or(0, |first| steps.place(first).1);
        let mut from = (0, threshold);
        for at in 1..=points.len() {
            // The curve is constant beyond the last point.
            let to = points
                .get(at)
                .map_or((i32::MAX, from.1), |point| steps.place(point));
            let piece = match at {
                1 => Piece::first(threshold, to),
                _ => Piece::between(from, to),
            };
            self.set_piece(at, from.0, piece);
            from = to;
        }
    }

    /// Sets a piece that begins at a flow, and assigns the cells from there to its end. Cells beyond saturation may
    /// begin in the previous piece.
    fn set_piece(&mut self, at: usize, begins: i32, piece: Piece) {
        let cells = self.cell(begins).wrapping_add(1)..self.cell(piece.end).wrapping_add(1);
        let cells = self.first_piece.get_mut(cells).unwrap_or_default();
        cells.fill(at.min(VALVE_POINTS - 1) as u8);
        if let Some(slot) = self.pieces.get_mut(at) {
            *slot = piece;
        }
    }

    /// Largest flow.
    #[must_use]
    pub const fn saturation(&self) -> MicroLitrePerSecond {
        self.saturation
    }

    /// Current for a flow in steps: zero for no flow, just above the threshold for the smallest flow, the saturation
    /// current for flows beyond saturation.
    #[must_use]
    pub fn current(&self, steps: i32) -> MilliAmp {
        let at = usize::from(self.first_piece[self.cell(steps)]) % VALVE_POINTS;
        let mut piece = &self.pieces[at];
        if steps > piece.end {
            piece = &self.pieces[at + 1];
        }
        let rise = u64::from(steps.cast_unsigned()).wrapping_mul(u64::from(piece.slope));
        let base = u64::from(piece.base.0) << CURRENT_BITS | u64::from(piece.base.1);
        MilliAmp((base.wrapping_add(rise) >> CURRENT_BITS) as i32)
    }

    /// The cell of a flow.
    #[allow(
        clippy::manual_clamp,
        reason = "of `clamp` the compiler doesn't make a saturation here, but six instructions more"
    )]
    fn cell(&self, steps: i32) -> usize {
        let cells = i64::from(steps).wrapping_mul(i64::from(self.cells_per_step));
        ((cells >> 32) as i32).max(0).min(LAST_CELL) as usize
    }
}

#[cfg(test)]
mod tests {
    use hitch_quantities::calibration::nominal::{LIFT, LOWER};
    use hitch_quantities::units::MilliBar;

    use super::*;
    use crate::valve::drop_scale::DropReference;

    fn table(points: &[(i32, i32)]) -> ValveTable {
        let mut table = ValveTable {
            count: points.len() as u32,
            points: [ValvePoint::default(); VALVE_POINTS],
        };
        for (slot, (flow, current)) in table.points.iter_mut().zip(points) {
            *slot = ValvePoint {
                flow: MicroLitrePerSecond(*flow),
                current: MilliAmp(*current),
            };
        }
        table
    }

    fn exact_ma(table: &ValveTable, flow: f64) -> f64 {
        let points = table.used();
        let right = points
            .iter()
            .position(|point| f64::from(point.flow.0) >= flow);
        let Some(right) = right else {
            return f64::from(points[points.len() - 1].current.0);
        };
        let [from, to] = [right - 1, right].map(|at| points[at]);
        let share = (flow - f64::from(from.flow.0)) / f64::from(to.flow.0 - from.flow.0);
        f64::from(from.current.0) + share * f64::from(to.current.0 - from.current.0)
    }

    fn inverse_of(table: &ValveTable, steps: FlowSteps) -> InverseCurve {
        let mut inverse = InverseCurve::EMPTY;
        inverse.fill(table, steps);
        inverse
    }

    /// 32 points that are as close as is allowed, but for one gap, and up to this flow; none is too steep.
    fn crowded(saturation: i32, wide_gap: usize) -> ValveTable {
        let gap = ValveTable::least_gap_of(MicroLitrePerSecond(saturation)).0;
        let points: [_; 32] = core::array::from_fn(|at| {
            let flow = if at <= wide_gap {
                at as i32 * gap
            } else {
                saturation - (31 - at as i32) * gap
            };
            (flow, 900 + at as i32 * gap.min(30))
        });
        table(&points)
    }

    /// Nominal and plain tables, and full ones with one wide gap, on the axes of all of [`axes`].
    fn awkward() -> impl Iterator<Item = (ValveTable, FlowSteps)> {
        let plain = [
            LIFT,
            LOWER,
            table(&[(0, 0), (10_000_000, 5_000)]),
            table(&[(0, 1_000), (64, 1_001), (128, 1_060)]),
            table(&[(0, 1_000), (5, 1_001), (10, 1_005)]),
        ];
        let full = [155, 1_000, 1_024, 2_001, 50_000, 978_617, 10_000_000]
            .into_iter()
            .flat_map(|saturation| [0, 7, 15, 30].map(|gap| crowded(saturation, gap)));
        plain
            .into_iter()
            .chain(full)
            .flat_map(|table| axes().map(|steps| (table, steps)))
    }

    /// Microlitres a second, and the coarsest and the finest steps that a reference drop gives.
    fn axes() -> [FlowSteps; 3] {
        let of_drop = |drop| DropReference::new(MilliBar(drop)).steps();
        [FlowSteps::MICROLITRES, of_drop(250_000), of_drop(1_000)]
    }

    #[test]
    fn a_look_up_is_the_curve_to_the_milliampere() {
        for (table, steps) in awkward() {
            let inverse = inverse_of(&table, steps);
            let flow_per_step = f64::from(1 << FlowSteps::BITS) / f64::from(steps.0);
            let end = steps.of(table.saturation());
            let kinks = table.used().iter().flat_map(|point| {
                let at = steps.of(point.flow);
                at - 1..=at + 1
            });
            let even = (1..=end).step_by((end as usize / 20_000).max(1));
            for at in even.chain(kinks).filter(|at| *at > 0) {
                let found = f64::from(inverse.current(at).0);
                let error = found - exact_ma(&table, f64::from(at) * flow_per_step);
                // A step of a steep piece, where breakpoints are rounded to them, is more than a milliampere.
                let steepest = table.used().windows(2).map(|pair| {
                    f64::from((pair[1].current - pair[0].current).0)
                        / f64::from((pair[1].flow - pair[0].flow).0)
                });
                let allowed = 1.0 + 0.5 * flow_per_step * steepest.fold(0.0, f64::max);
                assert!(
                    error.abs() <= allowed,
                    "{at} of {end} steps: {error} mA, {table:?}"
                );
            }
        }
    }

    #[test]
    fn more_flow_never_asks_for_less_and_the_ends_hold() {
        for (table, steps) in awkward() {
            let inverse = inverse_of(&table, steps);
            let mut last = table.threshold();
            let most = steps.of(table.saturation()).saturating_add(999);
            for at in (1..20_000.min(most)).chain((20_000..most).step_by(999)) {
                let current = inverse.current(at);
                assert!(current >= last && current > table.threshold());
                last = current;
            }
            let points = table.used();
            let saturated = points[points.len() - 1].current;
            for beyond in [most, i32::MAX / 2, i32::MAX] {
                assert_eq!(inverse.current(beyond), saturated);
            }
            for none in [0, -1, i32::MIN / 2, i32::MIN] {
                assert_eq!(inverse.current(none), MilliAmp::ZERO);
            }
        }
    }

    #[test]
    fn a_piece_that_is_too_steep_ends_in_a_step() {
        let table = table(&[(0, 1_000), (225, 2_000), (90_000, 2_500)]);
        let inverse = inverse_of(&table, FlowSteps::MICROLITRES);
        assert_eq!(inverse.current(1).0, 1_001);
        assert!((1_049..=1_050).contains(&inverse.current(50).0));
        assert!((1_224..=1_225).contains(&inverse.current(225).0));
        assert!((2_000..2_002).contains(&inverse.current(226).0));
    }
}
