//! Sink watch: a hitch that leaves its place by itself is brought back, but not for ever.
//!
//! A move that no lever asked for is a correction: the lowering spool or the check valve leaks. A few of them are
//! carried out, over a few degrees, the next is a fault. A correction is forgotten after a while, and all of them when
//! the lever moves.

use hitch_quantities::Fault;
use hitch_quantities::calibration::design_parameters::HoldParameters;
use hitch_quantities::units::{Count, MicrometrePerSecond, Millisecond};

/// Counts corrections.
#[derive(Clone, Copy, Debug, Default)]
pub struct SinkWatch {
    corrections: Count,
    /// What all of them together have moved the hitch, in nanometres.
    travel_nm: i32,
    age: Millisecond,
}

impl SinkWatch {
    /// Time passes.
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

    /// The lever was moved.
    pub fn new_set_point(&mut self) {
        *self = Self::default();
    }

    /// A correction goes on, for a millisecond at the speed that the valves give.
    ///
    /// # Errors
    /// All corrections together go too far: a leak that fast is a burst pipe, or the sensor drifts.
    pub fn correcting(
        &mut self,
        speed: MicrometrePerSecond,
        parameters: &HoldParameters,
    ) -> Result<(), Fault> {
        // A speed in um/s is the way of a millisecond in nm.
        self.travel_nm = self.travel_nm.saturating_add(speed.magnitude().0);
        match self.travel_nm > parameters.corrected_travel.0.saturating_mul(1000) {
            true => Err(Fault::Sinking),
            false => Ok(()),
        }
    }

    /// A correction is about to start.
    ///
    /// # Errors
    /// There were too many.
    pub fn correct(&mut self, parameters: &HoldParameters) -> Result<(), Fault> {
        if self.corrections >= parameters.corrections {
            return Err(Fault::Sinking);
        }
        self.corrections = self.corrections + Count(1);
        Ok(())
    }
}
