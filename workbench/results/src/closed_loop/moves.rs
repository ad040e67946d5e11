//! Drives and evaluates moves, on all cores.

use hitch_closed_loop::{ClosedLoop, STEP_S, Sample};
use hitch_plant::Model;
use hitch_quantities::{Fault, Inputs, ValidCalibration};
use rayon::prelude::*;

use super::ideal_ramp::IdealRamp;
use super::metrics::{MoveResult, Summary, judge};
use super::scenario::{Move, both_ways, middle_and_room_deg};
use hitch_closed_loop::valve_survey::ValveEnds;

/// Duration from the step of the set point: the longest move plus one minute, steps.
const RUN_STEPS: usize = 64_000;
/// Recorded duration of a move for plots, from the step of the set point, steps.
const KEPT_STEPS: usize = 3_000;
/// Positions of the lever for quick lift, as shares of the travel below the raised position.
const LEVER_BELOW: [f64; 3] = [0.1, 0.5, 1.0];
/// Time for which the button of quick lift is pressed, steps.
const PRESSED_STEPS: usize = 200;
/// Time in which quick lift raises the hitch before it is returned, steps.
const RAISING_STEPS: usize = 8_000;
/// Seed of the noise in the first move.
const SEED: u64 = 0x5eed_0001;

/// The first seconds of a move, for plots.
#[derive(Debug, Clone)]
pub struct MoveTrace {
    /// The move.
    pub order: Move,
    /// Samples from the step of the set point, at time zero.
    pub samples: Vec<Sample>,
    /// The last sample of the run, about a minute later.
    pub end: Sample,
    /// The first fault of the run; it may be over at the end.
    pub fault: Option<Fault>,
}

impl MoveTrace {
    /// Times, s, and a value of the samples until a time, s.
    #[must_use]
    pub fn points(&self, end_s: f64, value: fn(&Sample) -> f64) -> (Vec<f64>, Vec<f64>) {
        let samples = self.samples.iter();
        let shown = samples.take_while(|sample| sample.time_s <= end_s);
        shown.map(|sample| (sample.time_s, value(sample))).unzip()
    }
}

/// A set of moves.
#[derive(Debug, Clone)]
pub struct LoopRun {
    /// Figures of each move, in the order of the moves.
    pub results: Vec<MoveResult>,
    /// Figures of all.
    pub summary: Summary,
    /// Trace of each move.
    pub traces: Vec<MoveTrace>,
}

/// A move with its ideal manoeuvre.
#[derive(Debug, Clone)]
pub struct Course {
    order: Move,
    by: By,
    ideal: IdealRamp,
    seed: u64,
}

/// The operator's control that commands a move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum By {
    Lever,
    QuickLift,
}

/// Finds the ideal manoeuvre of each move.
#[must_use]
pub fn courses(model: &Model, moves: &[Move]) -> Vec<Course> {
    courses_by(By::Lever, model, moves)
}

fn courses_by(by: By, model: &Model, moves: &[Move]) -> Vec<Course> {
    let ends = [ValveEnds::of_lift(model), ValveEnds::of_lowering(model)];
    moves
        .par_iter()
        .enumerate()
        .map(|(index, order)| Course {
            order: *order,
            by,
            ideal: IdealRamp::find(
                model,
                order,
                ends[usize::from(order.to_deg < order.from_deg)],
            ),
            seed: SEED + index as u64,
        })
        .collect()
}

/// Drives `moves`, each with the minute after it; `None` if there are none.
#[must_use]
pub fn run(model: &Model, calibration: &ValidCalibration, moves: &[Move]) -> Option<LoopRun> {
    drive_all(model, calibration, &courses(model, moves))
}

/// Drives quick lift, from several positions of the lever and back to it; `None` without loads or temperatures.
#[must_use]
pub fn run_quick_lift(
    model: &Model,
    calibration: &ValidCalibration,
    loads_kg: &[f64],
    oil_temperatures_c: &[f64],
) -> Option<LoopRun> {
    let raised_deg = f64::from(calibration.operator.quick_lift_angle.0) * 1e-3;
    let (middle_deg, room_deg) = middle_and_room_deg(model);
    let pairs = LEVER_BELOW.map(|share| {
        let lowest_deg = middle_deg - 0.5 * room_deg;
        (raised_deg - share * (raised_deg - lowest_deg), raised_deg)
    });
    let moves = both_ways(&pairs, loads_kg, oil_temperatures_c);
    drive_all(
        model,
        calibration,
        &courses_by(By::QuickLift, model, &moves),
    )
}

fn drive_all(model: &Model, calibration: &ValidCalibration, courses: &[Course]) -> Option<LoopRun> {
    let driven: Vec<(MoveResult, MoveTrace)> = courses
        .par_iter()
        .map(|course| drive(model, calibration, course))
        .collect();
    let (results, traces): (Vec<_>, Vec<_>) = driven.into_iter().unzip();
    Some(LoopRun {
        summary: Summary::of(&results)?,
        results,
        traces,
    })
}

/// Figures of `courses`, observed for `after_s` beyond three times their shortest time.
#[must_use]
pub fn figures(
    model: &Model,
    calibration: &ValidCalibration,
    courses: &[Course],
    after_s: f64,
) -> Vec<MoveResult> {
    courses
        .par_iter()
        .map(|course| {
            let steps = 3 * (course.ideal.angles_deg.len() + 1) + (after_s / STEP_S) as usize;
            let samples = samples(model, calibration, course, steps);
            judge(&course.order, &samples, &course.ideal)
        })
        .collect()
}

fn drive(
    model: &Model,
    calibration: &ValidCalibration,
    course: &Course,
) -> (MoveResult, MoveTrace) {
    let mut samples = samples(model, calibration, course, RUN_STEPS);
    let result = judge(&course.order, &samples, &course.ideal);
    let end = samples[samples.len() - 1];
    let fault = samples.iter().find_map(|sample| sample.outputs.fault);
    samples.truncate(KEPT_STEPS);
    let order = course.order;
    let trace = MoveTrace {
        order,
        samples,
        end,
        fault,
    };
    (result, trace)
}

/// The samples from the step of the set point, at time zero.
fn samples(
    model: &Model,
    calibration: &ValidCalibration,
    course: &Course,
    steps: usize,
) -> Vec<Sample> {
    let order = &course.order;
    // Quick lift leaves the lever where it is, and can only be returned after it has raised the hitch.
    let (start_deg, lever_deg) = match course.by {
        By::Lever => (order.from_deg, order.to_deg),
        By::QuickLift => (
            order.from_deg.min(order.to_deg),
            order.from_deg.min(order.to_deg),
        ),
    };
    let mut closed_loop = ClosedLoop::new(
        model,
        calibration,
        order.load_kg,
        order.oil_temperature_c,
        start_deg,
        course.seed,
    );
    closed_loop.pick_up();
    let mut drive = |steps: usize| -> Vec<Sample> {
        let press = |step: usize| {
            let is_pressed = course.by == By::QuickLift && step < PRESSED_STEPS;
            move |inputs: &mut Inputs| inputs.switches.quick_lift |= is_pressed
        };
        (0..steps)
            .map(|step| closed_loop.step_with(lever_deg, press(step), |_, _| {}))
            .collect()
    };
    if course.by == By::QuickLift && order.to_deg < order.from_deg {
        drive(RAISING_STEPS);
    }
    let mut samples = drive(steps);
    let start_s = samples.first().map_or(0.0, |first| first.time_s);
    samples
        .iter_mut()
        .for_each(|sample| sample.time_s -= start_s);
    samples
}
