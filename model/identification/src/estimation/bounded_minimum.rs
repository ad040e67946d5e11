//! Minimum of a quadratic function within bounds.

use nalgebra::{DMatrix, DVector};

/// Slope towards the inside of a range, relative to the slope at zero, that is rounding.
const ROUNDING: f64 = 1e-9;

/// The point within `ranges` (low, high) that minimises `x' A x - 2 b' x`, with `A` positive definite (n by n) and `b` of
/// length n. `None` if `A` is not
/// positive definite.
///
/// Primal active set method (Nocedal and Wright, Numerical Optimization, section 16.5): from the point within the ranges
/// that is closest to zero, it moves to the minimum over the free coordinates or to the first bound on the way. There it
/// frees the coordinate whose gradient points inwards most.
#[must_use]
pub fn minimum_within(
    matrix: &DMatrix<f64>,
    pull: &DVector<f64>,
    ranges: &[(f64, f64)],
) -> Option<DVector<f64>> {
    let held_at = |index: usize, value: f64| value.clamp(ranges[index].0, ranges[index].1);
    let mut held = vec![false; pull.len()];
    let mut point = DVector::from_fn(pull.len(), |index, _| held_at(index, 0.0));
    // Each pass holds or frees one coordinate; rounding may free and hold the same one for ever.
    for _ in 0..10 * (pull.len() + 1) {
        let target = minimum_beside(matrix, pull, &point, &held)?;
        let Some((share, first)) = first_bound(&point, &target, ranges) else {
            point = target;
            match inward(matrix, pull, &point, &held, ranges) {
                Some(freed) => held[freed] = false,
                None => break,
            }
            continue;
        };
        point += (&target - &point) * share;
        let (low, high) = ranges[first];
        point[first] = if target[first] < low { low } else { high };
        held[first] = true;
    }
    Some(point)
}

/// The minimum over the coordinates that are not held.
fn minimum_beside(
    matrix: &DMatrix<f64>,
    pull: &DVector<f64>,
    point: &DVector<f64>,
    held: &[bool],
) -> Option<DVector<f64>> {
    let (mut matrix, mut right) = (matrix.clone(), pull.clone());
    let held = || (0..held.len()).filter(|&index| held[index]);
    for index in held() {
        right -= matrix.column(index) * point[index];
    }
    for index in held() {
        matrix.row_mut(index).fill(0.0);
        matrix.column_mut(index).fill(0.0);
        matrix[(index, index)] = 1.0;
        right[index] = point[index];
    }
    Some(matrix.cholesky()?.solve(&right))
}

/// Share of the way at which the first coordinate leaves its range, and that coordinate.
fn first_bound(
    point: &DVector<f64>,
    target: &DVector<f64>,
    ranges: &[(f64, f64)],
) -> Option<(f64, usize)> {
    let shares = ranges
        .iter()
        .enumerate()
        .filter_map(|(index, &(low, high))| {
            let (from, to) = (point[index], target[index]);
            let bound = match (to < low, to > high) {
                (true, _) => low,
                (_, true) => high,
                _ => return None,
            };
            Some((((bound - from) / (to - from)).clamp(0.0, 1.0), index))
        });
    shares.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// The held coordinate whose cost decreases most towards the inside of its range.
fn inward(
    matrix: &DMatrix<f64>,
    pull: &DVector<f64>,
    point: &DVector<f64>,
    held: &[bool],
    ranges: &[(f64, f64)],
) -> Option<usize> {
    let downhill = pull - matrix * point;
    let inwards = |&index: &usize| {
        if point[index] > 0.5 * (ranges[index].0 + ranges[index].1) {
            -downhill[index]
        } else {
            downhill[index]
        }
    };
    let negligible = |index: usize| ROUNDING * pull[index].abs().max(f64::MIN_POSITIVE);
    let held = (0..held.len()).filter(|&index| held[index]);
    held.filter(|index| inwards(index) > negligible(*index))
        .max_by(|a, b| inwards(a).total_cmp(&inwards(b)))
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::minimum_within;

    /// The conditions of Karush, Kuhn and Tucker are necessary and sufficient for the minimum of a convex function.
    #[test]
    fn the_minimum_fulfils_its_conditions() {
        let mut state = 1_u64;
        let mut uniform = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        for size in 1..30 {
            let root = DMatrix::from_fn(size, size, |_, _| uniform());
            let matrix = &root * root.transpose() + DMatrix::identity(size, size) * 1e-4;
            let pull = DVector::from_fn(size, |_, _| uniform());
            let ranges: Vec<(f64, f64)> = (0..size)
                .map(|_| (-1.0 + uniform(), 1.0 + uniform()))
                .collect();
            let point = minimum_within(&matrix, &pull, &ranges).unwrap();
            let downhill = &pull - &matrix * &point;
            for (index, &(low, high)) in ranges.iter().enumerate() {
                let (value, slope) = (point[index], downhill[index]);
                assert!((low..=high).contains(&value), "size {size}: {value}");
                let held = (value == low && slope <= 1e-8) || (value == high && slope >= -1e-8);
                assert!(held || slope.abs() < 1e-8, "size {size}: {slope}");
            }
        }
    }

    /// An indefinite matrix has no minimum.
    #[test]
    fn an_indefinite_matrix_is_refused() {
        let matrix = DMatrix::from_element(2, 2, 1.0) - DMatrix::identity(2, 2);
        assert!(minimum_within(&matrix, &DVector::zeros(2), &[(-1.0, 1.0); 2]).is_none());
    }
}
