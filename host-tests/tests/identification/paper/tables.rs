//! The paper's numbers, as printed.
//!
//! Table 2 is a digitised plot of the manufacturer's: its flows are integer multiples of 0.0713 and 0.1070 l/min, and
//! its "spool displacement" is 4 mm/A times (current - threshold), not a measurement. The displacement is not read here.

use std::sync::LazyLock;

use hitch_plant::Valve;

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

/// Measured values of one valve; a column of Table 5.
#[derive(Debug, Clone, Copy)]
pub struct Measured {
    /// Current at which flow begins, A; determined in steps of 0.1 A.
    pub threshold_a: f64,
    /// Current of saturation, A.
    pub saturation_a: f64,
    /// Flow at saturation, l/min.
    pub saturation_lpm: f64,
}

/// The column of Table 5 of a valve.
pub fn table_5(valve: Valve) -> Measured {
    let column = match valve {
        Valve::Lift => 1,
        Valve::Lower => 2,
    };
    let text = include_str!("../../../../model/paper/data/table5_measured.csv");
    let value = |name: &str| {
        let line = text.lines().find(|line| line.starts_with(name)).unwrap();
        line.split(',').nth(column).unwrap().parse().unwrap()
    };
    Measured {
        threshold_a: value("threshold_current_a"),
        saturation_a: value("saturation_current_a"),
        saturation_lpm: value("saturation_flow_lpm"),
    }
}

/// Current (A) and flow (l/min) of a valve: Table 2A of the lift valve, 2B of the lowering valve.
pub fn table_2(valve: Valve) -> &'static [(f64, f64)] {
    static LIFT: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| {
        rows(include_str!(
            "../../../../model/paper/data/table2a_lift_valve.csv"
        ))
    });
    static LOWER: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| {
        rows(include_str!(
            "../../../../model/paper/data/table2b_lower_valve.csv"
        ))
    });
    match valve {
        Valve::Lift => &LIFT,
        Valve::Lower => &LOWER,
    }
}

/// Current and flow of each row of a file.
fn rows(text: &str) -> Vec<(f64, f64)> {
    let row = |line: &str| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        (cells[0], cells[2])
    };
    text.lines()
        .filter(|line| line.starts_with(|c: char| c.is_ascii_digit()))
        .map(row)
        .collect()
}

/// Last current of a table without flow, A.
pub fn threshold_a(table: &[(f64, f64)]) -> f64 {
    let closed = table.iter().filter(|(_, flow_lpm)| *flow_lpm == 0.0);
    closed.map(|(current_a, _)| *current_a).fold(0.0, f64::max)
}

/// Largest flow of a table, l/min.
pub fn saturation_lpm(table: &[(f64, f64)]) -> f64 {
    table
        .iter()
        .map(|(_, flow_lpm)| *flow_lpm)
        .fold(0.0, f64::max)
}

/// First current of a table with the largest flow, A.
pub fn saturation_a(table: &[(f64, f64)]) -> f64 {
    let full_lpm = saturation_lpm(table);
    let open = table.iter().filter(|(_, flow_lpm)| *flow_lpm == full_lpm);
    open.map(|(current_a, _)| *current_a)
        .fold(f64::INFINITY, f64::min)
}
