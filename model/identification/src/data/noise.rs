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

/// Declared noise of a channel, else the median of the estimates from its runs; NaN without the channel.
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
    sigma.max(NOISE_FLOOR[channel.index()])
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
