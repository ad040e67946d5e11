//! A measured linkage: rocker angle and height of the hitch point over piston travel.

/// Points of a measured linkage.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkageTable {
    travel_m: Vec<f64>,
    angle_rad: Vec<f64>,
    height_m: Vec<f64>,
}

/// Reason why points are no linkage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum LinkageTableError {
    /// The lists differ in length, or are too short.
    #[error(
        "a linkage has the same number of travels, angles and heights, at least 3; here {travels}, {angles} and {heights}"
    )]
    Length {
        /// Number of travels.
        travels: usize,
        /// Number of angles.
        angles: usize,
        /// Number of heights.
        heights: usize,
    },
    /// A column does not rise at a point.
    #[error("travel, angle and height have to rise; point {} does not", .index + 1)]
    Order {
        /// Index of the point.
        index: usize,
    },
}

impl LinkageTable {
    /// A measured linkage: travel of the piston from its retracted end, m, angle of the rocker, rad, and height of the
    /// hitch point, m, each rising.
    ///
    /// # Errors
    /// See [`LinkageTableError`].
    pub fn new(
        travel_m: Vec<f64>,
        angle_rad: Vec<f64>,
        height_m: Vec<f64>,
    ) -> Result<Self, LinkageTableError> {
        let (travels, angles, heights) = (travel_m.len(), angle_rad.len(), height_m.len());
        if travels < 3 || angles != travels || heights != travels {
            return Err(LinkageTableError::Length {
                travels,
                angles,
                heights,
            });
        }
        let columns = [&travel_m, &angle_rad, &height_m];
        let rises = |index: usize| columns.iter().all(|of| of[index] > of[index - 1]);
        match (1..travels).find(|&index| !rises(index)) {
            Some(index) => Err(LinkageTableError::Order { index }),
            None => Ok(Self {
                travel_m,
                angle_rad,
                height_m,
            }),
        }
    }

    /// Travel at each point, m.
    #[must_use]
    pub fn travel_m(&self) -> &[f64] {
        &self.travel_m
    }

    /// Rocker angle at each point, rad.
    #[must_use]
    pub fn angle_rad(&self) -> &[f64] {
        &self.angle_rad
    }

    /// Height of the hitch point at each point, m.
    #[must_use]
    pub fn height_m(&self) -> &[f64] {
        &self.height_m
    }

    /// First and last travel, m.
    #[must_use]
    pub fn span_m(&self) -> (f64, f64) {
        (self.travel_m[0], self.travel_m[self.travel_m.len() - 1])
    }
}

/// A smooth curve through points that rise: cubic pieces with the slopes of Fritsch and Butland (1984), which rises
/// between the points too and has a continuous derivative.
pub struct RisingCurve<'a> {
    x: &'a [f64],
    y: &'a [f64],
    slopes: Vec<f64>,
}

impl<'a> RisingCurve<'a> {
    /// The curve through points with rising `x` and `y`.
    #[must_use]
    pub fn through(x: &'a [f64], y: &'a [f64]) -> Self {
        let widths: Vec<f64> = x.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let secants: Vec<f64> = y
            .windows(2)
            .zip(&widths)
            .map(|(pair, width)| (pair[1] - pair[0]) / width)
            .collect();
        let inner = secants.windows(2).zip(widths.windows(2)).map(|(d, w)| {
            // Weighted harmonic mean of the two secants.
            let (before, after) = (w[0] + 2.0 * w[1], 2.0 * w[0] + w[1]);
            (before + after) / (after / d[0] + before / d[1])
        });
        let last = widths.len() - 1;
        let first_slope = end_slope([widths[0], widths[1]], [secants[0], secants[1]]);
        let last_slope = end_slope(
            [widths[last], widths[last - 1]],
            [secants[last], secants[last - 1]],
        );
        let slopes = std::iter::once(first_slope)
            .chain(inner)
            .chain(std::iter::once(last_slope))
            .collect();
        Self { x, y, slopes }
    }

    /// Value and derivative at `x`; a straight line beyond the first and the last point.
    #[must_use]
    pub fn at(&self, x: f64) -> (f64, f64) {
        let (first, last) = (self.x[0], self.x[self.x.len() - 1]);
        let within = x.clamp(first, last);
        let (value, slope) = self.within(within);
        (value + slope * (x - within), slope)
    }

    /// The same between the first and the last point.
    fn within(&self, x: f64) -> (f64, f64) {
        let upper = self
            .x
            .partition_point(|&at| at <= x)
            .clamp(1, self.x.len() - 1);
        let (low, width) = (upper - 1, self.x[upper] - self.x[upper - 1]);
        let share = (x - self.x[low]) / width;
        let secant = (self.y[upper] - self.y[low]) / width;
        let (from, to) = (self.slopes[low], self.slopes[upper]);
        let bend = [3.0 * secant - 2.0 * from - to, from + to - 2.0 * secant];
        let value = self.y[low] + width * share * (from + share * (bend[0] + share * bend[1]));
        let slope = from + share * (2.0 * bend[0] + 3.0 * share * bend[1]);
        (value, slope)
    }
}

/// Slope at an end from the parabola through three points, kept between a tenth of and three times the end's secant:
/// then the curve rises.
fn end_slope(widths: [f64; 2], secants: [f64; 2]) -> f64 {
    let [near, far] = widths;
    let parabola = ((2.0 * near + far) * secants[0] - near * secants[1]) / (near + far);
    parabola.clamp(0.1 * secants[0], 3.0 * secants[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_that_do_not_rise_are_refused() {
        let refused = |height_m: Vec<f64>| {
            LinkageTable::new(vec![0.0, 0.1, 0.2], vec![1.0, 1.5, 2.0], height_m).unwrap_err()
        };
        let order = refused(vec![0.0, 0.2, 0.1]);
        assert_eq!(order, LinkageTableError::Order { index: 2 });
        let length = refused(vec![0.0, 0.2]);
        assert!(matches!(
            length,
            LinkageTableError::Length { heights: 2, .. }
        ));
    }

    #[test]
    fn the_curve_passes_its_points_and_rises_between_them() {
        let (x, y) = ([0.0, 0.1, 0.3, 0.4, 0.7], [0.0, 0.01, 0.5, 0.51, 2.0]);
        let curve = RisingCurve::through(&x, &y);
        for (x, y) in x.into_iter().zip(y) {
            assert!((curve.at(x).0 - y).abs() < 1e-12);
        }
        let dense = (0..=700).map(|k| curve.at(f64::from(k) * 1e-3));
        let dense: Vec<(f64, f64)> = dense.collect();
        for pair in dense.windows(2) {
            assert!(pair[1].0 > pair[0].0);
            // The derivative is that of the value.
            let secant = (pair[1].0 - pair[0].0) / 1e-3;
            let mean = 0.5 * (pair[0].1 + pair[1].1);
            assert!((secant - mean).abs() < 0.02, "{secant} {mean}");
        }
    }
}
