//! Loop of draft and depth: from the deviation of the quantity to a set point of position control.
//!
//! Draft is proportional to depth, so it changes with the angle the more, the harder the soil is at the present depth. The
//! error as an angle is therefore
//!
//! ```text
//! e = (D - D_set) / K * D_set / max(D, D_set)      K: force per degree at the set point
//! ```
//!
//! which is the change of depth that the soil asks for, also where it is twice as hard. The dial mixes it with the distance of
//! the lever: `m e + (1 - m) (lever - u)`, whose rest is `u = lever + e m / (1 - m)`.
//!
//! The error of a depth `z` as an angle is `(z - z_set) / (depth per degree)`; it has no part of the lever.

use hitch_quantities::calibration::field_parameters::{DepthParameters, DraftParameters};
use hitch_quantities::fixed::{Divisor, mul_div};
use hitch_quantities::units::{Micrometre, MilliDegree, Newton, PerMille};

use super::lag_loop::{Gains, Integral};

/// Errors of a step as angles; positive raises.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Errors {
    /// Weighted error of the draft, or error of the depth.
    quantity: MilliDegree,
    /// Weighted distance of the lever.
    position: MilliDegree,
}

impl Errors {
    /// Errors of a draft, and of a lever in front of the set point `present`; `mix`: weight of the draft.
    #[must_use]
    pub fn of(
        (draft, set_point): (Newton, Newton),
        lever_ahead: MilliDegree,
        mix: PerMille,
        parameters: &DraftParameters,
    ) -> Self {
        let error = draft_error(draft, set_point, parameters);
        let mix = mix.limited(PerMille::ZERO, PerMille::WHOLE);
        Self {
            quantity: error.scaled(mix.0, Divisor::THOUSAND),
            position: lever_ahead.scaled((PerMille::WHOLE - mix).0, Divisor::THOUSAND),
        }
    }

    /// Errors of a depth.
    #[must_use]
    pub fn of_depth(
        depth: Micrometre,
        set_point: Micrometre,
        parameters: &DepthParameters,
    ) -> Self {
        let deviation = depth - set_point;
        let band = parameters.dead_band;
        let beyond = deviation - deviation.limited(-band, band);
        let per_degree = Divisor::at_least_one(parameters.per_degree.0);
        Self {
            quantity: MilliDegree(mul_div(beyond.0, 1_000, per_degree)),
            position: MilliDegree::ZERO,
        }
    }
}

/// Deviation of the draft as an angle.
fn draft_error(draft: Newton, set_point: Newton, parameters: &DraftParameters) -> MilliDegree {
    let set_point = set_point.max(Newton(1));
    let band = set_point.scaled(parameters.dead_band.0, Divisor::THOUSAND);
    let deviation = draft - set_point;
    let beyond = deviation - deviation.limited(-band, band);
    let stiffness = Divisor::at_least_one(parameters.force_per_degree.0);
    let angle = mul_div(beyond.0, 1_000, stiffness);
    let hardest = Divisor::at_least_one(draft.max(set_point).0);
    MilliDegree(mul_div(angle, set_point.0, hardest))
}

/// The loop.
#[derive(Clone, Copy, Debug, Default)]
pub struct FunctionLoop {
    integral: Integral,
}

impl FunctionLoop {
    /// A loop whose first demand is `demand`.
    #[must_use]
    pub fn from(demand: MilliDegree, errors: Errors, gains: Gains) -> Self {
        Self {
            integral: Integral::at(demand - gains.proportional(errors.quantity)),
        }
    }

    /// The demand with these errors.
    #[must_use]
    pub fn demand(&self, errors: Errors, gains: Gains) -> MilliDegree {
        self.integral.value() + gains.proportional(errors.quantity)
    }

    /// The step ends with the set point `used`, instead of `demand`.
    pub fn follow(&mut self, errors: Errors, gains: Gains, demand: MilliDegree, used: MilliDegree) {
        let back = used - demand;
        self.integral
            .add(errors.quantity + errors.position + back, gains);
    }
}

#[cfg(test)]
mod tests {
    use hitch_quantities::units::{MilliHertz, Millimetre, MillimetrePerSecond};

    use super::*;

    const PARAMETERS: DraftParameters = DraftParameters::NOMINAL;
    const SET: Newton = Newton(18_000);

    fn gains() -> Gains {
        Gains::of(
            MilliHertz(200),
            Millimetre(1_500),
            MillimetrePerSecond(1_800),
        )
    }

    fn error(draft: i32) -> i32 {
        draft_error(Newton(draft), SET, &PARAMETERS).0
    }

    #[test]
    fn the_error_is_the_change_of_depth_that_the_soil_asks_for() {
        // At the set point K is 650 N a degree, so its depth is 18 000 / 650 degrees.
        let depth = 18_000.0 / 650.0 * 1e3;
        for hardness in [1.3, 2.0, 3.0] {
            let found = f64::from(error((18_000.0 * hardness) as i32));
            let exact = depth * (1.0 - 1.0 / hardness);
            assert!((found / exact - 1.0).abs() < 0.1, "{found}, not {exact}");
        }
        assert_eq!([error(18_360), error(17_640), error(18_000)], [0; 3]);
        assert!(error(17_000) < 0 && error(i32::MIN) < 0 && error(i32::MAX) > 0);
    }

    #[test]
    fn the_error_of_the_depth_is_the_angle_of_what_is_beyond_the_dead_band() {
        let of = |millimetre: i32| {
            let depth = Micrometre(millimetre * 1_000);
            Errors::of_depth(depth, Micrometre(250_000), &DepthParameters::NOMINAL)
                .quantity
                .0
        };
        assert_eq!([of(236), of(250), of(264)], [0; 3]);
        assert_eq!([of(255 + 18), of(245 - 18)], [1_000, -1_000]);
        assert!(of(-2_000_000) < 0 && of(2_000_000) > 0);
    }

    #[test]
    fn it_begins_without_a_step_whatever_the_error_is() {
        for draft in [0, 9_000, 18_000, 40_000] {
            let (lever, mix) = (MilliDegree(1_000), PerMille(700));
            let errors = Errors::of((Newton(draft), SET), lever, mix, &PARAMETERS);
            let start = MilliDegree(61_234);
            let control = FunctionLoop::from(start, errors, gains());
            let off = control.demand(errors, gains()) - start;
            assert!(off.magnitude() <= MilliDegree(1), "{off:?}");
        }
    }

    #[test]
    fn a_limit_leaves_no_windup() {
        let mut control = FunctionLoop::from(MilliDegree(60_000), Errors::default(), gains());
        let limit = MilliDegree(62_000);
        let step = |control: &mut FunctionLoop, draft| {
            let of = (Newton(draft), SET);
            let errors = Errors::of(of, MilliDegree::ZERO, PerMille::WHOLE, &PARAMETERS);
            let demand = control.demand(errors, gains());
            let used = demand.min(limit);
            control.follow(errors, gains(), demand, used);
            used
        };
        for _ in 0..60_000 {
            step(&mut control, 25_000);
        }
        assert_eq!(step(&mut control, 25_000), limit);
        let steps = (0..60_000).position(|_| step(&mut control, 16_000) < limit);
        assert!(steps < Some(200), "{steps:?} ms at the limit afterwards");
    }

    #[test]
    fn the_mix_rests_where_the_weighted_errors_balance() {
        let (lever, mix) = (MilliDegree(60_000), PerMille(500));
        let mut set_point = lever;
        let mut control = FunctionLoop::from(set_point, Errors::default(), gains());
        for _ in 0..20_000 {
            let of = (Newton(20_000), SET);
            let errors = Errors::of(of, lever - set_point, mix, &PARAMETERS);
            set_point = control.demand(errors, gains());
            control.follow(errors, gains(), set_point, set_point);
        }
        let off = (set_point - lever).0 - error(20_000);
        assert!(off.abs() < 50, "{off} mdeg");
    }
}
