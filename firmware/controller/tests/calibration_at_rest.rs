//! A change of the calibration moves no hitch that is at rest: the operator's lever does.

use hitch_controller::Controller;
use hitch_quantities::calibration::calibration_words::{CALIBRATION_WORDS, WordRange, word_range};
use hitch_quantities::units::{Micrometre, MilliAmp, MilliDegree};
use hitch_quantities::{Calibration, Inputs, Outputs, State, ValidCalibration};

/// Time for which a hitch is watched after a change, ms.
const WATCHED_MS: usize = 10_000;

/// A hitch in integers that follows its coils like a valve without lag.
#[derive(Clone)]
struct Hitch {
    controller: Controller,
    angle_micro: i64,
    lever: i32,
    steps: usize,
}

impl Hitch {
    /// Has been lifted or lowered to `lever`, and rests.
    fn resting_at(lever: i32) -> Self {
        let mut hitch = Self {
            controller: Controller::new(ValidCalibration::nominal()),
            angle_micro: 90_000_000,
            lever: 88_000,
            steps: 0,
        };
        hitch.run(10);
        hitch.lever = 91_000;
        hitch.run(50);
        hitch.lever = lever;
        let outputs = hitch.run(10_000);
        assert!(matches!(outputs.state, State::Holding | State::Floating));
        hitch
    }

    fn step(&mut self) -> Outputs {
        self.steps += 1;
        let noise = [0, 40, 20, -40][self.steps % 4];
        let inputs = Inputs {
            lever: Some(MilliDegree(self.lever)),
            rocker_angle: Some(MilliDegree((self.angle_micro / 1_000) as i32 + noise)),
            ..Inputs::default()
        };
        let outputs = self.controller.step(&inputs);
        let up = i64::from((outputs.lift_current.0 - 1_126).max(0)) * 40;
        let down = i64::from((outputs.lower_current.0 - 999).max(0)) * 40;
        self.angle_micro = (self.angle_micro + up - down).clamp(44_100_000, 135_900_000);
        outputs
    }

    fn run(&mut self, steps: usize) -> Outputs {
        (0..steps).map(|_| self.step()).last().unwrap_or_default()
    }

    /// Milliseconds; true if no coil is ever on.
    fn is_still(&mut self, ms: usize) -> bool {
        (0..ms).all(|_| {
            let outputs = self.step();
            outputs.lift_current == MilliAmp(0) && outputs.lower_current == MilliAmp(0)
        })
    }

    /// At rest a fifth of a degree above its set point, with the lever almost moved.
    fn displaced() -> Self {
        let mut hitch = Self::resting_at(90_000);
        hitch.lever = 90_150;
        hitch.angle_micro = 90_200_000;
        assert!(hitch.is_still(2_000), "inside both bands");
        hitch
    }
}

/// Xorshift: the same sequence everywhere.
struct Random(u64);

impl Random {
    fn between(&mut self, low: i32, high: i32) -> i32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        let range = i64::from(high) - i64::from(low) + 1;
        let above = ((self.0 >> 32) as i64).rem_euclid(range);
        (i64::from(low) + above) as i32
    }
}

/// Both ends of a word's range, its neighbours, and some in between.
fn values(word: usize, range: WordRange, random: &mut Random) -> Vec<i32> {
    let present = Calibration::nominal().to_words()[word];
    let mut values = vec![range.min, range.max, present / 2, present + 1];
    values.extend((0..2).map(|_| random.between(range.min, range.max)));
    values.retain(|value| (range.min..=range.max).contains(value) && *value != present);
    values
}

/// The nominal calibration with another value, if that is valid.
fn changed(word: usize, value: i32) -> Option<ValidCalibration> {
    let mut words = Calibration::nominal().to_words();
    words[word] = value;
    Calibration::from_words(&words).seal().ok()
}

// REQ-SAFE-14
#[test]
fn no_value_of_the_calibration_moves_a_hitch_at_rest() {
    const SEED: u64 = 20;
    let mut random = Random(SEED);
    // In between, at both limits with the lever beyond them.
    let places = [
        Hitch::displaced(),
        Hitch::resting_at(149_000),
        Hitch::resting_at(40_000),
    ];
    let (mut words, mut applied) = (0, 0);
    for word in 0..CALIBRATION_WORDS {
        let Some(range) = word_range(word) else {
            continue;
        };
        words += 1;
        // Whatever is not live locks, wherever the hitch is.
        let watched = if range.class.is_live() {
            &places[..]
        } else {
            &places[..1]
        };
        for value in values(word, range, &mut random) {
            let Some(calibration) = changed(word, value) else {
                continue;
            };
            for place in watched {
                let mut hitch = place.clone();
                hitch.controller.apply(calibration.clone());
                assert!(
                    hitch.is_still(WATCHED_MS),
                    "word {word} = {value}, seed {SEED}"
                );
                applied += 1;
            }
        }
    }
    println!("{words} words, {applied} changes of {WATCHED_MS} ms");
    assert_eq!(words, CALIBRATION_WORDS - 2, "without version and checksum");
    assert!(applied > 3 * words, "{applied}");
}

/// The nominal calibration after a change.
fn with(change: impl Fn(&mut Calibration)) -> ValidCalibration {
    let mut calibration = Calibration::nominal();
    change(&mut calibration);
    calibration.seal().expect("valid")
}

// REQ-SAFE-14
#[test]
fn a_limit_that_moves_the_set_point_locks_and_waits_for_the_lever() {
    for (lever, change) in [
        (90_000, (110_000, 135_400)),
        (90_000, (44_600, 60_000)),
        (149_000, (44_600, 138_000)),
        (40_000, (42_000, 135_400)),
    ] {
        let mut hitch = Hitch::resting_at(lever);
        hitch.controller.apply(with(|calibration| {
            let limits = &mut calibration.position;
            (limits.lower_limit, limits.upper_limit) =
                (MilliDegree(change.0), MilliDegree(change.1));
        }));
        assert!(hitch.is_still(WATCHED_MS), "{change:?}");
        assert_eq!(hitch.run(1).state, State::Locked);
    }
    let mut hitch = Hitch::resting_at(90_000);
    hitch.controller.apply(with(|calibration| {
        calibration.position.lower_limit = MilliDegree(110_000);
    }));
    for lever in [85_000, 95_000] {
        hitch.lever = lever;
        hitch.run(50);
    }
    assert_eq!(hitch.run(3_000).target, MilliDegree(110_000), "picked up");
}

// REQ-SAFE-14
#[test]
fn bands_take_effect_with_the_next_movement_of_the_lever() {
    let narrow = with(|calibration| {
        calibration.position.restart_band = Micrometre(180);
        calibration.position.lever_deadband = MilliDegree(20);
    });
    let mut hitch = Hitch::displaced();
    hitch.controller.apply(narrow);
    assert!(hitch.is_still(WATCHED_MS));
    hitch.lever = 90_400;
    assert!(!hitch.is_still(1_000), "moved by more than the old band");
    hitch.run(5_000);
    hitch.lever += 180;
    assert!(!hitch.is_still(1_000), "moved by more than the new band");
}

/// Ramps and gains change under a moving hitch; whatever else is changed makes another machine.
#[test]
fn what_a_tool_may_change_in_a_move_goes_on_and_nothing_else() {
    let resting = Hitch::resting_at(90_000);
    for word in 0..CALIBRATION_WORDS {
        let Some(range) = word_range(word) else {
            continue;
        };
        let present = Calibration::nominal().to_words()[word];
        let Some(calibration) = [present + 1, present - 1]
            .into_iter()
            .filter(|value| (range.min..=range.max).contains(value))
            .find_map(|value| changed(word, value))
        else {
            continue;
        };
        let mut hitch = resting.clone();
        hitch.controller.apply(calibration);
        let locked = hitch.run(1).state == State::Locked;
        assert_eq!(locked, !range.class.is_live(), "word {word}");
    }
}
