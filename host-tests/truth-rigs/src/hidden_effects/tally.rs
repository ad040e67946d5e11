//! Rates of correct answers, with confidence intervals.

use std::fmt;

use super::grade::Graded;
use crate::second_rig::draw::Kind;

/// Hits of a number of tries.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Rate {
    /// Hits.
    pub hits: usize,
    /// Tries.
    pub of: usize,
}

impl Rate {
    /// Counts true outcomes.
    pub fn count(results: impl IntoIterator<Item = bool>) -> Self {
        results.into_iter().fold(Self::default(), |rate, hit| Self {
            hits: rate.hits + usize::from(hit),
            of: rate.of + 1,
        })
    }

    /// 95 % interval (Wilson 1927).
    #[must_use]
    pub fn interval(self) -> (f64, f64) {
        const Z: f64 = 1.96;
        let n = self.of as f64;
        let share = self.hits as f64 / n;
        let centre = share + Z * Z / (2.0 * n);
        let half = Z * (share * (1.0 - share) / n + Z * Z / (4.0 * n * n)).sqrt();
        let whole = 1.0 + Z * Z / n;
        (
            ((centre - half) / whole).max(0.0),
            ((centre + half) / whole).min(1.0),
        )
    }
}

impl fmt::Display for Rate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.of == 0 {
            return write!(f, "-");
        }
        let (low, high) = self.interval();
        let percent = |share: f64| (100.0 * share).round();
        write!(
            f,
            "{}/{} ({}-{} %)",
            self.hits,
            self.of,
            percent(low),
            percent(high)
        )
    }
}

/// Limits of the detectability's bins.
pub const BINS: [(f64, f64); 3] = [(0.0, 0.25), (0.25, 1.0), (1.0, f64::INFINITY)];

/// Answers to some cases.
#[derive(Debug, Default)]
pub struct Tally<'a>(pub Vec<&'a Graded>);

impl<'a> Tally<'a> {
    /// Answers to cases of one kind.
    #[must_use]
    pub fn of(&self, kind: Kind) -> Self {
        self.filtered(|graded| graded.posed.case.kind == kind)
    }

    /// Answers to cases in a bin of detectability.
    #[must_use]
    pub fn within(&self, (low, high): (f64, f64)) -> Self {
        self.filtered(|graded| (low..high).contains(&graded.posed.detectability))
    }

    /// Answers that have something.
    #[must_use]
    pub fn filtered(&self, keep: impl Fn(&Graded) -> bool) -> Self {
        Self(
            self.0
                .iter()
                .copied()
                .filter(|graded| keep(graded))
                .collect(),
        )
    }

    /// How many answers have something.
    #[must_use]
    pub fn rate(&self, hit: impl Fn(&Graded) -> bool) -> Rate {
        Rate::count(self.0.iter().map(|graded| hit(graded)))
    }

    /// Coverage of the intervals.
    #[must_use]
    pub fn coverage(&self) -> Rate {
        Rate::count(self.0.iter().flat_map(|graded| graded.covered()))
    }

    /// Median held-out errors before and after.
    #[must_use]
    pub fn held_out(&self) -> Option<(f64, f64)> {
        let errors: Vec<(f64, f64)> = self.0.iter().map(|g| g.answer.held_out).collect();
        let median = |pick: fn(&(f64, f64)) -> f64| quantile(errors.iter().map(pick), 0.5);
        Some((median(|e| e.0)?, median(|e| e.1)?))
    }

    /// Stated probabilities in ten bins of equal width: their mean, and how many of the effects are there. Bins without
    /// any are left out.
    #[must_use]
    pub fn reliability(&self) -> Vec<(f64, Rate)> {
        let stated: Vec<(f64, bool)> = self.0.iter().flat_map(|graded| graded.stated()).collect();
        let bin = |confidence: f64| ((10.0 * confidence) as usize).min(9);
        let bins = (0..10).filter_map(|index| {
            let own = stated.iter().filter(|(stated, _)| bin(*stated) == index);
            let rate = Rate::count(own.clone().map(|(_, there)| *there));
            let mean = own.map(|(stated, _)| stated).sum::<f64>() / rate.of as f64;
            (rate.of > 0).then_some((mean, rate))
        });
        bins.collect()
    }

    /// A quantile of the times, s.
    #[must_use]
    pub fn seconds(&self, share: f64) -> Option<f64> {
        quantile(self.0.iter().map(|graded| graded.seconds), share)
    }
}

/// A quantile by rank; `None` without values.
pub fn quantile(values: impl Iterator<Item = f64>, share: f64) -> Option<f64> {
    let mut values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    let last = values.len().checked_sub(1)?;
    values.get((share * last as f64).round() as usize).copied()
}

#[cfg(test)]
mod tests {
    use super::Rate;

    /// Worked values of Wilson's interval.
    #[test]
    fn interval_is_wilsons() {
        let (low, high) = Rate { hits: 46, of: 46 }.interval();
        assert!((low - 0.9229).abs() < 1e-3 && high == 1.0, "{low} {high}");
        let (low, high) = Rate { hits: 5, of: 10 }.interval();
        assert!((low - 0.2366).abs() < 1e-3 && (high - 0.7634).abs() < 1e-3);
    }
}
