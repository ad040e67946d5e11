//! The inverse of a valve's curve, laid out so that a look-up takes little more than one in an evenly spaced table.
//!
//! ```text
//!   flow -> which 128th of the range -> first piece of the curve in it -> on to the piece that flow is in
//!   current = current at the piece's beginning + (flow - flow at its beginning) * slope, rounded to nearest
//! ```
//!
//! A valve's breakpoints are where the valve has its kinks, so they are kept: on an even grid they would be missed by
//! milliamperes. The first piece is raised by half a milliampere, so that the smallest flow asks for more than the
//! threshold. Slopes are in 2^-32 mA s/ul and stop short of a milliampere a microlitre a second, three hundred times
//! that of the rig's valves; a steeper piece is followed at that slope and ends in a step.

use super::units::{MicroLitrePerSecond, MilliAmp};
use super::valve_map::{VALVE_POINTS, ValvePoint, ValveTable};

/// Parts of the range that have an entry of their own: a power of two.
const PARTS: usize = 128;

/// Half a milliampere in 2^-32 mA.
const HALF: u64 = 1 << 31;

/// The inverse of one valve's curve.
#[derive(Clone, Copy, Debug)]
pub struct InverseCurve {
    /// Parts per flow, in 2^-32 s/ul.
    parts_per_flow: u32,
    /// The piece that the lower end of each part is in.
    first_piece: [u8; PARTS],
    pieces: [Piece; VALVE_POINTS],
    saturation: MicroLitrePerSecond,
}

/// A straight piece of the curve, up to the flow `end`. Nobody asks where the first one begins, so its flow may be
/// another than the curve's. The piece beyond saturation has no end.
#[derive(Clone, Copy, Debug, Default)]
struct Piece {
    end: MicroLitrePerSecond,
    flow: MicroLitrePerSecond,
    current: MilliAmp,
    /// In 2^-32 mA s/ul.
    slope: u32,
}

impl Piece {
    fn between(from: &ValvePoint, to: &ValvePoint) -> Self {
        Self {
            end: to.flow,
            flow: from.flow,
            current: from.current,
            slope: slope(from, to),
        }
    }

    const fn beyond(last: &ValvePoint) -> Self {
        Self {
            end: MicroLitrePerSecond(i32::MAX),
            flow: last.flow,
            current: last.current,
            slope: 0,
        }
    }

    fn current(&self, flow: MicroLitrePerSecond) -> MilliAmp {
        let further = flow.0.wrapping_sub(self.flow.0).cast_unsigned();
        let rise = u64::from(further).wrapping_mul(u64::from(self.slope));
        let rounded = rise.wrapping_add(HALF) >> 32;
        MilliAmp(self.current.0.wrapping_add(rounded as i32))
    }
}

impl InverseCurve {
    /// The inverse of the curve in `table`, which validation has seen.
    #[must_use]
    #[inline(never)]
    pub fn of(table: &ValveTable) -> Self {
        let points = table.used();
        let saturation = table.saturation();
        let range = saturation.0.unsigned_abs().saturating_add(1);
        let mut curve = Self {
            parts_per_flow: u32::try_from(((PARTS as u64) << 32) / u64::from(range))
                .unwrap_or(u32::MAX),
            first_piece: [0; PARTS],
            pieces: [Piece::default(); VALVE_POINTS],
            saturation,
        };
        for (at, from) in (0_u8..).zip(points) {
            let further = curve.part(from.flow).saturating_add(1);
            let further = curve.first_piece.get_mut(further..);
            further.unwrap_or_default().fill(at);
            if let Some(piece) = curve.pieces.get_mut(usize::from(at)) {
                let to = points.get(usize::from(at).saturating_add(1));
                *piece = to.map_or(Piece::beyond(from), |to| Piece::between(from, to));
            }
        }
        raise_by_half(&mut curve.pieces[0]);
        curve
    }

    /// Largest flow.
    #[must_use]
    pub const fn saturation(&self) -> MicroLitrePerSecond {
        self.saturation
    }

    /// Current that lets `flow` through: none for none, just more than the threshold for the smallest, the saturation
    /// current for all that is more than the valve can give.
    #[must_use]
    #[inline(never)]
    pub fn current(&self, flow: MicroLitrePerSecond) -> MilliAmp {
        if flow <= MicroLitrePerSecond::ZERO {
            return MilliAmp::ZERO;
        }
        let mut at = usize::from(self.first_piece[self.part(flow)]) % VALVE_POINTS;
        // The last piece has no end, so this does.
        while flow > self.pieces[at].end {
            at = (at + 1) % VALVE_POINTS;
        }
        self.pieces[at].current(flow)
    }

    /// The part that a flow is in; what is beyond the range is in the last one.
    fn part(&self, flow: MicroLitrePerSecond) -> usize {
        let flow = u64::from(flow.0.cast_unsigned());
        let part = flow.wrapping_mul(u64::from(self.parts_per_flow)) >> 32;
        (part as usize).min(PARTS - 1)
    }
}

/// How much more current a flow takes between two points, rounded down: the end of a piece is not overshot.
fn slope(from: &ValvePoint, to: &ValvePoint) -> u32 {
    let rise = u64::from((to.current - from.current).0.unsigned_abs()) << 32;
    let run = u64::from((to.flow - from.flow).0.unsigned_abs()).max(1);
    u32::try_from(rise / run).unwrap_or(u32::MAX)
}

/// Shifts the first piece so that a flow of 1 ul/s is just rounded up, and its end is not.
fn raise_by_half(piece: &mut Piece) {
    let shift = HALF
        .div_ceil(u64::from(piece.slope.max(1)))
        .saturating_sub(1);
    let shift = i32::try_from(shift).unwrap_or(0);
    piece.flow = piece.flow - MicroLitrePerSecond(shift);
}

#[cfg(test)]
mod tests {
    use super::super::nominal::{LIFT, LOWER};
    use super::*;

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

    fn exact_ma(table: &ValveTable, flow: i32) -> f64 {
        let points = table.used();
        let right = points.iter().position(|point| point.flow.0 >= flow);
        let Some(right) = right else {
            return f64::from(points[points.len() - 1].current.0);
        };
        let [from, to] = [right - 1, right].map(|at| points[at]);
        let share = f64::from(flow - from.flow.0) / f64::from(to.flow.0 - from.flow.0);
        f64::from(from.current.0) + share * f64::from(to.current.0 - from.current.0)
    }

    /// Kinks in one part of the range, a full table, and the largest flows.
    fn awkward() -> [ValveTable; 6] {
        let crowded: [_; 32] = core::array::from_fn(|at| (at as i32 * 40, 900 + at as i32 * 30));
        let mut crowded_at_first = crowded;
        crowded_at_first[31] = (5_000_000, 3_400);
        [
            LIFT,
            LOWER,
            table(&crowded),
            table(&crowded_at_first),
            table(&[(0, 0), (10_000_000, 5_000)]),
            table(&[(0, 1_000), (64, 1_001), (128, 1_060)]),
        ]
    }

    #[test]
    fn a_look_up_is_the_curve_to_the_milliampere() {
        for table in awkward() {
            let inverse = InverseCurve::of(&table);
            let end = table.saturation().0;
            let kinks = table
                .used()
                .iter()
                .flat_map(|point| point.flow.0 - 1..=point.flow.0 + 1);
            let even = (1..=end).step_by((end as usize / 50_000).max(1));
            for flow in even.chain(kinks).filter(|flow| *flow > 0) {
                let found = f64::from(inverse.current(MicroLitrePerSecond(flow)).0);
                let error = found - exact_ma(&table, flow);
                assert!(error.abs() <= 1.0, "{flow} ul/s of {end}: {error} mA");
            }
        }
    }

    #[test]
    fn more_flow_never_asks_for_less_and_the_ends_hold() {
        for table in awkward() {
            let inverse = InverseCurve::of(&table);
            let mut last = table.threshold();
            for flow in (1..100_000).chain((100_000..11_000_000).step_by(999)) {
                let current = inverse.current(MicroLitrePerSecond(flow));
                assert!(current >= last && current > table.threshold());
                last = current;
            }
            let points = table.used();
            assert_eq!(last, points[points.len() - 1].current);
            let least = inverse.current(MicroLitrePerSecond(i32::MIN));
            assert_eq!(least, MilliAmp::ZERO);
        }
    }

    #[test]
    fn a_piece_that_is_too_steep_ends_in_a_step() {
        let inverse = InverseCurve::of(&table(&[(0, 1_000), (100, 2_000), (90_000, 2_500)]));
        let current = |flow| inverse.current(MicroLitrePerSecond(flow)).0;
        assert_eq!(
            [current(1), current(50), current(100)],
            [1_001, 1_050, 1_100]
        );
        assert!((2_000..2_002).contains(&current(101)));
    }
}
