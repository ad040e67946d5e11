//! A proportional solenoid valve as an orifice: the lift valve and the lowering valve.

use crate::components::valve_curve::ValveCurve;

/// Proportional valve: a flow characteristic at a reference drop, scaled by the square root of the drop.
///
/// `Q = Q_ref(I) * sqrt(dp / dp_ref)`, which is equation 5 (lift) and 6 (lowering) of the paper with
/// `Cd A(I) sqrt(2/rho) = Q_ref(I) / sqrt(dp_ref)`. Below the transition drop the flow becomes laminar,
/// `Q ~ dp / (dp^2 + dp_t^2)^(1/4)` (Simscape's orifice); a transition drop of zero gives the square root law.
#[derive(Debug, Clone, PartialEq)]
pub struct OrificeValve {
    /// Flow over current at the reference drop.
    pub curve: ValveCurve,
    /// Pressure drop at which the curve holds, Pa.
    pub reference_drop_pa: f64,
    /// Drop of the transition from laminar to turbulent flow, Pa.
    pub transition_drop_pa: f64,
}

impl OrificeValve {
    /// Flow, m3/s, over a drop in Pa with a flow of `reference_flow_m3_s` at the reference drop; zero against the drop.
    #[inline]
    #[must_use]
    pub fn flow_m3_s(&self, reference_flow_m3_s: f64, drop_pa: f64) -> f64 {
        if drop_pa <= 0.0 {
            return 0.0;
        }
        if self.transition_drop_pa == 0.0 {
            return reference_flow_m3_s * (drop_pa / self.reference_drop_pa).sqrt();
        }
        // Ratio of the laws at both drops, with few roots and divisions: this is in the plant's innermost loop.
        let at_reference = squares(self.reference_drop_pa, self.transition_drop_pa);
        let at_drop = squares(drop_pa, self.transition_drop_pa);
        let laminar = (at_reference / at_drop).sqrt().sqrt();
        reference_flow_m3_s * (drop_pa / self.reference_drop_pa) * laminar
    }
}

/// Sum of squares.
fn squares(a: f64, b: f64) -> f64 {
    a * a + b * b
}
