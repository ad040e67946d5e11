//! Drives moves and judges them, on all cores.

use hitch_firmware::control::ValidCalibration;
use hitch_model::Model;
use rayon::prelude::*;

use super::ideal_ramp::IdealRamp;
use super::loop_::{ClosedLoop, Sample};
use super::metrics::{MoveResult, Summary, judge};
use super::scenario::Move;
use crate::valve_survey::ValveEnds;

/// From the step of the set point to the end: the longest move and the minute after it, steps.
const RUN_STEPS: usize = 64_000;
/// What is kept of a move for plots, from the step of the set point, steps.
const KEPT_STEPS: usize = 3_000;
/// Seed of the first move's instruments.
const SEED: u64 = 0x5eed_0001;

/// The first seconds of a move, for plots.
#[derive(Debug, Clone)]
pub struct MoveTrace {
    /// The move.
    pub order: Move,
    /// Samples from the step of the set point, time zero there.
    pub samples: Vec<Sample>,
}

/// A set of moves.
#[derive(Debug, Clone)]
pub struct LoopRun {
    /// Figures of each move, in the order of the moves.
    pub results: Vec<MoveResult>,
    /// Figures of all.
    pub summary: Summary,
    /// Traces of each move.
    pub traces: Vec<MoveTrace>,
}

/// Drives `moves`; `None` if there are none.
#[must_use]
pub fn run(model: &Model, calibration: &ValidCalibration, moves: &[Move]) -> Option<LoopRun> {
    let ends = [ValveEnds::of_lift(model), ValveEnds::of_lowering(model)];
    let driven: Vec<(MoveResult, MoveTrace)> = moves
        .par_iter()
        .enumerate()
        .map(|(index, order)| {
            let ends = ends[usize::from(order.to_deg < order.from_deg)];
            drive(model, calibration, order, ends, SEED + index as u64)
        })
        .collect();
    let (results, traces): (Vec<_>, Vec<_>) = driven.into_iter().unzip();
    Some(LoopRun {
        summary: Summary::of(&results)?,
        results,
        traces,
    })
}

fn drive(
    model: &Model,
    calibration: &ValidCalibration,
    order: &Move,
    ends: ValveEnds,
    seed: u64,
) -> (MoveResult, MoveTrace) {
    let ideal = IdealRamp::find(model, order, ends);
    let mut closed_loop = ClosedLoop::new(
        model,
        calibration,
        order.load_kg,
        order.oil_temperature_c,
        order.from_deg,
        seed,
    );
    closed_loop.pick_up();
    let mut samples: Vec<Sample> = (0..RUN_STEPS)
        .map(|_| closed_loop.step(order.to_deg))
        .collect();
    let start_s = samples.first().map_or(0.0, |first| first.time_s);
    samples
        .iter_mut()
        .for_each(|sample| sample.time_s -= start_s);
    let result = judge(order, &samples, &ideal);
    samples.truncate(KEPT_STEPS);
    (
        result,
        MoveTrace {
            order: *order,
            samples,
        },
    )
}
