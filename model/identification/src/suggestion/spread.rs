//! Distribution of a signal in a campaign: start values for the scales of shapes.

use hitch_plant::{Channel, Model, units};

use crate::data::problem::Problem;
use crate::data::ready_run::ReadyRun;

/// Quantiles at which the scale of a shape starts.
pub const QUANTILES: [f64; 3] = [0.2, 0.45, 0.7];

/// Quantiles of a signal, in SI, over the relevant samples: those with flow for a flow or a speed, those with current
/// for a current. `None` if the campaign does not contain it.
#[must_use]
pub fn quantiles(problem: Problem<'_>, signal: &str) -> Option<[f64; 3]> {
    let Problem {
        experiment, model, ..
    } = problem;
    let mut values: Vec<f64> = experiment
        .runs
        .iter()
        .flat_map(|run| values(run, model, signal))
        .filter(|value| value.is_finite())
        .collect();
    if values.len() < 30 {
        return None;
    }
    values.sort_by(f64::total_cmp);
    let at = |share: f64| values[(share * (values.len() - 1) as f64) as usize];
    let found = QUANTILES.map(at);
    (values[values.len() - 1] > values[0]).then_some(found)
}

fn values(run: &ReadyRun, model: &Model, signal: &str) -> Vec<f64> {
    let measured = |channel: Channel| run.measured[channel.index()].as_deref().unwrap_or(&[]);
    let lift = |a: &f64| a.max(0.0);
    let flow = |sign: f64| {
        let flows = measured(Channel::Flow).iter();
        let open = flows.map(move |lpm| sign * units::m3_s_from_lpm(*lpm));
        open.filter(|flow| *flow > 1e-5).collect()
    };
    match signal {
        "x" => {
            let angles = measured(Channel::RockerAngle).iter();
            let travel = angles.map(|deg| model.linkage().piston_m(deg.to_radians()));
            travel.collect()
        }
        "rocker_angle" => {
            let angles = measured(Channel::RockerAngle).iter();
            angles.map(|deg| deg.to_radians()).collect()
        }
        "p_cyl" => {
            let pressures = measured(Channel::CylinderPressure).iter();
            pressures.map(|bar| units::pa_from_bar(*bar)).collect()
        }
        "v" => {
            let area_m2 = model.constants().cylinder.area_m2();
            let flows: Vec<f64> = [flow(1.0), flow(-1.0)].concat();
            flows.into_iter().map(|flow| flow / area_m2).collect()
        }
        "q_lift" => flow(1.0),
        "q_lower" => flow(-1.0),
        "i_lift" => {
            let currents = run.drive.currents.iter().map(|c| lift(&c.lift_a));
            currents.filter(|a| *a > 0.5).collect()
        }
        "i_lower" => {
            let currents = run.drive.currents.iter().map(|c| lift(&c.lower_a));
            currents.filter(|a| *a > 0.5).collect()
        }
        "t_oil" => vec![run.oil_temperature_c; run.len()],
        _ => Vec::new(),
    }
}
