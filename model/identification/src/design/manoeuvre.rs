//! The manoeuvres for a next experiment.
//!
//! Each is the cheapest known way to separate some effects from others: a triangle shows hysteresis, two rates separate
//! it from lag, two loads separate pressure-dependent from flow-dependent effects, two temperatures identify those that
//! depend on viscosity. Currents are for the paper's valves, which open at 1.0 to 1.25 A and are fully open at 3.1 to
//! 3.3 A.

use hitch_plant::Currents;

use crate::design::plan::{Manoeuvre, RunPlan, Segment, Stand, USUAL_OIL_C};

/// Ramp of a step of the current, s: the fastest change of a current controller.
const STEP_S: f64 = 0.01;

/// Ramp of an ordinary motion, s.
const RAMP_S: f64 = 0.2;

const LIGHT_KG: f64 = 50.0;
const MIDDLE_KG: f64 = 150.0;
const HEAVY_KG: f64 = 250.0;

const COLD_C: f64 = 18.0;
const WARM_C: f64 = 60.0;

/// Start angles for lifting, for both directions and for lowering, as shares of the swing.
const LOW: f64 = 0.06;
const MIDDLE: f64 = 0.5;
const HIGH: f64 = 0.94;

const fn lift(lift_a: f64, ramp_s: f64, stay_s: f64) -> Segment {
    Segment {
        to: Currents {
            lift_a,
            lower_a: 0.0,
        },
        ramp_s,
        stay_s,
    }
}

const fn lower(lower_a: f64, ramp_s: f64, stay_s: f64) -> Segment {
    Segment {
        to: Currents {
            lift_a: 0.0,
            lower_a,
        },
        ramp_s,
        stay_s,
    }
}

const fn off(ramp_s: f64, stay_s: f64) -> Segment {
    lift(0.0, ramp_s, stay_s)
}

const fn hitch(load_kg: f64, start: f64, course: &'static [Segment]) -> RunPlan {
    hitch_at(USUAL_OIL_C, load_kg, start, course)
}

const fn hitch_at(
    oil_temperature_c: f64,
    load_kg: f64,
    start: f64,
    course: &'static [Segment],
) -> RunPlan {
    RunPlan {
        stand: Stand::Hitch { load_kg, start },
        oil_temperature_c,
        course,
    }
}

const fn bench(port_pressure_bar: f64, course: &'static [Segment]) -> RunPlan {
    RunPlan {
        stand: Stand::Flow { port_pressure_bar },
        oil_temperature_c: USUAL_OIL_C,
        course,
    }
}

static SLOW_LIFT: [Segment; 4] = [
    lift(1.0, RAMP_S, 0.3),
    lift(1.6, 5.0, 0.0),
    lift(1.0, 5.0, 0.0),
    off(RAMP_S, 1.0),
];

static FAST_LIFT: [Segment; 8] = [
    lift(2.2, 0.5, 0.0),
    off(0.5, 0.3),
    lift(2.2, 0.5, 0.0),
    off(0.5, 0.3),
    lift(2.2, 0.5, 0.0),
    off(0.5, 0.3),
    lift(2.2, 0.5, 0.0),
    off(0.5, 1.0),
];

static SLOW_LOWER: [Segment; 4] = [
    lower(0.9, RAMP_S, 0.3),
    lower(1.8, 4.5, 0.0),
    lower(0.9, 4.5, 0.0),
    off(RAMP_S, 1.0),
];

static FAST_LOWER: [Segment; 8] = [
    lower(2.2, 0.5, 0.0),
    off(0.5, 0.3),
    lower(2.2, 0.5, 0.0),
    off(0.5, 0.3),
    lower(2.2, 0.5, 0.0),
    off(0.5, 0.3),
    lower(2.2, 0.5, 0.0),
    off(0.5, 1.0),
];

static LIFT_STAIRS: [Segment; 10] = [
    lift(1.1, STEP_S, 1.2),
    lift(1.2, STEP_S, 1.2),
    lift(1.3, STEP_S, 1.2),
    lift(1.4, STEP_S, 1.2),
    lift(1.5, STEP_S, 1.2),
    lift(1.4, STEP_S, 1.2),
    lift(1.3, STEP_S, 1.2),
    lift(1.2, STEP_S, 1.2),
    lift(1.1, STEP_S, 1.2),
    off(STEP_S, 1.0),
];

static LOWER_STAIRS: [Segment; 14] = [
    lower(1.1, STEP_S, 1.0),
    lower(1.2, STEP_S, 1.0),
    lower(1.3, STEP_S, 1.0),
    lower(1.4, STEP_S, 1.0),
    lower(1.5, STEP_S, 1.0),
    lower(1.6, STEP_S, 1.0),
    lower(1.7, STEP_S, 1.0),
    lower(1.6, STEP_S, 1.0),
    lower(1.5, STEP_S, 1.0),
    lower(1.4, STEP_S, 1.0),
    lower(1.3, STEP_S, 1.0),
    lower(1.2, STEP_S, 1.0),
    lower(1.1, STEP_S, 1.0),
    off(STEP_S, 1.0),
];

static LIFT_REVERSALS: [Segment; 8] = [
    lift(1.5, RAMP_S, 0.5),
    lift(1.45, 0.3, 0.5),
    lift(1.5, 0.3, 0.5),
    lift(1.4, 0.3, 0.5),
    lift(1.5, 0.3, 0.5),
    lift(1.3, 0.3, 0.5),
    lift(1.5, 0.3, 0.5),
    off(RAMP_S, 1.0),
];

static LOWER_REVERSALS: [Segment; 8] = [
    lower(1.7, RAMP_S, 0.5),
    lower(1.65, 0.3, 0.5),
    lower(1.7, 0.3, 0.5),
    lower(1.6, 0.3, 0.5),
    lower(1.7, 0.3, 0.5),
    lower(1.5, 0.3, 0.5),
    lower(1.7, 0.3, 0.5),
    off(RAMP_S, 1.0),
];

static DEAD_BAND: [Segment; 9] = [
    lift(1.35, 0.6, 0.0),
    off(0.6, 0.0),
    lower(1.4, 0.6, 0.0),
    off(0.6, 0.0),
    lift(1.45, 0.6, 0.0),
    off(0.6, 0.0),
    lower(1.6, 0.6, 0.0),
    off(0.6, 0.0),
    off(0.1, 1.0),
];

static LIFT_STEPS: [Segment; 6] = [
    lift(1.5, STEP_S, 1.0),
    off(STEP_S, 1.0),
    lift(2.0, STEP_S, 0.6),
    off(STEP_S, 1.0),
    lift(3.0, STEP_S, 0.3),
    off(STEP_S, 1.0),
];

static LOWER_STEPS: [Segment; 6] = [
    lower(1.6, STEP_S, 1.0),
    off(STEP_S, 1.0),
    lower(2.0, STEP_S, 0.6),
    off(STEP_S, 1.0),
    lower(2.8, STEP_S, 0.3),
    off(STEP_S, 1.0),
];

static HOLD: [Segment; 1] = [off(STEP_S, 60.0)];

static IDLE: [Segment; 1] = [off(STEP_S, 10.0)];

static DEAD_HEAD: [Segment; 2] = [lift(2.0, RAMP_S, 4.0), off(RAMP_S, 2.0)];

static TO_THE_GROUND: [Segment; 4] = [
    lower(1.7, RAMP_S, 5.0),
    off(RAMP_S, 1.0),
    lift(1.4, RAMP_S, 2.0),
    off(RAMP_S, 1.0),
];

static TWO_LIFTS: [Segment; 4] = [
    lift(1.5, RAMP_S, 2.0),
    off(RAMP_S, 1.0),
    lift(2.2, RAMP_S, 1.0),
    off(RAMP_S, 1.0),
];

static TWO_LOWERINGS: [Segment; 4] = [
    lower(1.6, RAMP_S, 1.5),
    off(RAMP_S, 1.0),
    lower(2.2, RAMP_S, 0.8),
    off(RAMP_S, 1.0),
];

static CREEP: [Segment; 8] = [
    lift(1.25, RAMP_S, 3.0),
    off(RAMP_S, 1.5),
    lower(1.5, RAMP_S, 3.0),
    off(RAMP_S, 1.5),
    lift(1.25, RAMP_S, 3.0),
    off(RAMP_S, 1.5),
    lower(1.5, RAMP_S, 3.0),
    off(RAMP_S, 1.5),
];

static FULL_LIFT: [Segment; 2] = [lift(3.3, RAMP_S, 0.7), off(RAMP_S, 1.0)];

static FULL_LOWERING: [Segment; 2] = [lower(3.1, RAMP_S, 0.5), off(RAMP_S, 1.0)];

static UP_AND_DOWN: [Segment; 4] = [
    lift(1.5, 2.5, 0.0),
    off(2.5, 0.5),
    lower(1.7, 2.5, 0.0),
    off(2.5, 1.0),
];

static BENCH_LIFT: [Segment; 2] = [lift(3.4, 6.0, 0.0), off(6.0, 1.0)];

static BENCH_LOWER: [Segment; 2] = [lower(3.2, 6.0, 0.0), off(6.0, 1.0)];

/// Every manoeuvre.
pub static MANOEUVRES: &[Manoeuvre] = &[
    Manoeuvre {
        name: "slow-lift-triangle",
        instruction: "with 150 kg from near the bottom, sweep the lift current up from 1.0 to 1.6 A and back down in 5 s each way",
        runs: &[hitch(MIDDLE_KG, LOW, &SLOW_LIFT)],
    },
    Manoeuvre {
        name: "fast-lift-triangle",
        instruction: "with 150 kg from near the bottom, sweep the lift current from 0 to 2.2 A and back in 0.5 s each way, four times",
        runs: &[hitch(MIDDLE_KG, LOW, &FAST_LIFT)],
    },
    Manoeuvre {
        name: "slow-lowering-triangle",
        instruction: "with 150 kg from near the top, sweep the lowering current up from 0.9 to 1.8 A and back down in 4.5 s each way",
        runs: &[hitch(MIDDLE_KG, HIGH, &SLOW_LOWER)],
    },
    Manoeuvre {
        name: "fast-lowering-triangle",
        instruction: "with 150 kg from near the top, sweep the lowering current from 0 to 2.2 A and back in 0.5 s each way, four times",
        runs: &[hitch(MIDDLE_KG, HIGH, &FAST_LOWER)],
    },
    Manoeuvre {
        name: "lift-staircase",
        instruction: "with 150 kg from near the bottom, step the lift current from 1.1 to 1.5 A and back down in stairs of 0.1 A, 1.2 s each",
        runs: &[hitch(MIDDLE_KG, LOW, &LIFT_STAIRS)],
    },
    Manoeuvre {
        name: "lowering-staircase",
        instruction: "with 150 kg from near the top, step the lowering current from 1.1 to 1.7 A and back down in stairs of 0.1 A, 1 s each",
        runs: &[hitch(MIDDLE_KG, HIGH, &LOWER_STAIRS)],
    },
    Manoeuvre {
        name: "lift-reversals",
        instruction: "with 150 kg from near the bottom, hold the lift current at 1.5 A and reverse it by 0.05, 0.1 and 0.2 A and back, 0.5 s on each level",
        runs: &[hitch(MIDDLE_KG, LOW, &LIFT_REVERSALS)],
    },
    Manoeuvre {
        name: "lowering-reversals",
        instruction: "with 150 kg from near the top, hold the lowering current at 1.7 A and reverse it by 0.05, 0.1 and 0.2 A and back, 0.5 s on each level",
        runs: &[hitch(MIDDLE_KG, HIGH, &LOWER_REVERSALS)],
    },
    Manoeuvre {
        name: "dead-band-reversals",
        instruction: "with 150 kg at mid-stroke, sweep through the dead band from one valve to the other and back twice: lift current to 1.35 A, lowering current to 1.4 A, then 1.45 and 1.6 A, 0.6 s each way",
        runs: &[hitch(MIDDLE_KG, MIDDLE, &DEAD_BAND)],
    },
    Manoeuvre {
        name: "lift-steps",
        instruction: "with 150 kg from near the bottom, step the lift current within 10 ms to 1.5, 2.0 and 3.0 A and back to 0 for 1 s after each",
        runs: &[hitch(MIDDLE_KG, LOW, &LIFT_STEPS)],
    },
    Manoeuvre {
        name: "lowering-steps",
        instruction: "with 150 kg from near the top, step the lowering current within 10 ms to 1.6, 2.0 and 2.8 A and back to 0 for 1 s after each",
        runs: &[hitch(MIDDLE_KG, HIGH, &LOWER_STEPS)],
    },
    Manoeuvre {
        name: "hold-at-two-loads",
        instruction: "hold at mid-stroke for 60 s with both valves off, once with 50 kg and once with 250 kg",
        runs: &[
            hitch(LIGHT_KG, MIDDLE, &HOLD),
            hitch(HEAVY_KG, MIDDLE, &HOLD),
        ],
    },
    Manoeuvre {
        name: "idle",
        instruction: "log 10 s at mid-stroke with both valves off, the pump running and 150 kg on the hitch",
        runs: &[hitch(MIDDLE_KG, MIDDLE, &IDLE)],
    },
    Manoeuvre {
        name: "dead-head",
        instruction: "with 150 kg lift at 2.0 A into the upper stop, keep the current on for 4 s, and let go",
        runs: &[hitch(MIDDLE_KG, 0.85, &DEAD_HEAD)],
    },
    Manoeuvre {
        name: "down-to-the-ground",
        instruction: "with 150 kg lower at 1.7 A onto the ground or the lower stop, stay there for 1 s and lift off again at 1.4 A",
        runs: &[hitch(MIDDLE_KG, 0.3, &TO_THE_GROUND)],
    },
    Manoeuvre {
        name: "light-and-heavy-lift",
        instruction: "lift from near the bottom at 1.5 A and at 2.2 A with 50 kg, and the same with 250 kg",
        runs: &[
            hitch(LIGHT_KG, LOW, &TWO_LIFTS),
            hitch(HEAVY_KG, LOW, &TWO_LIFTS),
        ],
    },
    Manoeuvre {
        name: "light-and-heavy-lowering",
        instruction: "lower from near the top at 1.6 A and at 2.2 A with 50 kg, and the same with 250 kg",
        runs: &[
            hitch(LIGHT_KG, HIGH, &TWO_LOWERINGS),
            hitch(HEAVY_KG, HIGH, &TWO_LOWERINGS),
        ],
    },
    Manoeuvre {
        name: "creep-and-stop",
        instruction: "at mid-stroke creep up at 1.25 A, stop, creep down at 1.5 A and stop, twice, 3 s each, with 50 kg and with 250 kg",
        runs: &[
            hitch(LIGHT_KG, MIDDLE, &CREEP),
            hitch(HEAVY_KG, MIDDLE, &CREEP),
        ],
    },
    Manoeuvre {
        name: "full-opening",
        instruction: "with 50 kg open the lift valve fully (3.3 A) for 0.7 s from near the bottom, then the lowering valve (3.1 A) for 0.5 s from near the top",
        runs: &[
            hitch(LIGHT_KG, LOW, &FULL_LIFT),
            hitch(LIGHT_KG, HIGH, &FULL_LOWERING),
        ],
    },
    Manoeuvre {
        name: "cold-and-warm",
        instruction: "with 150 kg at mid-stroke sweep the lift current to 1.5 A and back and the lowering current to 1.7 A and back in 2.5 s each way, with the oil at 18 C and again at 60 C",
        runs: &[
            hitch_at(COLD_C, MIDDLE_KG, MIDDLE, &UP_AND_DOWN),
            hitch_at(WARM_C, MIDDLE_KG, MIDDLE, &UP_AND_DOWN),
        ],
    },
    Manoeuvre {
        name: "flow-bench-lift",
        instruction: "on the flow bench sweep the lift current from 0 to 3.4 A and back in 6 s each way, at port pressures of 20 and 140 bar",
        runs: &[bench(20.0, &BENCH_LIFT), bench(140.0, &BENCH_LIFT)],
    },
    Manoeuvre {
        name: "flow-bench-lowering",
        instruction: "on the flow bench sweep the lowering current from 0 to 3.2 A and back in 6 s each way, at port pressures of 5, 15 and 40 bar",
        runs: &[
            bench(5.0, &BENCH_LOWER),
            bench(15.0, &BENCH_LOWER),
            bench(40.0, &BENCH_LOWER),
        ],
    },
];
