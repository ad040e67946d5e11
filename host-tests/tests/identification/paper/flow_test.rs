//! The paper's flow test as a campaign: a simulated log of its test bench.
//!
//! Table 5 contains all printed results of the measurement: the begin and the end of the flow. The valve in between is
//! assumed to be that of Table 2, with its threshold shifted and its flow scaled to Table 5. The lift threshold is that
//! of Table 2: the currents were raised in steps of 0.1 A, so "1.1 A" does not contradict the table's 1.126 A, while
//! the lowering valve's "1.25 A" does contradict its 0.999 A.

use hitch_campaign::{Bench, Campaign, Noise, Run};
use hitch_plant::{Channel, Valve};
use rand::{Rng, SeedableRng};
use rand_distr::StandardNormal;
use rand_pcg::Pcg64;

use super::tables::{LOWER_DROP_BAR, saturation_lpm, table_2, table_5, threshold_a};

/// Step of the current, A (section 3.4).
const STEP_A: f64 = 0.1;
/// Highest current, A (section 3.4).
pub const HIGHEST_A: f64 = 3.5;
/// Duration of each current, s; chosen.
const HOLD_S: f64 = 1.0;
/// Time from one current to the next, s; chosen: adjusted by a knob, not by a relay.
const RAMP_S: f64 = 0.2;
/// Sample rate, Hz; chosen.
const SAMPLE_RATE_HZ: f64 = 50.0;
/// Noise of the flow meter, one sigma, l/min; chosen: a gear meter of this size.
const FLOW_SIGMA_LPM: f64 = 0.15;
/// Port pressures of the lift runs, bar; chosen. Two, so that a droop of the compensator would show.
const LIFT_PORTS_BAR: [f64; 2] = [20.0, 70.0];
/// Port pressures of the lowering runs, bar: that of Table 2B and, chosen, a higher one.
const LOWER_PORTS_BAR: [f64; 2] = [LOWER_DROP_BAR, 40.0];
/// Seed of the noise.
const SEED: u64 = 20_200_850;

/// Shift of a valve's threshold from Table 2 to Table 5, A.
pub fn threshold_shift_a(valve: Valve) -> f64 {
    match valve {
        Valve::Lift => 0.0,
        Valve::Lower => table_5(valve).threshold_a - threshold_a(table_2(valve)),
    }
}

/// Relative change of a valve's flow from Table 2 to Table 5.
pub fn flow_scale(valve: Valve) -> f64 {
    table_5(valve).saturation_lpm / saturation_lpm(table_2(valve)) - 1.0
}

/// The flow test of both valves.
pub fn campaign() -> Campaign {
    let lift = LIFT_PORTS_BAR.map(|port_bar| (Valve::Lift, port_bar));
    let lower = LOWER_PORTS_BAR.map(|port_bar| (Valve::Lower, port_bar));
    let mut noise = Noise {
        lift_current_a: None,
        lower_current_a: None,
        ..Noise::default()
    };
    noise.channels[Channel::Flow.index()] = Some(FLOW_SIGMA_LPM);
    let mut random = Pcg64::seed_from_u64(SEED);
    let runs = lift.into_iter().chain(lower);
    let runs = runs.map(|(valve, port_bar)| run(valve, port_bar, &mut random));
    Campaign {
        name: "paper-flow-test".to_owned(),
        description: "Flow test of both valves, from Tables 2 and 5".to_owned(),
        sample_rate_hz: SAMPLE_RATE_HZ,
        synchronous: false,
        noise,
        runs: runs.collect(),
    }
}

fn run(valve: Valve, port_pressure_bar: f64, random: &mut Pcg64) -> Run {
    let steps = (HIGHEST_A / STEP_A).round();
    let samples = ((steps + 1.0) * HOLD_S * SAMPLE_RATE_HZ) as usize;
    let time_s: Vec<f64> = (0..samples)
        .map(|sample| sample as f64 / SAMPLE_RATE_HZ)
        .collect();
    let current_a: Vec<f64> = time_s.iter().map(|time_s| staircase_a(*time_s)).collect();
    let flow_lpm = current_a.iter().map(|current_a| {
        let noise: f64 = random.sample(StandardNormal);
        measured_lpm(valve, *current_a, port_pressure_bar) + FLOW_SIGMA_LPM * noise
    });
    let mut channels = [const { None }; 4];
    channels[Channel::Flow.index()] = Some(flow_lpm.collect());
    let off_a = vec![0.0; samples];
    let (lift_current_a, lower_current_a, name) = match valve {
        Valve::Lift => (current_a, off_a, "lift"),
        Valve::Lower => (off_a, current_a, "lower"),
    };
    Run {
        file: format!("flow_{name}_{port_pressure_bar:03.0}bar.csv"),
        bench: Bench::Flow { port_pressure_bar },
        oil_temperature_c: 40.0,
        oil_temperature_known: true,
        time_s,
        lift_current_a,
        lower_current_a,
        channels,
        oil_temperature_log_c: None,
    }
}

/// Current of the test at a time, A: constant, then raised by a step.
fn staircase_a(time_s: f64) -> f64 {
    let step = (time_s / HOLD_S).floor();
    let ramp = ((time_s - step * HOLD_S) / RAMP_S).min(1.0);
    (STEP_A * (step - 1.0 + ramp)).max(0.0)
}

/// Flow of the measured valve, l/min, positive into the cylinder.
fn measured_lpm(valve: Valve, current_a: f64, port_pressure_bar: f64) -> f64 {
    let at_a = current_a - threshold_shift_a(valve);
    let flow_lpm = (1.0 + flow_scale(valve)) * interpolate(table_2(valve), at_a);
    match valve {
        Valve::Lift => flow_lpm,
        Valve::Lower => -flow_lpm * (port_pressure_bar / LOWER_DROP_BAR).sqrt(),
    }
}

/// Linear interpolation in a table, constant beyond its ends.
fn interpolate(table: &[(f64, f64)], at: f64) -> f64 {
    let segment = table.windows(2).find(|pair| at < pair[1].0);
    match segment {
        Some(&[(from, low), (to, high)]) => {
            low + (high - low) * ((at - from) / (to - from)).max(0.0)
        }
        _ => table.last().map_or(0.0, |(_, flow)| *flow),
    }
}

#[test]
fn the_measured_valve_is_table_5_s() {
    assert!((measured_lpm(Valve::Lift, 3.5, 70.0) - 37.27).abs() < 1e-9);
    assert!((measured_lpm(Valve::Lower, 3.5, 15.0) + 56.74).abs() < 1e-9);
    assert_eq!(measured_lpm(Valve::Lower, 1.25, 15.0), 0.0);
    assert!(measured_lpm(Valve::Lower, 1.26, 15.0) < 0.0);
}

#[test]
fn the_log_is_a_staircase_with_the_noise_it_declares() {
    let campaign = campaign();
    let run = &campaign.runs[0];
    assert_eq!(run.lift_current_a.first(), Some(&0.0));
    assert!((run.lift_current_a.last().unwrap() - 3.5).abs() < 1e-9);
    let still = &run.channel(Channel::Flow).unwrap()[..500];
    let sigma = (still.iter().map(|value| value * value).sum::<f64>() / still.len() as f64).sqrt();
    assert!((sigma / FLOW_SIGMA_LPM - 1.0).abs() < 0.1, "{sigma}");
}
