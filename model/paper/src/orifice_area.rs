//! Orifice areas from Table 2, as the paper estimates them.
//!
//! Equations 5 and 6: `Q = Cd A sqrt(2 dp / rho)`. The paper varies one area per table point (16 for the lift valve, 21
//! for the lowering valve) to minimise the sum of squared flow errors. The flow is linear in the area and every point
//! has its own, so the least-squares solution is exact: its residual is zero.

use hitch_plant::units::{m3_s_from_lpm, pa_from_bar};

use crate::tables::{DISCHARGE_COEFFICIENT, OIL_DENSITY_KG_M3};

/// Square millimetres per square metre.
const MM2_PER_M2: f64 = 1e6;

/// Flow per area (the velocity, m/s) at a pressure drop in bar.
pub fn flow_per_area_m_s(drop_bar: f64) -> f64 {
    DISCHARGE_COEFFICIENT * (2.0 * pa_from_bar(drop_bar) / OIL_DENSITY_KG_M3).sqrt()
}

/// Least-squares areas (mm2) for the flows of a table (l/min by current) at a pressure drop in bar.
///
/// A current that occurs several times in the table has one area, fitted to all its flows.
pub fn estimate_mm2(table: &[(f64, f64)], drop_bar: f64) -> Vec<f64> {
    let gain_m_s = flow_per_area_m_s(drop_bar);
    let area_mm2 = |current_a: f64| {
        // Normal equation of min sum (gain * area - flow)^2 over the points at this current.
        let points = table.iter().filter(|(at_a, _)| *at_a == current_a);
        let (squares, products) = points.fold((0.0, 0.0), |(squares, products), (_, flow_lpm)| {
            (
                squares + gain_m_s * gain_m_s,
                products + gain_m_s * m3_s_from_lpm(*flow_lpm),
            )
        });
        products / squares * MM2_PER_M2
    };
    table
        .iter()
        .map(|(current_a, _)| area_mm2(*current_a))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tables::*;

    fn largest(areas: &[f64]) -> f64 {
        areas.iter().copied().fold(0.0, f64::max)
    }

    #[test]
    fn largest_area_is_the_paper_s() {
        let lift = estimate_mm2(&TABLE_2A_LIFT, LIFT_DROP_BAR);
        let lower = estimate_mm2(&TABLE_2B_LOWER, LOWER_DROP_BAR);
        let error = largest(&lift).max(largest(&lower)) / LARGEST_AREA_MM2 - 1.0;
        assert!(error.abs() < 1e-3, "{error}");
        assert_eq!((lift[0], lower[0]), (0.0, 0.0));
    }
}
