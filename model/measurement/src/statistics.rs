//! Robust statistics of samples.

use std::ops::Range;

/// Standard deviations in a median absolute deviation of normal noise.
const SIGMA_PER_MAD: f64 = 1.4826;

/// The finite values, sorted.
pub(crate) fn sorted(values: impl IntoIterator<Item = f64>) -> Vec<f64> {
    let mut sorted: Vec<f64> = values.into_iter().filter(|v| v.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    sorted
}

/// The value below which this share of the values lies; NaN without values.
pub(crate) fn quantile(values: impl IntoIterator<Item = f64>, share: f64) -> f64 {
    let sorted = sorted(values);
    match sorted.len() {
        0 => f64::NAN,
        count => sorted[((count - 1) as f64 * share).round() as usize],
    }
}

/// The median; NaN without values.
pub(crate) fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    quantile(values, 0.5)
}

/// The median of so many values that its error is below a third of their standard deviation; `None` of fewer.
pub(crate) fn median_of_several(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    const SEVERAL: usize = 20;
    let values: Vec<f64> = values.into_iter().filter(|v| v.is_finite()).collect();
    (values.len() >= SEVERAL).then(|| median(values))
}

/// Robust standard deviation about a value, in the unit of the values.
pub(crate) fn spread_about(values: impl IntoIterator<Item = f64>, centre: f64) -> f64 {
    SIGMA_PER_MAD * median(values.into_iter().map(|v| (v - centre).abs()))
}

/// Last less first finite value; zero without any.
pub(crate) fn change(values: &[f64]) -> f64 {
    let mut known = values.iter().filter(|v| v.is_finite());
    let first = known.next();
    first.map_or(0.0, |first| known.next_back().unwrap_or(first) - first)
}

/// Standard deviation of white noise on a smooth signal, from its second differences, whose variance is six times that of the noise. Three
/// equal samples do not show it. A slow channel has no value in most rows.
pub(crate) fn noise<'a>(series: impl IntoIterator<Item = &'a [f64]>) -> f64 {
    let differences = series.into_iter().flat_map(|series| {
        let known: Vec<f64> = series.iter().copied().filter(|v| v.is_finite()).collect();
        let varied = known.windows(3).filter(|w| w[0] != w[1] || w[1] != w[2]);
        let differences = varied.map(|w| w[0] - 2.0 * w[1] + w[2]);
        differences.collect::<Vec<f64>>()
    });
    spread_about(differences, 0.0) / 6f64.sqrt()
}

/// The stretches of consecutive samples for which a condition holds, with at least `fewest` samples.
pub(crate) fn stretches(
    count: usize,
    fewest: usize,
    holds: impl Fn(usize) -> bool,
) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut from = 0;
    for at in 0..=count {
        if at < count && holds(at) {
            continue;
        }
        if at - from >= fewest.max(1) {
            found.push(from..at);
        }
        from = at + 1;
    }
    found
}
