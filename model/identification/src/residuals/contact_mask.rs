//! Mask of the samples where a hitch without inertia touches the ground or leaves it.
//!
//! The flow stops within a few milliseconds there. A sample just before or just after is off by the whole flow, and a
//! tenth of a degree decides on which side it lies.

use hitch_plant::hooks::effect_hooks::{EffectHooks, RunConditions};
use hitch_plant::simulation::Trace;
use hitch_plant::solver::root;
use hitch_plant::{AddedEffect, Dynamics, Model, SizeResponse};

use crate::data::ready_run::ReadyRun;

/// Samples next to a ground contact or a lift-off in either of two traces of a run. A dynamic model bounces for some
/// time instead and has no such samples.
pub(crate) fn contact_mask(run: &ReadyRun, model: &Model, traces: [&Trace; 2]) -> Vec<bool> {
    let mut near = vec![false; run.len()];
    let (true, Some(ground_deg)) = (run.on_hitch(), ground_deg(run, model)) else {
        return near;
    };
    for trace in traces {
        let above: Vec<bool> = trace
            .true_angle_deg
            .iter()
            .map(|&angle_deg| angle_deg > ground_deg)
            .collect();
        for (sample, pair) in above.windows(2).enumerate() {
            if pair[0] != pair[1] {
                let last = (sample + 2).min(run.len() - 1);
                near[sample.saturating_sub(1)..=last].fill(true);
            }
        }
    }
    near
}

/// Rocker angle at which the hitch touches the ground, degree; `None` in a dynamic model or without ground.
fn ground_deg(run: &ReadyRun, model: &Model) -> Option<f64> {
    if model.constants().dynamics == Dynamics::Dynamic {
        return None;
    }
    let linkage = model.linkage();
    let height_m = ground_m(run, model)?;
    let above_m = |piston_m: f64| linkage.at(piston_m).height_m - height_m;
    let piston_m = root::rising(above_m, 0.0, model.constants().cylinder.stroke_m, 1e-6);
    Some(linkage.at(piston_m).rocker_angle_rad.to_degrees())
}

/// Height of the ground above the rocker shaft, m, set by the effects of a model.
fn ground_m(run: &ReadyRun, model: &Model) -> Option<f64> {
    let located = |added: &&AddedEffect| added.effect.size_response() == SizeResponse::Located;
    let mut hooks = EffectHooks::default();
    let conditions = RunConditions {
        oil_temperature_c: run.oil_temperature_c,
        constants: model.constants(),
        linkage: model.linkage(),
    };
    for added in model.effects.iter().filter(located) {
        added.attach(conditions, &mut hooks);
    }
    hooks.ground.map(|ground| ground.height_m)
}
