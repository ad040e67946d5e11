//! A proportional solenoid valve as an orifice: the lift valve and the lowering valve.

use crate::components::valve_curve::ValveCurve;

/// Proportional valve: a flow characteristic at a reference drop, and the square root of the drop otherwise.
///
/// `Q = Q_ref(I) * sqrt(dp / dp_ref)`, which is equation 5 (lift) and 6 (lowering) of the paper with
/// `Cd A(I) sqrt(2/rho) = Q_ref(I) / sqrt(dp_ref)`. Below the transition drop the flow turns laminar,
/// `Q ~ dp / (dp^2 + dp_t^2)^(1/4)` (Simscape's orifice); zero gives the square root alone.
#[derive(Debug, Clone, PartialEq)]
pub struct OrificeValve {
    /// Flow over current at the reference drop.
    pub curve: ValveCurve,
    /// Pressure drop at which the curve holds, Pa.
    pub reference_drop_pa: f64,
    /// Drop at which the flow turns from laminar to turbulent, Pa.
    pub transition_drop_pa: f64,
}

impl OrificeValve {
    /// Flow, m3/s, of a valve whose curve gives `reference_flow_m3_s`, over a drop in Pa; no flow against the drop.
    #[must_use]
    pub fn flow_m3_s(&self, reference_flow_m3_s: f64, drop_pa: f64) -> f64 {
        if drop_pa <= 0.0 {
            return 0.0;
        }
        if self.transition_drop_pa == 0.0 {
            return reference_flow_m3_s * (drop_pa / self.reference_drop_pa).sqrt();
        }
        // The laws at both drops over each other, in as few roots and divisions as there can be: this is in the plant's
        // innermost loop.
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
