//! A speed that the bus delivers now and then.

use hitch_quantities::units::{MillimetrePerSecond, Millisecond};

/// A speed that is received now and then.
#[derive(Clone, Copy, Debug, Default)]
pub struct Received {
    /// The last one; `None` once it is lost.
    pub last: Option<MillimetrePerSecond>,
    /// Time since it was received.
    age: Millisecond,
    /// For how long it has been the same.
    pub still: Millisecond,
}

impl Received {
    /// One step: what was received, if anything.
    pub fn step(&mut self, sample: Option<MillimetrePerSecond>, time_out: Millisecond) {
        self.age = self.age.next();
        self.still = self.still.next();
        if sample.is_some() {
            if sample != self.last {
                self.still = Millisecond::ZERO;
            }
            self.last = sample;
            self.age = Millisecond::ZERO;
        }
        if self.age > time_out {
            self.last = None;
        }
    }
}
