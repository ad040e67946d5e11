//! Table 5: the paper's measurement of the valves, reproduced by the identification.

use hitch_effects::find;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::explanation::explain::{Explanation, explain};
use hitch_paper::flow_table::{flow_lpm, table_2};
use hitch_paper::tables::{FIGURE_12_LIFT_A, FIGURE_12_LOADS_KG};
use hitch_paper::test_bench::{self, deviation, saturation_a, table_5, threshold_a};
use hitch_paper::travel_time::travel_s;
use hitch_plant::{AddedEffect, Constants, Dynamics, Model, Valve};
use schemars::JsonSchema;
use serde::Serialize;

use crate::explanation::{Parameter, parameters};
use crate::progress::Progress;

/// Highest current of the flow test, A.
const HIGHEST_A: f64 = 3.5;
/// Flow below the resolution of a flow meter, l/min.
const HARDLY_LPM: f64 = 1e-3;
/// Bisection steps for a threshold.
const HALVINGS: usize = 40;

/// Table 5 compared with Table 2 and with the rebuilt model.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Table5 {
    /// One entry a valve: lift, lower.
    pub valves: [ValveCheck; 2],
    /// The effects identified in the flow test, in the order of the identification.
    pub effects: Vec<EffectCheck>,
    /// Verdict of the identification.
    pub verdict: &'static str,
    /// Error of the model before and after, in sigma of the flow meter.
    pub error: [f64; 2],
    /// Lift at the lowest current of Figure 12, where the time depends strongly on the threshold.
    pub slowest_lift: SlowestLift,
}

/// A valve's characteristic numbers: Table 2, Table 5, and the model with the effects found.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ValveCheck {
    /// `lift` or `lower`.
    pub valve: &'static str,
    /// Current at which flow begins, A.
    pub threshold_a: Triple,
    /// Flow of the open valve, l/min.
    pub saturation_lpm: Triple,
    /// Current from which the flow does not rise, A.
    pub saturation_a: Triple,
}

/// The same quantity from three sources.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct Triple {
    /// Table 2, the manufacturer's; the unit is that of the quantity.
    pub table_2: f64,
    /// Table 5, the paper's measurement.
    pub table_5: f64,
    /// The model with the identified effects.
    pub model: f64,
}

/// An identified effect, compared with the difference of the two tables.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct EffectCheck {
    /// Id of the effect.
    pub effect: &'static str,
    /// Value that converts Table 2 into Table 5, in the unit of the parameter; `null` for an effect that the tables do not imply.
    pub expected: Option<f64>,
    /// The identified parameter.
    pub found: Parameter,
}

/// Time of the slowest lift of Figure 12, s; the figure's axis ends at 30 s.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct SlowestLift {
    /// Current, A.
    pub current_a: f64,
    /// Time with the threshold of Table 2A, s; `null` if the lift never ends.
    pub table_2_s: Option<f64>,
    /// Time with the threshold of Table 5, s; `null` if the lift never ends.
    pub table_5_s: Option<f64>,
}

impl Table5 {
    /// Identifies from the flow test how the measured valves differ from those of the model.
    pub fn of(model: &Model, progress: &Progress) -> Self {
        let model = &quasi_static(model);
        let experiment = Experiment::new(&test_bench::campaign(), model);
        let found = explain(Problem::new(&experiment, model), &|what| {
            progress.say(format!("Table 5: trying {what}"))
        });
        let rebuilt = found.after.estimate.applied_to(model);
        Self {
            valves: [Valve::Lift, Valve::Lowering].map(|valve| valve_check(&rebuilt, valve)),
            effects: effect_checks(&found),
            verdict: found.verdict.name(),
            error: [found.before.error(), found.after.error()],
            slowest_lift: slowest_lift(model),
        }
    }
}

/// The model without its dynamics: the flow test is a steady-state test.
fn quasi_static(model: &Model) -> Model {
    let constants = Constants {
        dynamics: Dynamics::Steady,
        ..model.constants().clone()
    };
    // The linkage is unchanged, so its geometry remains valid.
    let steady = Model::new(model.name.clone(), constants);
    steady.map_or_else(
        |_| model.clone(),
        |steady| steady.with_effects(model.effects.clone()),
    )
}

fn effect_checks(found: &Explanation) -> Vec<EffectCheck> {
    let expected = |id: &str| match id {
        "lower-threshold-shift" => Some(deviation(Valve::Lowering).threshold_shift_a),
        "lift-flow-scale" => Some(deviation(Valve::Lift).flow_scale),
        "lower-flow-scale" => Some(deviation(Valve::Lowering).flow_scale),
        _ => None,
    };
    let steps = found.steps.iter().flat_map(|step| {
        let parameters = parameters(step.effect, &step.values, &step.intervals);
        parameters
            .into_iter()
            .map(|found| (step.effect.id(), found))
    });
    steps
        .map(|(effect, found)| EffectCheck {
            effect,
            expected: expected(effect),
            found,
        })
        .collect()
}

fn valve_check(rebuilt: &Model, valve: Valve) -> ValveCheck {
    let (table, measured) = (table_2(valve), table_5(valve));
    let flow = |current_a: f64| flow_lpm(rebuilt, valve, current_a);
    let full_lpm = flow(HIGHEST_A);
    let table_2_lpm = table
        .iter()
        .map(|(_, flow_lpm)| *flow_lpm)
        .fold(0.0, f64::max);
    ValveCheck {
        valve: match valve {
            Valve::Lift => "lift",
            Valve::Lowering => "lower",
        },
        threshold_a: Triple {
            table_2: threshold_a(table),
            table_5: measured.threshold_a,
            model: boundary_a(|current_a| flow(current_a) > HARDLY_LPM),
        },
        saturation_lpm: Triple {
            table_2: table_2_lpm,
            table_5: measured.saturation_lpm,
            model: full_lpm,
        },
        saturation_a: Triple {
            table_2: saturation_a(table),
            table_5: measured.saturation_a,
            model: boundary_a(|current_a| flow(current_a) > full_lpm - HARDLY_LPM),
        },
    }
}

/// Smallest current above which a condition holds, by bisection.
fn boundary_a(holds: impl Fn(f64) -> bool) -> f64 {
    let (mut below_a, mut above_a) = (0.0, HIGHEST_A);
    for _ in 0..HALVINGS {
        let middle_a = 0.5 * (below_a + above_a);
        if holds(middle_a) {
            above_a = middle_a
        } else {
            below_a = middle_a
        }
    }
    above_a
}

fn slowest_lift(model: &Model) -> SlowestLift {
    let (current_a, load_kg) = (FIGURE_12_LIFT_A[0], FIGURE_12_LOADS_KG[0]);
    let shift_a = table_5(Valve::Lift).threshold_a - threshold_a(table_2(Valve::Lift));
    let shifted = find("lift-threshold-shift").map(|effect| {
        let added = AddedEffect {
            effect,
            values: vec![shift_a],
        };
        model.with_effects(model.effects.iter().cloned().chain([added]).collect())
    });
    SlowestLift {
        current_a,
        table_2_s: travel_s(model, Valve::Lift, current_a, load_kg),
        table_5_s: shifted.and_then(|model| travel_s(&model, Valve::Lift, current_a, load_kg)),
    }
}
