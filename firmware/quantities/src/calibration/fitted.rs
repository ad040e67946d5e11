//! What a board has that the nominal machine has not, and the safety values that follow from it.

use super::block::Calibration;
use super::calibration_words::items;
use crate::units::Count;

/// What a board has that the nominal machine has not: its untaught calibration then monitors it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fitted {
    /// The rocker-angle sensor has a second, inverted track.
    pub second_track: bool,
    /// The external buttons have a second contact.
    pub second_contact: bool,
}

impl Calibration {
    /// Monitors what is fitted, and nothing else of it.
    pub fn monitor(&mut self, fitted: Fitted) {
        self.sensors.second_track = Count(i32::from(fitted.second_track));
        self.operator.second_contact = Count(i32::from(fitted.second_contact));
    }

    /// Whether a safety value differs from that of an untaught machine with what is fitted. The limits of the travel don't
    /// count: each machine is taught its own.
    #[must_use]
    pub fn has_other_safety_values(&self, fitted: Fitted) -> bool {
        let mut shipped = Self::unsealed_nominal();
        shipped.position.lower_limit = self.position.lower_limit;
        shipped.position.upper_limit = self.position.upper_limit;
        shipped.monitor(fitted);
        let mut safety = items().filter(|item| item.is_safety);
        safety.any(|item| self.word(item.first) != shipped.word(item.first))
    }
}
