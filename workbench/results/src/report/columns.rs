//! Samples as compact JSON.

use serde::Serialize;

use super::scale::extent;

/// Resolution of time stamps, s.
pub const TIME_S: f64 = 1e-4;
/// Share of the extent that is resolved without a wanted resolution: five digits.
const SHARE: f64 = 1e-5;
/// Share of the extent that is resolved at most: a tenth of a pixel of a row of a plot, which is 125 px high.
const OF_ROW: f64 = 1e-3;

/// The digits of base 64 (RFC 4648).
const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
/// The mark of a missing sample.
const MISSING: char = '-';

/// Samples in a compact form.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Column {
    /// Their step, in the unit of the values.
    pub step: f64,
    /// Their differences in steps, as text.
    pub differences: String,
}

/// Samples as integers in steps of 1, 2 or 5 times a power of ten, at most `resolution` (in the unit of the values), each as difference to
/// the one before. An invalid resolution is replaced by a hundred thousandth of the extent.
///
/// The differences are one text: variable-length quantities in base 64, as in the source maps of ECMA-426. A missing sample
/// is `-`.
pub fn column(values: &[f64], resolution: f64) -> Column {
    let (low, high) = extent(values.iter().copied()).unwrap_or((0.0, 0.0));
    let least = SHARE * (high - low).max(SHARE * high.abs().max(low.abs()));
    let wanted = if resolution.is_finite() && resolution > 0.0 {
        resolution
    } else {
        least
    };
    let step = if wanted > 0.0 {
        round_down(wanted)
    } else {
        1.0
    };
    let mut last = 0_i64;
    let mut differences = String::with_capacity(2 * values.len());
    for value in values {
        if !value.is_finite() {
            differences.push(MISSING);
            continue;
        }
        let number = (value / step).round() as i64;
        push(&mut differences, number.saturating_sub(last));
        last = number;
    }
    Column { step, differences }
}

/// Samples of a signal that is plotted in a row: `resolution` as in [`column`], but not finer than a plot shows.
pub fn plotted_column(values: &[f64], resolution: f64) -> Column {
    let (low, high) = extent(values.iter().copied()).unwrap_or((0.0, 0.0));
    column(values, resolution.max(OF_ROW * (high - low)))
}

/// The largest of 1, 2 and 5 times a power of ten that is not above a positive number.
fn round_down(number: f64) -> f64 {
    let power = 10_f64.powi(number.log10().floor() as i32);
    let steps = [5.0, 2.0].map(|factor| factor * power);
    let step = steps.into_iter().find(|step| *step <= number);
    step.unwrap_or(power)
}

/// Appends a number: five bits a digit, the lowest first, of which the first is the sign; the sixth says that digits follow.
fn push(text: &mut String, number: i64) {
    let mut rest = (i128::from(number.unsigned_abs()) << 1) | i128::from(number < 0);
    loop {
        let low = (rest & 31) as usize;
        rest >>= 5;
        let follows = usize::from(rest > 0) << 5;
        text.push(char::from(DIGITS[low | follows]));
        if rest == 0 {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As the script of the report does.
    fn decoded(column: &Column) -> Vec<Option<f64>> {
        let (mut sum, mut number, mut shift) = (0_i128, 0_i128, 0);
        let mut decoded = Vec::new();
        for letter in column.differences.bytes() {
            if char::from(letter) == MISSING {
                decoded.push(None);
                continue;
            }
            let digit = DIGITS.iter().position(|one| *one == letter).unwrap() as i128;
            number |= (digit & 31) << shift;
            shift += 5;
            if digit < 32 {
                sum += if number & 1 == 1 {
                    -(number >> 1)
                } else {
                    number >> 1
                };
                decoded.push(Some(sum as f64 * column.step));
                (number, shift) = (0, 0);
            }
        }
        decoded
    }

    #[test]
    fn samples_are_kept_to_the_resolution() {
        let values: Vec<f64> = (0..500)
            .map(|i| 60.0 + 20.0 * (f64::from(i) * 0.1).sin())
            .collect();
        for (value, kept) in values.iter().zip(decoded(&column(&values, 0.02))) {
            assert!((value - kept.unwrap()).abs() <= 0.0101);
        }
    }

    #[test]
    fn differences_are_those_of_source_maps() {
        // Examples of the format: 0, 1, -1, 15, -15, 16, 1200.
        for (number, text) in [
            (0, "A"),
            (1, "C"),
            (-1, "D"),
            (15, "e"),
            (-15, "f"),
            (16, "gB"),
            (1200, "grC"),
        ] {
            let mut found = String::new();
            push(&mut found, number);
            assert_eq!(found, text, "{number}");
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
            let column = column(values, resolution);
            assert!(column.step.is_finite() && column.step > 0.0, "{values:?}");
            assert_eq!(decoded(&column).len(), values.len());
        }
        let kept = decoded(&column(&[5.0, 5.0], 0.0));
        assert!((kept[0].unwrap() - 5.0).abs() < 1e-3, "{kept:?}");
    }
}
