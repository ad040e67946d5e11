//! `relief-override`: the relief valve needs more than its setting to pass the whole flow.
//!
//! `p_P = 154 bar + override Q_relief / Q_pump`: its spring gives as it opens (Merritt 5.6). 10 to 25 bar at 48 l/min.

use super::Parameter;
use super::described::Described;
use crate::campaign::Channel;

use crate::plant::sites::{RunConditions, Sites};
use crate::units::pa_from_bar;

/// Override of the relief valve.
pub static RELIEF_OVERRIDE: Described = Described {
    id: "relief-override",
    title: "Override of the relief valve",
    equation: "p_P = 154 bar + override Q_relief / 48 l/min",
    source: "Merritt 5.6; 10 to 25 bar over the range of a direct-acting valve, Hopsan's example 15 \
         bar at 42 l/min",
    shows: "pump pressure at the upper end of the stroke with the lift valve open: only there does \
         the relief valve work",
    parameters: &[Parameter {
        name: "override",
        unit: "bar",
        key: "override_bar",
        meaning: "pressure over the setting at the pump's whole flow",
        null: 0.0,
        typical: 15.0,
        low: -30.0,
        high: 60.0,
    }],
    channels: &[Channel::PumpPressure],
    needs: None,
    attach,
};

fn attach(values: &[f64], _: RunConditions<'_>, sites: &mut Sites) {
    sites.relief_override_pa += pa_from_bar(values[0]);
}
