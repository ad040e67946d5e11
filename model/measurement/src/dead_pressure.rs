//! Runs whose cylinder pressure stays near zero while the hitch is lifted.

use hitch_campaign::Run;
use hitch_plant::Channel;

use crate::finding::{Evidence, Finding, Kind};
use crate::lifting::lifting;
use crate::logs::{FAR, Logs};
use crate::statistics::median;

/// Pressure, bar, that the zero of a sensor may have.
const ZERO_BAR: f64 = 1.0;
/// How many times larger the pressure is in the other runs.
const TIMES: f64 = 3.0;

/// The runs whose cylinder pressure is near zero while the hitch is lifted.
pub(crate) fn findings(logs: &Logs) -> Vec<Finding> {
    let lifted = |(run, log, _): (usize, &Run, f64)| {
        let pressure = log.channel(Channel::CylinderPressure)?;
        let samples = lifting(logs, run);
        (samples.len() > 4).then(|| (run, median(samples.into_iter().map(|i| pressure[i]))))
    };
    let pressures: Vec<(usize, f64)> = logs.hitches().filter_map(lifted).collect();
    let near_zero = FAR * logs.noise_of(Channel::CylinderPressure) + ZERO_BAR;
    let others = pressures.iter().map(|p| p.1).filter(|bar| *bar > near_zero);
    let least = others.fold(f64::INFINITY, f64::min);
    if !(least.is_finite() && least > TIMES * near_zero) {
        return Vec::new();
    }
    let dead = pressures.into_iter().filter(|p| p.1.abs() <= near_zero);
    let finding = |(run, bar): (usize, f64)| {
        let seen = format!(
            "The cylinder pressure is {bar:.2} bar while the hitch is lifted, and {least:.1} bar or more in the other runs."
        );
        let cure =
            "Check the sensor, its supply and its column; leave the channel of this run out.";
        let evidence = Evidence::new(bar, logs.noise_of(Channel::CylinderPressure), "bar");
        let finding =
            Finding::new(Kind::DeadPressure, evidence, seen, cure).in_run(logs.campaign, run);
        finding.of(Channel::CylinderPressure.key())
    };
    dead.map(finding).collect()
}
