//! Noise of instruments and currents: as declared, or estimated from their records.

use hitch_campaign::Campaign;
use hitch_plant::{Channel, Currents};

/// Standard deviation of the noise of a record, in its unit, from the median of its second differences.
///
/// Second differences remove level and drift, the median ignores the manoeuvres; the variance of `1 - 2 + 1` is six.
/// The model's residuals are not used, as they contain the missing effect. `None` for fewer than ten samples.
#[must_use]
pub fn from_second_differences(record: &[f64]) -> Option<f64> {
    let mut bends: Vec<f64> = record
        .windows(3)
        .map(|w| (w[0] - 2.0 * w[1] + w[2]).abs())
        .filter(|bend| bend.is_finite())
        .collect();
    if bends.len() < 10 {
        return None;
    }
    let middle = bends.len() / 2;
    let (_, median, _) = bends.select_nth_unstable_by(middle, f64::total_cmp);
    const MEDIAN_OF_ABSOLUTE_NORMAL: f64 = 0.674_489_75;
    Some(*median / (MEDIAN_OF_ABSOLUTE_NORMAL * 6.0_f64.sqrt()))
}

/// Smallest accepted noise of each channel, in its unit, by [`Channel::index`]: a logger's last digit.
const NOISE_FLOOR: [f64; 4] = [0.01, 0.01, 0.01, 0.005];

/// Smallest accepted noise of a current, A.
const CURRENT_NOISE_FLOOR_A: f64 = 1e-4;

/// Declared noise of a channel, else the median of the estimates from its runs; NaN without the channel.
pub(crate) fn channel_noise(campaign: &Campaign, channel: Channel) -> f64 {
    let records = || campaign.runs.iter().filter_map(|run| run.channel(channel));
    if records().next().is_none() {
        return f64::NAN;
    }
    let sigma = campaign
        .noise
        .of(channel)
        .or_else(|| median(records().filter_map(from_second_differences).collect()))
        .unwrap_or(0.0);
    sigma.max(NOISE_FLOOR[channel.index()])
}

pub(crate) fn current_noise(campaign: &Campaign) -> Currents {
    let estimate = |records: Vec<&[f64]>| {
        median(
            records
                .into_iter()
                .filter_map(from_second_differences)
                .collect(),
        )
        .unwrap_or(0.0)
    };
    let lift_a = campaign.noise.lift_current_a.unwrap_or_else(|| {
        estimate(
            campaign
                .runs
                .iter()
                .map(|run| run.lift_current_a.as_slice())
                .collect(),
        )
    });
    let lower_a = campaign.noise.lower_current_a.unwrap_or_else(|| {
        estimate(
            campaign
                .runs
                .iter()
                .map(|run| run.lower_current_a.as_slice())
                .collect(),
        )
    });
    Currents {
        lift_a: lift_a.max(CURRENT_NOISE_FLOOR_A),
        lower_a: lower_a.max(CURRENT_NOISE_FLOOR_A),
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
