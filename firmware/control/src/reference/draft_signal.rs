//! From the outputs of two draft pins to the draft, with the plausibility of the pins.

use hitch_quantities::calibration::field_parameters::DraftParameters;
use hitch_quantities::fixed::{Divisor, mul_div};
use hitch_quantities::units::{Newton, SupplyShare};
use hitch_quantities::{Inputs, Trouble};

use super::noise_check::NoiseCheck;
use super::soil_sensor::{Signal, SoilSensor, Still};

/// A quarter of the supply: the swing of a pin at its span.
const QUARTER: Divisor = Divisor::at_least_one(25_000);

/// The draft of a step.
pub type Draft = Signal<Newton>;

/// Draft pins from step to step.
#[derive(Clone, Copy, Debug, Default)]
pub struct DraftSignal {
    left: Still,
    right: Still,
    /// Of the left and the right pin.
    noise: [NoiseCheck; 2],
    sensor: SoilSensor,
}

impl DraftSignal {
    /// One step; `moves`: the hitch moves.
    pub fn step(&mut self, inputs: &Inputs, moves: bool, parameters: &DraftParameters) -> Draft {
        let left = self.left.step(inputs.left_pin);
        let still = left.max(self.right.step(inputs.right_pin));
        let draft = self.if_quiet(inputs, parameters).map(|draft| draft.0);
        let corner = if moves && !self.is_in_soil() {
            parameters.raised_filter
        } else {
            parameters.work_filter
        };
        let soil = [parameters.soil_draft.0, parameters.soil_draft.0 / 2];
        let still = (still, Trouble::PinFrozen);
        self.sensor
            .step(draft, still, corner, soil, parameters)
            .map_or_else(|signal| signal, |draft| Draft::Measured(Newton(draft)))
    }

    /// Whether the implement is in the soil.
    #[must_use]
    pub const fn is_in_soil(&self) -> bool {
        self.sensor.is_in_soil()
    }

    /// The sum of the pins' forces, unless one of the pins is too noisy.
    fn if_quiet(
        &mut self,
        inputs: &Inputs,
        parameters: &DraftParameters,
    ) -> Result<Newton, Trouble> {
        let draft = forces(inputs, parameters)?;
        let [left, right] = &mut self.noise;
        let limit = parameters.noise_limit.0;
        let noisy = |check: &mut NoiseCheck, pin: Option<SupplyShare>| {
            pin.is_some_and(|pin| check.is_noisy(pin.0, limit))
        };
        let is_noisy = [noisy(left, inputs.left_pin), noisy(right, inputs.right_pin)];
        if is_noisy.contains(&true) {
            Err(Trouble::PinNoisy)
        } else {
            Ok(draft)
        }
    }
}

/// The sum of the pins' forces.
fn forces(inputs: &Inputs, parameters: &DraftParameters) -> Result<Newton, Trouble> {
    let range = parameters.output_min..=parameters.output_max;
    let pin = |sample: Option<SupplyShare>, zero: SupplyShare, span: Newton| {
        let output = sample.filter(|output| range.contains(output))?;
        Some(Newton(mul_div((output - zero).0, span.0, QUARTER)))
    };
    let left = pin(inputs.left_pin, parameters.left_zero, parameters.left_span);
    let right = pin(
        inputs.right_pin,
        parameters.right_zero,
        parameters.right_span,
    );
    let (Some(left), Some(right)) = (left, right) else {
        return Err(Trouble::PinRange);
    };
    let draft = left + right;
    let share = parameters.difference_share.0;
    let allowed = parameters.difference + draft.magnitude().scaled(share, Divisor::THOUSAND);
    if (left - right).magnitude() > allowed {
        Err(Trouble::PinsDisagree)
    } else {
        Ok(draft)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PARAMETERS: DraftParameters = DraftParameters::NOMINAL;

    struct Pins {
        signal: DraftSignal,
        step: i32,
    }

    impl Pins {
        fn new() -> Self {
            Self {
                signal: DraftSignal::default(),
                step: 0,
            }
        }

        /// Steps with outputs whose last bits change; the last draft.
        fn run(&mut self, steps: i32, pins: [Option<i32>; 2]) -> Draft {
            let mut draft = Draft::Suspect;
            for _ in 0..steps {
                self.step += 1;
                let noise = self.step % 7 - 3;
                let [left_pin, right_pin] = pins.map(|pin| pin.map(|pin| SupplyShare(pin + noise)));
                let inputs = Inputs {
                    left_pin,
                    right_pin,
                    ..Inputs::default()
                };
                draft = self.signal.step(&inputs, false, &PARAMETERS);
            }
            draft
        }
    }

    fn newton(draft: Draft) -> i32 {
        match draft {
            Draft::Measured(draft) => draft.0,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_draft_is_the_sum_of_both_pins_by_zero_and_span() {
        let draft = newton(Pins::new().run(2_000, [Some(56_250), Some(54_375)]));
        assert!((draft - 17_000).abs() < 20, "{draft} N");
        let draft = newton(Pins::new().run(2_000, [Some(50_000), Some(50_000)]));
        assert!(draft.abs() < 20, "{draft} N");
    }

    #[test]
    fn a_missing_or_impossible_pin_is_lost_after_the_check_time_and_used_again_when_healthy() {
        let good = [Some(55_000), Some(55_000)];
        for (bad, trouble) in [
            ([None, Some(55_000)], Trouble::PinRange),
            ([Some(0), Some(55_000)], Trouble::PinRange),
            ([Some(55_000), Some(99_500)], Trouble::PinRange),
            ([Some(50_000), Some(56_000)], Trouble::PinsDisagree),
        ] {
            let mut pins = Pins::new();
            let before = newton(pins.run(1_000, good));
            assert_eq!(pins.run(PARAMETERS.check_time.0 - 1, bad), Draft::Suspect);
            assert_eq!(pins.run(1, bad), Draft::Lost(trouble));
            let healthy = PARAMETERS.healthy_time.0;
            assert_eq!(pins.run(healthy - 1, good), Draft::Lost(trouble));
            let after = newton(pins.run(100, good));
            assert!((after - before).abs() < 50, "{before} and {after} N");
        }
    }

    #[test]
    fn a_pin_of_ten_times_the_noise_is_lost_and_a_blow_of_its_nominal_force_is_not() {
        let mut random = fastrand::Rng::with_seed(1);
        let mut signal = DraftSignal::default();
        let mut run = |steps: i32, largest: i32, output: i32| {
            (0..steps).fold(Draft::Suspect, |_, _| {
                let mut pin =
                    |largest: i32| Some(SupplyShare(output + random.i32(-largest..=largest)));
                let inputs = Inputs {
                    left_pin: pin(largest),
                    right_pin: pin(173),
                    ..Inputs::default()
                };
                signal.step(&inputs, false, &PARAMETERS)
            })
        };
        for output in [55_000, 80_000, 55_000] {
            for _ in 0..200 {
                assert!(!matches!(run(1, 173, output), Draft::Lost(_)));
            }
            assert!(matches!(run(1, 173, output), Draft::Measured(_)));
        }
        assert_eq!(run(100, 1_732, 55_000), Draft::Lost(Trouble::PinNoisy));
    }

    #[test]
    fn a_short_gap_leaves_the_draft_as_it_was() {
        let mut pins = Pins::new();
        let before = newton(pins.run(1_000, [Some(55_000), Some(55_000)]));
        assert_eq!(pins.run(20, [Some(100_000), Some(0)]), Draft::Suspect);
        let after = newton(pins.run(1, [Some(55_000), Some(55_000)]));
        assert!((after - before).abs() < 20, "{before} and {after} N");
    }

    #[test]
    fn a_pin_that_stands_still_in_the_soil_is_not_used_and_then_lost() {
        let mut pins = Pins::new();
        pins.run(1_000, [Some(55_000), Some(55_000)]);
        let inputs = Inputs {
            left_pin: Some(SupplyShare(55_000)),
            right_pin: Some(SupplyShare(55_001)),
            ..Inputs::default()
        };
        let drafts: std::vec::Vec<Draft> = (0..600)
            .map(|_| pins.signal.step(&inputs, false, &PARAMETERS))
            .collect();
        assert!(matches!(drafts[10], Draft::Measured(_)));
        assert!(drafts[30..450].iter().all(|draft| *draft == Draft::Suspect));
        assert_eq!(drafts[599], Draft::Lost(Trouble::PinFrozen));
    }

    #[test]
    fn soil_is_left_at_half_of_the_draft_at_which_it_is_entered() {
        let mut pins = Pins::new();
        let output = |newton: i32| Some(50_000 + newton / 2 * 25_000 / 40_000);
        let mut is_in_soil = |newton| {
            pins.run(2_000, [output(newton), output(newton)]);
            pins.signal.is_in_soil()
        };
        assert!(!is_in_soil(1_400));
        assert!(is_in_soil(1_700));
        assert!(is_in_soil(900));
        assert!(!is_in_soil(600));
    }
}
