//! `hose-compliance`: hoses and fittings swell with the pressure.
//!
//! `dp/dt = (sum Q - A v) / (V/E + C)`. Two metres of half-inch two-wire hose have 3 to 6e-13 m3/Pa, as much as 0.6 l
//! of oil; written in cm3/bar, 0.03 to 0.06.

use super::described::Described;
use super::{Parameter, Search};
use crate::campaign::Channel;
use crate::model::Dynamics;
use crate::plant::sites::{RunConditions, Sites};
use crate::units::pa_from_bar;

/// Compliance of hoses.
pub static HOSE_COMPLIANCE: Described = Described {
    id: "hose-compliance",
    form: None,
    title: "Compliance of hoses",
    equation: "dp/dt = (sum Q - A v) / (V/E + C)",
    source: "two-wire hose, 0.25 l at 0.4 to 0.8e9 Pa: 0.03 to 0.06 cm3/bar",
    shows: "slower ringing of the cylinder pressure at every load alike; entrained air softens light \
         loads more",
    parameters: &[Parameter {
        name: "compliance",
        unit: "cm3/bar",
        key: "compliance_cm3_bar",
        meaning: "volume that the hoses take up",
        null: 0.0,
        typical: 0.04,
        low: 0.0,
        high: 1.0,
    }],
    channels: &[Channel::CylinderPressure],
    needs: Some(Dynamics::Dynamic),
    search: Search::Secants,
    attach,
};

fn attach(values: &[f64], _: RunConditions<'_>, sites: &mut Sites) {
    sites.compliance_m3_pa += values[0] * 1e-6 / pa_from_bar(1.0);
}
