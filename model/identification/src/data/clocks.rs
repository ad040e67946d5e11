//! Clock offsets of a log: each channel against the currents.

use hitch_plant::Channel;
use hitch_plant::simulation::Trace;

/// Prior standard deviation of a clock offset, s: a channel may be one sample of 20 ms out of step (docs/campaigns.md).
pub const OFFSET_PRIOR_S: f64 = 0.008;

/// Largest clock offset, s: slightly more than one sample. Larger delays have another cause.
pub const LARGEST_OFFSET_S: f64 = 0.024;

/// Clock offsets of a campaign.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Clocks {
    /// Offset of each channel against the currents, s, by [`Channel::index`]; positive if stamped late.
    pub offsets_s: [f64; 4],
}

impl Clocks {
    /// Whether any offset exceeds one standard deviation of the prior.
    #[must_use]
    pub fn are_off(&self) -> bool {
        let mut offsets_s = self.offsets_s.iter();
        offsets_s.any(|offset_s| offset_s.abs() > OFFSET_PRIOR_S)
    }

    /// A simulated trace as logged at `time_s` with these clock offsets.
    #[must_use]
    pub fn stamped(&self, time_s: &[f64], trace: &Trace) -> Trace {
        Trace {
            channels: Channel::ALL.map(|channel| self.stamped_channel(channel, time_s, trace)),
            true_angle_deg: trace.true_angle_deg.clone(),
            idle_pressure_bar: trace.idle_pressure_bar,
        }
    }

    /// [`Clocks::stamped`] for one channel.
    #[must_use]
    pub fn stamped_channel(&self, channel: Channel, time_s: &[f64], trace: &Trace) -> Vec<f64> {
        let offset_s = self.offsets_s[channel.index()];
        if offset_s != 0.0 && time_s.len() > 1 {
            later(time_s, trace.channel(channel), offset_s)
        } else {
            trace.channel(channel).to_vec()
        }
    }
}

/// Relative difference of time steps up to which they count as equal.
const EVEN: f64 = 1e-6;

/// A record delayed by `delay_s`, by cubic interpolation (Catmull & Rom): linear interpolation would attenuate a
/// pressure that rings with four samples per period. The result is clamped to the two neighbouring samples, so that the
/// jump of a pump pressure does not overshoot.
fn later(time_s: &[f64], values: &[f64], delay_s: f64) -> Vec<f64> {
    let last = values.len() - 1;
    let step_s = (time_s[last] - time_s[0]) / last as f64;
    let even = |pair: &[f64]| (pair[1] - pair[0] - step_s).abs() <= EVEN * step_s;
    let steps = delay_s / step_s;
    if steps.abs() > last as f64 || !time_s.windows(2).all(even) {
        // The times rise, so the search for each goes on where that for the one before ended.
        let mut passed = 0;
        let value = |now_s: &f64| {
            let at_s = (now_s - delay_s).clamp(time_s[0], time_s[last]);
            passed += time_s[passed..]
                .iter()
                .take_while(|time_s| **time_s <= at_s)
                .count();
            value_after(time_s, values, at_s, passed)
        };
        return time_s.iter().map(value).collect();
    }
    // Nearly all logs are equidistant: each sample then has the same interpolation weights.
    let (shift, share) = (steps.ceil(), steps.ceil() - steps);
    let weights = catmull_rom(share);
    let sample_of_window = 1 + shift as isize;
    let at_edge = |sample: usize| value_at(time_s, values, time_s[sample] - delay_s);
    let first = sample_of_window.clamp(0, last as isize + 1) as usize;
    let skipped = (first as isize - sample_of_window) as usize;
    let mut moved: Vec<f64> = (0..first).map(at_edge).collect();
    let inner = values.get(skipped..).unwrap_or_default().windows(4);
    let inner = inner.map(|around| held([0, 1, 2, 3].map(|k| around[k]), weights));
    moved.extend(inner.take(last + 1 - first));
    moved.extend((moved.len()..=last).map(at_edge));
    moved
}

/// Interpolated value of a record, constant beyond its ends.
fn value_at(time_s: &[f64], values: &[f64], at_s: f64) -> f64 {
    let last = values.len() - 1;
    let at_s = at_s.clamp(time_s[0], time_s[last]);
    let passed = time_s.partition_point(|&time_s| time_s <= at_s);
    value_after(time_s, values, at_s, passed)
}

/// Interpolated value of a record at a time within it, at which `passed` of its samples have passed.
fn value_after(time_s: &[f64], values: &[f64], at_s: f64, passed: usize) -> f64 {
    let last = values.len() - 1;
    let cell = passed.clamp(1, last) - 1;
    let share = (at_s - time_s[cell]) / (time_s[cell + 1] - time_s[cell]);
    let around = [cell.saturating_sub(1), cell, cell + 1, (cell + 2).min(last)];
    held(around.map(|k| values[k]), catmull_rom(share))
}

/// A weighted sum of four points, clamped to the range of the two in the middle.
fn held([a, b, c, d]: [f64; 4], [of_a, of_b, of_c, of_d]: [f64; 4]) -> f64 {
    (of_a * a + of_b * b + of_c * c + of_d * d)
        .max(b.min(c))
        .min(b.max(c))
}

/// Weights of four equidistant points for the value at a share of the way from the second to the third.
fn catmull_rom(share: f64) -> [f64; 4] {
    let (s, s2, s3) = (share, share * share, share * share * share);
    // Slopes at the two middle points: half the difference of their neighbours each.
    let (of_first, of_second) = (0.5 * (s3 - 2.0 * s2 + s), 0.5 * (s3 - s2));
    let (leaving, arriving) = (2.0 * s3 - 3.0 * s2 + 1.0, 3.0 * s2 - 2.0 * s3);
    [
        -of_first,
        leaving - of_second,
        arriving + of_first,
        of_second,
    ]
}

#[cfg(test)]
mod tests {
    use super::{later, value_at};

    /// The fast path for equidistant logs agrees with the general one, also at the ends.
    #[test]
    fn the_fast_path_equals_the_general_one() {
        let time_s: Vec<f64> = (0..40).map(|k| 3.0 + 0.02 * f64::from(k)).collect();
        let values: Vec<f64> = time_s.iter().map(|t| (9.0 * t).sin() + t * t).collect();
        for delay_s in [
            -1.0, -0.79, -0.061, -0.04, -0.013, 0.0, 0.001, 0.02, 0.033, 0.5, 0.779, 0.78, 2.0,
        ] {
            let moved = later(&time_s, &values, delay_s);
            assert_eq!(moved.len(), values.len());
            for (sample, moved) in moved.iter().enumerate() {
                let expected = value_at(&time_s, &values, time_s[sample] - delay_s);
                assert!((moved - expected).abs() < 1e-9, "{delay_s} s, {sample}");
            }
        }
    }

    /// The search along a log with uneven steps finds the cells of a search in the whole log.
    #[test]
    fn uneven_steps_are_searched_in_order() {
        let uneven = |k: u32| 3.0 + 0.02 * f64::from(k) + 0.009 * (7.0 * f64::from(k)).sin();
        let time_s: Vec<f64> = (0..40).map(uneven).collect();
        let values: Vec<f64> = time_s.iter().map(|t| (9.0 * t).sin()).collect();
        for delay_s in [-1.0, -0.061, -0.02, -0.003, 0.0, 0.001, 0.033, 0.5, 2.0] {
            let moved = later(&time_s, &values, delay_s);
            let expected = time_s
                .iter()
                .map(|t| value_at(&time_s, &values, t - delay_s));
            assert_eq!(moved, expected.collect::<Vec<f64>>(), "{delay_s} s");
        }
    }
}
