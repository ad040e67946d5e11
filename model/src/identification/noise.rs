//! Noise of an instrument from its own record, where no data sheet declares it.

/// One sigma of the noise of a record, in its unit: from the median of its second differences.
///
/// Second differences remove level and drift, the median ignores the manoeuvres; `1 - 2 + 1` has a variance of six.
/// The model's residual is not used: it would hide the effect that is looked for. `None` for fewer than ten samples.
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
