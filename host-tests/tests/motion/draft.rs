//! Draft, mix, depth limit and slip guard: the controller with hitch, tractor and field.

use hitch_closed_loop::field::{FieldSample, LINK_DEPTH_M, Settings};
use hitch_controller::Controller;
use hitch_field::draft::Texture;
use hitch_field::soil::{SoilPlan, Stretch};
use hitch_field::strength::StrengthConstants;
use hitch_quantities::calibration::field_parameters::DraftParameters;
use hitch_quantities::units::{
    Count, Micrometre, MillimetrePerSecond, Newton, PerMille, SupplyShare,
};
use hitch_quantities::{Calibration, Function, Inputs, Reason, Trouble, ValidCalibration};
use hitch_results::field_loop::pass::{Comparison, DRAFT_N, Pass, fitted, fitted_with};
use host_tests::seeds::cases;
use host_tests::trace;

use crate::beyond::Motion;

fn pass(soil: SoilPlan, settings: Settings, work_s: f64, seed: u64) -> Pass {
    Pass {
        soil,
        settings,
        link_depth_m: LINK_DEPTH_M,
        work_s,
        seed,
    }
}

fn of(function: Function, draft_n: f64) -> Settings {
    Settings {
        function,
        draft_n: Some(draft_n),
        mix: Some(0.5),
        ..Settings::default()
    }
}

fn outputs(
    trace: &[[u8; hitch_quantities::signals::INPUT_BYTES]],
    calibration: ValidCalibration,
    mut tell: impl FnMut(usize, &mut Inputs),
) -> Vec<hitch_quantities::Outputs> {
    let mut controller = Controller::new(calibration);
    let steps = trace.iter().enumerate();
    steps
        .map(|(step, bytes)| {
            let mut inputs = Inputs::from_bytes(bytes);
            tell(step, &mut inputs);
            controller.step(&inputs)
        })
        .collect()
}

/// Any inputs of draft and slip control.
fn add_any(random: &mut fastrand::Rng, inputs: &mut Inputs) {
    let mut word = |low, high| random.bool().then(|| random.i32(low..high));
    inputs.left_pin = word(40_000, 80_000).map(SupplyShare);
    inputs.right_pin = word(40_000, 80_000).map(SupplyShare);
    inputs.ground_speed = word(0, 4_000).map(MillimetrePerSecond);
    inputs.wheel_speed = word(0, 4_000).map(MillimetrePerSecond);
    inputs.draft_set_point = word(0, 40_000).map(Newton);
    inputs.mix = word(-100, 1_200).map(PerMille);
    inputs.slip_limit = word(-100, 1_200).map(PerMille);
    inputs.depth_sensor = word(0, 100_000).map(SupplyShare);
    inputs.depth_set_point = word(-100_000, 500_000).map(Micrometre);
    inputs.function = word(-1, 6).map(Count);
}

/// Steps in which missing pins are not lost yet.
const CHECK_STEPS: usize = DraftParameters::NOMINAL.check_time.0 as usize - 1;

#[test]
fn a_machine_without_pins_or_settings_behaves_as_before_to_the_last_bit() {
    let traces = [trace::recorded().unwrap(), trace::random(11, 50_000)];
    for steps in &traces {
        let nominal = || Calibration::nominal().validate().unwrap();
        let plain = outputs(steps, nominal(), |_, _| {});
        let mut random = fastrand::Rng::with_seed(5);
        let told = outputs(steps, nominal(), |_, inputs| add_any(&mut random, inputs));
        assert!(plain == told, "signals of what is not fitted");
        let calibration = fitted_with(|calibration| calibration.slip.highest_limit.0 = 0);
        let mut fitted = outputs(steps, calibration, |_, _| {});
        // Only the missing pins are reported.
        for outputs in &mut fitted[CHECK_STEPS..] {
            assert_eq!(outputs.trouble.take(), Some(Trouble::PinRange));
        }
        assert!(plain == fitted, "fitted, and position control selected");
    }
}

#[test]
fn any_signals_of_the_field_move_nothing_that_a_lock_holds() {
    let steps = trace::random(12, 50_000);
    let mut random = fastrand::Rng::with_seed(6);
    let all = outputs(&steps, fitted(), |_, inputs| {
        add_any(&mut random, inputs);
        inputs.switches.transport_lock = true;
    });
    assert!(
        all.iter()
            .all(|outputs| outputs.lift_current.0 == 0 && outputs.lower_current.0 == 0)
    );
}

/// Variation of the soil that stays if the long process, which a loop below 0.3 Hz can follow, is taken away altogether.
fn smallest_ratio() -> f64 {
    let soil = StrengthConstants::default();
    let fast = soil.short_deviation.hypot(soil.clod_deviation);
    fast / fast.hypot(soil.long_deviation)
}

// Not reached are 0.5 for draft, which is below `smallest_ratio`, 0.7 for mix, and 30 activations a minute.
#[test]
fn draft_varies_less_and_the_mix_keeps_the_depth() {
    let seeds = cases(4, 24);
    let [draft, mix, limit] =
        [Function::Draft, Function::Mix, Function::DepthLimit].map(|function| {
            Comparison::of(&hitch_model_file::dynamic(), function, &fitted(), 1..=seeds)
        });
    println!(
        "{draft}\n{mix}\n{limit}\nwithout the long process: {:.3}",
        smallest_ratio()
    );
    assert!(smallest_ratio() > 0.5);
    assert!(draft.draft_ratio < 0.85, "{draft}");
    assert!(mix.draft_ratio < 0.90, "{mix}");
    assert!(draft.draft_ratio < mix.draft_ratio && mix.depth_ratio < draft.depth_ratio);
    assert!(mix.depth_ratio <= 0.06, "{mix}");
    assert!(limit.draft_ratio < 0.90, "{limit}");
}

#[test]
fn harder_soil_is_compensated_within_two_seconds() {
    const SET_N: f64 = 11_900.0;
    for seed in 1..=cases(2, 8) {
        let mut soil = SoilPlan::uniform(Texture::Coarse);
        soil.texture_changes = vec![(60.0, Texture::Fine)];
        let pass = pass(soil, of(Function::Draft, SET_N), 25.0, seed);
        let samples = pass.drive(&hitch_model_file::dynamic(), &fitted(), |_, _| {});
        let off: Vec<f64> = samples
            .iter()
            .map(|sample| sample.field.draft_n / SET_N - 1.0)
            .collect();
        let at = off.iter().position(|off| *off > 0.5).unwrap();
        let first = off[at..].iter().position(|off| off.abs() <= 0.05).unwrap();
        let lowest = off[at..].iter().copied().fold(f64::MAX, f64::min);
        println!(
            "seed {seed}: within 5 % after {first} ms, then as low as {:.1} %",
            lowest * 100.0
        );
        assert!(first <= 2_000 && lowest >= -0.15);
    }
}

/// Where the rear axle meets and leaves a soft patch of 20 m.
fn patch(samples: &[FieldSample]) -> [usize; 2] {
    [60.0, 80.0].map(|at_m| {
        let mut distances = samples.iter().map(|sample| sample.field.distance_m);
        distances.position(|distance_m| distance_m >= at_m).unwrap()
    })
}

#[test]
fn a_soft_patch_slips_little_above_the_limit_and_is_left_at_the_depth() {
    for function in [Function::Position, Function::Draft] {
        let mut soil = SoilPlan::uniform(Texture::Medium);
        soil.stretches = vec![Stretch::soft_patch(60.0, 20.0)];
        let settings = Settings {
            slip_limit: Some(0.2),
            ..of(function, DRAFT_N)
        };
        let samples =
            pass(soil, settings, 30.0, 1).drive(&hitch_model_file::dynamic(), &fitted(), |_, _| {});
        let [from, to] = patch(&samples);
        let slip = |range: std::ops::Range<usize>| {
            let all = samples[range].iter().map(|sample| sample.field.slip);
            all.fold(0.0, f64::max)
        };
        let (peak, later) = (slip(from..to), slip(from + 1_500..to));
        let depth_m = samples[to + 3_000].field.depth_m;
        let before_m = samples[from - 1].field.depth_m;
        println!(
            "{function:?}: slip at most {:.1} %, {:.1} % after 1.5 s; depth {:.1} cm before, {:.1} cm 3 s after",
            peak * 100.0,
            later * 100.0,
            before_m * 100.0,
            depth_m * 100.0
        );
        assert!(later <= 0.25, "{later}");
        assert!((depth_m / before_m - 1.0).abs() <= 0.05);
        let raised = samples[from..to]
            .iter()
            .filter(|sample| sample.hitch.outputs.reference == Some(Reason::Slip));
        assert!(raised.count() > 1_000, "the guard raises");
    }
}

/// Changes what is measured; the other arguments are what was measured when the fault began, and noise.
type Change = fn(&mut Inputs, &Inputs, i32);

type Fault = (&'static str, Trouble, Change);

/// Faults with their trouble.
const FAULTS: [Fault; 11] = [
    ("left pin missing", Trouble::PinRange, |inputs, _, _| {
        inputs.left_pin = None
    }),
    ("left pin broken", Trouble::PinRange, |inputs, _, _| {
        inputs.left_pin = Some(SupplyShare(0));
    }),
    ("right pin shorted", Trouble::PinRange, |inputs, _, _| {
        inputs.right_pin = Some(SupplyShare(100_000));
    }),
    (
        "left pin without force",
        Trouble::PinsDisagree,
        |inputs, _, _| {
            inputs.left_pin = Some(SupplyShare(50_000));
        },
    ),
    ("left pin frozen", Trouble::PinFrozen, |inputs, then, _| {
        inputs.left_pin = then.left_pin;
    }),
    ("both pins frozen", Trouble::PinFrozen, |inputs, then, _| {
        (inputs.left_pin, inputs.right_pin) = (then.left_pin, then.right_pin);
    }),
    ("left pin noisy", Trouble::PinNoisy, |inputs, _, noise| {
        inputs.left_pin = inputs.left_pin.map(|pin| pin + SupplyShare(noise));
    }),
    ("no ground speed", Trouble::GroundSpeed, |inputs, _, _| {
        inputs.ground_speed = None
    }),
    ("no wheel speed", Trouble::WheelSpeed, |inputs, _, _| {
        inputs.wheel_speed = None
    }),
    (
        "ground speed frozen",
        Trouble::SpeedFrozen,
        |inputs, _, _| {
            inputs.ground_speed = inputs.ground_speed.map(|_| MillimetrePerSecond(1_790));
        },
    ),
    (
        "wheel speed frozen",
        Trouble::SpeedFrozen,
        |inputs, _, _| {
            inputs.wheel_speed = inputs.wheel_speed.map(|_| MillimetrePerSecond(2_050));
        },
    ),
];

/// A pass with a fault from a time on.
fn with_fault(fault_s: f64, pass: &Pass, fault: Change) -> Vec<FieldSample> {
    let mut then = None;
    let mut random = fastrand::Rng::with_seed(fault_s.to_bits());
    let model = hitch_model_file::dynamic();
    pass.drive(&model, &fitted(), |time_s, inputs| {
        // Ten times the noise of a pin, evenly distributed.
        let noise = random.i32(-1_732..=1_732);
        if time_s >= fault_s {
            let then = *then.get_or_insert(*inputs);
            fault(inputs, &then, noise);
        }
    })
}

#[test]
fn a_lost_or_stuck_sensor_moves_the_hitch_by_less_than_three_degrees_more_than_its_function() {
    for function in [Function::Draft, Function::Mix, Function::DepthLimit] {
        let settings = Settings {
            slip_limit: Some(0.25),
            ..of(function, DRAFT_N)
        };
        let pass = pass(SoilPlan::varying(Texture::Medium), settings, 15.0, 3);
        let healthy = pass.drive(&hitch_model_file::dynamic(), &fitted(), |_, _| {});
        for (name, trouble, fault) in FAULTS {
            let is_pin = name.contains("pin");
            let mut most = Motion::default();
            for time in 0..cases(3, 20) {
                let fault_s = 5.0 + 0.23 * time as f64;
                let samples = with_fault(fault_s, &pass, fault);
                most = most.max(Motion::of(&samples, &healthy, (fault_s * 1e3) as usize));
                let outputs = samples.last().unwrap().hitch.outputs;
                assert_eq!(outputs.trouble, Some(trouble), "{function:?}, {name}");
                assert_eq!(outputs.fault, None);
                let holds = outputs.reference == Some(Reason::Holds);
                assert_eq!(holds, is_pin, "{name}: {outputs:?}");
            }
            let Motion {
                whole_deg,
                beyond_deg,
            } = most;
            println!("{function:?}, {name}: {beyond_deg:.2} of {whole_deg:.2} degrees");
            assert!(beyond_deg <= 3.0, "{function:?}, {name}: {most:?}");
        }
    }
}
