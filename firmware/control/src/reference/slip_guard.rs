//! Slip guard: raises the hitch as far as the slip is above its limit.
//!
//! It is a maximum: the set point is the higher one of what the function demands and of what the guard demands. The integral of
//! the guard exists while the guard raises, and begins at the former, so that there is no step and nothing to unwind.

use hitch_quantities::calibration::field_parameters::SlipParameters;
use hitch_quantities::fixed::{Divisor, mul_div};
use hitch_quantities::units::{MilliDegree, PerMille};

use super::lag_loop::{Gains, Integral};

/// The guard; without a demand while there is nothing to limit.
#[derive(Clone, Copy, Debug, Default)]
pub struct SlipGuard {
    integral: Option<Integral>,
}

impl SlipGuard {
    /// One step: the set point, `demand` or above it. `slip` with its limit; `None` where slip is not limited, or not
    /// known.
    pub fn step(
        &mut self,
        slip: Option<(PerMille, PerMille)>,
        demand: MilliDegree,
        gains: Gains,
        parameters: &SlipParameters,
    ) -> MilliDegree {
        let Some((slip, limit)) = slip else {
            self.integral = None;
            return demand;
        };
        let highest = demand + parameters.most_raise;
        let per_degree = Divisor::at_least_one(parameters.slip_per_degree.0);
        let error = MilliDegree(mul_div((slip - limit).0, 1_000, per_degree));
        let mut integral = self.integral.unwrap_or(Integral::at(demand));
        integral.add(error, gains);
        let integral = integral.limited(demand, highest);
        let raised = integral.value() + gains.proportional(error);
        self.integral = (raised > demand).then_some(integral);
        raised.limited(demand, highest)
    }
}

#[cfg(test)]
mod tests {
    use hitch_quantities::units::{Millimetre, MillimetrePerSecond};

    use super::*;

    const PARAMETERS: SlipParameters = SlipParameters::NOMINAL;
    const DEMAND: MilliDegree = MilliDegree(60_000);

    fn gains() -> Gains {
        let (length, speed) = (Millimetre(1_500), MillimetrePerSecond(1_800));
        Gains::of(PARAMETERS.crossover, length, speed)
    }

    fn run(guard: &mut SlipGuard, steps: i32, slip: i32, demand: MilliDegree) -> MilliDegree {
        let slip = Some((PerMille(slip), PerMille(200)));
        (0..steps).fold(demand, |_, _| {
            guard.step(slip, demand, gains(), &PARAMETERS)
        })
    }

    #[test]
    fn below_the_limit_the_demand_passes_to_the_last_digit() {
        let mut guard = SlipGuard::default();
        for demand in [60_000, 60_001, 75_000, 44_000] {
            let demand = MilliDegree(demand);
            assert_eq!(run(&mut guard, 500, 190, demand), demand);
        }
        let free = guard.step(None, DEMAND, gains(), &PARAMETERS);
        assert_eq!(free, DEMAND, "where slip is not limited");
    }

    #[test]
    fn above_the_limit_it_raises_as_far_as_it_may_and_comes_back_to_the_demand() {
        let mut guard = SlipGuard::default();
        assert!(run(&mut guard, 100, 250, DEMAND) > DEMAND);
        let highest = DEMAND + PARAMETERS.most_raise;
        assert_eq!(run(&mut guard, 20_000, 400, DEMAND), highest);
        let one = run(&mut guard, 500, 150, DEMAND);
        assert!(DEMAND < one && one < highest, "{one:?}");
        assert_eq!(run(&mut guard, 20_000, 150, DEMAND), DEMAND);
    }

    #[test]
    fn a_time_below_the_limit_leaves_nothing_to_unwind() {
        let mut fresh = SlipGuard::default();
        let mut old = SlipGuard::default();
        run(&mut old, 60_000, 20, DEMAND);
        let of = |guard: &mut SlipGuard| run(guard, 300, 260, DEMAND);
        let (fresh, old) = (of(&mut fresh), of(&mut old));
        assert!(
            (fresh - old).magnitude() <= MilliDegree(1),
            "{fresh:?}, {old:?}"
        );
    }
}
