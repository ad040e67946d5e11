//! Selection of an additional sensor that shows the difference of two effects.

use hitch_plant::{Channel, Model, Plant, units};

use crate::design::plan::{Manoeuvre, RunPlan};
use crate::design::separation::{Pair, TestBench};
use crate::parallel;

/// An instrument for a rig, with its usual noise, one sigma, in its unit.
struct Instrument {
    name: &'static str,
    channel: Option<Channel>,
    sigma: f64,
    value: fn(&Plant) -> f64,
}

/// Every measurable quantity of the plant.
static INSTRUMENTS: [Instrument; 6] = [
    Instrument {
        name: "a pressure sensor at the pump",
        channel: Some(Channel::PumpPressure),
        sigma: 0.1,
        value: |plant| plant.reading().pump_pressure_bar,
    },
    Instrument {
        name: "a pressure sensor at the cylinder",
        channel: Some(Channel::CylinderPressure),
        sigma: 0.1,
        value: |plant| plant.reading().cylinder_pressure_bar,
    },
    Instrument {
        name: "a flow meter in the cylinder line",
        channel: Some(Channel::Flow),
        sigma: 0.2,
        value: |plant| plant.reading().flow_lpm,
    },
    Instrument {
        name: "a rocker angle sensor",
        channel: Some(Channel::RockerAngle),
        sigma: 0.05,
        value: |plant| plant.reading().rocker_angle_deg,
    },
    Instrument {
        name: "a position sensor on the piston rod (0.1 mm)",
        channel: None,
        sigma: 0.1,
        value: |plant| 1e3 * plant.state().piston_m,
    },
    Instrument {
        name: "a measuring glass at the leak line (0.05 l/min)",
        channel: None,
        sigma: 0.05,
        value: |plant| units::lpm_from_m3_s(plant.flows().leakage_m3_s),
    },
];

/// The instrument with the largest difference between the effects of a pair that the campaign lacks; `None` if no
/// difference exceeds the instrument's noise.
#[must_use]
pub fn additional_instrument(
    bench: &TestBench,
    manoeuvres: &[Manoeuvre],
    pair: Pair,
) -> Option<&'static str> {
    let [named, other] = pair.rivals().map(|rival| bench.with(rival));
    let runs: Vec<&RunPlan> = manoeuvres.iter().flat_map(|m| &m.runs).collect();
    let largest: Vec<[f64; INSTRUMENTS.len()]> = parallel::map(&runs, |run| {
        differences(run, &named, &other, bench.rate_hz())
    });
    let channels = bench.channels();
    INSTRUMENTS
        .iter()
        .enumerate()
        .filter(|(_, instrument)| instrument.channel.is_none_or(|c| !channels[c.index()]))
        .map(|(index, instrument)| {
            let worst = largest.iter().map(|run| run[index]).fold(0.0, f64::max);
            (worst, instrument.name)
        })
        .filter(|(worst, _)| *worst > 1.0)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, name)| name)
}

/// Root mean square over a run of the difference of two models in each instrument, in its sigmas.
fn differences(
    run: &RunPlan,
    named: &Model,
    other: &Model,
    rate_hz: f64,
) -> [f64; INSTRUMENTS.len()] {
    let time_s = run.time_s(rate_hz);
    let start = run.currents(0.0);
    let plant = |model| Plant::new(model, run.rig(model), run.oil_temperature_c, start);
    let (mut a, mut b) = (plant(named), plant(other));
    let mut squares = [0.0; INSTRUMENTS.len()];
    for pair in time_s.windows(2) {
        let currents = run.currents(pair[1]);
        a.step(currents, pair[1] - pair[0]);
        b.step(currents, pair[1] - pair[0]);
        for (square, instrument) in squares.iter_mut().zip(&INSTRUMENTS) {
            let difference = ((instrument.value)(&a) - (instrument.value)(&b)) / instrument.sigma;
            if difference.is_finite() {
                *square += difference * difference;
            }
        }
    }
    squares.map(|square| (square / time_s.len() as f64).sqrt())
}
