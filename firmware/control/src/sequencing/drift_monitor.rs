//! Drift monitor: limits the corrections of a hitch that drifts from its set point.
//!
//! A move that the lever did not demand is a correction: the lowering spool or the check valve leaks. A limited number
//! of corrections over a limited travel is allowed; the next one is a fault. The count of corrections decays with time
//! and is reset when the lever moves.

use hitch_quantities::Fault;
use hitch_quantities::calibration::design_parameters::HoldParameters;
use hitch_quantities::units::{Count, MicrometrePerSecond, Millisecond};

/// Counts corrections and their travel.
#[derive(Clone, Copy, Debug, Default)]
pub struct DriftMonitor {
    corrections: Count,
    /// Total travel of the corrections, nm.
    travel_nm: i32,
    age: Millisecond,
}

impl DriftMonitor {
    /// One step of time.
    pub fn tick(&mut self, parameters: &HoldParameters) {
        if self.corrections == Count::ZERO {
            return;
        }
        self.age = self.age.next();
        if self.age >= parameters.correction_memory {
            self.age = Millisecond::ZERO;
            self.corrections = self.corrections - Count(1);
            self.travel_nm = 0;
        }
    }

    /// The lever was moved: resets the monitor.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// Adds the travel of one millisecond of a correction.
    ///
    /// # Errors
    /// The total travel is too large: the leak is a burst pipe, or the sensor drifts.
    pub fn add_travel(
        &mut self,
        speed: MicrometrePerSecond,
        parameters: &HoldParameters,
    ) -> Result<(), Fault> {
        // A speed in um/s is the way of a millisecond in nm.
        self.travel_nm = self.travel_nm.saturating_add(speed.magnitude().0);
        if self.travel_nm > parameters.corrected_travel.0.saturating_mul(1000) {
            Err(Fault::Sinking)
        } else {
            Ok(())
        }
    }

    /// A correction starts.
    ///
    /// # Errors
    /// There were too many corrections.
    pub fn start_correction(&mut self, parameters: &HoldParameters) -> Result<(), Fault> {
        if self.corrections >= parameters.corrections {
            return Err(Fault::Sinking);
        }
        self.corrections = self.corrections + Count(1);
        Ok(())
    }
}
