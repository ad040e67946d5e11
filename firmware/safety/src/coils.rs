//! Watches the coils: what was asked for against what is measured.

use hitch_quantities::calibration::design_parameters::SafetyParameters;
use hitch_quantities::units::{MilliAmp, Millisecond};
use hitch_quantities::{CoilCurrents, Inputs};

/// What is wrong with a coil in this step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CoilFaults {
    /// Less than half of what was asked for.
    pub open: bool,
    /// More than was asked for, or than the coil bears.
    pub short: bool,
    /// Something although nothing was asked for.
    pub stuck: bool,
}

/// The watch.
#[derive(Clone, Copy, Debug, Default)]
pub struct CoilWatch {
    /// How long each coil has been off.
    off_for: [Millisecond; 2],
}

impl CoilWatch {
    /// One step with the currents that were asked for in the last one; a coil that isn't measured is healthy.
    pub fn judge(
        &mut self,
        asked: CoilCurrents,
        inputs: &Inputs,
        parameters: &SafetyParameters,
    ) -> CoilFaults {
        let mut faults = CoilFaults::default();
        let coils = [
            (asked.lift, inputs.lift_current),
            (asked.lower, inputs.lower_current),
        ];
        for ((asked, measured), off_for) in coils.into_iter().zip(&mut self.off_for) {
            let off = asked <= MilliAmp::ZERO;
            *off_for = off_for.counted_while(off).min(parameters.decay_time);
            let Some(measured) = measured else {
                continue;
            };
            faults.open |= asked >= parameters.testable_current && measured < MilliAmp(asked.0 / 2);
            faults.short |= !off && measured - asked > parameters.excess_current;
            let decayed = *off_for >= parameters.decay_time;
            faults.stuck |= decayed && measured > parameters.leftover_current;
        }
        faults
    }
}
