//! Decimal numbers that convert back to the same SI value.

/// Most significant digits of a number.
const MOST_DIGITS: usize = 17;

/// The shortest decimal number that yields exactly `si` when multiplied by `unit`.
pub fn decimal(si: f64, unit: f64) -> String {
    let value = si / unit;
    let near = [value, value.next_up(), value.next_down()];
    let texts = (0..MOST_DIGITS).flat_map(|digits| near.map(|value| format!("{value:.digits$e}")));
    let same = |text: &String| text.parse::<f64>().is_ok_and(|value| value * unit == si);
    plain(
        texts
            .into_iter()
            .find(same)
            .and_then(|text| text.parse().ok())
            .unwrap_or(value),
    )
}

/// Formats a number for TOML, without an exponent if it is readable that way.
fn plain(value: f64) -> String {
    let readable = value == 0.0 || (1e-5..1e7).contains(&value.abs());
    if readable {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitch_plant::units::{M3_S_PER_LPM, PA_PER_BAR};
    use proptest::prelude::*;

    #[test]
    fn round_numbers_stay_round() {
        assert_eq!(decimal(154e5, PA_PER_BAR), "154");
        assert_eq!(decimal(54.5 * M3_S_PER_LPM, M3_S_PER_LPM), "54.5");
        assert_eq!(decimal(0.0, PA_PER_BAR), "0");
        assert_eq!(decimal(5e7, 1.0), "5e7");
    }

    proptest! {
        #[test]
        fn values_come_back_bit_for_bit(written in -1e4..1e4_f64, unit in prop::sample::select(vec![1.0, 1e-3, M3_S_PER_LPM, PA_PER_BAR])) {
            let si = written * unit;
            let read: f64 = decimal(si, unit).parse().unwrap();
            prop_assert_eq!(read * unit, si);
        }
    }
}
