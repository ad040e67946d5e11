//! Data sheet of the rig. It repeats the values of the model on purpose, so that a wrong constant is not in both
//! plants.

use std::sync::LazyLock;

use crate::polyline::value_at;

/// Pascal in a bar.
pub const BAR: f64 = 1e5;
/// m3/s in a litre per minute.
pub const LPM: f64 = 1e-3 / 60.0;
/// Standard gravity, m/s2.
pub const GRAVITY_M_S2: f64 = 9.806_65;
/// Piston area of the 7.6 cm bore, m2.
pub const AREA_M2: f64 = std::f64::consts::PI * 0.076 * 0.076 / 4.0;
/// Stroke, m.
pub const STROKE_M: f64 = 0.158;
/// Oil behind the piston at zero travel, m3.
pub const DEAD_VOLUME_M3: f64 = 0.3e-3;
/// Bulk modulus of the oil without air, Pa.
pub const BULK_MODULUS_PA: f64 = 1.2e9;
/// Links and frame, as mass at the hitch point, kg.
pub const DEAD_WEIGHT_KG: f64 = 30.0;
/// Piston and rod, kg.
pub const PISTON_KG: f64 = 20.0;
/// Viscous friction that the dynamic rig is known to have, N s/m.
pub const KNOWN_VISCOUS_N_S_M: f64 = 12_000.0;
/// Spool lag that the dynamic rig is known to have, s.
pub const KNOWN_SPOOL_LAG_S: f64 = 0.045;
/// Net flow of the pump, m3/s.
pub const PUMP_M3_S: f64 = 54.5 * 0.88 * LPM;
/// Margin that the pressure compensator keeps, Pa.
pub const MARGIN_PA: f64 = 4.0 * BAR;
/// Cracking pressure of the check valve, Pa.
pub const CRACKING_PA: f64 = 2.5 * BAR;
/// Relief setting, Pa.
pub const RELIEF_PA: f64 = 154.0 * BAR;
/// Drop at which the lift valve's table holds, Pa.
pub const LIFT_REFERENCE_PA: f64 = 1.5 * BAR;
/// Drop at which the lowering valve's table holds, Pa.
pub const LOWER_REFERENCE_PA: f64 = 15.0 * BAR;
/// Density of the oil, kg/m3.
pub const DENSITY_KG_M3: f64 = 877.3;
/// Spool travel over current, m/A.
pub const SPOOL_M_PER_A: f64 = 4e-3;
/// Vacuum, Pa gauge.
pub const VACUUM_PA: f64 = -BAR;

/// Kinematic viscosity of SAE 30, m2/s, by Walther's equation.
#[must_use]
pub fn viscosity_m2_s(oil_temperature_c: f64) -> f64 {
    let exponent = 9.1898 - 3.5632 * (oil_temperature_c + 273.15).log10();
    (10f64.powf(10f64.powf(exponent)) - 0.7) * 1e-6
}

/// A valve's flow over current.
#[derive(Debug)]
pub struct FlowTable {
    points: Vec<(f64, f64)>,
    /// Last current without flow, A.
    pub threshold_a: f64,
}

impl FlowTable {
    fn read(csv: &str) -> Self {
        let points: Vec<(f64, f64)> = csv
            .lines()
            .filter(|line| line.starts_with(|c: char| c.is_ascii_digit()))
            .map(|line| {
                let cells: Vec<f64> = line
                    .split(',')
                    .map(|cell| cell.trim().parse().expect("a number in a shipped table"))
                    .collect();
                (cells[0], cells[2] * LPM)
            })
            .collect();
        let threshold_a = points
            .iter()
            .filter(|point| point.1 == 0.0)
            .map(|point| point.0)
            .fold(0.0, f64::max);
        Self {
            points,
            threshold_a,
        }
    }

    /// Flow at the reference drop, m3/s.
    #[must_use]
    pub fn flow_m3_s(&self, current_a: f64) -> f64 {
        value_at(&self.points, current_a)
    }
}

/// Table 2A of the paper.
pub static LIFT_TABLE: LazyLock<FlowTable> = LazyLock::new(|| {
    FlowTable::read(include_str!(
        "../../../../model/paper/data/table2a_lift_valve.csv"
    ))
});

/// Table 2B of the paper.
pub static LOWER_TABLE: LazyLock<FlowTable> = LazyLock::new(|| {
    FlowTable::read(include_str!(
        "../../../../model/paper/data/table2b_lower_valve.csv"
    ))
});
