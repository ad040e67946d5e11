//! Straight lines through points.

/// Value at `x` on straight lines through points of rising x; before the first and behind the last point as there, zero
/// without points.
#[must_use]
pub fn value_at(points: &[(f64, f64)], x: f64) -> f64 {
    let behind = points.partition_point(|point| point.0 <= x);
    match (behind, points.len()) {
        (_, 0) => 0.0,
        (0, _) => points[0].1,
        (n, all) if n == all => points[n - 1].1,
        (n, _) => {
            let ((x0, y0), (x1, y1)) = (points[n - 1], points[n]);
            y0 + (y1 - y0) * (x - x0) / (x1 - x0)
        }
    }
}
