//! Pump pressure below cylinder pressure while oil flows from the pump into the cylinder.

use hitch_plant::Channel;

use crate::finding::{Evidence, Finding, Kind, by_run};
use crate::lifting::lifting;
use crate::logs::{FAR, Logs, ZERO_BAR};
use crate::statistics::median_of_several;

/// The runs in which it is.
pub(crate) fn findings(logs: &Logs) -> Vec<Finding> {
    let [pump, cylinder] = [Channel::PumpPressure, Channel::CylinderPressure];
    let far_bar = FAR * logs.noise_of(pump).hypot(logs.noise_of(cylinder));
    let deficit_bar = |at: usize| {
        let run = &logs.runs()[at];
        let (pump, cylinder) = run.channel(pump).zip(run.channel(cylinder))?;
        let samples = lifting(logs, at).into_iter();
        median_of_several(samples.map(|i| cylinder[i] - pump[i]))
    };
    let is_wrong = |bar| bar > far_bar + ZERO_BAR;
    by_run(logs.campaign, deficit_bar, is_wrong, |bar| {
        let seen = format!(
            "The pump pressure is {bar:.1} bar below the cylinder pressure while oil flows from the pump into the cylinder."
        );
        let cure = "Swap the columns of the two pressures, or check their units and ranges.";
        let evidence = Evidence::new(bar, far_bar, "bar");
        Finding::new(Kind::PumpBelowCylinder, evidence, seen, cure).of(pump.key())
    })
}
