//! Runs of an external plan on the second rig.

use hitch_campaign::Bench;
use hitch_identification::design::plan::{RunPlan, Stand};
use hitch_plant::{Currents, Model, Rig};

use super::manoeuvres::{Course, Manoeuvre};

/// A planned run; `model` defines its start angle.
#[must_use]
pub fn on_order(plan: &RunPlan, model: &Model) -> Manoeuvre {
    let bench = match plan.stand {
        Stand::Hitch { load_kg, .. } => Bench::Hitch { load_kg },
        Stand::Flow { port_pressure_bar } => Bench::Flow { port_pressure_bar },
    };
    let start_deg = match plan.rig(model) {
        Rig::Hitch(rig) => rig.start_angle_rad.to_degrees(),
        Rig::Flow { .. } => f64::NAN,
    };
    Manoeuvre {
        file: String::new(),
        bench,
        start_deg,
        oil_temperature_c: plan.oil_temperature_c,
        duration_s: plan.duration_s(),
        lift: course(plan, |currents| currents.lift_a),
        lower: course(plan, |currents| currents.lower_a),
    }
}

/// One current of a plan.
fn course(plan: &RunPlan, current_a: impl Fn(Currents) -> f64) -> Course {
    let segments: f64 = plan.course.iter().map(|s| s.ramp_s + s.stay_s).sum();
    let mut time_s = plan.duration_s() - segments;
    let mut knots = vec![(time_s, 0.0)];
    for segment in &plan.course {
        let to_a = current_a(segment.to);
        knots.push((time_s + segment.ramp_s, to_a));
        time_s += segment.ramp_s + segment.stay_s;
        knots.push((time_s, to_a));
    }
    Course::through(knots)
}
