//! Coil drivers on any part: two PWM outputs, the enable line of the drivers, and its read-back.
//!
//! The order of writes matters. Switching off, the line goes low first: it acts on both coils, independent of the
//! pulses. Switching on, the pulses are set first: the line never enables a pulse width of an earlier millisecond.

use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal::pwm::SetDutyCycle;

use super::drive::{Compare, Drive};

/// An output did not accept its value. Both coils are off until a restart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CoilDriverError;

/// The drivers. The largest duty of both PWM outputs has to be
/// [`BoardScaling::pwm_steps`](super::BoardScaling::pwm_steps).
#[derive(Debug)]
pub struct CoilDriver<Lift, Lower, Enable, Feedback> {
    lift: Lift,
    lower: Lower,
    enable: Enable,
    feedback: Feedback,
    /// Last commanded level of the line.
    asked: bool,
    /// An output has failed.
    failed: bool,
}

impl<Lift, Lower, Enable, Feedback> CoilDriver<Lift, Lower, Enable, Feedback>
where
    Lift: SetDutyCycle,
    Lower: SetDutyCycle,
    Enable: OutputPin,
    Feedback: InputPin,
{
    /// The drivers, with outputs that are off.
    #[must_use]
    pub const fn new(lift: Lift, lower: Lower, enable: Enable, feedback: Feedback) -> Self {
        Self {
            lift,
            lower,
            enable,
            feedback,
            asked: false,
            failed: false,
        }
    }

    /// Writes the values of the drivers.
    ///
    /// # Errors
    /// If an output fails or has failed before; both coils are then off.
    pub fn drive(&mut self, drive: Drive) -> Result<(), CoilDriverError> {
        if self.failed {
            return self.cut().and(Err(CoilDriverError));
        }
        if !drive.enable {
            return self.cut();
        }
        let set = self
            .set_pulses(drive.lift, drive.lower)
            .and_then(|()| self.enable.set_high().map_err(|_| CoilDriverError));
        match set {
            Ok(()) => {
                self.asked = true;
                Ok(())
            }
            Err(error) => {
                self.failed = true;
                self.cut().and(Err(error))
            }
        }
    }

    /// Switches both coils off: the line, then the pulses. Every output is written, even if a previous one fails.
    ///
    /// # Errors
    /// If an output fails; the drivers then stay off.
    pub fn cut(&mut self) -> Result<(), CoilDriverError> {
        self.asked = false;
        let line = self.enable.set_low().map_err(|_| CoilDriverError);
        let pulses = self.set_pulses(Compare::OFF, Compare::OFF);
        let cut = line.and(pulses);
        self.failed |= cut.is_err();
        cut
    }

    /// Level of the enable line, read back at the drivers. A failed read-back differs from the commanded level, so
    /// the application treats the line as faulty.
    pub fn enable_feedback(&mut self) -> bool {
        self.feedback.is_high().unwrap_or(!self.asked)
    }

    /// Returns the outputs, in the order of [`Self::new`].
    #[must_use]
    pub fn release(self) -> (Lift, Lower, Enable, Feedback) {
        (self.lift, self.lower, self.enable, self.feedback)
    }

    fn set_pulses(&mut self, lift: Compare, lower: Compare) -> Result<(), CoilDriverError> {
        let lift = self.lift.set_duty_cycle(lift.get());
        let lower = self.lower.set_duty_cycle(lower.get());
        if lift.is_ok() && lower.is_ok() {
            Ok(())
        } else {
            Err(CoilDriverError)
        }
    }
}
