//! What the drivers of the coils get.

use crate::control::Outputs;
use crate::control::units::Duty;

/// Steps of the timer in half a pulse: 168 MHz, counted up and down at 16 kHz.
pub const PWM_STEPS: u16 = 5_250;

/// A compare value of the pulse-width timer: 0 is off, [`PWM_STEPS`] is on throughout.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Compare(u16);

impl Compare {
    /// The register's value.
    #[must_use]
    pub const fn get(self) -> u16 {
        self.0
    }

    /// The value of a register; beyond [`PWM_STEPS`] it is on throughout.
    #[must_use]
    pub fn new(register: u16) -> Self {
        Self(register.min(PWM_STEPS))
    }
}

impl From<Duty> for Compare {
    fn from(duty: Duty) -> Self {
        // 5 250 steps are 100 000 thousandths of a percent: 21 of 400.
        let steps = (duty.limited(Duty::ZERO, Duty(100_000)).0 * 21 + 200) / 400;
        Self::new(u16::try_from(steps).unwrap_or(0))
    }
}

/// Both coils and the line that enables their drivers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Drive {
    /// Lift coil.
    pub lift: Compare,
    /// Lowering coil.
    pub lower: Compare,
    /// The enable line: without it the drivers pass no current whatever the pulses say.
    pub enable: bool,
}

impl Drive {
    /// No current.
    pub const OFF: Self = Self {
        lift: Compare(0),
        lower: Compare(0),
        enable: false,
    };
}

impl From<&Outputs> for Drive {
    /// The line is only up while a coil is meant to have a current and nothing is tripped or faulty.
    fn from(outputs: &Outputs) -> Self {
        let (lift, lower) = (outputs.lift_duty.into(), outputs.lower_duty.into());
        let asked = lift != Compare(0) || lower != Compare(0);
        match asked && outputs.fault.is_none() && outputs.trip.is_none() {
            true => Self {
                lift,
                lower,
                enable: true,
            },
            false => Self::OFF,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Fault;

    #[test]
    fn a_duty_is_its_share_of_the_steps() {
        let compare = |duty| Compare::from(Duty(duty)).get();
        assert_eq!(
            [compare(0), compare(50_000), compare(100_000)],
            [0, 2_625, 5_250]
        );
        assert_eq!([compare(i32::MIN), compare(i32::MAX)], [0, 5_250]);
    }

    #[test]
    fn a_fault_drops_pulses_and_line_together() {
        let lifting = Outputs {
            lift_duty: Duty(40_000),
            ..Outputs::default()
        };
        assert!(Drive::from(&lifting).enable);
        let faulty = Outputs {
            fault: Some(Fault::Angle),
            ..lifting
        };
        assert_eq!(Drive::from(&faulty), Drive::OFF);
        assert_eq!(Drive::from(&Outputs::default()), Drive::OFF);
    }
}
