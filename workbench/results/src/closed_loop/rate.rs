//! Rate control: the external button is held, and released.

use hitch_closed_loop::{ClosedLoop, STEP_S};
use hitch_plant::Model;
use hitch_quantities::units::MilliDegreePerSecond;
use hitch_quantities::{Inputs, ValidCalibration};
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use super::scenario::middle_and_room_deg;

/// Requested speeds as shares of the fastest one of the calibration.
const SHARES: [f64; 3] = [0.2, 0.5, 1.0];
/// Longest and shortest time for which the button is held, s.
const HELD_S: f64 = 3.0;
const SHORTEST_S: f64 = 0.1;
/// The controller ends a press when the rest of its longest travel is what the hitch travels in this time, s.
const STOP_S: f64 = 0.15;
/// Share of the remaining travel that a press takes at the requested speed: the controller does not end it.
const TRAVEL_SHARE: f64 = 0.9;
/// Time after the release, s.
const AFTER_S: f64 = 3.0;
/// Time before the button is pressed, in which it is seen released, ms.
const RELEASED_MS: usize = 100;
/// Speeds are means over this time, ms: longer than the period of the hitch on its oil.
const MEAN_MS: usize = 100;
/// At rest, the angle stays within this distance, degree.
const AT_REST_DEG: f64 = 0.05;
/// Seed of the noise in the first press.
const SEED: u64 = 0x5eed_0002;

/// One press of the button.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Press {
    /// Requested speed of the rocker, degree/s; positive lifts.
    pub rate_deg_per_s: f64,
    /// Load at the hitch point, kg.
    pub load_kg: f64,
    /// Oil temperature, C.
    pub oil_temperature_c: f64,
    /// Angle at which the button is pressed, degree.
    pub from_deg: f64,
    /// Time for which it is held, s.
    pub held_s: f64,
}

/// Figures of one press, from the true angle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct PressResult {
    /// Requested speed of the rocker, degree/s; positive lifts.
    pub rate_deg_per_s: f64,
    /// Load, kg.
    pub load_kg: f64,
    /// Oil temperature, C.
    pub oil_temperature_c: f64,
    /// Steady speed over the requested one: mean of the second half of the press.
    pub speed_ratio: f64,
    /// Time from the press until half of the requested speed, s; `null` if it is never reached.
    #[schemars(with = "Option<f64>")]
    pub start_delay_s: f64,
    /// Time from the release until the hitch is at rest, s; `null` if it is not at rest after three seconds.
    #[schemars(with = "Option<f64>")]
    pub stop_delay_s: f64,
    /// Largest speed beyond the requested one, as a share of it.
    pub speed_overshoot: f64,
    /// Travel after the release, degree.
    pub travel_after_deg: f64,
}

/// Figures of a set of presses: the worst of each.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct PressSummary {
    /// Number of presses.
    pub presses: usize,
    /// Largest error of the steady speed, as a share of the requested one.
    pub speed_error_max: f64,
    /// Largest speed beyond the requested one, as a share of it.
    pub speed_overshoot_max: f64,
    /// Latest start, s; `null` if a press never reaches half of its speed.
    #[schemars(with = "Option<f64>")]
    pub start_delay_max_s: f64,
    /// Latest stop, s; `null` if a hitch is not at rest after three seconds.
    #[schemars(with = "Option<f64>")]
    pub stop_delay_max_s: f64,
}

impl PressSummary {
    /// Summarises presses; `None` if there are none.
    #[must_use]
    pub fn of(presses: &[PressResult]) -> Option<Self> {
        let largest = |of: fn(&PressResult) -> f64| presses.iter().map(of).fold(0.0, larger);
        (!presses.is_empty()).then(|| Self {
            presses: presses.len(),
            speed_error_max: largest(|press| (press.speed_ratio - 1.0).abs()),
            speed_overshoot_max: largest(|press| press.speed_overshoot),
            start_delay_max_s: largest(|press| press.start_delay_s),
            stop_delay_max_s: largest(|press| press.stop_delay_s),
        })
    }
}

/// The larger one; NaN if one of them is.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else {
        a.max(b)
    }
}

/// The course of a press.
#[derive(Debug, Clone)]
pub struct PressTrace {
    /// The press.
    pub press: Press,
    /// True angle in each millisecond from the press on, degree.
    pub angles_deg: Vec<f64>,
}

impl PressTrace {
    /// Time, s, and speed of the rocker, degree/s, as means over 100 ms, every so many milliseconds.
    #[must_use]
    pub fn speeds_deg_per_s(&self, every_ms: usize) -> (Vec<f64>, Vec<f64>) {
        let means = self.angles_deg.windows(MEAN_MS + 1).enumerate();
        let means = means.step_by(every_ms.max(1));
        means
            .map(|(first, window)| {
                let middle_s = (first + MEAN_MS / 2) as f64 * STEP_S;
                let speed = (window[MEAN_MS] - window[0]) / (MEAN_MS as f64 * STEP_S);
                (middle_s, speed)
            })
            .unzip()
    }
}

/// A set of presses.
#[derive(Debug, Clone)]
pub struct PressRun {
    /// Figures of each press, in the order of the presses.
    pub results: Vec<PressResult>,
    /// Figures of all.
    pub summary: PressSummary,
    /// Course of each press.
    pub traces: Vec<PressTrace>,
}

/// The presses of the scenario: both directions, about the middle of the travel.
#[must_use]
pub fn presses(
    model: &Model,
    calibration: &ValidCalibration,
    loads_kg: Option<&[f64]>,
    oil_temperatures_c: &[f64],
) -> Vec<Press> {
    let fastest_deg_per_s = f64::from(calibration.rate.rate_limit.0) * 1e-3;
    let longest_deg = f64::from(calibration.rate.longest_travel.0) * 1e-3;
    let (middle_deg, room_deg) = middle_and_room_deg(model);
    let usual_kg = model.usual_loads_kg();
    let mut presses = Vec::new();
    for &load_kg in loads_kg.unwrap_or(&usual_kg) {
        for &oil_temperature_c in oil_temperatures_c {
            for share in SHARES {
                let speed = share * fastest_deg_per_s;
                let longest_s = TRAVEL_SHARE * (longest_deg / speed - STOP_S);
                let held_s = HELD_S.min(room_deg / speed).min(longest_s).max(SHORTEST_S);
                presses.extend([speed, -speed].map(|rate_deg_per_s| Press {
                    rate_deg_per_s,
                    load_kg,
                    oil_temperature_c,
                    from_deg: middle_deg - 0.5 * rate_deg_per_s * held_s,
                    held_s,
                }));
            }
        }
    }
    presses
}

/// Drives presses, on all cores; `None` if there are none.
#[must_use]
pub fn run_presses(
    model: &Model,
    calibration: &ValidCalibration,
    presses: &[Press],
) -> Option<PressRun> {
    let driven: Vec<(PressResult, PressTrace)> = presses
        .par_iter()
        .enumerate()
        .map(|(index, press)| {
            let angles_deg = angles_deg(model, calibration, press, SEED + index as u64);
            let result = judge(press, &angles_deg);
            let press = *press;
            (result, PressTrace { press, angles_deg })
        })
        .collect();
    let (results, traces): (Vec<_>, Vec<_>) = driven.into_iter().unzip();
    Some(PressRun {
        summary: PressSummary::of(&results)?,
        results,
        traces,
    })
}

/// The true angle in each millisecond from the press on.
fn angles_deg(model: &Model, calibration: &ValidCalibration, press: &Press, seed: u64) -> Vec<f64> {
    let mut closed_loop = ClosedLoop::new(
        model,
        calibration,
        press.load_kg,
        press.oil_temperature_c,
        press.from_deg,
        seed,
    );
    let mut after = |steps: usize, rate_deg_per_s: Option<f64>| -> Vec<f64> {
        let jog = rate_deg_per_s.map(|rate| MilliDegreePerSecond((rate * 1e3).round() as i32));
        let tell = |inputs: &mut Inputs| inputs.jog = jog;
        // The hitch does not pass the lever: it is not captured.
        let end_deg = press.from_deg + press.rate_deg_per_s * press.held_s;
        let lever_deg = press.from_deg.min(end_deg) - 3.0;
        (0..steps)
            .map(|_| closed_loop.step_with(lever_deg, tell, |_, _| {}).angle_deg)
            .collect()
    };
    after(RELEASED_MS, None);
    let mut angles_deg = after(steps(press.held_s), Some(press.rate_deg_per_s));
    angles_deg.extend(after(steps(AFTER_S), None));
    angles_deg
}

fn steps(time_s: f64) -> usize {
    (time_s / STEP_S).round() as usize
}

/// Figures of a press; `angles_deg` start at the press.
fn judge(press: &Press, angles_deg: &[f64]) -> PressResult {
    let held = steps(press.held_s);
    // Share of the requested speed, in the time before each step.
    let mean_s = MEAN_MS as f64 * STEP_S;
    let shares: Vec<f64> = angles_deg
        .windows(MEAN_MS + 1)
        .map(|window| (window[MEAN_MS] - window[0]) / mean_s / press.rate_deg_per_s)
        .collect();
    let travel_deg = angles_deg[held - 1] - angles_deg[held / 2];
    let steady_s = (held - 1 - held / 2) as f64 * STEP_S;
    // The middle of a mean is its time.
    let started = shares.iter().position(|&share| share >= 0.5);
    let end_deg = angles_deg[angles_deg.len() - 1];
    let moves = |angle_deg: &f64| (angle_deg - end_deg).abs() > AT_REST_DEG;
    let last_moving = angles_deg.iter().rposition(moves).unwrap_or(0);
    let tail = &angles_deg[angles_deg.len() - MEAN_MS..];
    let is_at_rest = !tail.iter().any(moves);
    PressResult {
        rate_deg_per_s: press.rate_deg_per_s,
        load_kg: press.load_kg,
        oil_temperature_c: press.oil_temperature_c,
        speed_ratio: travel_deg / steady_s / press.rate_deg_per_s,
        start_delay_s: started.map_or(f64::NAN, |at| (at + MEAN_MS / 2) as f64 * STEP_S),
        stop_delay_s: if is_at_rest {
            (last_moving + 1).saturating_sub(held) as f64 * STEP_S
        } else {
            f64::NAN
        },
        speed_overshoot: shares.iter().copied().fold(1.0, f64::max) - 1.0,
        travel_after_deg: (end_deg - angles_deg[held - 1]).abs(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_of_a_ramp_are_those_of_its_shape() {
        // 10 degrees/s after a dead time of 0.2 s; it stops 0.1 s after the release.
        let press = Press {
            rate_deg_per_s: -10.0,
            load_kg: 150.0,
            oil_temperature_c: 40.0,
            from_deg: 90.0,
            held_s: 2.0,
        };
        let angles_deg: Vec<f64> = (0..5_000)
            .map(|ms| 90.0 - 10.0 * (f64::from(ms.clamp(200, 2_100)) - 200.0) * 1e-3)
            .collect();
        let result = judge(&press, &angles_deg);
        assert!((result.speed_ratio - 1.0).abs() < 1e-9, "{result:?}");
        assert!((result.start_delay_s - 0.2).abs() < 0.002, "{result:?}");
        assert!((result.stop_delay_s - 0.095).abs() < 0.002, "{result:?}");
        assert!((result.travel_after_deg - 1.01).abs() < 0.02, "{result:?}");
        assert!(result.speed_overshoot < 1e-9, "{result:?}");
    }
}
