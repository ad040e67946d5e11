//! `lift-flow-scale`, `lower-flow-scale`: the valve passes a share more or less than its data sheet says.
//!
//! `Q = (1 + scale) Q_table`, for one valve: orifice area and discharge coefficient (equations 5 and 6). The paper's
//! valves saturate 6.7 % (lift) and 3.4 % (lowering) under the manufacturer's values.

use super::{Effect, Parameter};
use crate::campaign::Channel;
use crate::plant::sites::{RunConditions, Sites, Valve};

/// Flow scale of one valve.
#[derive(Debug)]
pub struct FlowScale {
    valve: Valve,
    id: &'static str,
    title: &'static str,
    shows: &'static str,
}

/// Flow scale of the lift valve.
pub static LIFT: FlowScale = FlowScale {
    valve: Valve::Lift,
    id: "lift-flow-scale",
    title: "Scaled flow of the lift valve",
    shows: "lifting at every current alike in proportion: flow and speed; the same as another margin of the \
            compensator, another discharge coefficient or a stiffer spring of the check valve",
};

/// Flow scale of the lowering valve.
pub static LOWERING: FlowScale = FlowScale {
    valve: Valve::Lowering,
    id: "lower-flow-scale",
    title: "Scaled flow of the lowering valve",
    shows: "lowering at every current and load alike in proportion: flow and speed",
};

static PARAMETERS: [Parameter; 1] = [Parameter {
    name: "scale",
    unit: "",
    key: "scale",
    meaning: "relative change of the flow",
    null: 0.0,
    typical: 0.05,
    low: -0.5,
    high: 0.5,
}];

impl Effect for FlowScale {
    fn id(&self) -> &'static str {
        self.id
    }

    fn title(&self) -> &'static str {
        self.title
    }

    fn equation(&self) -> &'static str {
        "Q = (1 + scale) Q_table(I)"
    }

    fn source(&self) -> &'static str {
        "equations 5 and 6 of the paper with another Cd A; paper, Table 5 against Table 2"
    }

    fn shows(&self) -> &'static str {
        self.shows
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn channels(&self) -> &'static [Channel] {
        &[Channel::Flow, Channel::RockerAngle]
    }

    fn attach(&self, values: &[f64], _: RunConditions<'_>, sites: &mut Sites) {
        let factor = match self.valve {
            Valve::Lift => &mut sites.lift_flow_factor,
            Valve::Lowering => &mut sites.lower_flow_factor,
        };
        *factor *= 1.0 + values[0];
    }
}
