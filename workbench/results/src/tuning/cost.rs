//! Cost of a set of moves, and of presses of the button: mean time, with penalties for violated motion limits.

use crate::closed_loop::{MoveResult, PressResult};

/// Limits, slightly stricter than the promised ones.
const OVERSHOOT_DEG: f64 = 0.25;
const FINAL_ERROR_DEG: f64 = 0.25;
const SWING: f64 = 1.4;

/// Upper bound of the time ratio; also the ratio of a move that never arrives.
const SLOWEST: f64 = 5.0;

/// Mean time ratio, plus ten times the excess of the slowest 5 %, plus penalties for violated limits.
#[must_use]
pub fn cost(results: &[MoveResult]) -> f64 {
    let count = results.len().max(1) as f64;
    let mean = |of: &dyn Fn(&MoveResult) -> f64| results.iter().map(of).sum::<f64>() / count;
    let beyond = |value: f64, bar: f64| (value - bar).max(0.0);
    let ratio = |result: &MoveResult| {
        let known = Some(result.ratio).filter(|ratio| ratio.is_finite());
        known.unwrap_or(SLOWEST)
    };
    let slow = mean(&|result| beyond(ratio(result), 1.35));
    let overshoot = mean(&|result| beyond(result.overshoot_deg, OVERSHOOT_DEG));
    let error = mean(&|result| beyond(result.final_error_deg, FINAL_ERROR_DEG));
    let swing = mean(&|result| beyond(result.pressure_swing_ratio, SWING));
    let restarts = mean(&|result| f64::from(result.switched_on_after));
    mean(&|result| ratio(result).min(SLOWEST))
        + 10.0 * slow.min(5.0)
        + 100.0 * overshoot
        + 100.0 * error
        + 10.0 * swing
        + 10.0 * restarts
}

/// Limits of the button's speed as shares of it, stricter than the promised 5 %, and than what a person beside the
/// implement notices.
const SPEED_ERROR: f64 = 0.04;
const SPEED_OVERSHOOT: f64 = 0.1;
/// Usual sum of the delays from press to motion and from release to rest, s, and the one of a press that fails.
const USUAL_DELAY_S: f64 = 0.5;
const LONGEST_DELAY_S: f64 = 2.5;

/// Mean of start and stop delay over their usual sum, plus penalties for errors and overshoot of the speed. Zero without
/// presses.
#[must_use]
pub fn press_cost(results: &[PressResult]) -> f64 {
    let count = results.len().max(1) as f64;
    let mean = |of: &dyn Fn(&PressResult) -> f64| results.iter().map(of).sum::<f64>() / count;
    let delay = mean(&|result| {
        let delay_s = result.start_delay_s + result.stop_delay_s;
        let known = Some(delay_s).filter(|delay_s| delay_s.is_finite());
        known.unwrap_or(LONGEST_DELAY_S).min(LONGEST_DELAY_S) / USUAL_DELAY_S
    });
    let beyond = |value: f64, bar: f64| (value - bar).max(0.0);
    let error = mean(&|result| beyond((result.speed_ratio - 1.0).abs(), SPEED_ERROR));
    let overshoot = mean(&|result| beyond(result.speed_overshoot, SPEED_OVERSHOOT));
    delay + 100.0 * error + 20.0 * overshoot
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_late_a_wrong_and_an_overshooting_press_cost_more() {
        let good = PressResult {
            rate_deg_per_s: 3.0,
            load_kg: 150.0,
            oil_temperature_c: 40.0,
            speed_ratio: 1.01,
            start_delay_s: 0.3,
            stop_delay_s: 0.2,
            speed_overshoot: 0.05,
            travel_after_deg: 0.5,
        };
        assert!((press_cost(&[good]) - 1.0).abs() < 1e-12);
        assert_eq!(press_cost(&[]), 0.0);
        let worse = [
            PressResult {
                start_delay_s: 0.5,
                ..good
            },
            PressResult {
                start_delay_s: f64::NAN,
                ..good
            },
            PressResult {
                stop_delay_s: 0.4,
                ..good
            },
            PressResult {
                speed_ratio: 0.9,
                ..good
            },
            PressResult {
                speed_overshoot: 0.33,
                ..good
            },
        ];
        for result in worse {
            assert!(
                press_cost(&[result]) > 1.3,
                "{result:?}: {}",
                press_cost(&[result])
            );
        }
    }

    const GOOD: MoveResult = MoveResult {
        from_deg: 80.0,
        to_deg: 100.0,
        load_kg: 150.0,
        oil_temperature_c: 40.0,
        arrived: true,
        time_s: 0.5,
        shortest_s: 0.45,
        ratio: 1.1,
        tracking_error_deg: 0.0,
        overshoot_deg: 0.1,
        final_error_deg: 0.1,
        active_after_s: 0.0,
        switched_on_after: 0,
        pressure_swing_ratio: 1.0,
    };

    #[test]
    fn a_move_inside_the_bars_costs_its_time_and_every_excess_costs_more() {
        assert!((cost(&[GOOD]) - 1.1).abs() < 1e-12);
        let worse = [
            MoveResult { ratio: 1.5, ..GOOD },
            MoveResult {
                arrived: false,
                time_s: f64::NAN,
                ratio: f64::NAN,
                ..GOOD
            },
            MoveResult {
                overshoot_deg: 0.3,
                ..GOOD
            },
            MoveResult {
                final_error_deg: 0.3,
                ..GOOD
            },
            MoveResult {
                pressure_swing_ratio: 1.5,
                ..GOOD
            },
            MoveResult {
                switched_on_after: 1,
                ..GOOD
            },
        ];
        for result in worse {
            assert!(cost(&[result]) > 1.5, "{result:?}: {}", cost(&[result]));
        }
    }
}
