//! `lift-flow-scale`, `lower-flow-scale`: relative deviation of a valve's flow from its data sheet.
//!
//! `Q = (1 + scale) Q_table`, per valve: orifice area and discharge coefficient (equations 5 and 6). The paper's valves
//! saturate 6.7 % (lift) and 3.4 % (lowering) below the manufacturer's values. With a different shape of the metering
//! edge the deviation depends on the opening: the scale increases linearly with it.

use hitch_plant::hooks::elements::FlowFactor;
use hitch_plant::{Channel, Parameter};

use crate::described::Described;

const SCALE: Parameter = Parameter {
    meaning: "relative change of the flow, at half the largest",
    typical: 0.05,
    low: -0.5,
    high: 0.5,
    ..Parameter::ratio("scale")
};

const GROWTH: Parameter = Parameter {
    meaning: "relative growth of the scale from half to the largest flow",
    typical: 0.3,
    low: -1.0,
    high: 1.0,
    ..Parameter::ratio("growth")
};

/// Flow scale of the lift valve.
pub static LIFT: Described = Described {
    id: "lift-flow-scale",
    title: "Scaled flow of the lift valve",
    equation: "Q = (1 + scale) Q_table(I)",
    source: "equations 5 and 6 of the paper with another Cd A; paper, Table 5 against Table 2",
    shows: "lifting at every current by the same factor: flow and speed; equivalent to another margin of the \
            compensator, another discharge coefficient or a stiffer spring of the check valve",
    parameters: &[SCALE],
    channels: &[Channel::Flow, Channel::RockerAngle],
    attach: |values, _, hooks| scale(&mut hooks.lift_flow_factor, values[0], 0.0),
    ..Described::USUAL
};

/// Flow scale of the lift valve that increases with its opening.
pub static LIFT_UNEVEN: Described = Described {
    form: Some("uneven"),
    title: "Scaled flow of the lift valve, with a different scale when fully open",
    equation: "Q = (1 + scale (1 + growth (2 Q_table / Q_largest - 1))) Q_table(I)",
    shows: "lifting at every current, with different factors for fast and slow motion: flow and speed",
    parameters: &[SCALE, GROWTH],
    refines: true,
    attach: |values, _, hooks| scale(&mut hooks.lift_flow_factor, values[0], values[1]),
    ..LIFT
};

/// Flow scale of the lowering valve.
pub static LOWERING: Described = Described {
    id: "lower-flow-scale",
    title: "Scaled flow of the lowering valve",
    shows: "lowering at every current and load by the same factor: flow and speed",
    attach: |values, _, hooks| scale(&mut hooks.lower_flow_factor, values[0], 0.0),
    ..LIFT
};

/// Flow scale of the lowering valve that increases with its opening.
pub static LOWERING_UNEVEN: Described = Described {
    form: Some("uneven"),
    title: "Scaled flow of the lowering valve, with a different scale when fully open",
    equation: "Q = (1 + scale (1 + growth (2 Q_table / Q_largest - 1))) Q_table(I)",
    shows: "lowering at every current and load, with different factors for fast and slow motion: flow and speed",
    parameters: &[SCALE, GROWTH],
    refines: true,
    attach: |values, _, hooks| scale(&mut hooks.lower_flow_factor, values[0], values[1]),
    ..LOWERING
};

fn scale(factor: &mut FlowFactor, scale: f64, growth: f64) {
    factor.at_half += scale;
    factor.growth += scale * growth;
}
