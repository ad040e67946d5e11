//! The manoeuvres for a next experiment.
//!
//! Each is the cheapest known way to separate some effects from others: a triangle shows hysteresis, two rates separate
//! it from lag, two loads separate pressure-dependent from flow-dependent effects, two temperatures identify those that
//! depend on viscosity. Currents, loads and pressures are relative to the machine, see [`template`](super::template):
//! current 0 is the threshold of the valve and 1 its full opening.

use crate::design::plan::USUAL_OIL_C;
use hitch_plant::Valve;

use crate::design::template::{Load, RunTemplate, SegmentTemplate, StandTemplate, Template};

/// Ramp of a step of the current, s: the fastest change of a current controller.
const STEP_S: f64 = 0.01;

/// Ramp of an ordinary motion, s.
const RAMP_S: f64 = 0.2;

/// Oil temperatures for effects that depend on viscosity, degree Celsius.
const COLD_C: f64 = 18.0;
const WARM_C: f64 = 60.0;

/// Start angles for lifting, for both directions and for lowering, as shares of the swing.
const LOW: f64 = 0.06;
const MIDDLE: f64 = 0.5;
const HIGH: f64 = 0.94;

const fn lift(opening: f64, ramp_s: f64, stay_s: f64) -> SegmentTemplate {
    SegmentTemplate {
        open: Some((Valve::Lift, opening)),
        ramp_s,
        stay_s,
    }
}

const fn lower(opening: f64, ramp_s: f64, stay_s: f64) -> SegmentTemplate {
    SegmentTemplate {
        open: Some((Valve::Lower, opening)),
        ramp_s,
        stay_s,
    }
}

const fn off(ramp_s: f64, stay_s: f64) -> SegmentTemplate {
    SegmentTemplate {
        open: None,
        ramp_s,
        stay_s,
    }
}

const fn hitch(load: Load, start: f64, course: &'static [SegmentTemplate]) -> RunTemplate {
    hitch_at(USUAL_OIL_C, load, start, course)
}

const fn hitch_at(
    oil_temperature_c: f64,
    load: Load,
    start: f64,
    course: &'static [SegmentTemplate],
) -> RunTemplate {
    RunTemplate {
        stand: StandTemplate::Hitch { load, start },
        oil_temperature_c,
        course,
    }
}

const fn bench(share_of_relief: f64, course: &'static [SegmentTemplate]) -> RunTemplate {
    RunTemplate {
        stand: StandTemplate::Flow { share_of_relief },
        oil_temperature_c: USUAL_OIL_C,
        course,
    }
}

static SLOW_LIFT: [SegmentTemplate; 4] = [
    lift(-0.059, RAMP_S, 0.3),
    lift(0.223, 5.0, 0.0),
    lift(-0.059, 5.0, 0.0),
    off(RAMP_S, 1.0),
];

static FAST_LIFT: [SegmentTemplate; 8] = [
    lift(0.505, 0.5, 0.0),
    off(0.5, 0.3),
    lift(0.505, 0.5, 0.0),
    off(0.5, 0.3),
    lift(0.505, 0.5, 0.0),
    off(0.5, 0.3),
    lift(0.505, 0.5, 0.0),
    off(0.5, 1.0),
];

static SLOW_LOWER: [SegmentTemplate; 4] = [
    lower(-0.047, RAMP_S, 0.3),
    lower(0.378, 4.5, 0.0),
    lower(-0.047, 4.5, 0.0),
    off(RAMP_S, 1.0),
];

static FAST_LOWER: [SegmentTemplate; 8] = [
    lower(0.567, 0.5, 0.0),
    off(0.5, 0.3),
    lower(0.567, 0.5, 0.0),
    off(0.5, 0.3),
    lower(0.567, 0.5, 0.0),
    off(0.5, 0.3),
    lower(0.567, 0.5, 0.0),
    off(0.5, 1.0),
];

static LIFT_STAIRS: [SegmentTemplate; 10] = [
    lift(-0.012, STEP_S, 1.2),
    lift(0.035, STEP_S, 1.2),
    lift(0.082, STEP_S, 1.2),
    lift(0.129, STEP_S, 1.2),
    lift(0.176, STEP_S, 1.2),
    lift(0.129, STEP_S, 1.2),
    lift(0.082, STEP_S, 1.2),
    lift(0.035, STEP_S, 1.2),
    lift(-0.012, STEP_S, 1.2),
    off(STEP_S, 1.0),
];

static LOWER_STAIRS: [SegmentTemplate; 14] = [
    lower(0.048, STEP_S, 1.0),
    lower(0.095, STEP_S, 1.0),
    lower(0.142, STEP_S, 1.0),
    lower(0.189, STEP_S, 1.0),
    lower(0.236, STEP_S, 1.0),
    lower(0.283, STEP_S, 1.0),
    lower(0.331, STEP_S, 1.0),
    lower(0.283, STEP_S, 1.0),
    lower(0.236, STEP_S, 1.0),
    lower(0.189, STEP_S, 1.0),
    lower(0.142, STEP_S, 1.0),
    lower(0.095, STEP_S, 1.0),
    lower(0.048, STEP_S, 1.0),
    off(STEP_S, 1.0),
];

static LIFT_REVERSALS: [SegmentTemplate; 8] = [
    lift(0.176, RAMP_S, 0.5),
    lift(0.152, 0.3, 0.5),
    lift(0.176, 0.3, 0.5),
    lift(0.129, 0.3, 0.5),
    lift(0.176, 0.3, 0.5),
    lift(0.082, 0.3, 0.5),
    lift(0.176, 0.3, 0.5),
    off(RAMP_S, 1.0),
];

static LOWER_REVERSALS: [SegmentTemplate; 8] = [
    lower(0.331, RAMP_S, 0.5),
    lower(0.307, 0.3, 0.5),
    lower(0.331, 0.3, 0.5),
    lower(0.283, 0.3, 0.5),
    lower(0.331, 0.3, 0.5),
    lower(0.236, 0.3, 0.5),
    lower(0.331, 0.3, 0.5),
    off(RAMP_S, 1.0),
];

static DEAD_BAND: [SegmentTemplate; 9] = [
    lift(0.105, 0.6, 0.0),
    off(0.6, 0.0),
    lower(0.189, 0.6, 0.0),
    off(0.6, 0.0),
    lift(0.152, 0.6, 0.0),
    off(0.6, 0.0),
    lower(0.283, 0.6, 0.0),
    off(0.6, 0.0),
    off(0.1, 1.0),
];

static LIFT_STEPS: [SegmentTemplate; 6] = [
    lift(0.176, STEP_S, 1.0),
    off(STEP_S, 1.0),
    lift(0.411, STEP_S, 0.6),
    off(STEP_S, 1.0),
    lift(0.881, STEP_S, 0.3),
    off(STEP_S, 1.0),
];

static LOWER_STEPS: [SegmentTemplate; 6] = [
    lower(0.283, STEP_S, 1.0),
    off(STEP_S, 1.0),
    lower(0.472, STEP_S, 0.6),
    off(STEP_S, 1.0),
    lower(0.850, STEP_S, 0.3),
    off(STEP_S, 1.0),
];

static HOLD: [SegmentTemplate; 1] = [off(STEP_S, 60.0)];

static IDLE: [SegmentTemplate; 1] = [off(STEP_S, 10.0)];

static DEAD_HEAD: [SegmentTemplate; 2] = [lift(0.411, RAMP_S, 4.0), off(RAMP_S, 2.0)];

static TO_THE_GROUND: [SegmentTemplate; 4] = [
    lower(0.331, RAMP_S, 5.0),
    off(RAMP_S, 1.0),
    lift(0.129, RAMP_S, 2.0),
    off(RAMP_S, 1.0),
];

static TWO_LIFTS: [SegmentTemplate; 4] = [
    lift(0.176, RAMP_S, 2.0),
    off(RAMP_S, 1.0),
    lift(0.505, RAMP_S, 1.0),
    off(RAMP_S, 1.0),
];

static TWO_LOWERINGS: [SegmentTemplate; 4] = [
    lower(0.283, RAMP_S, 1.5),
    off(RAMP_S, 1.0),
    lower(0.567, RAMP_S, 0.8),
    off(RAMP_S, 1.0),
];

static CREEP: [SegmentTemplate; 8] = [
    lift(0.058, RAMP_S, 3.0),
    off(RAMP_S, 1.5),
    lower(0.236, RAMP_S, 3.0),
    off(RAMP_S, 1.5),
    lift(0.058, RAMP_S, 3.0),
    off(RAMP_S, 1.5),
    lower(0.236, RAMP_S, 3.0),
    off(RAMP_S, 1.5),
];

static FULL_LIFT: [SegmentTemplate; 2] = [lift(1.023, RAMP_S, 0.7), off(RAMP_S, 1.0)];

static FULL_LOWERING: [SegmentTemplate; 2] = [lower(0.991, RAMP_S, 0.5), off(RAMP_S, 1.0)];

static UP_AND_DOWN: [SegmentTemplate; 4] = [
    lift(0.176, 2.5, 0.0),
    off(2.5, 0.5),
    lower(0.331, 2.5, 0.0),
    off(2.5, 1.0),
];

static BENCH_LIFT: [SegmentTemplate; 2] = [lift(1.070, 6.0, 0.0), off(6.0, 1.0)];

static BENCH_LOWER: [SegmentTemplate; 2] = [lower(1.038, 6.0, 0.0), off(6.0, 1.0)];

/// Every manoeuvre, relative to the machine.
pub static TEMPLATES: &[Template] = &[
    Template {
        name: "slow-lift-triangle",
        instruction: "with {middle} kg from near the bottom, sweep the lift current up from {lift -0.059} to {lift 0.223} A and back down in 5 s each way",
        runs: &[hitch(Load::Middle, LOW, &SLOW_LIFT)],
    },
    Template {
        name: "fast-lift-triangle",
        instruction: "with {middle} kg from near the bottom, sweep the lift current from 0 to {lift 0.505} A and back in 0.5 s each way, four times",
        runs: &[hitch(Load::Middle, LOW, &FAST_LIFT)],
    },
    Template {
        name: "slow-lowering-triangle",
        instruction: "with {middle} kg from near the top, sweep the lowering current up from {lower -0.047} to {lower 0.378} A and back down in 4.5 s each way",
        runs: &[hitch(Load::Middle, HIGH, &SLOW_LOWER)],
    },
    Template {
        name: "fast-lowering-triangle",
        instruction: "with {middle} kg from near the top, sweep the lowering current from 0 to {lower 0.567} A and back in 0.5 s each way, four times",
        runs: &[hitch(Load::Middle, HIGH, &FAST_LOWER)],
    },
    Template {
        name: "lift-staircase",
        instruction: "with {middle} kg from near the bottom, step the lift current from {lift -0.012} to {lift 0.176} A and back down in stairs of {lift-span 0.047} A, 1.2 s each",
        runs: &[hitch(Load::Middle, LOW, &LIFT_STAIRS)],
    },
    Template {
        name: "lowering-staircase",
        instruction: "with {middle} kg from near the top, step the lowering current from {lower 0.048} to {lower 0.331} A and back down in stairs of {lower-span 0.047} A, 1 s each",
        runs: &[hitch(Load::Middle, HIGH, &LOWER_STAIRS)],
    },
    Template {
        name: "lift-reversals",
        instruction: "with {middle} kg from near the bottom, hold the lift current at {lift 0.176} A and reverse it by {lift-span 0.024}, {lift-span 0.047} and {lift-span 0.094} A and back, 0.5 s on each level",
        runs: &[hitch(Load::Middle, LOW, &LIFT_REVERSALS)],
    },
    Template {
        name: "lowering-reversals",
        instruction: "with {middle} kg from near the top, hold the lowering current at {lower 0.331} A and reverse it by {lower-span 0.024}, {lower-span 0.047} and {lower-span 0.094} A and back, 0.5 s on each level",
        runs: &[hitch(Load::Middle, HIGH, &LOWER_REVERSALS)],
    },
    Template {
        name: "dead-band-reversals",
        instruction: "with {middle} kg at mid-stroke, sweep through the dead band from one valve to the other and back twice: lift current to {lift 0.105} A, lowering current to {lower 0.189} A, then {lift 0.152} and {lower 0.283} A, 0.6 s each way",
        runs: &[hitch(Load::Middle, MIDDLE, &DEAD_BAND)],
    },
    Template {
        name: "lift-steps",
        instruction: "with {middle} kg from near the bottom, step the lift current within 10 ms to {lift 0.176}, {lift 0.411} and {lift 0.881} A and back to 0 for 1 s after each",
        runs: &[hitch(Load::Middle, LOW, &LIFT_STEPS)],
    },
    Template {
        name: "lowering-steps",
        instruction: "with {middle} kg from near the top, step the lowering current within 10 ms to {lower 0.283}, {lower 0.472} and {lower 0.850} A and back to 0 for 1 s after each",
        runs: &[hitch(Load::Middle, HIGH, &LOWER_STEPS)],
    },
    Template {
        name: "hold-at-two-loads",
        instruction: "hold at mid-stroke for 60 s with both valves off, once with {light} kg and once with {heavy} kg",
        runs: &[
            hitch(Load::Light, MIDDLE, &HOLD),
            hitch(Load::Heavy, MIDDLE, &HOLD),
        ],
    },
    Template {
        name: "idle",
        instruction: "log 10 s at mid-stroke with both valves off, the pump running and {middle} kg on the hitch",
        runs: &[hitch(Load::Middle, MIDDLE, &IDLE)],
    },
    Template {
        name: "dead-head",
        instruction: "with {middle} kg lift at {lift 0.411} A into the upper stop, keep the current on for 4 s, and let go",
        runs: &[hitch(Load::Middle, 0.85, &DEAD_HEAD)],
    },
    Template {
        name: "down-to-the-ground",
        instruction: "with {middle} kg lower at {lower 0.331} A onto the ground or the lower stop, stay there for 1 s and lift off again at {lift 0.129} A",
        runs: &[hitch(Load::Middle, 0.3, &TO_THE_GROUND)],
    },
    Template {
        name: "light-and-heavy-lift",
        instruction: "lift from near the bottom at {lift 0.176} A and at {lift 0.505} A with {light} kg, and the same with {heavy} kg",
        runs: &[
            hitch(Load::Light, LOW, &TWO_LIFTS),
            hitch(Load::Heavy, LOW, &TWO_LIFTS),
        ],
    },
    Template {
        name: "light-and-heavy-lowering",
        instruction: "lower from near the top at {lower 0.283} A and at {lower 0.567} A with {light} kg, and the same with {heavy} kg",
        runs: &[
            hitch(Load::Light, HIGH, &TWO_LOWERINGS),
            hitch(Load::Heavy, HIGH, &TWO_LOWERINGS),
        ],
    },
    Template {
        name: "creep-and-stop",
        instruction: "at mid-stroke creep up at {lift 0.058} A, stop, creep down at {lower 0.236} A and stop, twice, 3 s each, with {light} kg and with {heavy} kg",
        runs: &[
            hitch(Load::Light, MIDDLE, &CREEP),
            hitch(Load::Heavy, MIDDLE, &CREEP),
        ],
    },
    Template {
        name: "full-opening",
        instruction: "with {light} kg open the lift valve fully ({lift 1.023} A) for 0.7 s from near the bottom, then the lowering valve ({lower 0.991} A) for 0.5 s from near the top",
        runs: &[
            hitch(Load::Light, LOW, &FULL_LIFT),
            hitch(Load::Light, HIGH, &FULL_LOWERING),
        ],
    },
    Template {
        name: "cold-and-warm",
        instruction: "with {middle} kg at mid-stroke sweep the lift current to {lift 0.176} A and back and the lowering current to {lower 0.331} A and back in 2.5 s each way, with the oil at 18 C and again at 60 C",
        runs: &[
            hitch_at(COLD_C, Load::Middle, MIDDLE, &UP_AND_DOWN),
            hitch_at(WARM_C, Load::Middle, MIDDLE, &UP_AND_DOWN),
        ],
    },
    Template {
        name: "flow-bench-lift",
        instruction: "on the flow bench sweep the lift current from 0 to {lift 1.070} A and back in 6 s each way, at port pressures of {port 0.13} and {port 0.91} bar",
        runs: &[bench(0.13, &BENCH_LIFT), bench(0.91, &BENCH_LIFT)],
    },
    Template {
        name: "flow-bench-lowering",
        instruction: "on the flow bench sweep the lowering current from 0 to {lower 1.038} A and back in 6 s each way, at port pressures of {port 0.0325}, {port 0.0975} and {port 0.26} bar",
        runs: &[
            bench(0.0325, &BENCH_LOWER),
            bench(0.0975, &BENCH_LOWER),
            bench(0.26, &BENCH_LOWER),
        ],
    },
];
