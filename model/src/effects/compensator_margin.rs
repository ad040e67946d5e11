//! `compensator-margin`: the compensator keeps another margin than declared while lifting.
//!
//! `p_P - p_C = 4 bar + excess`. The preload of its spring is set by shims and settles with age; 10 to 30 % off the data
//! sheet is usual. What the check valve's 2.5 bar leave drives the lift orifice, so a bar more on 1.5 bar is 29 % more
//! lift flow.

use super::described::Described;
use super::{Parameter, Search};
use crate::campaign::Channel;
use crate::units::pa_from_bar;

/// Another margin than declared.
pub static COMPENSATOR_MARGIN: Described = Described {
    id: "compensator-margin",
    form: None,
    title: "Margin of the pressure compensator, off the declared one",
    equation: "p_P - p_C = 4 bar + excess; Q = Q_table(I) sqrt((p_P - p_C - 2.5 bar) / 1.5 bar)",
    source: "preload of the compensator's spring: 10 to 30 % off the data sheet",
    shows: "the pump pressure stands more or less than 4 bar over every load alike while lifting; without a pump pressure \
         it is the lift valve's flow scale",
    parameters: &[Parameter {
        name: "excess",
        unit: "bar",
        key: "excess_bar",
        meaning: "margin on top of the declared one",
        null: 0.0,
        typical: 0.5,
        low: -1.4,
        high: 10.0,
    }],
    channels: &[Channel::PumpPressure, Channel::Flow, Channel::RockerAngle],
    needs: None,
    search: Search::Secants,
    refines: false,
    attach: |values, _, sites| {
        let excess_pa = pa_from_bar(values[0]);
        sites.margin.push(Box::new(move |_| excess_pa));
    },
};
