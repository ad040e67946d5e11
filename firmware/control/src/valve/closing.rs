//! How much still flows through a valve whose coil has been cut.
//!
//! The spool then makes for zero current, of which its hysteresis `H` remains, `I(t) - H = (I - H) e^(-t/T)`, and
//! passes its whole curve on the way:
//!
//! ```text
//! volume = T * integral of Q(i) / (i - H) di  from the threshold to I  =  T Q(I) share(I)
//! ```
//!
//! `share` depends on the curve alone, so it is worked out once for each of its points. A valve with a metering notch
//! has a small one: its flow is gone long before its threshold is reached.

use hitch_quantities::Calibration;
use hitch_quantities::calibration::valve_table::{VALVE_POINTS, ValvePoint, ValveTable};
use hitch_quantities::fixed::{Divisor, interpolate, mul_div};
use hitch_quantities::units::MilliAmp;

/// How both valves close.
#[derive(Clone, Copy, Debug)]
pub struct ClosingCurves {
    /// Lift valve.
    pub lift: ClosingCurve,
    /// Lowering valve.
    pub lower: ClosingCurve,
}

impl ClosingCurves {
    /// The curves of a calibration's valves.
    #[must_use]
    pub fn of(calibration: &Calibration) -> Self {
        let hysteresis = calibration.hydraulics.hysteresis;
        Self {
            lift: ClosingCurve::of(&calibration.lift, hysteresis),
            lower: ClosingCurve::of(&calibration.lower, hysteresis),
        }
    }
}

/// Share over current of one valve.
#[derive(Clone, Copy, Debug)]
pub struct ClosingCurve {
    /// Current, and share in thousandths; past the last one in use all are the same.
    points: [(i32, i32); VALVE_POINTS],
}

impl ClosingCurve {
    /// The curve of a valve with this hysteresis.
    #[must_use]
    pub fn of(table: &ValveTable, hysteresis: MilliAmp) -> Self {
        let mut points = [(0, 0); VALVE_POINTS];
        let mut integral = 0_i32;
        let mut before: Option<&ValvePoint> = None;
        let mut last = (0, 0);
        for (point, slot) in table.used().iter().zip(&mut points) {
            if let Some(before) = before {
                integral = integral.saturating_add(between(before, point, hysteresis));
            }
            // The integral is in thousandths of a flow.
            let share = integral / point.flow.0.max(1);
            last = (point.current.0, share);
            *slot = last;
            before = Some(point);
        }
        for slot in points.iter_mut().skip(table.used().len()) {
            *slot = last;
        }
        Self { points }
    }

    /// Share at `current`, in thousandths.
    #[must_use]
    pub fn share(&self, current: MilliAmp) -> i32 {
        let above = self.points.partition_point(|point| point.0 < current.0);
        let left = above.checked_sub(1).and_then(|at| self.points.get(at));
        match (left, self.points.get(above)) {
            (Some(&left), Some(&right)) => interpolate(left, right, current.0),
            (Some(&end), None) => end.1,
            // Below the threshold nothing flows.
            (None, _) => 0,
        }
    }
}

/// A thousand times the integral of `Q / (i - H)` between two points, by Simpson's rule.
fn between(from: &ValvePoint, to: &ValvePoint, hysteresis: MilliAmp) -> i32 {
    let ratio = |flow: i32, current: i32| {
        let above = current.saturating_sub(hysteresis.0);
        mul_div(flow, 1000, Divisor::at_least_one(above))
    };
    let middle_flow = from.flow.0.saturating_add(to.flow.0) / 2;
    let middle_current = from.current.0.saturating_add(to.current.0) / 2;
    let sum = ratio(from.flow.0, from.current.0)
        .saturating_add(ratio(middle_flow, middle_current).saturating_mul(4))
        .saturating_add(ratio(to.flow.0, to.current.0));
    let width = to.current.0.saturating_sub(from.current.0);
    mul_div(sum, width, Divisor::at_least_one(6))
}

#[cfg(test)]
mod tests {
    use hitch_quantities::calibration::nominal::{LIFT, LOWER};

    use super::*;

    /// The integral in small steps.
    fn share(table: &ValveTable, current: i32, hysteresis: i32) -> f64 {
        let (mut volume, steps) = (0.0, 30_000);
        let mut spool = f64::from(current - hysteresis);
        for _ in 0..steps {
            let flow = table.flow(MilliAmp(spool.round() as i32 + hysteresis));
            volume += f64::from(flow.0) * 1e-4;
            spool *= (-1e-4_f64).exp();
        }
        volume / f64::from(table.flow(MilliAmp(current)).0)
    }

    #[test]
    fn shares_are_what_flows_while_a_spool_falls_shut() {
        for table in [LIFT, LOWER] {
            let curve = ClosingCurve::of(&table, MilliAmp(120));
            for current in [1_300, 1_500, 1_600, 1_700, 2_000, 2_500, 3_000] {
                let (found, exact) = (
                    f64::from(curve.share(MilliAmp(current))) * 1e-3,
                    share(&table, current, 120),
                );
                assert!(
                    (found - exact).abs() <= 0.03,
                    "{current} mA: {found}, not {exact}"
                );
            }
            assert_eq!(curve.share(MilliAmp(0)), 0);
            assert_eq!(curve.share(table.threshold()), 0);
        }
    }
}
