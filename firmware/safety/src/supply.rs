//! Watches the supply voltage: how long it has been out of its limits, gaps included.

use hitch_quantities::Inputs;
use hitch_quantities::calibration::design_parameters::SafetyParameters;
use hitch_quantities::units::Millisecond;

/// The watch.
#[derive(Clone, Copy, Debug, Default)]
pub struct SupplyWatch {
    /// Since when the supply is out of its limits, with the good samples in between.
    bad_for: Millisecond,
    /// Good samples since the last bad one.
    good_for: Millisecond,
}

impl SupplyWatch {
    /// One step; true once the supply has been out of its limits for `supply_time`. It counts as good again after half
    /// of that time without a bad sample, so a supply that comes and goes trips as fast as one that stays away.
    pub fn judge(&mut self, inputs: &Inputs, parameters: &SafetyParameters) -> bool {
        let bad = inputs
            .supply
            .is_some_and(|supply| supply < parameters.supply_min || supply > parameters.supply_max);
        let time = parameters.supply_time;
        if bad {
            self.bad_for = (self.bad_for + self.good_for).next().min(time);
            self.good_for = Millisecond::ZERO;
        } else if self.bad_for > Millisecond::ZERO {
            self.good_for = self.good_for.next();
            if self.good_for + self.good_for > time {
                *self = Self::default();
            }
        }
        self.bad_for >= time
    }
}
