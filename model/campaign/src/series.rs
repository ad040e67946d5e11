//! The received samples of one signal.

use crate::run_columns::{LIFT, LOWER};

/// Part of the steps that rise in a column of times: one that does not rise everywhere is refused later, with its line.
const RISES: f64 = 0.9;
/// Samples in the order of reception.
#[derive(Debug, Clone, Default)]
pub struct Series {
    /// Times, s.
    pub times_s: Vec<f64>,
    /// Values; NaN where the sender has no valid one.
    pub values: Vec<f64>,
    /// Positions in the log.
    pub bytes: Vec<usize>,
}

/// The median step of times, s; infinite for a single one.
pub fn median_step_s(times_s: &[f64]) -> f64 {
    let mut steps_s: Vec<f64> = times_s.windows(2).map(|two| two[1] - two[0]).collect();
    steps_s.sort_by(f64::total_cmp);
    let middle = steps_s.get(steps_s.len() / 2);
    middle.copied().unwrap_or(f64::INFINITY)
}

/// Whether values rise from sample to sample, apart from a few faults; NaN is skipped.
pub fn rises(values: &[f64]) -> bool {
    let known: Vec<f64> = values
        .iter()
        .copied()
        .filter(|value| value.is_finite())
        .collect();
    let steps = known.len().saturating_sub(1);
    let up = known.windows(2).filter(|pair| pair[1] > pair[0]).count();
    steps > 0 && up as f64 >= RISES * steps as f64
}

impl Series {
    /// The samples up to the last one that is not later than `end_s`.
    pub fn until(&self, end_s: f64) -> Self {
        let last = self.times_s.iter().rposition(|time_s| *time_s <= end_s);
        let count = last.map_or(0, |last| last + 1);
        Self {
            times_s: self.times_s[..count].to_vec(),
            values: self.values[..count].to_vec(),
            bytes: self.bytes[..count].to_vec(),
        }
    }

    /// The samples of these rows.
    pub fn rows(&self, rows: impl IntoIterator<Item = usize>) -> Self {
        let mut samples = Self::default();
        for row in rows {
            samples.times_s.push(self.times_s[row]);
            samples.values.push(self.values[row]);
            samples.bytes.push(self.bytes[row]);
        }
        samples
    }

    /// Adds a sample; duplicates are merged.
    pub fn push(&mut self, time_s: f64, value: f64, byte: usize) {
        if self.times_s.last() == Some(&time_s) && self.values.last() == Some(&value) {
            return;
        }
        self.times_s.push(time_s);
        self.values.push(value);
        self.bytes.push(byte);
    }

    /// The measurements at `times_s`, which rise. Each sample belongs to its nearest time, if it is within `within_s`, and is
    /// moved there with the slope between its neighbours; NaN at a time without a sample of its own.
    ///
    /// An interpolated value would be a mean of two samples, with less noise than the instrument has, and samples of a slow
    /// channel would be counted several times. The slope adds at most 6 % to the noise.
    pub fn measured_at(&self, times_s: &[f64], within_s: f64) -> Vec<f64> {
        let mut values = vec![f64::NAN; times_s.len()];
        // The sample that was used last, and its row.
        let mut last: Option<(usize, usize)> = None;
        for (row, &time_s) in times_s.iter().enumerate() {
            let distance_s = |sample: usize| (self.times_s[sample] - time_s).abs();
            let Some(sample) = self
                .nearest(time_s)
                .filter(|&one| distance_s(one) <= within_s)
            else {
                continue;
            };
            if let Some((used, other)) = last.filter(|(used, _)| *used == sample) {
                if (self.times_s[used] - times_s[other]).abs() <= distance_s(sample) {
                    continue;
                }
                values[other] = f64::NAN;
            }
            last = Some((sample, row));
            values[row] = self.moved(sample, time_s);
        }
        values
    }

    /// The valid sample nearest to a time.
    fn nearest(&self, time_s: f64) -> Option<usize> {
        let next = self.times_s.partition_point(|&sample_s| sample_s < time_s);
        let around = [next.checked_sub(1), Some(next)].into_iter().flatten();
        let known = around.filter(|&one| self.values.get(one).is_some_and(|value| !value.is_nan()));
        let distance_s = |one: &usize| (self.times_s[*one] - time_s).abs();
        known.min_by(|a, b| distance_s(a).total_cmp(&distance_s(b)))
    }

    /// A sample, moved to a time near it.
    fn moved(&self, sample: usize, time_s: f64) -> f64 {
        let known = |index: Option<usize>| {
            let index = index.filter(|&index| self.values.get(index).is_some_and(|v| !v.is_nan()));
            index.unwrap_or(sample)
        };
        let (before, after) = (known(sample.checked_sub(1)), known(Some(sample + 1)));
        let span_s = self.times_s[after] - self.times_s[before];
        let later_s = time_s - self.times_s[sample];
        if span_s > 0.0 {
            let rise = self.values[after] - self.values[before];
            self.values[sample] + rise * (later_s / span_s)
        } else {
            self.values[sample]
        }
    }

    /// The value at each of `times_s`, interpolated linearly between the neighbouring samples; NaN if none is within
    /// `within_s`. For inputs, which are not compared.
    pub fn at(&self, times_s: &[f64], within_s: f64) -> Vec<f64> {
        times_s
            .iter()
            .map(|&time_s| self.at_time(time_s, within_s))
            .collect()
    }

    fn at_time(&self, time_s: f64, within_s: f64) -> f64 {
        let next = self.times_s.partition_point(|&sample_s| sample_s < time_s);
        let sample = |index: usize| {
            let known = self.times_s.get(index).zip(self.values.get(index));
            known.filter(|(_, value)| !value.is_nan())
        };
        let near = |&(sample_s, _): &(&f64, &f64)| (sample_s - time_s).abs() <= within_s;
        let after = sample(next);
        let before = next.checked_sub(1).and_then(sample);
        match (before, after) {
            (_, Some((&sample_s, &value))) if sample_s == time_s => value,
            (Some(before), Some(after)) if near(&before) || near(&after) => {
                let share = (time_s - before.0) / (after.0 - before.0);
                before.1 + share * (after.1 - before.1)
            }
            (Some(only), None) | (None, Some(only)) if near(&only) => *only.1,
            _ => f64::NAN,
        }
    }
}

/// A column of a log from the samples of its signal, at its own times as they are. Elsewhere currents, which are inputs of the model, are interpolated; measured
/// channels keep the noise of their samples.
pub fn values(column: &str, series: &Series, times_s: &[f64], within_s: f64) -> Vec<f64> {
    match column {
        _ if series.times_s == times_s => series.values.clone(),
        LIFT | LOWER => series.at(times_s, within_s),
        _ => series.measured_at(times_s, within_s),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(samples: &[(f64, f64)]) -> Series {
        let mut series = Series::default();
        for (time_s, value) in samples {
            series.push(*time_s, *value, 0);
        }
        series
    }

    #[test]
    fn a_value_lies_on_the_line_between_its_neighbours() {
        let series = series(&[(0.0, 1.0), (0.25, 2.0), (0.25, 2.0), (0.5, f64::NAN)]);
        assert_eq!(series.times_s.len(), 3, "heard twice");
        let at = series.at(&[0.0, 0.125, 0.25, 0.375], 0.125);
        assert_eq!(at, [1.0, 1.5, 2.0, 2.0]);
    }

    /// Variances of the values, and of the sum of neighbours, of unit noise.
    fn variances(values: &[f64]) -> (f64, f64) {
        let mean_square = |of: Vec<f64>| of.iter().map(|v| v * v).sum::<f64>() / of.len() as f64;
        let sums = values.windows(2).map(|two| two[0] + two[1]).collect();
        (mean_square(values.to_vec()), mean_square(sums))
    }

    #[test]
    fn moved_samples_have_the_noise_of_the_instrument_and_are_independent() {
        // Noise from a linear congruential generator, mean zero, variance one.
        let mut state = 7_u64;
        let mut noise = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            ((state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5) * 12.0_f64.sqrt()
        };
        let samples: Vec<(f64, f64)> = (0..20_000).map(|k| (f64::from(k), noise())).collect();
        let series = series(&samples);
        for later in [0.0, 0.2, 0.5] {
            let times_s: Vec<f64> = (1..19_998).map(|k| f64::from(k) + later).collect();
            let values = series.measured_at(&times_s, 0.5);
            let (of_one, of_two) = variances(&values);
            assert!((0.97..1.16).contains(&of_one), "{later}: {of_one}");
            assert!((of_two / of_one - 2.0).abs() < 0.08, "{later}: {of_two}");
        }
    }

    #[test]
    fn a_sample_is_moved_along_a_line_and_used_once() {
        let slow = series(&[(0.0, 1.0), (4.0, 5.0), (8.0, 9.0), (12.0, f64::NAN)]);
        let times_s: Vec<f64> = (0..13).map(|k| f64::from(k) + 0.3).collect();
        let values = slow.measured_at(&times_s, 0.5);
        let known = values
            .iter()
            .enumerate()
            .filter(|(_, value)| value.is_finite());
        let known: Vec<usize> = known.map(|(row, _)| row).collect();
        assert_eq!(known, [0, 4, 8]);
        for row in known {
            assert!(
                (values[row] - (times_s[row] + 1.0)).abs() < 1e-12,
                "{values:?}"
            );
        }
        // Between two rows, both of which it is near: the nearer one.
        let once = series(&[(0.5, 1.0)]).measured_at(&[0.0, 0.9, 2.0], 0.5);
        assert!(
            once[0].is_nan() && once[1] == 1.0 && once[2].is_nan(),
            "{once:?}"
        );
        let same = series(&[(1.0, 1.0), (1.0, 2.0), (1.0, 3.0)]).measured_at(&[1.0], 0.5);
        assert!(same[0].is_finite());
        assert!(series(&[]).measured_at(&[0.0], 1.0)[0].is_nan());
    }

    #[test]
    fn what_was_not_sampled_is_not_made_up() {
        let slow = series(&[(0.0, 1.0), (1.0, 2.0)]);
        let at = slow.at(&[0.0, 0.25, 0.5, 0.75, 1.0, 1.25], 0.125);
        assert_eq!((at[0], at[4]), (1.0, 2.0));
        assert!([1, 2, 3, 5].iter().all(|&row| at[row].is_nan()), "{at:?}");
    }
}
