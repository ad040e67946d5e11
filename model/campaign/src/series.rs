//! The received samples of one signal.

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

impl Series {
    /// Adds a sample; duplicates are merged.
    pub fn push(&mut self, time_s: f64, value: f64, byte: usize) {
        if self.times_s.last() == Some(&time_s) && self.values.last() == Some(&value) {
            return;
        }
        self.times_s.push(time_s);
        self.values.push(value);
        self.bytes.push(byte);
    }

    /// The median time between samples, s; infinite for a single one.
    pub fn median_step_s(&self) -> f64 {
        let mut steps_s: Vec<f64> = self.times_s.windows(2).map(|two| two[1] - two[0]).collect();
        steps_s.sort_by(f64::total_cmp);
        steps_s
            .get(steps_s.len() / 2)
            .copied()
            .unwrap_or(f64::INFINITY)
    }

    /// The value at each of `times_s`, interpolated linearly between the neighbouring samples; NaN if none is within
    /// `within_s`.
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

    #[test]
    fn what_was_not_sampled_is_not_made_up() {
        let slow = series(&[(0.0, 1.0), (1.0, 2.0)]);
        let at = slow.at(&[0.0, 0.25, 0.5, 0.75, 1.0, 1.25], 0.125);
        assert_eq!((at[0], at[4]), (1.0, 2.0));
        assert!([1, 2, 3, 5].iter().all(|&row| at[row].is_nan()), "{at:?}");
    }
}
