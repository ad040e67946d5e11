//! Pump pressure below cylinder pressure while oil flows from the pump into the cylinder.

use hitch_plant::Channel;

use crate::finding::{Evidence, Finding, Kind, common_or_single};
use crate::lifting::lifting;
use crate::logs::{FAR, Logs};
use crate::statistics::median;

/// Fewest samples of a run while lifting.
const FEWEST: usize = 20;
/// Pressure, bar, by which a zero of either sensor may be off.
const ZEROS_BAR: f64 = 1.0;

/// The runs in which it is.
pub(crate) fn findings(logs: &Logs) -> Vec<Finding> {
    let runs = 0..logs.runs().len();
    let judged: Vec<(usize, f64)> = runs
        .filter_map(|run| Some((run, deficit_bar(logs, run)?)))
        .collect();
    let [pump, cylinder] = [Channel::PumpPressure, Channel::CylinderPressure];
    let far_bar = FAR * logs.noise_of(pump).hypot(logs.noise_of(cylinder));
    let below = judged
        .iter()
        .filter(|judged| judged.1 > far_bar + ZEROS_BAR);
    let wrong: Vec<(usize, f64)> = below.copied().collect();
    common_or_single(logs.campaign, &wrong, judged.len(), |bar| {
        let seen = format!(
            "The pump pressure is {bar:.1} bar below the cylinder pressure while oil flows from the pump into the cylinder."
        );
        let cure = "Swap the columns of the two pressures, or check their units and ranges.";
        let evidence = Evidence::new(bar, far_bar, "bar");
        Finding::new(Kind::PumpBelowCylinder, evidence, seen, cure).of(pump.key())
    })
}

/// Median of cylinder pressure above pump pressure while lifting, bar.
fn deficit_bar(logs: &Logs, at: usize) -> Option<f64> {
    let run = &logs.runs()[at];
    let pump = run.channel(Channel::PumpPressure)?;
    let cylinder = run.channel(Channel::CylinderPressure)?;
    let samples = lifting(logs, at);
    let deficit = samples.iter().map(|&i| cylinder[i] - pump[i]);
    (samples.len() >= FEWEST).then(|| median(deficit))
}
