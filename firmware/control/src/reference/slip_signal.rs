//! Slip of the driven wheels from ground speed and wheel speed, with the learned rolling radius.
//!
//! Slip is `1 - ground / (k wheel)`. The factor `k` is the mean of `ground / wheel` while slip is unlikely: above the ground, at
//! speed (patents of New Holland average it so).

use hitch_quantities::calibration::field_parameters::SlipParameters;
use hitch_quantities::fixed::{Divisor, behind, mul_div, mul_shift_16};
use hitch_quantities::units::{MillimetrePerSecond, PerMille};
use hitch_quantities::{Inputs, Trouble};

use super::low_pass::LowPass;
use super::received::Received;

/// One, of 2^-16.
const ONE: i32 = 1 << 16;
/// Further fraction bits of the factor while it is averaged.
const BITS: u32 = 10;

/// Fraction bits of the slip in its filter.
const FILTER_BITS: u32 = 8;

/// Speeds, rolling radius and slip from step to step.
#[derive(Clone, Copy, Debug)]
pub struct SlipSignal {
    ground: Received,
    wheel: Received,
    /// One speed stands still while the other one changes, until both change.
    one_is_frozen: bool,
    /// Of 2^-26.
    factor: i32,
    filter: LowPass,
}

impl Default for SlipSignal {
    fn default() -> Self {
        Self {
            ground: Received::default(),
            wheel: Received::default(),
            one_is_frozen: false,
            factor: ONE << BITS,
            filter: LowPass::default(),
        }
    }
}

impl SlipSignal {
    /// One step: the slip; `Ok(None)` below the lowest speed.
    ///
    /// # Errors
    /// The speed that is lost.
    pub fn step(
        &mut self,
        inputs: &Inputs,
        in_soil: bool,
        parameters: &SlipParameters,
    ) -> Result<Option<PerMille>, Trouble> {
        self.ground.step(inputs.ground_speed, parameters.time_out);
        self.wheel.step(inputs.wheel_speed, parameters.time_out);
        let found = self.speeds(parameters);
        let Ok(Some((ground, wheel))) = found else {
            self.filter.reset();
            return found.map(|_| None);
        };
        if !in_soil {
            self.learn(ground, wheel, parameters);
        }
        let rolling = mul_shift_16(wheel.0, self.factor >> BITS);
        let share = mul_div(ground.0, 1_000, Divisor::at_least_one(rolling));
        let slip = PerMille::WHOLE - PerMille(share);
        let fine = slip.limited(-PerMille::WHOLE, PerMille::WHOLE).0 << FILTER_BITS;
        let filtered = self.filter.step(fine, parameters.filter);
        Ok(Some(PerMille(filtered >> FILTER_BITS)))
    }

    /// The ground speed, if it is known.
    #[must_use]
    pub const fn ground_speed(&self) -> Option<MillimetrePerSecond> {
        self.ground.last
    }

    /// Both speeds; none below the lowest speed.
    fn speeds(
        &mut self,
        parameters: &SlipParameters,
    ) -> Result<Option<(MillimetrePerSecond, MillimetrePerSecond)>, Trouble> {
        let ground = self.ground.last.ok_or(Trouble::GroundSpeed)?;
        let wheel = self.wheel.last.ok_or(Trouble::WheelSpeed)?;
        let [ground_is_still, wheel_is_still] =
            [&self.ground, &self.wheel].map(|speed| speed.still >= parameters.frozen_time);
        let moves = ground.max(wheel) >= parameters.lowest_speed;
        // Two speeds that are both still say nothing about each other.
        if !(moves && ground_is_still && wheel_is_still) {
            self.one_is_frozen = moves && (ground_is_still || wheel_is_still);
        }
        if self.one_is_frozen {
            return Err(Trouble::SpeedFrozen);
        }
        Ok((ground >= parameters.lowest_speed).then_some((ground, wheel)))
    }

    fn learn(
        &mut self,
        ground: MillimetrePerSecond,
        wheel: MillimetrePerSecond,
        parameters: &SlipParameters,
    ) {
        let range = mul_div(parameters.radius_range.0, ONE, Divisor::THOUSAND);
        let present = mul_div(ground.0, ONE, Divisor::at_least_one(wheel.0));
        // `clamp` panics on crossed limits, which the linker cannot exclude.
        let present = present
            .max(ONE.saturating_sub(range))
            .min(ONE.saturating_add(range));
        let time = parameters.radius_time.divisor();
        self.factor = behind(self.factor, present << BITS, time);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PARAMETERS: SlipParameters = SlipParameters::NOMINAL;

    /// Speeds received each 100 ms, with a last digit that changes; the last slip.
    fn run(
        signal: &mut SlipSignal,
        steps: i32,
        [ground, wheel]: [Option<i32>; 2],
        in_soil: bool,
    ) -> Result<Option<PerMille>, Trouble> {
        let mut found = Ok(None);
        for step in 0..steps {
            let now = step % 100 == 0;
            let digit = step / 100 % 2;
            let speed = |value: Option<i32>| {
                value
                    .filter(|_| now)
                    .map(|value| MillimetrePerSecond(value + digit))
            };
            let inputs = Inputs {
                ground_speed: speed(ground),
                wheel_speed: speed(wheel),
                ..Inputs::default()
            };
            found = signal.step(&inputs, in_soil, &PARAMETERS);
        }
        found
    }

    fn slip(found: Result<Option<PerMille>, Trouble>) -> i32 {
        found.unwrap().unwrap().0
    }

    #[test]
    fn slip_is_the_part_of_the_wheel_speed_that_is_missing_on_the_ground() {
        let mut signal = SlipSignal::default();
        let found = run(&mut signal, 5_000, [Some(1_600), Some(2_000)], true);
        assert!((slip(found) - 200).abs() <= 2, "{found:?}");
    }

    #[test]
    fn the_rolling_radius_is_learned_above_the_ground_only() {
        let mut signal = SlipSignal::default();
        let speeds = [Some(1_880), Some(2_000)];
        let _ = run(&mut signal, 20_000, speeds, true);
        assert!((slip(run(&mut signal, 1_000, speeds, true)) - 60).abs() <= 2);
        let _ = run(&mut signal, 20_000, speeds, false);
        assert!(slip(run(&mut signal, 5_000, speeds, true)).abs() <= 2);
        let found = slip(run(&mut signal, 5_000, [Some(1_504), Some(2_000)], true));
        assert!((found - 200).abs() <= 2, "{found}");
    }

    #[test]
    fn a_wrong_speed_takes_the_radius_no_further_than_its_range() {
        let mut signal = SlipSignal::default();
        let _ = run(&mut signal, 60_000, [Some(1_000), Some(3_000)], false);
        let found = slip(run(&mut signal, 5_000, [Some(2_000), Some(2_000)], true));
        assert!((found + 176).abs() <= 3, "1 - 1 / 0.85, not {found}");
    }

    #[test]
    fn below_the_lowest_speed_there_is_no_slip() {
        let mut signal = SlipSignal::default();
        let found = run(&mut signal, 5_000, [Some(880), Some(2_000)], true);
        assert_eq!(found, Ok(None));
    }

    #[test]
    fn a_speed_that_is_silent_or_stands_still_is_lost() {
        let mut signal = SlipSignal::default();
        let both = [Some(1_800), Some(2_000)];
        let _ = run(&mut signal, 1_000, both, true);
        let found = run(&mut signal, 700, [None, Some(2_000)], true);
        assert_eq!(found, Err(Trouble::GroundSpeed));
        let _ = run(&mut signal, 1_000, both, true);
        let found = run(&mut signal, 700, [Some(1_800), None], true);
        assert_eq!(found, Err(Trouble::WheelSpeed));
    }

    /// Steps with both speeds in each; the last slip.
    fn told(
        signal: &mut SlipSignal,
        steps: i32,
        speeds: impl Fn(i32) -> [i32; 2],
    ) -> Result<Option<PerMille>, Trouble> {
        let mut slip = Ok(None);
        for step in 0..steps {
            let [ground, wheel] = speeds(step).map(MillimetrePerSecond);
            let inputs = Inputs {
                ground_speed: Some(ground),
                wheel_speed: Some(wheel),
                ..Inputs::default()
            };
            slip = signal.step(&inputs, true, &PARAMETERS);
        }
        slip
    }

    #[test]
    fn a_speed_that_stands_still_is_lost_until_it_changes_even_if_the_other_one_rests_too() {
        let mut signal = SlipSignal::default();
        let found = told(&mut signal, 4_000, |step| [1_800, 2_000 + step % 5]);
        assert_eq!(found, Err(Trouble::SpeedFrozen));
        let found = told(&mut signal, 4_000, |_| [1_800, 2_000]);
        assert_eq!(found, Err(Trouble::SpeedFrozen));
        let found = told(&mut signal, 10, |step| [1_800 + step, 2_000 + step]);
        assert!(found.is_ok(), "{found:?}");
    }

    #[test]
    fn a_tractor_that_stops_with_one_speed_before_the_other_has_lost_none() {
        let mut signal = SlipSignal::default();
        let _ = told(&mut signal, 2_000, |step| {
            [1_800 + step % 5, 2_000 + step % 5]
        });
        for _ in 0..80 {
            let found = told(&mut signal, 100, |step| [0, (50 - step).max(0)]);
            assert_eq!(found, Ok(None));
        }
    }
}
