//! Drives and evaluates moves, on all cores.

use hitch_plant::Model;
use hitch_quantities::ValidCalibration;
use rayon::prelude::*;

use super::ideal_ramp::IdealRamp;
use super::loop_::{ClosedLoop, STEP_S, Sample};
use super::metrics::{MoveResult, Summary, judge};
use super::scenario::Move;
use crate::valve_survey::ValveEnds;

/// Duration from the step of the set point: the longest move plus one minute, steps.
const RUN_STEPS: usize = 64_000;
/// Recorded duration of a move for plots, from the step of the set point, steps.
const KEPT_STEPS: usize = 3_000;
/// Seed of the noise in the first move.
const SEED: u64 = 0x5eed_0001;

/// The first seconds of a move, for plots.
#[derive(Debug, Clone)]
pub struct MoveTrace {
    /// The move.
    pub order: Move,
    /// Samples from the step of the set point, at time zero.
    pub samples: Vec<Sample>,
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
    ideal: IdealRamp,
    seed: u64,
}

/// Finds the ideal manoeuvre of each move.
#[must_use]
pub fn courses(model: &Model, moves: &[Move]) -> Vec<Course> {
    let ends = [ValveEnds::of_lift(model), ValveEnds::of_lowering(model)];
    moves
        .par_iter()
        .enumerate()
        .map(|(index, order)| Course {
            order: *order,
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
    let driven: Vec<(MoveResult, MoveTrace)> = courses(model, moves)
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
    samples.truncate(KEPT_STEPS);
    let order = course.order;
    (result, MoveTrace { order, samples })
}

/// The samples from the step of the set point, at time zero.
fn samples(
    model: &Model,
    calibration: &ValidCalibration,
    course: &Course,
    steps: usize,
) -> Vec<Sample> {
    let order = &course.order;
    let mut closed_loop = ClosedLoop::new(
        model,
        calibration,
        order.load_kg,
        order.oil_temperature_c,
        order.from_deg,
        course.seed,
    );
    closed_loop.pick_up();
    let mut samples: Vec<Sample> = (0..steps).map(|_| closed_loop.step(order.to_deg)).collect();
    let start_s = samples.first().map_or(0.0, |first| first.time_s);
    samples
        .iter_mut()
        .for_each(|sample| sample.time_s -= start_s);
    samples
}
