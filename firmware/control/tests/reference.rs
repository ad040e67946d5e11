//! The reference layer as a whole: limits, changes without a step, and what it leaves to the lever.

use hitch_control::operator::engage::Engagement;
use hitch_control::reference::{ReferenceControl, Situation};
use hitch_quantities::units::{
    Count, MicrometrePerSecond, MilliDegree, MillimetrePerSecond, Newton, PerMille, SupplyShare,
};
use hitch_quantities::{Calibration, Function, Inputs, Reason, Trouble};

const SET: i32 = 18_000;
const LEVER: i32 = 62_000;

/// A layer whose hitch is where it is sent.
struct Bench {
    layer: ReferenceControl,
    calibration: Calibration,
    inputs: Inputs,
    draft: i32,
    lever: i32,
    highest: i32,
    set_point: i32,
    steps: i32,
}

impl Bench {
    fn new(function: Function) -> Self {
        let mut calibration = Calibration::nominal();
        calibration.draft.fitted = Count(1);
        calibration.draft.step = MilliDegree(0);
        calibration.slip.highest_limit = PerMille(300);
        Self {
            layer: ReferenceControl::default(),
            calibration,
            inputs: Inputs {
                draft_set_point: Some(Newton(SET)),
                function: Some(Count(function as i32)),
                ..Inputs::default()
            },
            draft: SET,
            lever: LEVER,
            highest: 135_400,
            set_point: LEVER,
            steps: 0,
        }
    }

    /// One step; the change of the set point.
    fn step(&mut self) -> i32 {
        self.steps += 1;
        let digit = self.steps % 5;
        let output = SupplyShare(50_000 + digit + self.draft / 2 * 25_000 / 40_000);
        let inputs = Inputs {
            left_pin: self.inputs.left_pin.or(Some(output)),
            right_pin: Some(output),
            ..self.inputs
        };
        let situation = Situation {
            lever: MilliDegree(self.lever),
            engagement: Engagement::Off,
            angle: MilliDegree(self.set_point),
            highest: MilliDegree(self.highest),
            valve_speeds: [MicrometrePerSecond(150_000); 2],
        };
        let before = self.set_point;
        self.layer.sense(&inputs, false, &self.calibration);
        self.set_point = self.layer.step(&inputs, &situation, &self.calibration).0;
        self.set_point - before
    }

    /// Steps; the largest change in one of them.
    fn run(&mut self, steps: i32) -> i32 {
        (0..steps).map(|_| self.step().abs()).max().unwrap_or(0)
    }
}

const FUNCTIONS: [Function; 3] = [Function::Draft, Function::Mix, Function::DepthLimit];

#[test]
fn above_the_ground_and_in_position_control_the_set_point_is_the_lever() {
    for function in FUNCTIONS {
        let mut bench = Bench::new(function);
        bench.draft = 0;
        for lever in [62_000, 62_001, 100_000, 50_000] {
            bench.lever = lever;
            bench.run(50);
            assert_eq!(bench.set_point, lever);
            assert_eq!(bench.layer.reason(), Some(Reason::AboveGround));
        }
    }
    let mut bench = Bench::new(Function::Position);
    bench.lever = 71_234;
    bench.run(500);
    assert_eq!((bench.set_point, bench.layer.reason()), (71_234, None));
}

#[test]
fn draft_raises_in_hard_soil_and_stays_within_the_limits() {
    for function in FUNCTIONS {
        let mut bench = Bench::new(function);
        bench.run(1_000);
        bench.draft = 30_000;
        bench.highest = 75_000;
        bench.run(60_000);
        match function {
            Function::Mix => assert!(bench.set_point > LEVER),
            _ => assert_eq!(
                (bench.set_point, bench.layer.reason()),
                (75_000, Some(Reason::Ceiling))
            ),
        }
        bench.draft = 8_000;
        bench.run(60_000);
        let floor = match function {
            Function::DepthLimit => LEVER,
            _ => LEVER - bench.calibration.draft.margin.0,
        };
        assert_eq!(
            (bench.set_point, bench.layer.reason()),
            (floor, Some(Reason::Floor))
        );
    }
}

#[test]
fn a_raised_lever_raises_the_hitch_in_any_function() {
    for function in FUNCTIONS {
        let mut bench = Bench::new(function);
        bench.draft = 8_000;
        bench.run(20_000);
        bench.lever = 120_000;
        bench.run(5_000);
        let margin = bench.calibration.draft.margin.0;
        assert!(bench.set_point >= 120_000 - margin, "{}", bench.set_point);
    }
}

#[test]
fn no_change_of_the_function_steps() {
    // 150 mm/s of the piston at 1.9 mm a degree.
    const IN_A_STEP: i32 = 90;
    let mut bench = Bench::new(Function::Position);
    bench.run(1_000);
    let orders = [1, 2, 3, 1, 3, 2, 1, 0];
    for (turn, function) in orders.into_iter().enumerate() {
        bench.draft = [SET, 21_000, 15_500][turn % 3];
        bench.inputs.function = Some(Count(function));
        let change = bench.run(3_000);
        assert!(change <= IN_A_STEP, "to {function}: {change} mdeg");
    }
    assert_eq!(bench.layer.reason(), Some(Reason::Holds));
    let held = bench.set_point;
    bench.draft = 30_000;
    assert_eq!(bench.run(10_000), 0, "held at {held}");
    for _ in 0..2_000 {
        bench.lever += 10;
        bench.step();
    }
    assert_eq!(bench.set_point, bench.lever, "taken over");
}

#[test]
fn a_function_that_was_switched_off_is_resumed_without_a_step_and_a_lost_one_is_not() {
    const IN_A_STEP: i32 = 90;
    let mut bench = Bench::new(Function::Draft);
    bench.run(1_000);
    bench.inputs.function = Some(Count(Function::Position as i32));
    bench.run(1_000);
    assert_eq!(bench.layer.reason(), Some(Reason::Holds));
    bench.inputs.function = Some(Count(Function::Draft as i32));
    bench.draft = 20_000;
    let held = bench.set_point;
    assert!(bench.run(1_000) <= IN_A_STEP);
    assert_eq!(bench.layer.reason(), Some(Reason::Draft));
    assert!(bench.set_point > held, "draft raises in hard soil");
    // A set point that is missing for a moment ends it for good, as a lost pin does.
    let set_point = bench.inputs.draft_set_point.take();
    bench.run(10);
    bench.inputs.draft_set_point = set_point;
    bench.run(1_000);
    assert_eq!(bench.layer.reason(), Some(Reason::Holds));
}

#[test]
fn the_guard_acts_in_the_soil_and_above_its_speed_only() {
    for (ground, wheel, draft, acts) in [
        (1_000, 2_000, SET, true),
        (1_000, 2_000, 0, false),
        (880, 1_760, SET, false),
        (1_000, 1_100, SET, false),
    ] {
        let mut bench = Bench::new(Function::Position);
        bench.draft = draft;
        for step in 0..3_000 {
            let digit = step % 3;
            bench.inputs.ground_speed = Some(MillimetrePerSecond(ground + digit));
            bench.inputs.wheel_speed = Some(MillimetrePerSecond(wheel + digit));
            bench.step();
        }
        let raised = bench.set_point > LEVER;
        assert_eq!(raised, acts, "{ground}, {wheel} mm/s, {draft} N");
        assert_eq!(bench.layer.reason() == Some(Reason::Slip), acts);
    }
}

#[test]
fn without_speeds_what_the_guard_has_raised_stays() {
    let mut bench = Bench::new(Function::Position);
    let speeds = |bench: &mut Bench, step: i32| {
        bench.inputs.ground_speed = Some(MillimetrePerSecond(1_000 + step % 3));
        bench.inputs.wheel_speed = Some(MillimetrePerSecond(1_500 + step % 3));
    };
    for step in 0..1_000 {
        speeds(&mut bench, step);
        bench.step();
    }
    let raised = bench.set_point;
    assert!(raised > LEVER + 1_000);
    bench.inputs.ground_speed = None;
    bench.run(5_000);
    assert_eq!(bench.layer.reason(), Some(Reason::Holds));
    assert!(bench.set_point > LEVER + 1_000, "{}", bench.set_point);
}

#[test]
fn a_lost_pin_is_reported_whatever_is_selected_and_has_the_command() {
    for function in [Function::Position, Function::Draft] {
        let mut bench = Bench::new(function);
        bench.calibration.slip.highest_limit = PerMille(0);
        bench.run(1_000);
        assert_eq!(bench.layer.trouble(), None);
        assert!(
            bench
                .layer
                .draft()
                .is_some_and(|draft| (draft.0 - SET).abs() < 50)
        );
        bench.inputs.left_pin = Some(SupplyShare(0));
        bench.run(bench.calibration.draft.check_time.0);
        bench.layer.end();
        assert_eq!(bench.layer.trouble(), Some(Trouble::PinRange));
        assert_eq!(bench.layer.draft(), None);
    }
}

#[test]
fn the_draft_is_followed_while_the_layer_has_not_the_command() {
    let mut bench = Bench::new(Function::Draft);
    bench.run(1_000);
    // Quick lift raises the implement; the draft at its end is the present one at once.
    bench.layer.end();
    for step in 0..2_000 {
        let output = Some(SupplyShare(50_000 + step % 5));
        let inputs = Inputs {
            left_pin: output,
            right_pin: output,
            ..bench.inputs
        };
        bench.layer.sense(&inputs, false, &bench.calibration);
    }
    bench.draft = 0;
    bench.step();
    assert_eq!(bench.layer.reason(), Some(Reason::AboveGround));
}
