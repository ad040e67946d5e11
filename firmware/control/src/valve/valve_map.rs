//! The valve map and its inverse: which current lets which flow through.
//!
//! The curve itself is a table of the calibration ([`hitch_quantities::calibration::valve_table`]).
//!
//! * No flow is no current, and no current is no flow.
//! * The current of the smallest flow is just above the threshold; that of any flow beyond saturation is the
//!   saturation current.
//! * Lifting is compensated: flow depends on the current alone. Lowering goes with the root of the
//!   pressure drop (turbulent orifice, `Q = Cd A sqrt(2 dp / rho)`), so a flow is brought to the
//!   drop at which the table was measured: `Q_ref = Q sqrt(dp_ref / dp)`.

use hitch_quantities::Calibration;
use hitch_quantities::units::{MicroLitrePerSecond, MilliAmp, MilliBar};

use super::drop_scale::{DropReference, DropScale};
use super::inverse_curve::{FlowSteps, InverseCurve};

/// What the inverse maps need of a calibration, worked out once.
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

    /// Makes these the curves of a calibration, in their place. Not inlined: it would add to the stack of a step.
    #[inline(never)]
    pub fn fill(&mut self, calibration: &Calibration) {
        self.reference = DropReference::new(calibration.hydraulics.reference_drop);
        self.lift.fill(&calibration.lift, FlowSteps::MICROLITRES);
        self.lower.fill(&calibration.lower, self.reference.steps());
    }

    /// The lowering valve's scale at a pressure drop.
    #[must_use]
    pub fn scale(&self, drop: MilliBar) -> DropScale {
        DropScale::new(&self.reference, drop)
    }

    /// The maps at a scale of the lowering valve.
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
