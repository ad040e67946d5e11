//! Figures of merit of a move, evaluated on the true angle, not on the measured one.

use hitch_closed_loop::{ARRIVED_DEG, STEP_S, Sample};
use schemars::JsonSchema;
use serde::Serialize;

use super::ideal_ramp::IdealRamp;
use super::pressure_swing::swing_bar;
use super::scenario::Move;

/// Figures of one move.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct MoveResult {
    /// Start angle, degree.
    pub from_deg: f64,
    /// Set point, degree.
    pub to_deg: f64,
    /// Load, kg.
    pub load_kg: f64,
    /// Oil temperature, C.
    pub oil_temperature_c: f64,
    /// Whether the angle finally stays within 0.5 degree of the set point.
    pub arrived: bool,
    /// Time from the step of the set point until the angle stays within 0.5 degree, s; `null` if it never does.
    #[schemars(with = "Option<f64>")]
    pub time_s: f64,
    /// Shortest time of the plant with edges of a normal manoeuvre, s; `null` if the plant cannot do the move.
    #[schemars(with = "Option<f64>")]
    pub shortest_s: f64,
    /// `time_s / shortest_s`; `null` if either is `null`. Below one if the valve opened or closed more steeply than in a
    /// normal manoeuvre.
    #[schemars(with = "Option<f64>")]
    pub ratio: f64,
    /// Root mean square of the difference from the angle of the ideal manoeuvre at the same time, until both have
    /// arrived, degree.
    pub tracking_error_deg: f64,
    /// Largest overshoot of the set point, degree.
    pub overshoot_deg: f64,
    /// Distance from the set point at the end of the run, degree.
    #[schemars(with = "Option<f64>")]
    pub final_error_deg: f64,
    /// On time of the coils in the minute after `time_s`, s, including the tail of the approach. Zero if it never
    /// arrives.
    pub active_after_s: f64,
    /// Number of coil activations in the minute after `time_s`; zero if it never arrives.
    pub switched_on_after: u32,
    /// Peak-to-peak cylinder pressure during the move relative to the ideal ramp; `null` if there is none.
    #[schemars(with = "Option<f64>")]
    pub pressure_swing_ratio: f64,
}

/// Figures of a set of moves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Summary {
    /// Number of moves.
    pub moves: usize,
    /// Number of moves that arrived.
    pub arrived: usize,
    /// Median time ratio of the moves that arrived; `null` if none did.
    #[schemars(with = "Option<f64>")]
    pub ratio_median: f64,
    /// 95 % quantile of the time ratio of the moves that arrived; `null` if none did.
    #[schemars(with = "Option<f64>")]
    pub ratio_p95: f64,
    /// Median tracking error, degree.
    pub tracking_error_median_deg: f64,
    /// Largest overshoot, degree.
    pub overshoot_max_deg: f64,
    /// Largest final error, degree.
    pub final_error_max_deg: f64,
    /// Longest on time after arrival, s.
    pub active_after_max_s: f64,
    /// Number of coil activations after arrival, of all moves.
    pub switched_on_after: u32,
    /// Largest pressure swing ratio.
    pub pressure_swing_ratio_max: f64,
}

impl MoveResult {
    /// Duration, s; infinite if it never arrived.
    #[must_use]
    pub fn took_s(&self) -> f64 {
        if self.arrived {
            self.time_s
        } else {
            f64::INFINITY
        }
    }
}

/// Figures of a move; `samples` start at the step of the set point.
#[must_use]
pub fn judge(order: &Move, samples: &[Sample], ideal: &IdealRamp) -> MoveResult {
    let way = (order.to_deg - order.from_deg).signum();
    let beyond = |sample: &Sample| (sample.angle_deg - order.to_deg) * way;
    let last_away = samples
        .iter()
        .rposition(|sample| beyond(sample).abs() > ARRIVED_DEG);
    let steps = last_away.map_or(0, |at| at + 1);
    let arrived = steps < samples.len();
    let time_s = if arrived {
        steps as f64 * STEP_S
    } else {
        f64::NAN
    };
    let minute = &samples[steps..(steps + 60_000).min(samples.len())];
    let on = |sample: &&Sample| is_on(sample);
    MoveResult {
        from_deg: order.from_deg,
        to_deg: order.to_deg,
        load_kg: order.load_kg,
        oil_temperature_c: order.oil_temperature_c,
        arrived,
        time_s,
        shortest_s: ideal.time_s,
        ratio: time_s / ideal.time_s,
        tracking_error_deg: tracking_error_deg(order, &samples[..steps], ideal),
        overshoot_deg: samples.iter().map(beyond).fold(0.0, f64::max),
        final_error_deg: samples.last().map_or(f64::NAN, |last| beyond(last).abs()),
        active_after_s: minute.iter().filter(on).count() as f64 * STEP_S,
        switched_on_after: minute
            .windows(2)
            .filter(|pair| !is_on(&pair[0]) && is_on(&pair[1]))
            .count() as u32,
        pressure_swing_ratio: swing_bar(samples.iter().map(|sample| sample.cylinder_pressure_bar))
            / ideal.pressure_swing_bar,
    }
}

/// Root mean square of the difference from the ideal manoeuvre, which stays at the set point after arrival.
fn tracking_error_deg(order: &Move, samples: &[Sample], ideal: &IdealRamp) -> f64 {
    let wanted_deg = ideal
        .angles_deg
        .iter()
        .copied()
        .chain(std::iter::repeat(order.to_deg));
    let driven_deg = samples
        .iter()
        .map(|sample| sample.angle_deg)
        .chain(std::iter::repeat(order.to_deg));
    let steps = samples.len().max(ideal.angles_deg.len()).max(1);
    let both = wanted_deg.zip(driven_deg).take(steps);
    let sum: f64 = both.map(|(wanted, driven)| (wanted - driven).powi(2)).sum();
    (sum / steps as f64).sqrt()
}

fn is_on(sample: &Sample) -> bool {
    sample.outputs.lift_current.0 > 0 || sample.outputs.lower_current.0 > 0
}

impl Summary {
    /// Summarises moves; `None` if there are none.
    #[must_use]
    pub fn of(moves: &[MoveResult]) -> Option<Self> {
        let sorted = |figure: fn(&MoveResult) -> f64| {
            let mut figures: Vec<f64> = moves.iter().map(figure).collect();
            figures.sort_by(f64::total_cmp);
            figures
        };
        // A lift that the plant cannot do has no ratio, although a hitch that started there counts as arrived.
        let mut ratios = sorted(|result| result.ratio);
        ratios.retain(|ratio| ratio.is_finite());
        let largest = |figure: fn(&MoveResult) -> f64| moves.iter().map(figure).fold(0.0, f64::max);
        Some(Self {
            moves: moves.len(),
            arrived: moves.iter().filter(|result| result.arrived).count(),
            ratio_median: quantile(&ratios, 0.5).unwrap_or(f64::NAN),
            ratio_p95: quantile(&ratios, 0.95).unwrap_or(f64::NAN),
            tracking_error_median_deg: quantile(&sorted(|result| result.tracking_error_deg), 0.5)?,
            overshoot_max_deg: largest(|result| result.overshoot_deg),
            final_error_max_deg: largest(|result| result.final_error_deg),
            active_after_max_s: largest(|result| result.active_after_s),
            switched_on_after: moves.iter().map(|result| result.switched_on_after).sum(),
            pressure_swing_ratio_max: largest(|result| result.pressure_swing_ratio),
        })
    }
}

/// Quantile of a sorted list, with linear interpolation.
fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let at = share * (sorted.len().checked_sub(1)?) as f64;
    let (below, above) = (at.floor() as usize, at.ceil() as usize);
    Some(sorted[below] + (sorted[above] - sorted[below]) * (at - at.floor()))
}
