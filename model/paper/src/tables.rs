//! The paper's numbers, as printed.
//!
//! Table 2 is a digitised plot of the manufacturer's: its flows are integer multiples of 0.0713 and 0.1070 l/min, and
//! its "spool displacement" is 4 mm/A times (current - threshold), not a measurement. The displacement is omitted here.

/// Current (A) and flow (l/min) of the lift valve at the compensated pressure drop; Table 2A.
pub const TABLE_2A_LIFT: [(f64, f64); 16] = [
    (0.000, 0.000),
    (1.114, 0.000),
    (1.126, 0.000),
    (1.138, 0.143),
    (1.568, 8.128),
    (1.974, 15.829),
    (2.319, 22.389),
    (2.640, 28.521),
    (2.858, 32.513),
    (3.070, 36.506),
    (3.252, 39.929),
    (3.270, 39.929),
    (3.288, 39.929),
    (3.306, 39.929),
    (3.464, 39.929),
    (3.500, 39.929),
];

/// Current (A) and flow (l/min) of the lowering valve at a pressure difference of 15 bar; Table 2B.
pub const TABLE_2B_LOWER: [(f64, f64); 21] = [
    (0.000, 0.000),
    (0.242, 0.000),
    (0.969, 0.000),
    (0.999, 0.000),
    (1.017, 0.321),
    (1.042, 0.642),
    (1.072, 0.963),
    (1.138, 1.176),
    (1.502, 2.674),
    (1.544, 2.888),
    (1.574, 3.422),
    (1.744, 9.840),
    (2.035, 20.535),
    (2.271, 29.198),
    (2.567, 40.214),
    (3.022, 57.005),
    (3.040, 57.754),
    (3.070, 58.289),
    (3.119, 58.717),
    (3.306, 58.717),
    (3.500, 58.717),
];

/// Measured values of one valve; a column of Table 5.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// Current at which flow begins, A; determined in steps of 0.1 A.
    pub threshold_a: f64,
    /// Current of saturation, A.
    pub saturation_a: f64,
    /// Flow at saturation, l/min.
    pub saturation_lpm: f64,
}

/// Table 5, lift valve.
pub const TABLE_5_LIFT: Measured = Measured {
    threshold_a: 1.1,
    saturation_a: 3.2,
    saturation_lpm: 37.27,
};
/// Table 5, lowering valve.
pub const TABLE_5_LOWER: Measured = Measured {
    threshold_a: 1.25,
    saturation_a: 3.1,
    saturation_lpm: 56.74,
};

/// Discharge coefficient of equations 5 and 6.
pub const DISCHARGE_COEFFICIENT: f64 = 0.7;
/// Density of the oil (SAE 30), kg/m3.
pub const OIL_DENSITY_KG_M3: f64 = 877.3;
/// Pressure drop of the lift orifice, bar: the compensator's 4 bar less the check valve's 2.5 bar.
pub const LIFT_DROP_BAR: f64 = 1.5;
/// Pressure drop of Table 2B, bar.
pub const LOWER_DROP_BAR: f64 = 15.0;
/// Largest estimated orifice area (section 4.1), mm2.
pub const LARGEST_AREA_MM2: f64 = 51.411;
/// Cracking pressure of the check valve (Table 4), bar.
pub const CRACKING_PRESSURE_BAR: f64 = 2.5;

/// Loads of Figure 12, kg.
pub const FIGURE_12_LOADS_KG: [f64; 5] = [50.0, 100.0, 150.0, 200.0, 250.0];
/// Lift currents of Figure 12A, A.
pub const FIGURE_12_LIFT_A: [f64; 5] = [1.2, 1.5, 1.8, 2.1, 2.4];
/// Lowering currents of Figure 12B, A.
pub const FIGURE_12_LOWER_A: [f64; 5] = [1.5, 2.0, 2.5, 3.0, 3.3];

#[cfg(test)]
mod tests {
    use super::*;

    /// The table as left by the paper's authors, next to the program, to check the copy.
    fn from_csv(text: &str) -> Vec<(f64, f64)> {
        let rows = text
            .lines()
            .filter(|line| line.starts_with(|c: char| c.is_ascii_digit()));
        let numbers = |row: &str| {
            row.split(',')
                .map(|cell| cell.parse().unwrap())
                .collect::<Vec<f64>>()
        };
        rows.map(numbers).map(|row| (row[0], row[2])).collect()
    }

    #[test]
    fn tables_are_the_paper_s() {
        assert_eq!(
            from_csv(include_str!("../data/table2a_lift_valve.csv")),
            TABLE_2A_LIFT
        );
        assert_eq!(
            from_csv(include_str!("../data/table2b_lower_valve.csv")),
            TABLE_2B_LOWER
        );
    }
}
