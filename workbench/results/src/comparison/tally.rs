//! Accumulates mean and root mean square.

/// Sums of values; NaN is skipped.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tally {
    /// Number of values.
    pub samples: usize,
    sum: f64,
    squares: f64,
}

impl Tally {
    /// Adds a value.
    pub fn add(&mut self, value: f64) {
        if value.is_nan() {
            return;
        }
        self.samples += 1;
        self.sum += value;
        self.squares += value * value;
    }

    /// Mean; NaN without values.
    pub fn mean(&self) -> f64 {
        self.sum / self.samples as f64
    }

    /// Root mean square; NaN without values.
    pub fn rms(&self) -> f64 {
        (self.squares / self.samples as f64).sqrt()
    }
}

/// Adds a value to the tally of its part; a part has one from its first value on.
pub fn add_to<P: PartialEq>(parts: &mut Vec<(P, Tally)>, part: P, value: f64) {
    let known = parts.iter().position(|(known, _)| *known == part);
    let place = known.unwrap_or_else(|| {
        parts.push((part, Tally::default()));
        parts.len() - 1
    });
    parts[place].1.add(value);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn skips_dropouts() {
        let mut tally = Tally::default();
        [3.0, f64::NAN, -4.0]
            .into_iter()
            .for_each(|value| tally.add(value));
        assert_eq!(
            (tally.samples, tally.mean(), tally.rms()),
            (2, -0.5, 12.5_f64.sqrt())
        );
    }
}
