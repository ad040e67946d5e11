//! The observer behind an angle sensor that lags, against the closed forms of its equations.

use hitch_control::estimation::delayed_output::{
    DelayedOutput, LaggingAngle, Pole, position_correction_nm,
};
use hitch_control::estimation::motion_observer::MotionObserver;
use hitch_control::valve::phase::{Direction, Phase};
use hitch_quantities::Calibration;
use hitch_quantities::units::{Micrometre, MicrometrePerSecond, MilliDegree, Millisecond};

const LAGS_MS: [i32; 6] = [1, 10, 50, 189, 350, 500];
/// Poles of the observer, 1/s.
const POLE: f64 = 16.0;
/// Where a motion starts, piston travel in um.
const START: i32 = 60_000;

fn moving(speed: i32) -> Phase {
    Phase::Moving {
        direction: Direction::of(speed),
        speed: MicrometrePerSecond(speed.abs()),
    }
}

/// A hitch whose valves are thought to be closed, and what its sensor shows.
struct Hitch {
    calibration: Calibration,
    observer: MotionObserver,
    travel_um: f64,
    shown_mdeg: f64,
    lag_ms: i32,
}

impl Hitch {
    /// At rest, as the sensor shows.
    fn new(lag_ms: i32) -> Self {
        let calibration = Calibration::nominal();
        let shown_mdeg = f64::from(calibration.linkage.angle(Micrometre(START)).0);
        let mut hitch = Self {
            calibration,
            observer: MotionObserver::default(),
            travel_um: f64::from(START),
            shown_mdeg,
            lag_ms,
        };
        (0..1_000).for_each(|_| hitch.step(0, Phase::Holding));
        hitch
    }

    /// One step of a hitch that moves at this speed, um/s.
    fn step(&mut self, speed: i32, phase: Phase) {
        let linkage = &self.calibration.linkage;
        self.travel_um += f64::from(speed) * 1e-3;
        let true_mdeg = f64::from(linkage.angle(Micrometre(self.travel_um.round() as i32)).0);
        let share = 1.0 - (-1.0 / f64::from(self.lag_ms)).exp();
        self.shown_mdeg += share * (true_mdeg - self.shown_mdeg);
        let shown = LaggingAngle {
            angle: MilliDegree(self.shown_mdeg.round() as i32),
            lag: Millisecond(self.lag_ms),
            linkage,
        };
        let measured = linkage.travel(shown.angle);
        let motion = &self.calibration.motion;
        self.observer.update(measured, Some(&shown), phase, motion);
    }

    /// By how much the hitch is ahead of its estimate, um.
    fn error_um(&self) -> f64 {
        self.travel_um - f64::from(self.observer.position().0)
    }
}

/// A speed that the valve model does not know makes the error `v (t + p t^2) e^(-p t)`, whatever the lag.
#[test]
fn the_error_of_the_estimate_is_that_of_three_poles_for_any_lag() {
    for speed in [40_000_i32, -40_000] {
        let peak_um = 0.0525 * f64::from(speed.abs());
        for lag_ms in LAGS_MS {
            let mut hitch = Hitch::new(lag_ms);
            let mut largest_um = 0.0_f64;
            for ms in 1..=800 {
                hitch.step(speed, moving(speed));
                let time = f64::from(ms) * 1e-3;
                let form = (time + POLE * time * time) * (-POLE * time).exp();
                let expected_um = f64::from(speed) * form;
                let error_um = hitch.error_um();
                largest_um = largest_um.max(error_um.abs());
                assert!(
                    (error_um - expected_um).abs() <= 0.06 * peak_um,
                    "{speed} um/s, {lag_ms} ms, {ms} ms: {error_um}, not {expected_um} um"
                );
            }
            assert!((largest_um / peak_um - 1.0).abs() < 0.06, "{largest_um} um");
        }
    }
}

#[test]
fn at_a_constant_speed_the_estimate_is_true_and_the_shown_position_lags_by_lag_times_speed() {
    for speed in [30_000_i32, -30_000] {
        for lag_ms in [50, 100, 189] {
            let mut hitch = Hitch::new(lag_ms);
            (0..1_200).for_each(|_| hitch.step(speed, moving(speed)));
            let error_um = hitch.error_um();
            assert!(error_um.abs() <= 60.0, "{lag_ms} ms: {error_um} um");
            let estimated = hitch.observer.speed().0;
            assert!((estimated - speed).abs() <= 600, "{estimated} um/s");
            let behind_um = (hitch.observer.position() - hitch.observer.shown_position()).0;
            let expected_um = lag_ms * speed / 1_000;
            assert!(
                (behind_um - expected_um).abs() <= expected_um.abs() / 20,
                "{lag_ms} ms: {behind_um}, not {expected_um} um"
            );
        }
    }
}

/// The trailing distance is `T v (1 - e^(-t/T))`, and grows by the part of the speed that is yet to be shown.
#[test]
fn a_signal_trails_by_the_closed_form_of_a_first_order_lag() {
    const SPEED: i32 = 50_000;
    for lag_ms in LAGS_MS {
        let mut output = DelayedOutput::default();
        for ms in 1..=1_000 {
            output.follow(
                MicrometrePerSecond(SPEED),
                MicrometrePerSecond(-SPEED),
                Millisecond(lag_ms),
            );
            let unshown = (-f64::from(ms) / f64::from(lag_ms)).exp();
            let trails_um = f64::from(lag_ms * SPEED / 1_000) * (1.0 - unshown);
            // A step of the speed.
            let off_um = f64::from(output.distance().0) - trails_um;
            assert!(off_um.abs() <= 60.0, "{lag_ms} ms, {ms} ms: {off_um} um");
            let off = f64::from(output.growth().0) - f64::from(SPEED) * unshown;
            let step = f64::from(SPEED) / f64::from(lag_ms) + 300.0;
            assert!(off.abs() <= step, "{lag_ms} ms, {ms} ms: {off} um/s");
            assert_eq!(output.model_growth(), -output.growth());
        }
    }
}

#[test]
fn without_lag_the_sensor_shows_the_position() {
    let mut output = DelayedOutput::default();
    for speed in [0, 1, -1, 112_000, -250_000, i32::MAX, i32::MIN] {
        let speed = MicrometrePerSecond(speed);
        output.follow(speed, -speed, Millisecond::ZERO);
        assert_eq!(output.distance(), Micrometre::ZERO);
        assert_eq!(output.growth(), MicrometrePerSecond::ZERO);
        assert_eq!(output.model_growth(), MicrometrePerSecond::ZERO);
    }
    let calibration = Calibration::nominal();
    let mut observer = MotionObserver::default();
    for step in 0..500 {
        let measured = Micrometre(START + 40 * step);
        observer.update(measured, None, moving(40_000), &calibration.motion);
        assert_eq!(observer.shown_position(), observer.position());
        assert_eq!(observer.shown_model_speed(), observer.model_speed());
        assert!(observer.is_shown_within(Micrometre::ZERO));
    }
}

/// What was measured before is no part of a later error.
#[test]
fn a_forgotten_output_starts_as_a_new_one() {
    let calibration = Calibration::nominal();
    let shown = |angle| LaggingAngle {
        angle: MilliDegree(angle),
        lag: Millisecond(189),
        linkage: &calibration.linkage,
    };
    let mut used = DelayedOutput::default();
    (0..50).for_each(|step| {
        _ = used.compare(&shown(90_000 + 60 * step), Micrometre(START), Pole::USUAL)
    });
    used.forget();
    let mut new = DelayedOutput::default();
    assert_eq!(
        used.compare(&shown(100_000), Micrometre(START), Pole::USUAL),
        new.compare(&shown(100_000), Micrometre(START), Pole::USUAL)
    );
}

/// The whole travel to and fro within a step is faster than any hitch. The error is bounded by `T` times the travel and
/// the steady one of a position that is off by it, `travel / (3 p)`, and is gone once the sensor rests at the position.
#[test]
fn the_longest_lag_is_stable_at_the_largest_speeds() {
    const LAG_MS: i32 = 500;
    let calibration = Calibration::nominal();
    let linkage = &calibration.linkage;
    let place = linkage.angle(Micrometre(START));
    let (lowest, highest) = (linkage.angle(Micrometre(0)), MilliDegree(150_000));
    let most_um_ms = 2.0 * 250e3 * (f64::from(LAG_MS) + 1e3 / (3.0 * POLE));
    for period in [1, 2, 7, 100, 1_000] {
        let mut output = DelayedOutput::default();
        let mut compare = |angle| {
            let shown = LaggingAngle {
                angle,
                lag: Millisecond(LAG_MS),
                linkage,
            };
            let error = output.compare(&shown, Micrometre(START), Pole::USUAL);
            assert!(
                f64::from(error).abs() <= most_um_ms,
                "{period}: {error} um ms"
            );
            assert!(position_correction_nm(error, Pole::USUAL).abs() <= i32::MAX / 2);
            error
        };
        for step in 0..10_000 {
            compare(if step / period % 2 == 0 {
                highest
            } else {
                lowest
            });
        }
        let left = (0..1_000).map(|_| compare(place)).last().unwrap();
        // Rounding holds what decays by less than half a unit a step: 10 mdeg ms, of which 20 um ms.
        assert!(left.abs() <= 40, "{period}: {left} um ms");
    }
}

#[test]
fn sums_of_any_speed_saturate() {
    let mut output = DelayedOutput::default();
    for speed in [i32::MAX, i32::MIN] {
        let fastest = MicrometrePerSecond(speed);
        for _ in 0..2_000 {
            output.follow(fastest, fastest, Millisecond(500));
        }
        assert_eq!(output.distance().0 > 0, speed > 0);
    }
    let rest = MicrometrePerSecond::ZERO;
    (0..10_000).for_each(|_| output.follow(rest, rest, Millisecond(500)));
    assert_eq!(output.distance(), Micrometre::ZERO);
}
