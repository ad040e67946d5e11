//! Dropouts in the currents.
//!
//! A current drives the model, so a gap in it has to be filled, or the run is rejected. A gap is interpolated linearly
//! if the error is small: it is short compared to the valve's own lag, or the current is the same on both sides.

/// Longest gap that is always filled, s. A step within it is shifted by at most half of it.
pub const SHORT_GAP_S: f64 = 0.2;
/// Longest gap that is filled if the current is the same on both sides, s.
const STEADY_GAP_S: f64 = 2.0;
/// Difference below which two currents are the same, A: ten times the noise of a logged current.
const STEADY_WITHIN_A: f64 = 0.04;

/// A gap that cannot be filled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// Its first missing sample.
    pub sample: usize,
    /// Duration of the gap, s; infinite if the current has no value at all.
    pub duration_s: f64,
}

/// Fills the gaps (NaN) of a current in place; at the ends of the run the nearest value is used.
///
/// # Errors
/// The first gap that is too long to be filled.
pub fn bridge(time_s: &[f64], current_a: &mut [f64]) -> Result<(), Gap> {
    let mut known: Option<usize> = None;
    let mut sample = 0;
    while sample < current_a.len() {
        if !current_a[sample].is_nan() {
            known = Some(sample);
            sample += 1;
            continue;
        }
        let next = (sample..current_a.len()).find(|&i| !current_a[i].is_nan());
        fill(time_s, current_a, sample, known, next)?;
        sample = next.unwrap_or(current_a.len());
    }
    Ok(())
}

/// Fills the samples from `sample` on, between the known samples `before` and `after`.
fn fill(
    time_s: &[f64],
    current_a: &mut [f64],
    sample: usize,
    before: Option<usize>,
    after: Option<usize>,
) -> Result<(), Gap> {
    let gap = |duration_s| Gap { sample, duration_s };
    let nearest = before.or(after).zip(after.or(before));
    let (from, to) = nearest.ok_or(gap(f64::INFINITY))?;
    let end = after.unwrap_or(current_a.len());
    let duration_s = time_s[after.unwrap_or(end - 1)] - time_s[before.unwrap_or(sample)];
    let steady = from != to && (current_a[to] - current_a[from]).abs() < STEADY_WITHIN_A;
    if duration_s > if steady { STEADY_GAP_S } else { SHORT_GAP_S } {
        return Err(gap(duration_s));
    }
    let start_a = current_a[from];
    let slope = if from == to {
        0.0
    } else {
        (current_a[to] - start_a) / (time_s[to] - time_s[from])
    };
    for i in sample..end {
        current_a[i] = start_a + slope * (time_s[i] - time_s[from]);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAN: f64 = f64::NAN;

    fn bridged(step_s: f64, values: &[f64]) -> Result<Vec<f64>, Gap> {
        let time_s: Vec<f64> = (0..values.len()).map(|i| i as f64 * step_s).collect();
        let mut current_a = values.to_vec();
        bridge(&time_s, &mut current_a).map(|()| current_a)
    }

    #[test]
    fn short_gaps_are_straight_lines() {
        assert_eq!(bridged(0.0625, &[1.0, NAN, 2.0]), Ok(vec![1.0, 1.5, 2.0]));
        assert_eq!(
            bridged(0.0625, &[NAN, 1.0, 2.0, NAN]),
            Ok(vec![1.0, 1.0, 2.0, 2.0])
        );
    }

    #[test]
    fn long_gaps_are_refused_unless_the_current_is_steady() {
        let gap = |sample, duration_s| Err(Gap { sample, duration_s });
        assert_eq!(bridged(0.25, &[1.0, NAN, 2.0]), gap(1, 0.5));
        assert_eq!(bridged(0.25, &[1.0, NAN, 1.0]), Ok(vec![1.0, 1.0, 1.0]));
        assert_eq!(bridged(1.5, &[1.0, NAN, 1.0]), gap(1, 3.0));
        assert_eq!(bridged(0.25, &[1.0, 1.0, NAN]), gap(2, 0.25));
        assert_eq!(bridged(0.25, &[NAN, NAN]), gap(0, f64::INFINITY));
    }
}
