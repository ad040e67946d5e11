//! Row 8: a sensor that shows noise at rest, and falls still.

use super::*;

#[test]
fn a_trembling_sensor_that_falls_still_is_frozen_also_at_rest() {
    let still_after = |noise: [i32; 4]| {
        let mut rig = Rig::armed();
        for step in 0..2_000 {
            rig.step_with(Order::Rest, |inputs| {
                inputs.rocker_angle = Some(MilliDegree(90_000 + noise[step % 4]));
            });
        }
        (1..=500).find(|_| {
            rig.step_with(Order::Rest, |inputs| {
                inputs.rocker_angle = Some(MilliDegree(91_000))
            });
            rig.envelope.tripped() == Some(Trip::AngleFrozen)
        })
    };
    assert_eq!(
        still_after([0, 40, -20, 20]),
        Some(21),
        "the first one is a step"
    );
    assert_eq!(still_after([0; 4]), None, "it never trembled");
    assert_eq!(
        still_after([0, 20, 40, 60]),
        None,
        "two steps on for one back is motion"
    );
}

#[test]
fn a_sensor_is_known_to_tremble_after_so_many_steps() {
    let mut known_after = None;
    for steps in (0..400).step_by(4) {
        let mut rig = Rig::armed();
        rig.envelope = Envelope::default();
        let mut at = |angle| {
            rig.step_with(Order::Rest, |inputs| {
                inputs.rocker_angle = Some(MilliDegree(angle))
            });
        };
        // One digit up, then two or three of them at a time.
        (0..steps).for_each(|step| at(90_000 + [0, 20, -20, 40][step % 4]));
        (0..30).for_each(|_| at(90_500));
        if rig.envelope.tripped() == Some(Trip::AngleFrozen) {
            known_after = known_after.or(Some(steps));
        }
    }
    assert_eq!(known_after, Some(32));
}

#[test]
fn steps_of_up_to_a_digit_and_a_half_are_no_tremble() {
    let is_watched = |back: i32| {
        let mut rig = Rig::armed();
        rig.envelope = Envelope::default();
        let mut at = |angle| {
            rig.step_with(Order::Rest, |inputs| {
                inputs.rocker_angle = Some(MilliDegree(angle))
            });
        };
        // Onwards digit by digit, so that the digit is known; then a digit up, and further back.
        let onwards = (0..100).map(|_| 40);
        let to_and_fro = (0..200).flat_map(|_| [-back, 40]);
        let mut angle = 90_000;
        for step in onwards.chain(to_and_fro) {
            angle += step;
            at(angle);
        }
        (0..30).for_each(|_| at(angle + 500));
        rig.envelope.tripped() == Some(Trip::AngleFrozen)
    };
    assert!(!is_watched(60));
    assert!(is_watched(61));
}

/// White noise and a converter's digit of 0.047 degree, while the hitch sinks by three digits a minute: near a step of
/// the converter the reading trembles, half a digit on it stands still. Nobody may take that for a fault; a sensor
/// whose noise spans more than a digit never stands still for 20 ms, and is known to be frozen when it does.
#[test]
fn a_healthy_sensor_is_not_frozen_whatever_its_digit() {
    const DIGIT: f64 = 47.0;
    for (sigma_in_digits, is_watched) in [
        (0.15, false),
        (0.3, false),
        (0.55, false),
        (0.8, false),
        (1.4, true),
        (3.0, true),
    ] {
        let mut random = fastrand::Rng::with_seed(7);
        let mut rig = Rig::armed();
        let mut at = |angle_mdeg: f64| {
            let read = (angle_mdeg / DIGIT).round() * DIGIT;
            rig.step_with(Order::Rest, |inputs| {
                inputs.rocker_angle = Some(MilliDegree(read.round() as i32));
            });
            rig.envelope.tripped()
        };
        for step in 0..600_000 {
            let sunk_mdeg = f64::from(step) * 3.0 * DIGIT / 60_000.0;
            // A sum of twelve is as good as normal here.
            let normal: f64 = (0..12).map(|_| random.f64()).sum::<f64>() - 6.0;
            let noise_mdeg = sigma_in_digits * DIGIT * normal;
            let tripped = at(90_000.0 - sunk_mdeg + noise_mdeg);
            assert_eq!(tripped, None, "{sigma_in_digits} digits, after {step} ms");
        }
        let still = (0..100).map(|_| at(88_000.0)).last().flatten();
        let frozen = is_watched.then_some(Trip::AngleFrozen);
        assert_eq!(still, frozen, "{sigma_in_digits} digits");
    }
}

#[test]
fn a_sensor_coarser_than_its_noise_may_stand_still() {
    // Trembles wherever it rests near a step of the converter: every other sample is like the last one.
    let mut rig = Rig::armed();
    for step in 0..20_000 {
        rig.step_with(Order::Rest, |inputs| {
            inputs.rocker_angle = Some(MilliDegree(90_000 + step / 2 % 2 * 50));
        });
    }
    // ... and not between two steps.
    for _ in 0..20_000 {
        rig.step_with(Order::Rest, |inputs| {
            inputs.rocker_angle = Some(MilliDegree(90_100));
        });
    }
    assert_eq!(rig.envelope.tripped(), None);
}
