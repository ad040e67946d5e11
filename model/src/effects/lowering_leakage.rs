//! `lowering-leakage`: the shut lowering valve and the check valve do not hold the load for ever.
//!
//! `Q = G p_C`, laminar flow through an annular gap (Merritt 3.3, `G = pi d c^3 / 12 mu l`), out of the cylinder past
//! the flow meter. A seated poppet loses 5e-6 l/min/bar, a worn one a thousand times that.

use super::{Effect, Parameter};
use crate::campaign::Channel;
use crate::plant::sites::{RunConditions, Sites};
use crate::units;

/// Leakage out of the cylinder.
#[derive(Debug)]
pub struct LoweringLeakage;

static PARAMETERS: [Parameter; 1] = [Parameter {
    name: "conductance",
    unit: "l/min/bar",
    key: "conductance_lpm_per_bar",
    meaning: "leakage flow over cylinder pressure",
    null: 0.0,
    typical: 0.002,
    low: 0.0,
    high: 0.1,
}];

impl Effect for LoweringLeakage {
    fn id(&self) -> &'static str {
        "lowering-leakage"
    }

    fn title(&self) -> &'static str {
        "Leakage of the load-holding valves"
    }

    fn equation(&self) -> &'static str {
        "Q_leak = conductance * p_C"
    }

    fn source(&self) -> &'static str {
        "laminar gap, Merritt 3.3; worn load-holding valves"
    }

    fn shows(&self) -> &'static str {
        "the hitch sinks while holding, faster under heavy loads; little else"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn channels(&self) -> &'static [Channel] {
        &[Channel::RockerAngle]
    }

    fn attach(&self, values: &[f64], _: RunConditions<'_>, sites: &mut Sites) {
        let conductance = units::m3_s_from_lpm(values[0]) / units::PA_PER_BAR;
        sites.leakage.push(Box::new(move |pressure_pa| {
            conductance * pressure_pa.max(0.0)
        }));
    }
}
