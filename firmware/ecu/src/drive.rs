//! Values of the coil drivers.

use hitch_quantities::Outputs;
use hitch_quantities::units::Duty;

/// Compare value of the PWM timer: 0 is off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Compare(u16);

impl Compare {
    /// Off.
    pub const OFF: Self = Self(0);

    /// The register's value.
    #[must_use]
    pub const fn get(self) -> u16 {
        self.0
    }

    /// The value for a duty on a timer with `pwm_steps` steps ([`BoardScaling::pwm_steps`](crate::BoardScaling)).
    #[must_use]
    pub fn of(duty: Duty, pwm_steps: u16) -> Self {
        let share = duty.limited(Duty::ZERO, Duty::WHOLE).0.unsigned_abs();
        let whole = Duty::WHOLE.0.unsigned_abs();
        let steps = share
            .saturating_mul(u32::from(pwm_steps))
            .saturating_add(whole / 2)
            / whole;
        Self(u16::try_from(steps).unwrap_or(0).min(pwm_steps))
    }
}

/// Both coils and the enable line of their drivers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Drive {
    /// Lift coil.
    pub lift: Compare,
    /// Lowering coil.
    pub lower: Compare,
    /// Enable line: without it the drivers pass no current, independent of the pulses.
    pub enable: bool,
}

impl Drive {
    /// No current.
    pub const OFF: Self = Self {
        lift: Compare::OFF,
        lower: Compare::OFF,
        enable: false,
    };
}

impl Drive {
    /// The values for a timer with `pwm_steps` steps. The line is high only while a coil current is requested, without
    /// a trip or fault.
    #[must_use]
    pub fn new(outputs: &Outputs, pwm_steps: u16) -> Self {
        let lift = Compare::of(outputs.lift_duty, pwm_steps);
        let lower = Compare::of(outputs.lower_duty, pwm_steps);
        let asked = lift != Compare::OFF || lower != Compare::OFF;
        if asked && outputs.fault.is_none() && outputs.trip.is_none() {
            Self {
                lift,
                lower,
                enable: true,
            }
        } else {
            Self::OFF
        }
    }
}

#[cfg(test)]
mod tests {
    use hitch_quantities::Fault;

    use super::*;

    #[test]
    fn a_duty_is_its_share_of_the_steps() {
        let compare = |duty| Compare::of(Duty(duty), 5_250).get();
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
        assert!(Drive::new(&lifting, 5_250).enable);
        let faulty = Outputs {
            fault: Some(Fault::Angle),
            ..lifting
        };
        assert_eq!(Drive::new(&faulty, 5_250), Drive::OFF);
        assert_eq!(Drive::new(&Outputs::default(), 5_250), Drive::OFF);
    }
}
