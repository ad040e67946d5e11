//! `pump-flow`: deviation of the pump's delivery from the declared value.
//!
//! `Q_pump = (1 + change) Q_declared`: another engine speed or displacement. The slip of a worn pump depends on the
//! pressure instead (`pump-leakage`). It shows only if the lift valve demands more than the delivery.

use hitch_plant::{Channel, Parameter};

use crate::described::Described;

/// Deviation of the pump's delivery.
pub static PUMP_FLOW: Described = Described {
    id: "pump-flow",
    title: "Deviation of the pump flow",
    equation: "Q_pump = (1 + change) Q_max",
    source: "engine speed and displacement; a deviation below 20 % rarely affects a lift",
    shows: "lifting at high currents, equally at all pressures; invisible while the compensator has surplus flow",
    parameters: &[Parameter {
        meaning: "change of the flow as a share of the declared one",
        typical: -0.3,
        low: -0.7,
        high: 1.0,
        ..Parameter::ratio("change")
    }],
    channels: &[Channel::PumpPressure, Channel::Flow],
    attach: |values, conditions, hooks| {
        let lost_m3_s = -values[0] * conditions.constants.pump.flow_m3_s();
        hooks.pump_slip.push(Box::new(move |_| lost_m3_s));
    },
    ..Described::USUAL
};
