//! Runs whose pressures are in another unit.

use hitch_campaign::Bench;
use hitch_plant::Channel;

use crate::finding::{Evidence, Finding, Kind};
use crate::logs::Logs;
use crate::rest_pressure::{Line, rests};
use crate::statistics::median;

/// Units as multiples of a bar, and what they are when bar is expected.
const UNITS: [(f64, &str); 6] = [
    (14.504, "psi"),
    (100.0, "kPa"),
    (0.1, "MPa"),
    (1000.0, "mbar"),
    (0.068_95, "bar converted from psi twice"),
    (0.01, "bar converted from kPa twice"),
];
/// Least pressure, bar, of a flow bench whose ratio is known in spite of a sensor's zero.
const LEAST_PORT_BAR: f64 = 4.0;
/// Ratio by which friction and zeros may change a pressure at rest; the units are further apart.
const TOLERANCE: f64 = 1.3;

/// The runs in another unit, with their index.
pub(crate) fn findings(logs: &Logs) -> Vec<Finding> {
    let (rests, line) = rests(logs);
    let line = line.filter(|line| unit(line.slope).is_none() || logs.model.is_none());
    let line = line.or_else(|| {
        logs.model.map(|_| Line {
            zero_bar: 0.0,
            slope: 1.0,
            spread_bar: 0.0,
        })
    });
    let of_rest = rests
        .iter()
        .filter_map(|rest| Some((rest.run, rest.best.measured_bar / line?.bar(&rest.best))));
    let of_port = (0..logs.runs().len()).filter_map(|run| Some((run, port_ratio(logs, run)?)));
    let wrong = of_rest
        .chain(of_port)
        .filter_map(|(run, ratio)| Some((run, ratio, unit(ratio)?)));
    let finding = |(run, ratio, name): (usize, f64, &str)| {
        let seen = format!(
            "The cylinder pressure is {ratio:.3} times that of the weight, by the other runs, or of the port: it is in {name}, not bar."
        );
        let cure = "State the unit of the column for this run in [run.columns].";
        let evidence = Evidence::new(ratio, (TOLERANCE - 1.0) * ratio, "");
        let finding = Finding::new(Kind::PressureUnit, evidence, seen, cure);
        finding
            .in_run(logs.campaign, run)
            .of(Channel::CylinderPressure.key())
    };
    wrong.map(finding).collect()
}

/// Measured pressure of a flow bench by that of its port.
fn port_ratio(logs: &Logs, run: usize) -> Option<f64> {
    let log = &logs.runs()[run];
    let Bench::Flow { port_pressure_bar } = log.bench else {
        return None;
    };
    let pressure = log.channel(Channel::CylinderPressure)?;
    (port_pressure_bar >= LEAST_PORT_BAR)
        .then(|| median(pressure.iter().copied()) / port_pressure_bar)
}

/// Name of the unit with about this multiple of a bar.
fn unit(ratio: f64) -> Option<&'static str> {
    let near = |(factor, _): &&(f64, &str)| {
        (ratio / factor).max(factor / ratio) < TOLERANCE && ratio > 0.0
    };
    UNITS.iter().find(near).map(|unit| unit.1)
}
