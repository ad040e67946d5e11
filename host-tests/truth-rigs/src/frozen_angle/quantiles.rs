//! Quantiles of the extra travel of many freezes.

use super::freeze::Cost;

/// Shares of the freezes that are printed.
pub const SHARES: [f64; 4] = [0.5, 0.95, 0.99, 1.0];

/// The extra travel, degree, that each of [`SHARES`] stays within.
#[must_use]
pub fn quantiles_deg(costs: &[Cost]) -> [f64; 4] {
    let mut extra_deg: Vec<f64> = costs.iter().map(|cost| cost.extra_deg).collect();
    extra_deg.sort_by(f64::total_cmp);
    SHARES.map(|share| {
        let rank = (share * extra_deg.len() as f64).ceil() as usize;
        extra_deg.get(rank.max(1) - 1).copied().unwrap_or(0.0)
    })
}
