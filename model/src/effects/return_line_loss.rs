//! `return-line-loss`: filter and line between lowering valve and tank hold the flow back.
//!
//! `p_T = loss (Q / 40 l/min)^2`, turbulent: `dp = (lambda L/d + zeta) rho v^2 / 2`. The lowering valve's drop is what
//! the cylinder pressure leaves. 1 bar at 60 l/min is usual, several bar with a clogged filter or a thin hose.

use super::{Effect, Parameter};
use crate::campaign::Channel;
use crate::plant::sites::{RunConditions, Sites};
use crate::units;

/// Flow at which the loss is stated, l/min.
const REFERENCE_FLOW_LPM: f64 = 40.0;

/// Back pressure of the return line behind the lowering valve.
#[derive(Debug)]
pub struct ReturnLineLoss;

static PARAMETERS: [Parameter; 1] = [Parameter {
    name: "loss",
    unit: "bar",
    key: "loss_bar",
    meaning: "back pressure at 40 l/min",
    null: 0.0,
    typical: 1.0,
    low: 0.0,
    high: 20.0,
}];

impl Effect for ReturnLineLoss {
    fn id(&self) -> &'static str {
        "return-line-loss"
    }

    fn title(&self) -> &'static str {
        "Back pressure of the return line"
    }

    fn equation(&self) -> &'static str {
        "p_T = loss * (Q_lower / 40 l/min)^2"
    }

    fn source(&self) -> &'static str {
        "turbulent pipe and filter loss; filter 0.3 to 1 bar and 2 m of hose 0.5 bar at 60 l/min"
    }

    fn shows(&self) -> &'static str {
        "lowering at high current and light load is slower; at low flow nothing"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn channels(&self) -> &'static [Channel] {
        &[Channel::Flow, Channel::RockerAngle]
    }

    fn attach(&self, values: &[f64], _: RunConditions<'_>, sites: &mut Sites) {
        let reference_m3_s = units::m3_s_from_lpm(REFERENCE_FLOW_LPM);
        let coefficient = units::pa_from_bar(values[0]) / (reference_m3_s * reference_m3_s);
        sites.return_loss_pa_s2_m6 += coefficient;
    }
}
