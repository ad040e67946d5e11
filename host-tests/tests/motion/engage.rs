//! Quick engagement: the controller with hitch, tractor and field.

use hitch_closed_loop::field::{FieldRig, FieldSample, LINK_DEPTH_M, RAISED_DEG, Settings};
use hitch_controller::Controller;
use hitch_field::draft::Texture;
use hitch_field::soil::SoilPlan;
use hitch_field::terrain::Terrain;
use hitch_field::tractor::TractorConstants;
use hitch_quantities::units::{MilliDegree, PerMille, SupplyShare};
use hitch_quantities::{Function, Inputs, Reason, State, Trouble};
use hitch_results::field_loop::pass::{DRAFT_N, SPEED_M_S, fitted};
use host_tests::seeds::cases;
use host_tests::trace;

use crate::beyond::Motion;

/// When the implement is lowered.
const BEGINS: usize = 8_000;

/// How the implement is lowered.
#[derive(Clone, Copy, Debug, PartialEq)]
enum By {
    /// The lever stays at the depth; quick lift raises at first, and its second press lowers.
    QuickLift,
    /// As quick lift, but the switch of quick engagement lowers, and is held so long, ms.
    Engage(usize),
    /// The lever stays raised, and the switch is held so long, ms.
    EngageBelowLever(usize),
}

struct Run {
    function: Function,
    by: By,
    dial: Option<i32>,
    seed: u64,
}

impl Run {
    fn drive(&self, mut tell: impl FnMut(usize, &mut Inputs)) -> Vec<FieldSample> {
        let model = hitch_model_file::dynamic();
        let field = (
            TractorConstants::ploughing(),
            SoilPlan::varying(Texture::Medium),
        );
        let mut rig = FieldRig::new(&model, &fitted(), field, Terrain::flat(), self.seed);
        let deep_deg = rig.coupling().angle_deg(LINK_DEPTH_M);
        let settings = Settings {
            function: self.function,
            draft_n: Some(DRAFT_N),
            mix: Some(0.5),
            ..Settings::default()
        };
        (0..20_000)
            .map(|step| {
                let lever_deg = match self.by {
                    By::EngageBelowLever(_) => RAISED_DEG,
                    // The pick-up is at the raised hitch.
                    _ if step < 10 => RAISED_DEG,
                    _ => deep_deg,
                };
                rig.step(lever_deg, SPEED_M_S, &settings, |inputs| {
                    inputs.lowering_dial = self.dial.map(PerMille);
                    let presses = [5..50, BEGINS..BEGINS + 50];
                    let [raise, lower] = presses.map(|press| press.contains(&step));
                    let held = |ms| (BEGINS..BEGINS + ms).contains(&step);
                    match self.by {
                        By::QuickLift => inputs.switches.quick_lift = raise || lower,
                        By::Engage(ms) => {
                            inputs.switches.quick_lift = raise;
                            inputs.switches.engage = held(ms);
                        }
                        By::EngageBelowLever(ms) => inputs.switches.engage = held(ms),
                    }
                    tell(step, inputs);
                })
            })
            .collect()
    }
}

/// Course of an entry.
#[derive(Clone, Copy, Debug, Default)]
struct Entry {
    /// Time until the draft is at 90 % of its set point, s.
    at_draft_s: f64,
    /// Largest draft over its set point within 5 s.
    most_draft: f64,
    /// Largest change of the set point in a step while the switch lowers and when it hands over, degree.
    step_deg: f64,
}

impl Entry {
    fn of(samples: &[FieldSample]) -> Self {
        let after = &samples[BEGINS..];
        let drafts = || after.iter().map(|sample| sample.field.draft_n / DRAFT_N);
        let at = drafts().position(|draft| draft >= 0.9).expect("is reached");
        let steps = after
            .windows(2)
            .map(|pair| [0, 1].map(|at| pair[at].hitch.outputs))
            .filter(|[first, _]| first.reference == Some(Reason::Engages))
            .map(|[first, second]| (second.target - first.target).magnitude().0);
        Self {
            at_draft_s: at as f64 * 1e-3,
            most_draft: drafts().take(5_000).fold(0.0, f64::max),
            step_deg: f64::from(steps.max().unwrap_or(0)) * 1e-3,
        }
    }

    /// Means of time and draft over runs, and the largest step.
    fn mean(all: &[Self]) -> Self {
        let mean = |of: fn(&Self) -> f64| all.iter().map(of).sum::<f64>() / all.len() as f64;
        Self {
            at_draft_s: mean(|entry| entry.at_draft_s),
            most_draft: mean(|entry| entry.most_draft),
            step_deg: all.iter().map(|entry| entry.step_deg).fold(0.0, f64::max),
        }
    }
}

/// Reason at a time after the press, ms.
fn reason(samples: &[FieldSample], after_ms: usize) -> Option<Reason> {
    samples[BEGINS + after_ms].hitch.outputs.reference
}

#[test]
fn it_lowers_into_the_soil_and_hands_over_without_a_step_or_overshoot() {
    for (function, expected) in [
        (Function::Draft, Reason::Draft),
        (Function::Mix, Reason::Mix),
    ] {
        for dial in [Some(500), None] {
            let mut entries = [By::QuickLift, By::Engage(4_000)].map(|by| (by, Vec::new()));
            for (by, found) in &mut entries {
                for seed in 1..=cases(4, 24) {
                    let (by, seed) = (*by, seed);
                    let samples = Run {
                        function,
                        by,
                        dial,
                        seed,
                    }
                    .drive(|_, _| {});
                    found.push(Entry::of(&samples));
                    if by == By::QuickLift {
                        continue;
                    }
                    assert_eq!(reason(&samples, 100), Some(Reason::Engages));
                    let mut held = samples[BEGINS..BEGINS + 4_000].iter();
                    let handed_over =
                        held.any(|sample| sample.hitch.outputs.reference == Some(expected));
                    assert!(handed_over, "while the switch is held");
                }
            }
            let [lift, engaged] = entries.map(|(_, found)| Entry::mean(&found));
            println!(
                "{function:?}, dial {dial:?}\n  quick lift {lift:.3?}\n  engagement {engaged:.3?}"
            );
            // The dead band of the set point, and what the valve moves the hitch by in a millisecond.
            assert!(engaged.step_deg <= 0.4, "{engaged:?}");
            assert!(engaged.at_draft_s <= lift.at_draft_s + 0.1, "{engaged:?}");
            assert!(engaged.most_draft <= lift.most_draft + 0.1, "{engaged:?}");
        }
    }
}

#[test]
fn without_a_function_it_lowers_while_it_is_held_and_returns_to_the_lever() {
    let run = |by| {
        let (function, dial) = (Function::Position, Some(600));
        Run {
            function,
            by,
            dial,
            seed: 1,
        }
        .drive(|_, _| {})
    };
    for by in [By::Engage(1_500), By::EngageBelowLever(1_500)] {
        let samples = run(by);
        let held = &samples[BEGINS..BEGINS + 1_500];
        assert!(
            held.iter()
                .skip(1)
                .all(|sample| sample.hitch.outputs.reference == Some(Reason::Engages))
        );
        assert!(
            held[1_499].field.depth_m > 0.1,
            "{} m",
            held[1_499].field.depth_m
        );
        assert_eq!(reason(&samples, 1_501), None);
        let last = samples.last().unwrap().hitch;
        assert!(
            (last.angle_deg - last.lever_deg).abs() <= 0.5,
            "{by:?}: {last:?}"
        );
    }
}

#[test]
fn a_raised_lever_keeps_a_function_of_the_draft_from_lowering_below_its_margin() {
    let run = Run {
        function: Function::Draft,
        by: By::EngageBelowLever(3_000),
        dial: None,
        seed: 1,
    };
    let samples = run.drive(|_, _| {});
    let margin_deg = f64::from(fitted().draft.margin.0) * 1e-3;
    let lowest = samples
        .iter()
        .map(|sample| sample.hitch.angle_deg)
        .fold(f64::MAX, f64::min);
    assert!(lowest >= RAISED_DEG - margin_deg - 0.5, "{lowest} degrees");
}

#[test]
fn locks_and_lost_pins_end_it_as_any_motion() {
    type Fault = fn(&mut Inputs);
    let cases: [(&str, Fault, Option<State>); 4] = [
        (
            "transport lock",
            |inputs| inputs.switches.transport_lock = true,
            Some(State::TransportLock),
        ),
        (
            "hold",
            |inputs| inputs.switches.hold = true,
            Some(State::Holding),
        ),
        (
            "no angle",
            |inputs| inputs.rocker_angle = None,
            Some(State::Fault),
        ),
        (
            "pin broken",
            |inputs| inputs.left_pin = Some(SupplyShare(0)),
            None,
        ),
    ];
    let run = Run {
        function: Function::Draft,
        by: By::Engage(10_000),
        dial: Some(600),
        seed: 1,
    };
    let healthy = run.drive(|_, _| {});
    for (name, fault, state) in cases {
        let from = BEGINS + 300;
        let samples = run.drive(|step, inputs| {
            if step >= from {
                fault(inputs);
            }
        });
        assert_eq!(
            samples[from - 1].hitch.outputs.reference,
            Some(Reason::Engages)
        );
        let Motion {
            whole_deg,
            beyond_deg,
        } = Motion::of(&samples, &healthy, from);
        println!("{name}: {beyond_deg:.2} of {whole_deg:.2} degrees");
        assert!(beyond_deg <= 3.0, "{name}: {beyond_deg} degrees");
        // What cuts the coil ends the motion itself.
        assert!(
            state.is_none() || whole_deg <= 3.0,
            "{name}: {whole_deg} degrees"
        );
        let last = samples.last().unwrap().hitch.outputs;
        match state {
            Some(state) => assert_eq!(last.state, state, "{name}"),
            None => assert_eq!(
                (last.reference, last.trouble),
                (Some(Reason::Holds), Some(Trouble::PinRange))
            ),
        }
    }
}

/// Largest currents of a controller whose switch is held from a step on; the lever picks the hitch up at step 1000.
fn currents_ma(held_from: usize) -> [i32; 2] {
    let mut controller = Controller::new(fitted());
    let mut most = [0; 2];
    for step in 0..6_000 {
        let mut inputs = Inputs {
            lever: Some(MilliDegree(if step < 1_000 { 100_000 } else { 110_000 })),
            rocker_angle: Some(MilliDegree(110_000 + step as i32 % 3)),
            ..Inputs::default()
        };
        inputs.switches.engage = step >= held_from;
        let outputs = controller.step(&inputs);
        most = [
            most[0].max(outputs.lift_current.0),
            most[1].max(outputs.lower_current.0),
        ];
    }
    most
}

#[test]
fn a_switch_that_is_held_when_the_lever_takes_over_has_to_be_released_first() {
    assert_eq!(currents_ma(0), [0, 0]);
    let [lift, lower] = currents_ma(3_000);
    assert!(lift == 0 && lower > 100, "{lift} mA, {lower} mA");
}

#[test]
fn a_held_switch_moves_nothing_that_a_lock_holds() {
    let mut controller = Controller::new(fitted());
    for bytes in trace::random(13, 50_000) {
        let mut inputs = Inputs::from_bytes(&bytes);
        inputs.switches.engage = true;
        inputs.switches.transport_lock = true;
        let outputs = controller.step(&inputs);
        assert_eq!((outputs.lift_current.0, outputs.lower_current.0), (0, 0));
    }
}
