//! Groups of the currents of a machine's valves.

use hitch_plant::{Model, ValveCurve};

/// Current below which a valve counts as off, A; at most half of the smaller threshold.
const OFF_BELOW_A: f64 = 0.2;
/// Limits between the groups as shares of the range from threshold to saturation: shut, small opening, partly open,
/// fully open.
const SHARES: [f64; 4] = [0.0, 0.28, 0.56, 0.84];
/// Steps to which the limits are rounded, A, for ranges of at least so many of them.
const STEPS_A: [f64; 4] = [0.1, 0.05, 0.02, 0.01];
const FEWEST_STEPS: f64 = 12.0;
/// Share of the largest flow at which a valve counts as saturated.
const SATURATED: f64 = 0.98;

/// Limits between the groups of both valves, A.
#[derive(Debug, Clone, PartialEq)]
pub struct CurrentGroups {
    /// Current below which a valve counts as off.
    pub off_below_a: f64,
    lift_a: Vec<f64>,
    lower_a: Vec<f64>,
}

impl CurrentGroups {
    /// The groups of a machine, by the curves of its valves.
    #[must_use]
    pub fn of(model: &Model) -> Self {
        let constants = model.constants();
        let curves = [&constants.lift_valve.curve, &constants.lower_valve.curve];
        let thresholds_a = curves.map(ValveCurve::threshold_a);
        Self {
            off_below_a: OFF_BELOW_A.min(0.5 * thresholds_a[0].min(thresholds_a[1])),
            lift_a: limits_a(curves[0]),
            lower_a: limits_a(curves[1]),
        }
    }

    /// Limits of the lift valve, or of the lowering valve, A; rising.
    #[must_use]
    pub fn limits_a(&self, is_lift: bool) -> &[f64] {
        if is_lift { &self.lift_a } else { &self.lower_a }
    }
}

fn limits_a(curve: &ValveCurve) -> Vec<f64> {
    let (currents_a, flows) = (curve.currents_a(), curve.flows_m3_s());
    let threshold_a = curve.threshold_a();
    let largest = flows.last().copied().unwrap_or(0.0);
    let saturated = flows.iter().position(|flow| *flow >= SATURATED * largest);
    let saturation_a = saturated.map_or(threshold_a, |point| currents_a[point]);
    let range_a = (saturation_a - threshold_a).max(0.0);
    let mut steps_a = STEPS_A.into_iter();
    let step_a = steps_a.find(|step_a| range_a >= FEWEST_STEPS * step_a);
    let step_a = step_a.unwrap_or(STEPS_A[STEPS_A.len() - 1]);
    // Rounded again, so that names are short.
    let rounded = |current_a: f64| ((current_a / step_a).round() * step_a * 1e3).round() / 1e3;
    let mut limits_a = SHARES
        .map(|share| rounded(threshold_a + share * range_a))
        .to_vec();
    limits_a.dedup();
    limits_a
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The paper's machine with the currents of its valves multiplied.
    fn scaled(factor: f64) -> Model {
        let nominal = hitch_model_file::nominal();
        let mut constants = nominal.constants().clone();
        for valve in [&mut constants.lift_valve, &mut constants.lower_valve] {
            let currents = valve
                .curve
                .currents_a()
                .iter()
                .map(|current| factor * current);
            let flows = valve.curve.flows_m3_s().to_vec();
            valve.curve = ValveCurve::new(currents.collect(), flows).expect("a curve");
        }
        nominal.with_constants(constants).expect("a linkage")
    }

    fn written(limits_a: &[f64]) -> Vec<String> {
        limits_a.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn groups_are_those_of_the_valves() {
        let paper = CurrentGroups::of(&scaled(1.0));
        assert_eq!(written(paper.limits_a(false)), ["1", "1.6", "2.1", "2.7"]);
        assert_eq!(written(paper.limits_a(true)), ["1.1", "1.7", "2.3", "2.9"]);
        let small = CurrentGroups::of(&scaled(1.6 / 3.5));
        let limits_a = small.limits_a(true);
        assert_eq!(limits_a.len(), 4, "{limits_a:?}");
        assert!(limits_a[0] > 0.45 && limits_a[3] < 1.45, "{limits_a:?}");
        assert_eq!(small.off_below_a, 0.2);
        let smaller = CurrentGroups::of(&scaled(0.1));
        assert!(smaller.off_below_a < smaller.limits_a(false)[0]);
    }
}
