//! Sink watch: a hitch that leaves its place by itself is brought back, but not for ever.
//!
//! A move that no lever asked for is a correction: the lowering spool or the check valve leaks. A few
//! of them are carried out, the next is a fault. A correction is forgotten after a while, and all of
//! them when the lever moves.

use super::design_parameters::HoldParameters;
use super::mode::Fault;
use super::units::{Count, Millisecond};

/// Counts corrections.
#[derive(Clone, Copy, Debug, Default)]
pub struct SinkWatch {
    corrections: Count,
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
        }
    }

    /// The lever was moved.
    pub fn new_set_point(&mut self) {
        *self = Self::default();
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
