//! The valve map and its inverse: from flow to current.
//!
//! The curve itself is a table of the calibration ([`hitch_quantities::calibration::valve_table`]).
//!
//! * No flow has no current, and no current has no flow.
//! * The smallest flow has a current just above the threshold; flows beyond saturation have the saturation current.
//! * Lifting is compensated: the flow depends on the current alone. The lowering flow is proportional to the square
//!   root of the pressure drop (turbulent orifice, `Q = Cd A sqrt(2 dp / rho)`). A flow is therefore converted to the
//!   drop of the table: `Q_ref = Q sqrt(dp_ref / dp)`.

use hitch_quantities::Calibration;
use hitch_quantities::units::{MicroLitrePerSecond, MilliAmp, MilliBar};

use super::drop_scale::{DropReference, DropScale};
use super::inverse_curve::{FlowSteps, InverseCurve};

/// Data of the inverse maps, computed once for a calibration.
#[derive(Clone, Copy, Debug)]
pub struct ValveCurves {
    lift: InverseCurve,
    lower: InverseCurve,
    reference: DropReference,
}

impl ValveCurves {
    /// No curves: no flow at any current.
    pub const EMPTY: Self = Self {
        lift: InverseCurve::EMPTY,
        lower: InverseCurve::EMPTY,
        reference: DropReference::UNKNOWN,
    };

    /// The curves of a calibration.
    #[must_use]
    pub fn of(calibration: &Calibration) -> Self {
        let mut curves = Self::EMPTY;
        curves.fill(calibration);
        curves
    }

    /// Computes the curves of a calibration in place. Not inlined: it would add to the stack of a step.
    #[inline(never)]
    pub fn fill(&mut self, calibration: &Calibration) {
        self.reference = DropReference::new(calibration.hydraulics.reference_drop);
        self.lift.fill(&calibration.lift, FlowSteps::MICROLITRES);
        self.lower.fill(&calibration.lower, self.reference.steps());
    }

    /// Flow scale of the lowering valve at a pressure drop.
    #[must_use]
    pub fn scale(&self, drop: MilliBar) -> DropScale {
        DropScale::new(&self.reference, drop)
    }

    /// The maps at a flow scale of the lowering valve.
    #[must_use]
    pub const fn at(&self, scale: DropScale) -> ValveMap<'_> {
        ValveMap {
            curves: self,
            scale,
        }
    }
}

/// The inverse maps of both valves at the present pressure drop.
#[derive(Clone, Copy, Debug)]
pub struct ValveMap<'a> {
    curves: &'a ValveCurves,
    scale: DropScale,
}

impl ValveMap<'_> {
    /// Lift current for a flow into the cylinder.
    #[must_use]
    pub fn lift_current(&self, flow: MicroLitrePerSecond) -> MilliAmp {
        self.curves.lift.current(flow.0)
    }

    /// Lowering current for a flow out of the cylinder.
    #[must_use]
    pub fn lower_current(&self, flow: MicroLitrePerSecond) -> MilliAmp {
        self.curves.lower.current(self.scale.steps(flow))
    }

    /// Largest flow into the cylinder.
    #[must_use]
    pub fn lift_saturation(&self) -> MicroLitrePerSecond {
        self.curves.lift.saturation()
    }

    /// Largest flow out of the cylinder at the present drop.
    #[must_use]
    pub fn lower_saturation(&self) -> MicroLitrePerSecond {
        self.scale.to_present(self.curves.lower.saturation())
    }
}
