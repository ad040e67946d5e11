//! Extra travel of a hitch after a fault compared with cutting both coils at its instant: measured on the dynamic
//! plant, in both directions, at several loads, in every phase of a long move.

use hitch_closed_loop::{ClosedLoop, Sample};
use hitch_plant::{Currents, Model};
use hitch_quantities::units::{Count, Microsecond, MilliAmp, MilliDegree, MilliVolt, PerMille};
use hitch_quantities::{Calibration, Fault, Inputs, Outputs};
use host_tests::seeds::cases;

/// Faults of a moving hitch.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Trouble {
    /// No fault: the reference.
    CutAtOnce,
    AngleLost,
    AngleShortedLow,
    AngleShortedHigh,
    LeverLost,
    SupplyLow,
    SupplyHigh,
    SupplyIntermittent,
    Overrun,
    Underrun,
    ReferenceOff,
    SensorSupplyLow,
    TracksDiffer,
    TrackSticks,
    ClockOff,
    CoilOpen,
    CoilShorted,
    LiftStuck,
    LowerStuck,
    AngleFrozen,
    AngleJumpsAhead,
    AngleJumpsBack,
    AngleErratic,
    AngleNoisy,
}

use Trouble::*;

/// Faults with the permitted extra travel of each, degree.
const ELECTRICAL_DEG: f64 = 2.0;
const ANGLE_DEG: f64 = 5.0;
const TROUBLES: [(Trouble, f64); 21] = [
    (AngleLost, ELECTRICAL_DEG),
    (AngleShortedLow, ELECTRICAL_DEG),
    (AngleShortedHigh, ELECTRICAL_DEG),
    (LeverLost, ELECTRICAL_DEG),
    (SupplyLow, ELECTRICAL_DEG),
    (SupplyHigh, ELECTRICAL_DEG),
    (SupplyIntermittent, ELECTRICAL_DEG),
    (Overrun, ELECTRICAL_DEG),
    (Underrun, ELECTRICAL_DEG),
    (SensorSupplyLow, ELECTRICAL_DEG),
    (ReferenceOff, ANGLE_DEG),
    (TracksDiffer, ELECTRICAL_DEG),
    (TrackSticks, ANGLE_DEG),
    (ClockOff, ANGLE_DEG),
    (CoilOpen, ELECTRICAL_DEG),
    (CoilShorted, ELECTRICAL_DEG),
    (AngleFrozen, ANGLE_DEG),
    (AngleJumpsAhead, ANGLE_DEG),
    (AngleJumpsBack, ANGLE_DEG),
    (AngleErratic, ANGLE_DEG),
    (AngleNoisy, ANGLE_DEG),
];

const LOADS_KG: [f64; 3] = [50.0, 150.0, 250.0];
const MOVES_DEG: [(f64, f64); 2] = [(60.0, 120.0), (120.0, 60.0)];
/// Times in a move at which the fault begins, ms: from before the start to after the end.
const INSTANTS_MS: std::ops::Range<usize> = 20..1_000;
/// By day, and with `HITCH_THOROUGH`.
const FEW_EVERY_MS: usize = 175;
const EVERY_MS: usize = 35;
/// Duration of the observation afterwards, ms.
const WATCHED_MS: usize = 600;

/// Last readings of the sensors.
#[derive(Clone, Copy, Default)]
struct Memory {
    inputs: Inputs,
}

/// One run: a fault at `instant_ms` of the move.
struct Run {
    /// Largest distance from the position at the fault in either direction, degree.
    travel_deg: f64,
    /// Time from the fault until both coils are off, ms.
    off_after_ms: Option<usize>,
    fault: Option<Fault>,
}

/// A pseudo-random number between `-most` and `most`.
fn scattered(step: usize, most: i32) -> i32 {
    fastrand::Rng::with_seed(step as u64).i32(-most..=most)
}

fn tell(trouble: Trouble, step: usize, memory: &Memory, inputs: &mut Inputs) {
    let shifted =
        |inputs: &Inputs, by: i32| inputs.rocker_angle.map(|angle| angle + MilliDegree(by));
    inputs.step_time = Some(Microsecond(1_000));
    inputs.second_angle = inputs.rocker_angle;
    match trouble {
        CutAtOnce | CoilOpen | CoilShorted | LiftStuck | LowerStuck => {}
        AngleLost => inputs.rocker_angle = None,
        AngleShortedLow => inputs.rocker_angle = Some(MilliDegree(30_000)),
        AngleShortedHigh => inputs.rocker_angle = Some(MilliDegree(150_000)),
        LeverLost => inputs.lever = None,
        SupplyLow => inputs.supply = Some(MilliVolt(7_500)),
        SupplyHigh => inputs.supply = Some(MilliVolt(24_000)),
        SupplyIntermittent if step.is_multiple_of(2) => inputs.supply = Some(MilliVolt(7_000)),
        SupplyIntermittent => inputs.supply = Some(MilliVolt(13_500)),
        Underrun => inputs.step_time = Some(Microsecond(400)),
        ReferenceOff => inputs.reference = Some(PerMille(920)),
        SensorSupplyLow => inputs.sensor_supply = Some(MilliVolt(4_600)),
        TracksDiffer => inputs.second_angle = shifted(inputs, 3_000),
        // Trembles where it sticks, so no other row sees it.
        TrackSticks => {
            let stuck = memory.inputs.rocker_angle;
            inputs.rocker_angle = stuck.map(|angle| angle + MilliDegree(scattered(step, 50)));
        }
        ClockOff => inputs.clock_ratio = Some(PerMille(500)),
        Overrun => inputs.step_time = Some(Microsecond(3_000)),
        AngleFrozen => inputs.rocker_angle = memory.inputs.rocker_angle,
        AngleJumpsAhead => inputs.rocker_angle = shifted(inputs, 8_000),
        AngleJumpsBack => inputs.rocker_angle = shifted(inputs, -8_000),
        AngleErratic => inputs.rocker_angle = shifted(inputs, scattered(step, 10_000)),
        AngleNoisy => inputs.rocker_angle = shifted(inputs, scattered(step, 800)),
    }
}

fn wire(trouble: Trouble, outputs: &Outputs, currents: &mut Currents) {
    // A trip also opens the switch that feeds both drivers.
    let fed = outputs.trip.is_none();
    match trouble {
        CutAtOnce | CoilOpen => *currents = Currents::default(),
        // Whatever the regulation does about it.
        CoilShorted if fed => {
            let shorted = |asked: MilliAmp| {
                if asked > MilliAmp(0) {
                    f64::from(asked.0) * 1e-3 + 1.0
                } else {
                    0.0
                }
            };
            currents.lift_a = shorted(outputs.lift_current);
            currents.lower_a = shorted(outputs.lower_current);
        }
        LiftStuck if fed => currents.lift_a = 3.5,
        LowerStuck if fed => currents.lower_a = 3.5,
        _ => {}
    }
}

/// Picks the hitch up with the lever, with both tracks of the angle sensor healthy.
fn pick_up(closed_loop: &mut ClosedLoop<'_>, at_deg: f64) {
    for ms in 0..500 {
        let lever_deg = if ms < 100 { at_deg - 2.0 } else { at_deg };
        closed_loop.step_with(
            lever_deg,
            |inputs| inputs.second_angle = inputs.rocker_angle,
            |_, _| {},
        );
    }
}

fn run(
    model: &Model,
    trouble: Trouble,
    load_kg: f64,
    (from_deg, to_deg): (f64, f64),
    instant_ms: usize,
) -> Run {
    let mut calibration = Calibration::nominal();
    let two_tracks = matches!(trouble, TracksDiffer | TrackSticks);
    calibration.sensors.second_track = Count(i32::from(two_tracks));
    let calibration = calibration.sealed().validate().unwrap();
    let mut closed_loop = ClosedLoop::new(model, &calibration, load_kg, 40.0, from_deg, 5);
    pick_up(&mut closed_loop, from_deg);
    let mut memory = Memory::default();
    let mut step = |step: usize, trouble: Option<Trouble>| -> Sample {
        let before = memory;
        let sample = closed_loop.step_with(
            to_deg,
            |inputs| tell(trouble.unwrap_or(CutAtOnce), step, &before, inputs),
            |outputs, currents| {
                if let Some(trouble) = trouble {
                    wire(trouble, outputs, currents);
                }
            },
        );
        memory = Memory {
            inputs: sample.inputs,
        };
        sample
    };
    let mut start_deg = from_deg;
    for ms in 0..instant_ms {
        start_deg = step(ms, None).angle_deg;
    }
    let mut result = Run {
        travel_deg: 0.0,
        off_after_ms: None,
        fault: None,
    };
    for ms in 0..WATCHED_MS {
        let sample = step(ms, Some(trouble));
        result.travel_deg = result.travel_deg.max((sample.angle_deg - start_deg).abs());
        let off = sample.outputs.lift_current.0 == 0 && sample.outputs.lower_current.0 == 0;
        result.off_after_ms = result.off_after_ms.or(off.then_some(ms));
        result.fault = result.fault.or(sample.outputs.fault);
    }
    result
}

/// The worst case over all instants, loads and directions.
#[derive(Default)]
struct Worst {
    extra_deg: f64,
    where_: String,
    off_after_ms: usize,
    faults: Vec<&'static str>,
}

fn worst(model: &Model, trouble: Trouble, yardsticks: &[f64]) -> Worst {
    let mut worst = Worst::default();
    for (place, yardstick_deg) in places().zip(yardsticks) {
        let (load_kg, way, instant_ms) = place;
        let run = run(model, trouble, load_kg, way, instant_ms);
        let extra_deg = run.travel_deg - yardstick_deg;
        if extra_deg > worst.extra_deg {
            worst.extra_deg = extra_deg;
            worst.where_ = format!("{load_kg} kg, {} to {}, at {instant_ms} ms", way.0, way.1);
        }
        worst.off_after_ms = worst
            .off_after_ms
            .max(run.off_after_ms.unwrap_or(WATCHED_MS));
        if let Some(fault) = run
            .fault
            .map(Fault::name)
            .filter(|fault| !worst.faults.contains(fault))
        {
            worst.faults.push(fault);
        }
    }
    worst
}

fn places() -> impl Iterator<Item = (f64, (f64, f64), usize)> {
    LOADS_KG.into_iter().flat_map(|load_kg| {
        MOVES_DEG.into_iter().flat_map(move |way| {
            INSTANTS_MS
                .step_by(cases(FEW_EVERY_MS, EVERY_MS))
                .map(move |ms| (load_kg, way, ms))
        })
    })
}

#[test]
fn no_fault_takes_the_hitch_further_than_it_may() {
    let model = hitch_model_file::dynamic();
    let yardsticks: Vec<f64> = places()
        .map(|(load_kg, way, ms)| run(&model, CutAtOnce, load_kg, way, ms).travel_deg)
        .collect();
    println!(
        "{} runs a trouble; beyond cutting both coils at once:",
        yardsticks.len()
    );
    println!(
        "{:16} {:>9} {:>7} {:24} worst at",
        "trouble", "extra deg", "off ms", "reported as"
    );
    let mut too_far = Vec::new();
    for (trouble, most_deg) in TROUBLES {
        let worst = worst(&model, trouble, &yardsticks);
        println!(
            "{:16} {:9.2} {:7} {:24} {}",
            format!("{trouble:?}"),
            worst.extra_deg,
            worst.off_after_ms,
            worst.faults.join(" "),
            worst.where_
        );
        if worst.extra_deg > most_deg {
            too_far.push((trouble, worst.extra_deg));
        }
    }
    assert!(too_far.is_empty(), "{too_far:?}");
}

// REQ-SAFE-06
/// A driver that switches itself on under a resting hitch.
#[test]
fn a_stuck_driver_moves_a_resting_hitch_only_slightly() {
    let model = hitch_model_file::dynamic();
    for load_kg in LOADS_KG {
        for trouble in [LiftStuck, LowerStuck] {
            let run = run(&model, trouble, load_kg, (90.0, 90.0), 100);
            println!(
                "{load_kg} kg, {trouble:?}: {:.2} degree, {:?}",
                run.travel_deg, run.fault
            );
            assert_eq!(run.fault, Some(Fault::Coil));
            assert!(
                run.travel_deg <= ELECTRICAL_DEG,
                "{load_kg} kg, {trouble:?}: {} deg",
                run.travel_deg
            );
        }
    }
}

/// Effect of a drifting sensor on a hitch at rest.
struct Drift {
    /// The reported fault, and its time, s.
    found: Option<(Fault, f64)>,
    /// True way from where it rested, degree.
    travel_deg: f64,
}

fn drift(rate_deg_per_s: f64, watched_s: u32) -> Drift {
    let model = hitch_model_file::dynamic();
    let calibration = Calibration::nominal().validate().unwrap();
    let mut closed_loop = ClosedLoop::new(&model, &calibration, 150.0, 40.0, 90.0, 3);
    closed_loop.pick_up();
    let mut drift = Drift {
        found: None,
        travel_deg: 0.0,
    };
    for ms in 0..watched_s * 1_000 {
        let off = MilliDegree((rate_deg_per_s * f64::from(ms)) as i32);
        let sample = closed_loop.step_with(
            90.0,
            |inputs| inputs.rocker_angle = inputs.rocker_angle.map(|angle| angle + off),
            |_, _| {},
        );
        drift.travel_deg = drift.travel_deg.max((sample.angle_deg - 90.0).abs());
        if let Some(fault) = sample.outputs.fault {
            drift.found = Some((fault, f64::from(ms) * 1e-3));
            break;
        }
    }
    let found = match drift.found {
        Some((fault, after_s)) => format!("{} after {after_s:.2} s", fault.name()),
        None => format!("nothing in {watched_s} s"),
    };
    let travel_deg = drift.travel_deg;
    println!("{rate_deg_per_s} deg/s: {found}; true travel {travel_deg:.2} deg");
    drift
}

/// The controller corrects the apparent motion a few times, by a few degrees in all. One sensor alone cannot distinguish
/// a drift from a leak.
#[test]
fn a_drifting_angle_is_followed_by_a_few_degrees_at_most() {
    let rates_deg_per_s = [
        -10.0, 1.0, -0.1, 0.01, -0.01, 0.1, -1.0, 10.0, -0.001, 0.001,
    ];
    for &rate_deg_per_s in cases(&rates_deg_per_s[..4], &rates_deg_per_s) {
        let drift = drift(rate_deg_per_s, 4_000);
        assert!(drift.found.is_some(), "{rate_deg_per_s} deg/s");
        assert!(drift.travel_deg <= 5.0, "{rate_deg_per_s} deg/s");
    }
}

/// Five corrections within 12 minutes are a fault; a drift that causes fewer is followed as long as it lasts.
#[test]
fn the_slowest_drift_that_is_noticed() {
    for &rate_deg_per_s in cases(&[-0.0004][..], &[-0.0004, 0.0004]) {
        let (_, after_s) = drift(rate_deg_per_s, 12_000).found.unwrap();
        assert!(after_s <= 11_000.0, "{rate_deg_per_s} deg/s: {after_s} s");
    }
    assert_eq!(drift(0.0003, 12_000).found, None);
}
