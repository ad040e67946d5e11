//! How the pressure swings.

/// Peak to peak, bar.
pub fn swing_bar(pressures_bar: impl Iterator<Item = f64>) -> f64 {
    let (low, high) = pressures_bar.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), bar| {
        (low.min(bar), high.max(bar))
    });
    high - low
}
