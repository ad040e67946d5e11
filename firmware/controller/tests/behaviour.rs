//! What the controller does in the situations that an operator, or a failing part, puts it in.

use hitch_controller::Controller;
use hitch_quantities::units::{MilliAmp, MilliBar, MilliDegree, MilliDegreePerSecond};
use hitch_quantities::{Calibration, Fault, Inputs, Outputs, State};

/// A hitch in integers: follows its coils like a valve without lag, and may be stuck or leak.
struct Hitch {
    controller: Controller,
    angle_micro: i64,
    lever: i32,
    stuck: bool,
    leak_udeg_ms: i64,
    pump_pressure: Option<MilliBar>,
}

impl Hitch {
    /// At 90 degrees, picked up, resting.
    fn picked_up() -> Self {
        let mut hitch = Self::locked();
        hitch.lever = 88_000;
        hitch.run(10);
        hitch.lever = 90_000;
        assert_eq!(hitch.run(300).state, State::Holding);
        hitch
    }

    fn locked() -> Self {
        let calibration = Calibration::nominal().validate().expect("nominal");
        Self {
            controller: Controller::new(calibration),
            angle_micro: 90_000_000,
            lever: 100_000,
            stuck: false,
            leak_udeg_ms: 0,
            pump_pressure: None,
        }
    }

    fn inputs(&self) -> Inputs {
        Inputs {
            lever: Some(MilliDegree(self.lever)),
            rocker_angle: Some(MilliDegree((self.angle_micro / 1_000) as i32)),
            pump_pressure: self.pump_pressure,
            ..Inputs::default()
        }
    }

    fn step(&mut self, inputs: &Inputs) -> Outputs {
        let outputs = self.controller.step(inputs);
        let up = i64::from((outputs.lift_current.0 - 1_126).max(0)) * 40;
        let down = i64::from((outputs.lower_current.0 - 999).max(0)) * 40;
        if !self.stuck {
            self.angle_micro += up - down - self.leak_udeg_ms;
        }
        outputs
    }

    fn run(&mut self, steps: usize) -> Outputs {
        (0..steps)
            .map(|_| self.step(&self.inputs()))
            .last()
            .unwrap_or_default()
    }

    /// Steps until `state`, at most `limit`.
    fn until(&mut self, state: State, limit: usize) -> usize {
        (0..limit)
            .position(|_| self.run(1).state == state)
            .unwrap_or_else(|| panic!("never {state:?}"))
    }

    fn angle_deg(&self) -> f64 {
        self.angle_micro as f64 * 1e-6
    }
}

fn off(outputs: &Outputs) -> bool {
    outputs.lift_current == MilliAmp(0) && outputs.lower_current == MilliAmp(0)
}

// REQ-MODE-02
#[test]
fn the_hitch_follows_the_lever_and_then_rests_with_both_coils_off() {
    let mut hitch = Hitch::picked_up();
    for target in [110_000, 60_000, 61_000] {
        hitch.lever = target;
        let outputs = hitch.run(5_000);
        assert!(
            (hitch.angle_deg() - f64::from(target) * 1e-3).abs() < 0.36,
            "{} for {target}",
            hitch.angle_deg()
        );
        assert_eq!(outputs.state, State::Holding, "{outputs:?}");
        assert!((0..60_000).all(|_| off(&hitch.run(1))), "hunts at {target}");
    }
}

// REQ-MODE-02
/// A converter's last digit and a shaking cab: 0.1 degree, one sigma.
#[test]
fn a_lever_that_trembles_moves_nothing() {
    let mut hitch = Hitch::picked_up();
    let mut random = 1_u32;
    let mut noise = || {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (random >> 16).cast_signed() % 150 - 75
    };
    for target in [90_000, 105_000, 104_000] {
        for step in 0..20_000 {
            hitch.lever = target + (0..6).map(|_| noise()).sum::<i32>();
            let outputs = hitch.run(1);
            let off = outputs.lift_current.0 == 0 && outputs.lower_current.0 == 0;
            assert!(off || step < 3_000, "{step} ms after {target} mdeg");
        }
    }
    assert!((hitch.angle_deg() - 104.0).abs() < 0.5);
}

// REQ-MODE-04
#[test]
fn set_points_beyond_the_limits_are_held_inside() {
    let mut hitch = Hitch::picked_up();
    hitch.lever = 149_000;
    let outputs = hitch.run(6_000);
    assert_eq!(outputs.target, MilliDegree(135_400));
    assert!(hitch.angle_deg() < 135.9);
}

// REQ-MODE-07
#[test]
fn a_reversed_lever_passes_through_rest() {
    let mut hitch = Hitch::picked_up();
    hitch.lever = 120_000;
    assert_eq!(hitch.run(150).state, State::Lifting);
    hitch.lever = 60_000;
    let stopped = hitch.until(State::Settling, 100);
    let lowering = hitch.until(State::Lowering, 2_000);
    assert!(stopped < 100, "stops after {stopped} ms");
    assert!(lowering >= 150, "only {lowering} ms of dwell");
}

#[test]
fn a_missing_angle_cuts_the_coils_and_locks() {
    let mut hitch = Hitch::picked_up();
    hitch.lever = 120_000;
    assert_eq!(hitch.run(150).state, State::Lifting);
    let broken = Inputs {
        rocker_angle: None,
        ..hitch.inputs()
    };
    let cut = (0..20)
        .position(|_| off(&hitch.step(&broken)))
        .expect("cut");
    assert!(cut <= 6, "cut after {cut} ms");
    let outputs = hitch.step(&broken);
    assert_eq!(
        (outputs.state, outputs.fault),
        (State::Fault, Some(Fault::Angle))
    );
    hitch.until(State::Locked, 600);
    assert!(
        (0..5_000).all(|_| off(&hitch.run(1))),
        "moves although nobody picked it up"
    );
    hitch.lever = 60_000;
    hitch.run(1);
    assert_eq!(
        hitch.run(50).state,
        State::Lowering,
        "picked up by passing the hitch"
    );
}

// REQ-MODE-03
#[test]
fn a_button_moves_the_hitch_at_its_rate_and_leaves_the_lever_locked() {
    let mut hitch = Hitch::locked();
    let jog = |rate| Some(MilliDegreePerSecond(rate));
    hitch.run(20);
    for _ in 0..1_000 {
        let inputs = Inputs {
            jog: jog(10_000),
            ..hitch.inputs()
        };
        hitch.step(&inputs);
    }
    let start_deg = hitch.angle_deg();
    for _ in 0..1_000 {
        let inputs = Inputs {
            jog: jog(10_000),
            ..hitch.inputs()
        };
        assert_eq!(hitch.step(&inputs).state, State::Lifting);
    }
    let rate = hitch.angle_deg() - start_deg;
    assert!(
        (rate - 10.0).abs() < 0.5,
        "{rate} deg/s: within 5 % although this valve isn't the table's"
    );
    let released_deg = hitch.angle_deg();
    let outputs = hitch.run(2_000);
    assert!(
        hitch.angle_deg() - released_deg < 1.0,
        "runs on by {}",
        hitch.angle_deg() - released_deg
    );
    assert_eq!(outputs.state, State::Locked);
}

// REQ-MODE-08
#[test]
fn a_leaking_hitch_is_brought_back_a_few_times_and_then_reported() {
    let mut hitch = Hitch::picked_up();
    hitch.leak_udeg_ms = 100; // 0.1 degree a second
    let mut corrections = 0;
    let mut lifting = false;
    let mut lowest_deg = f64::INFINITY;
    let fault = (0..120_000).find_map(|_| {
        let outputs = hitch.run(1);
        corrections += usize::from(outputs.state == State::Lifting && !lifting);
        lifting = outputs.state == State::Lifting;
        lowest_deg = lowest_deg.min(hitch.angle_deg());
        outputs.fault
    });
    assert_eq!(fault, Some(Fault::Sinking));
    assert_eq!(corrections, 5);
    assert!(lowest_deg > 89.3, "sank to {lowest_deg}");
}

#[test]
fn a_moved_lever_is_no_leak() {
    let mut hitch = Hitch::picked_up();
    for step in 0..40 {
        hitch.lever = 90_000 + step % 2 * 2_000;
        assert_eq!(hitch.run(2_000).fault, None, "move {step}");
    }
}

// REQ-MODE-09
/// The angle of a hitch that is stuck while it is lifted looks like that of a frozen sensor.
#[test]
fn a_hitch_that_is_stuck_when_it_should_rise_is_reported_and_not_tried_again() {
    let mut hitch = Hitch::picked_up();
    hitch.stuck = true;
    hitch.lever = 110_000;
    let fault = (0..500).find_map(|_| hitch.run(1).fault);
    assert!(
        matches!(fault, Some(Fault::Angle | Fault::NotFollowing)),
        "{fault:?}"
    );
    assert!((0..5_000).all(|_| off(&hitch.run(1))));
}

// REQ-MODE-09
#[test]
fn a_load_that_the_pump_cannot_lift_is_tried_a_few_times_and_then_reported() {
    let mut hitch = Hitch::picked_up();
    hitch.stuck = true;
    hitch.pump_pressure = Some(MilliBar(154_000));
    hitch.lever = 110_000;
    let stalled = hitch.until(State::Stalled, 1_000);
    assert!(stalled <= 500, "noticed after {stalled} ms");
    let mut attempts = 1;
    let mut lifting = false;
    let fault = (0..20_000).find_map(|_| {
        let outputs = hitch.run(1);
        attempts += usize::from(outputs.state == State::Lifting && !lifting);
        lifting = outputs.state == State::Lifting;
        outputs.fault
    });
    assert_eq!((fault, attempts), (Some(Fault::NotMoving), 3));
}

#[test]
fn a_hitch_that_comes_down_to_the_ground_stays_there_and_one_that_hangs_is_reported() {
    for (pressure, fault) in [
        (None, None),
        (Some(MilliBar(300)), None),
        (Some(MilliBar(7_400)), Some(Fault::NotMoving)),
    ] {
        let mut hitch = Hitch::picked_up();
        hitch.stuck = true;
        hitch.lever = 60_000;
        let inputs = Inputs {
            cylinder_pressure: pressure,
            ..hitch.inputs()
        };
        let found = (0..20_000).find_map(|_| hitch.step(&inputs).fault);
        assert_eq!(found, fault, "{pressure:?}");
        if fault.is_none() {
            assert_eq!(hitch.run(1).state, State::Holding);
            hitch.stuck = false;
            hitch.lever = 100_000;
            hitch.run(4_000);
            assert!((hitch.angle_deg() - 100.0).abs() < 0.5);
        }
    }
}

// REQ-MODE-09
#[test]
fn the_relief_valve_is_noticed_by_the_pump_pressure() {
    let mut hitch = Hitch::picked_up();
    hitch.stuck = true;
    hitch.pump_pressure = Some(MilliBar(154_000));
    hitch.lever = 110_000;
    let stalled = hitch.until(State::Stalled, 1_000);
    assert!(stalled <= 70, "noticed after {stalled} ms");
}

#[test]
fn an_end_stop_inside_the_limits_counts_as_arrival() {
    let mut hitch = Hitch::picked_up();
    hitch.angle_micro = 134_500_000;
    hitch.controller = Controller::new(Calibration::nominal().validate().expect("nominal"));
    hitch.lever = 132_000;
    hitch.run(10);
    hitch.lever = 134_500;
    hitch.run(300);
    hitch.stuck = true;
    hitch.lever = 135_400;
    let outputs = hitch.run(5_000);
    assert_eq!((outputs.state, outputs.fault), (State::Holding, None));
    assert!(
        (0..10_000).all(|_| off(&hitch.run(1))),
        "works against the end stop"
    );
}

// REQ-SAFE-05
#[test]
fn swapped_coils_trip_the_envelope() {
    let mut hitch = Hitch::picked_up();
    hitch.lever = 120_000;
    let mut fault = None;
    for _ in 0..1_000 {
        let before = hitch.angle_micro;
        let outputs = hitch.run(1);
        hitch.angle_micro = 2 * before - hitch.angle_micro;
        fault = fault.or(outputs.fault);
    }
    assert_eq!(fault, Some(Fault::Envelope));
    assert!(hitch.angle_deg() > 85.0, "fell to {}", hitch.angle_deg());
}
