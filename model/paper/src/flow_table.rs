//! Table 2 computed with the model: the valve block on a flow bench, at every current of the table.

use hitch_plant::units::pa_from_bar;
use hitch_plant::{Currents, Model, Plant, Rig, Valve};

use crate::tables::{LOWER_DROP_BAR, TABLE_2A_LIFT, TABLE_2B_LOWER};

/// Pressure at the port while lifting, bar. Any value below the relief pressure is possible: the lift valve is
/// pressure-compensated.
const LIFT_PORT_BAR: f64 = 20.0;
/// Oil temperature of the tables, degrees Celsius.
const OIL_TEMPERATURE_C: f64 = 40.0;

/// One row of Table 2 with the model's flow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Solenoid current, A.
    pub current_a: f64,
    /// The table's flow, l/min.
    pub paper_lpm: f64,
    /// The model's flow, l/min.
    pub model_lpm: f64,
}

/// Table 2 of a valve: 2A of the lift valve, 2B of the lowering valve.
pub fn table_2(valve: Valve) -> &'static [(f64, f64)] {
    match valve {
        Valve::Lift => &TABLE_2A_LIFT,
        Valve::Lowering => &TABLE_2B_LOWER,
    }
}

/// Table 2 of a valve, with the flows of a model.
pub fn rows(model: &Model, valve: Valve) -> Vec<Row> {
    let row = |&(current_a, paper_lpm): &(f64, f64)| Row {
        current_a,
        paper_lpm,
        model_lpm: flow_lpm(model, valve, current_a),
    };
    table_2(valve).iter().map(row).collect()
}

/// Steady flow through a valve on the flow bench, l/min; positive in the valve's own direction.
pub fn flow_lpm(model: &Model, valve: Valve, current_a: f64) -> f64 {
    let (port_bar, lift_a, lower_a, sign) = match valve {
        Valve::Lift => (LIFT_PORT_BAR, current_a, 0.0, 1.0),
        Valve::Lowering => (LOWER_DROP_BAR, 0.0, current_a, -1.0),
    };
    let rig = Rig::Flow {
        port_pressure_pa: pa_from_bar(port_bar),
    };
    let at_rest = Plant::new(model, rig, OIL_TEMPERATURE_C, Currents { lift_a, lower_a });
    // Adding zero converts a negative zero into a positive one.
    sign * at_rest.reading().flow_lpm + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nominal_model_flows_as_table_2_says() {
        for valve in [Valve::Lift, Valve::Lowering] {
            for row in rows(&hitch_model_file::nominal(), valve) {
                assert!(
                    (row.model_lpm - row.paper_lpm).abs() < 1e-6,
                    "{valve:?} {row:?}"
                );
            }
        }
    }
}
