//! Maps values to positions in a drawing, and finds round numbers for its axes.

/// A linear scale from values to pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    from: f64,
    to: f64,
    start_px: f64,
    end_px: f64,
}

impl Scale {
    /// Maps `low..high` (widened if empty) to `start_px..end_px`.
    pub fn new((low, high): (f64, f64), (start_px, end_px): (f64, f64)) -> Self {
        let (from, to) = if high - low > 1e-9 * low.abs().max(1.0) {
            (low, high)
        } else {
            (low - 0.5, high + 0.5)
        };
        Self {
            from,
            to,
            start_px,
            end_px,
        }
    }

    /// Position of a value, pixels.
    pub fn px(&self, value: f64) -> f64 {
        self.start_px + (value - self.from) / (self.to - self.from) * (self.end_px - self.start_px)
    }

    /// Round values within the scale, about `count` of them.
    pub fn ticks(&self, count: usize) -> Vec<f64> {
        let step = round_step((self.to - self.from) / count.max(1) as f64);
        let first = (self.from / step).ceil();
        let last = (self.to / step + 1e-9).floor();
        (0..=(last - first).max(0.0) as usize)
            .map(|i| (first + i as f64) * step)
            .collect()
    }

    /// Formats a tick with as many digits as the spacing needs.
    pub fn label(&self, tick: f64, count: usize) -> String {
        let step = round_step((self.to - self.from) / count.max(1) as f64);
        let digits = (-step.log10().floor()).clamp(0.0, 6.0) as usize;
        let text = format!("{tick:.digits$}");
        if text
            .trim_start_matches('-')
            .chars()
            .all(|c| matches!(c, '0' | '.'))
        {
            "0".to_owned()
        } else {
            text
        }
    }
}

/// 1, 2 or 5 times a power of ten, at least `step`.
fn round_step(step: f64) -> f64 {
    let power = 10_f64.powf(step.log10().floor());
    let round = [1.0, 2.0, 5.0].map(|factor| factor * power);
    round
        .into_iter()
        .find(|candidate| *candidate >= step * (1.0 - 1e-9))
        .unwrap_or(10.0 * power)
}

/// Least and greatest of the finite values; `None` if there are none.
pub fn extent(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    let finite = values.into_iter().filter(|value| value.is_finite());
    finite.fold(None, |range: Option<(f64, f64)>, value| match range {
        None => Some((value, value)),
        Some((low, high)) => Some((low.min(value), high.max(value))),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let scale = Scale::new((-0.13, 1.02), (0.0, 100.0));
        assert_eq!(scale.ticks(5), [0.0, 0.5, 1.0]);
        assert_eq!(scale.label(0.5, 5), "0.5");
        let scale = Scale::new((90.0, 90.0), (0.0, 100.0));
        assert_eq!(scale.px(90.0), 50.0);
        assert!(scale.ticks(4).contains(&90.0));
    }

    #[test]
    fn extent_ignores_dropouts() {
        assert_eq!(
            extent([f64::NAN, 2.0, -1.0, f64::INFINITY]),
            Some((-1.0, 2.0))
        );
        assert_eq!(extent([f64::NAN]), None);
    }
}
