//! Runs whose cylinder pressure is in another unit, or stays near zero.

use hitch_campaign::{Bench, Run};
use hitch_plant::Channel;

use crate::finding::{Evidence, Finding, Kind, by_run, unexplained};
use crate::lifting::lifting;
use crate::logs::{FAR, Logs, ZERO_BAR};
use crate::rest_pressure::{Line, rests};
use crate::statistics::median_of_several;

/// Units as multiples of a bar, and what they are when bar is expected.
const UNITS: [(f64, &str); 6] = [
    (14.504, "psi"),
    (100.0, "kPa"),
    (0.1, "MPa"),
    (1000.0, "mbar"),
    (0.068_95, "bar converted from psi twice"),
    (0.01, "bar converted from kPa twice"),
];
/// Ratio by which friction and zeros may change a pressure at rest; the units are further apart.
const TOLERANCE: f64 = 1.3;

/// The runs with a wrong pressure.
pub(crate) fn findings(logs: &Logs) -> Vec<Finding> {
    let pressures = pressures(logs);
    // That of the median of several samples is a third of theirs.
    let zero_bar = ZERO_BAR + FAR / 3.0 * logs.noise_of(Channel::CylinderPressure);
    let is_dead = |bar: f64| bar.abs() <= zero_bar;
    let lifted = |run: usize| {
        let (bar, expected_bar) = pressures[run]?;
        let is_far = expected_bar / TOLERANCE > 2.0 * zero_bar;
        (is_far && !lifting(logs, run).is_empty()).then_some(bar)
    };
    let ratio = |run: usize| pressures[run].map(|(bar, expected_bar)| bar / expected_bar);
    let units = by_run(logs.campaign, ratio, |ratio| unit(ratio).is_some(), in_unit);
    if units.iter().any(|finding| finding.run.is_none()) {
        return units;
    }
    let mut found = by_run(logs.campaign, lifted, is_dead, near_zero);
    found.extend(unexplained(units, &found));
    found
}

/// Cylinder pressure of each run, and that of its weight or its port, bar.
fn pressures(logs: &Logs) -> Vec<Option<(f64, f64)>> {
    let rests = rests(logs);
    let line = logs
        .model
        .map(|_| Line::WEIGHT)
        .or_else(|| Line::through(&rests));
    let of_run = |(at, run): (usize, &Run)| match run.bench {
        Bench::Hitch { .. } => {
            let best = rests.iter().find(|rest| rest.run == at)?.best(&line?);
            Some((best.measured_bar, line?.bar(&best)))
        }
        Bench::Flow { port_pressure_bar } => {
            let pressure = run.channel(Channel::CylinderPressure)?;
            let bar = median_of_several(pressure.iter().copied())?;
            let is_known = port_pressure_bar * (TOLERANCE - 1.0) > ZERO_BAR;
            is_known.then_some((bar, port_pressure_bar))
        }
    };
    logs.runs().iter().enumerate().map(of_run).collect()
}

fn near_zero(bar: f64) -> Finding {
    let seen = format!("The cylinder pressure is {bar:.2} bar while the hitch is lifted.");
    let cure = "Check the sensor, its supply and its column; leave the channel of this run out.";
    let evidence = Evidence::new(bar, ZERO_BAR, "bar");
    Finding::new(Kind::DeadPressure, evidence, seen, cure).of(Channel::CylinderPressure.key())
}

fn in_unit(ratio: f64) -> Finding {
    let name = unit(ratio).unwrap_or("another unit");
    let seen = format!(
        "The cylinder pressure is {ratio:.3} times that of the weight or of the port: it is in {name}, not bar."
    );
    let cure = "State the unit of the column for this run in [run.columns].";
    let evidence = Evidence::new(ratio, (TOLERANCE - 1.0) * ratio, "");
    Finding::new(Kind::PressureUnit, evidence, seen, cure).of(Channel::CylinderPressure.key())
}

/// Name of the unit with about this multiple of a bar.
fn unit(ratio: f64) -> Option<&'static str> {
    let near = |unit: &&(f64, &str)| (1.0 / TOLERANCE..TOLERANCE).contains(&(ratio / unit.0));
    UNITS.iter().find(near).map(|unit| unit.1)
}
