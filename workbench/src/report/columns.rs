//! Samples as compact JSON.

use serde_json::{Value, json};

use super::scale::extent;

/// Resolution of time stamps, s.
pub const TIME_S: f64 = 1e-4;
/// Share of the extent that is resolved: four digits.
const SHARE: f64 = 1e-4;

/// Samples as integers in steps of a power of ten, at most `resolution` (in the unit of the values), each as difference to
/// the one before; `null` where missing. An invalid resolution is replaced by a ten thousandth of the extent.
pub fn column(values: &[f64], resolution: f64) -> Value {
    let (low, high) = extent(values.iter().copied()).unwrap_or((0.0, 0.0));
    let least = SHARE * (high - low).max(SHARE * high.abs().max(low.abs()));
    let wanted = match resolution.is_finite() && resolution > 0.0 {
        true => resolution,
        false => least,
    };
    let step = match wanted > 0.0 {
        true => 10_f64.powi(wanted.log10().floor() as i32),
        false => 1.0,
    };
    let mut last = 0_i64;
    let difference = |value: &f64| {
        value.is_finite().then(|| {
            let number = (value / step).round() as i64;
            let difference = number.saturating_sub(last);
            last = number;
            difference
        })
    };
    let differences: Vec<Option<i64>> = values.iter().map(difference).collect();
    json!({ "step": step, "differences": differences })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As the script of the report does.
    fn decoded(column: &Value) -> Vec<Option<f64>> {
        let step = column["step"].as_f64().unwrap();
        let mut sum = 0.0;
        let differences = column["differences"].as_array().unwrap().iter();
        let decoded = differences.map(|difference| {
            sum += difference.as_f64()?;
            Some(sum * step)
        });
        decoded.collect()
    }

    #[test]
    fn samples_are_kept_to_the_resolution() {
        let values: Vec<f64> = (0..500)
            .map(|i| 60.0 + 20.0 * (f64::from(i) * 0.1).sin())
            .collect();
        for (value, kept) in values.iter().zip(decoded(&column(&values, 0.02))) {
            assert!((value - kept.unwrap()).abs() <= 0.0051);
        }
    }

    #[test]
    fn a_dropout_is_kept_and_does_not_shift_the_others() {
        let kept = decoded(&column(&[1.0, f64::NAN, 1.5], 0.1));
        assert_eq!(kept, [Some(1.0), None, Some(1.5)]);
    }

    #[test]
    fn any_values_and_resolution_have_a_step() {
        for (values, resolution) in [
            (&[][..], 0.1),
            (&[0.0, 0.0], 0.0),
            (&[5.0, 5.0], f64::NAN),
            (&[f64::NAN], -1.0),
            (&[1e300, -1e300], 1e-3),
        ] {
            let step = column(values, resolution)["step"].as_f64().unwrap();
            assert!(step.is_finite() && step > 0.0, "{values:?}");
        }
        let kept = decoded(&column(&[5.0, 5.0], 0.0));
        assert!((kept[0].unwrap() - 5.0).abs() < 1e-3, "{kept:?}");
    }
}
