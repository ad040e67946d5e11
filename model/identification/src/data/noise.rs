//! Noise of instruments and currents: as declared, or estimated from their records.

use hitch_campaign::{Campaign, Run};
use hitch_plant::{Channel, Currents};

/// Standard deviation of the noise of a record, in its unit, from the median of its second differences.
///
/// Each sample is compared with the line between its neighbours, which removes level and drift; the median ignores the
/// manoeuvres. Neighbours are the next measured samples, however many rows of the log are between them: a slow channel in
/// a fast log has its own rate. The model's residuals are not used, as they contain the missing effect. `None` for fewer
/// than ten samples.
#[must_use]
pub fn from_second_differences(time_s: &[f64], record: &[f64]) -> Option<f64> {
    let rows = time_s.iter().zip(record);
    let measured: Vec<(f64, f64)> = rows
        .filter(|(_, value)| value.is_finite())
        .map(|(time_s, value)| (*time_s, *value))
        .collect();
    let mut bends: Vec<f64> = measured
        .windows(3)
        .map(|w| bend(w[0], w[1], w[2]))
        .collect();
    if bends.len() < 10 {
        return None;
    }
    let middle = bends.len() / 2;
    let (_, median, _) = bends.select_nth_unstable_by(middle, f64::total_cmp);
    const MEDIAN_OF_ABSOLUTE_NORMAL: f64 = 0.674_489_75;
    Some(*median / MEDIAN_OF_ABSOLUTE_NORMAL)
}

/// The step between the values that a record can have, in its unit; zero if it has none.
///
/// Different values of a rounded record are at least this step apart, and it returns to the two values of the closest pair.
/// A record with more digits passes each value once, also on a steady ramp, whose samples are equally far apart.
#[must_use]
pub fn resolution(record: &[f64]) -> f64 {
    /// Part of a step that rounding and the conversion of units may change.
    const ROUNDING: f64 = 1e-6;
    let mut values: Vec<f64> = record.iter().copied().filter(|v| v.is_finite()).collect();
    values.sort_unstable_by(f64::total_cmp);
    let levels: Vec<&[f64]> = values.chunk_by(|a, b| a == b).collect();
    let step = |pair: &[&[f64]]| pair[1][0] - pair[0][0];
    let closest = levels.windows(2).map(step).fold(f64::INFINITY, f64::min);
    let returns = |pair: &&[&[f64]]| pair.iter().all(|level| level.len() > 1);
    let held = levels.windows(2).filter(returns).map(step);
    let held = held.fold(f64::INFINITY, f64::min);
    let is_step = held.is_finite() && held <= closest * (1.0 + ROUNDING);
    if is_step { held } else { 0.0 }
}

/// Standard deviation of an error that is uniform within one step.
fn rounding_sigma(step: f64) -> f64 {
    step / 12.0_f64.sqrt()
}

/// Distance of a sample, given by time and value, from the line between its neighbours, in standard deviations of unit
/// noise.
fn bend(before: (f64, f64), sample: (f64, f64), after: (f64, f64)) -> f64 {
    let share = (sample.0 - before.0) / (after.0 - before.0);
    let line = (1.0 - share) * before.1 + share * after.1;
    let variance = 1.0 + share * share + (1.0 - share) * (1.0 - share);
    (sample.1 - line).abs() / variance.sqrt()
}

/// Smallest accepted noise of each channel, in its unit, by [`Channel::index`]: a logger's last digit.
const NOISE_FLOOR: [f64; 4] = [0.01, 0.01, 0.01, 0.005];

/// Smallest accepted noise of a current, A.
const CURRENT_NOISE_FLOOR_A: f64 = 1e-4;

/// Declared noise of a channel, else the median of the estimates from its runs, and at least that of rounding to the
/// record's resolution; NaN without the channel.
pub(crate) fn channel_noise(campaign: &Campaign, channel: Channel) -> f64 {
    let records = || {
        let runs = campaign.runs.iter();
        runs.filter_map(|run| Some((run.time_s.as_slice(), run.channel(channel)?)))
    };
    if records().next().is_none() {
        return f64::NAN;
    }
    let sigma = campaign
        .noise
        .of(channel)
        .or_else(|| {
            let of = |(time_s, record)| from_second_differences(time_s, record);
            median(records().filter_map(of).collect())
        })
        .unwrap_or(0.0);
    let of_steps = records().map(|(_, record)| rounding_sigma(resolution(record)));
    let rounded = median(of_steps.collect()).unwrap_or(0.0);
    sigma.max(rounded).max(NOISE_FLOOR[channel.index()])
}

pub(crate) fn current_noise(campaign: &Campaign) -> Currents {
    let estimate = |record: fn(&Run) -> &[f64]| {
        let runs = campaign.runs.iter();
        let of = |run: &Run| from_second_differences(&run.time_s, record(run));
        let estimated_a = median(runs.filter_map(of).collect()).unwrap_or(0.0);
        estimated_a.max(CURRENT_NOISE_FLOOR_A)
    };
    let declared = &campaign.noise;
    let at_least = |declared_a: f64| declared_a.max(CURRENT_NOISE_FLOOR_A);
    Currents {
        lift_a: declared
            .lift_current_a
            .map_or_else(|| estimate(|run| &run.lift_current_a), at_least),
        lower_a: declared
            .lower_current_a
            .map_or_else(|| estimate(|run| &run.lower_current_a), at_least),
    }
}

/// Half a second, samples.
pub(crate) fn persistence_block(campaign: &Campaign) -> usize {
    ((0.5 * campaign.sample_rate_hz).round() as usize).max(2)
}

/// Ratio of the variance of the currents' noise averaged over half a second to that of white noise.
///
/// Part of a logger's noise is slow; the variance of block means on plateaus of the current shows how much.
pub(crate) fn current_persistence(campaign: &Campaign, sigma: Currents) -> f64 {
    let block = persistence_block(campaign);
    let (mut ratio_sum, mut blocks) = (0.0, 0.0);
    for run in &campaign.runs {
        for (record, sigma_a) in [
            (&run.lift_current_a, sigma.lift_a),
            (&run.lower_current_a, sigma.lower_a),
        ] {
            for plateau in plateaus(record, sigma_a, 4 * block) {
                let mean = plateau.iter().sum::<f64>() / plateau.len() as f64;
                for part in plateau.chunks_exact(block) {
                    let part_mean = part.iter().sum::<f64>() / block as f64;
                    ratio_sum += (part_mean - mean).powi(2) * block as f64 / (sigma_a * sigma_a);
                    blocks += 1.0;
                }
                blocks -= 1.0;
            }
        }
    }
    if blocks < 20.0 {
        return 1.0;
    }
    (ratio_sum / blocks).max(1.0)
}

/// Stretches of at least `shortest` samples over which a current is constant and well above zero.
fn plateaus(record: &[f64], sigma_a: f64, shortest: usize) -> Vec<&[f64]> {
    let mut found = Vec::new();
    let mut start = 0;
    for end in 1..=record.len() {
        let level = record[start..end.min(start + 10)].iter().sum::<f64>()
            / (end.min(start + 10) - start) as f64;
        let leaves = end == record.len() || (record[end] - level).abs() > 5.0 * sigma_a;
        if leaves {
            if end - start >= shortest && level > 20.0 * sigma_a {
                found.push(&record[start..end]);
            }
            start = end;
        }
    }
    found
}

pub(crate) fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sine of this amplitude over 1 000 samples, rounded to a step.
    fn wave(amplitude: f64, step: f64) -> Vec<f64> {
        let of = |i: u32| amplitude * (f64::from(i) * 0.0063).sin();
        (0..1_000).map(|i| (of(i) / step).round() * step).collect()
    }

    #[test]
    fn a_rounded_record_has_the_noise_of_its_rounding() {
        for step in [1.0, 0.02] {
            let got = resolution(&wave(30.0 * step, step));
            assert!((got - step).abs() < 1e-9, "{got}");
        }
        // A uniform error of one degree: the variance is the integral of x^2 from -1/2 to 1/2.
        assert!((rounding_sigma(1.0).powi(2) - 1.0 / 12.0).abs() < 1e-12);
        let rounded = wave(30.0, 1.0);
        let errors = (0..1_000).map(|i| 30.0 * (f64::from(i) * 0.0063).sin() - rounded[i as usize]);
        let variance = errors.map(|error| error * error).sum::<f64>() / 1_000.0;
        assert!((variance * 12.0 - 1.0).abs() < 0.1, "{variance}");
    }

    #[test]
    fn equal_steps_of_a_ramp_are_no_resolution() {
        let ramp = |i: i32| f64::from(i.clamp(100, 300)) * 0.0217;
        let held: Vec<f64> = (0..400).map(ramp).collect();
        assert_eq!(resolution(&held), 0.0);
        assert_eq!(resolution(&[]), 0.0);
        assert_eq!(resolution(&[3.0; 20]), 0.0);
    }
}
