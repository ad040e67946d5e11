//! Comparison of the paper with the model: the data of `hitch paper`.
mod show;
mod table_5;

use hitch_paper::check_valve::Spring;
use hitch_paper::travel_time::Panel;
use hitch_paper::{flow_table, orifice_area, tables, travel_time};
use hitch_plant::{Model, Valve};
use schemars::JsonSchema;
use serde::Serialize;

use crate::progress::Progress;

pub use table_5::Table5;

/// Port diameters for which the spring of equation 7 is computed, m; assumed, as the paper states none.
const PORT_DIAMETERS_M: [f64; 3] = [0.008, 0.010, 0.012];
/// Compression of that spring, m; assumed.
const COMPRESSION_M: f64 = 0.005;

/// The paper's results and the model's.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Paper {
    /// Name of the model.
    pub model: String,
    /// Tables 2A and 2B with the areas estimated from them.
    pub table_2: [FlowTable; 2],
    /// Largest estimated orifice area (section 4.1).
    pub orifice_area: LargestArea,
    /// Table 5, identified from the paper's flow test.
    pub table_5: Table5,
    /// Equation 7.
    pub check_valve: CheckValve,
    /// Figure 12.
    pub figure_12: Figure12,
}

/// Table 2 of one valve.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct FlowTable {
    /// `lift` or `lower`.
    pub valve: &'static str,
    /// Pressure drop of the orifice, bar.
    pub drop_bar: f64,
    /// The table's rows.
    pub rows: Vec<FlowRow>,
    /// Greatest difference between paper and model, l/min.
    pub largest_difference_lpm: f64,
}

/// One row of Table 2.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct FlowRow {
    /// Solenoid current, A.
    pub current_a: f64,
    /// The paper's flow, l/min.
    pub paper_lpm: f64,
    /// The model's flow, l/min.
    pub model_lpm: f64,
    /// Orifice area estimated from the paper's flow, mm2.
    pub area_mm2: f64,
}

/// The largest estimated area.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct LargestArea {
    /// Value of the paper, mm2.
    pub paper_mm2: f64,
    /// Value of this model, mm2.
    pub model_mm2: f64,
    /// `model_mm2 / paper_mm2 - 1`.
    pub relative_difference: f64,
}

/// The check valve's cracking pressure.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct CheckValve {
    /// Value of the paper, bar.
    pub paper_bar: f64,
    /// Value of the model, bar.
    pub model_bar: f64,
    /// Springs that satisfy equation 7.
    pub springs: Vec<SpringRow>,
}

/// A spring that satisfies the cracking pressure.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SpringRow {
    /// Diameter of the port, mm.
    pub port_diameter_mm: f64,
    /// Compression with the valve seated, mm.
    pub compression_mm: f64,
    /// Stiffness, N/mm.
    pub stiffness_n_mm: f64,
    /// Equation 7 with these values, bar.
    pub cracking_pressure_bar: f64,
}

/// Figure 12: times of travel, with the paper's statements on them.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Figure12 {
    /// Figure 12A.
    pub lifting: Travel,
    /// Figure 12B.
    pub lowering: Travel,
    /// The paper's statements.
    pub statements: Vec<Statement>,
}

/// One panel of Figure 12.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Travel {
    /// Currents, A: the rows.
    pub currents_a: [f64; 5],
    /// Loads, kg: the columns.
    pub loads_kg: [f64; 5],
    /// Times, s; `null` if the end is not reached.
    pub times_s: [[Option<f64>; 5]; 5],
}

/// A statement of the paper.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Statement {
    /// The statement, with its section.
    pub paper: &'static str,
    /// The result of the model.
    pub model: String,
    /// Whether they agree.
    pub holds: bool,
}

impl Paper {
    /// Computes everything from a model.
    pub fn of(model: &Model, progress: &Progress) -> Self {
        let lift = flow_table(model, Valve::Lift);
        let lower = flow_table(model, Valve::Lowering);
        Self {
            model: model.name.clone(),
            orifice_area: largest_area(&[&lift, &lower]),
            table_2: [lift, lower],
            table_5: Table5::of(model, progress),
            check_valve: check_valve(model),
            figure_12: figure_12(model),
        }
    }
}

fn flow_table(model: &Model, valve: Valve) -> FlowTable {
    let (name, drop_bar) = match valve {
        Valve::Lift => ("lift", tables::LIFT_DROP_BAR),
        Valve::Lowering => ("lower", tables::LOWER_DROP_BAR),
    };
    let areas_mm2 = orifice_area::estimate_mm2(flow_table::table_2(valve), drop_bar);
    let rows: Vec<FlowRow> = flow_table::rows(model, valve)
        .into_iter()
        .zip(areas_mm2)
        .map(|(row, area_mm2)| FlowRow {
            current_a: row.current_a,
            paper_lpm: row.paper_lpm,
            model_lpm: row.model_lpm,
            area_mm2,
        })
        .collect();
    let difference = |row: &FlowRow| (row.model_lpm - row.paper_lpm).abs();
    let largest_difference_lpm = rows.iter().map(difference).fold(0.0, f64::max);
    FlowTable {
        valve: name,
        drop_bar,
        rows,
        largest_difference_lpm,
    }
}

fn largest_area(flow_tables: &[&FlowTable]) -> LargestArea {
    let areas = flow_tables
        .iter()
        .flat_map(|table| &table.rows)
        .map(|row| row.area_mm2);
    let model_mm2 = areas.fold(0.0, f64::max);
    let paper_mm2 = tables::LARGEST_AREA_MM2;
    LargestArea {
        paper_mm2,
        model_mm2,
        relative_difference: model_mm2 / paper_mm2 - 1.0,
    }
}

fn check_valve(model: &Model) -> CheckValve {
    let row = |port_diameter_m: f64| {
        let spring = Spring::for_port(port_diameter_m, COMPRESSION_M);
        SpringRow {
            port_diameter_mm: port_diameter_m * 1e3,
            compression_mm: spring.compression_m * 1e3,
            stiffness_n_mm: spring.stiffness_n_m * 1e-3,
            cracking_pressure_bar: spring.cracking_pressure_bar(),
        }
    };
    CheckValve {
        paper_bar: tables::CRACKING_PRESSURE_BAR,
        model_bar: hitch_plant::units::bar_from_pa(
            model.constants().check_valve.cracking_pressure_pa,
        ),
        springs: PORT_DIAMETERS_M.map(row).to_vec(),
    }
}

fn figure_12(model: &Model) -> Figure12 {
    let lifting = travel_time::panel(model, Valve::Lift);
    let lowering = travel_time::panel(model, Valve::Lowering);
    let statements = statements(&lifting, &lowering);
    Figure12 {
        lifting: lifting.into(),
        lowering: lowering.into(),
        statements,
    }
}

fn statements(lifting: &Panel, lowering: &Panel) -> Vec<Statement> {
    let spread = lifting.spread_over_load();
    let yes_or_no = |holds: bool| if holds { "true at every one" } else { "false" }.to_owned();
    vec![
        Statement {
            paper: "lifting time does not depend on load (4.3)",
            model: spread.map_or("a lift never ends".to_owned(), |share| {
                format!("spread {:.3} %", 100.0 * share)
            }),
            holds: spread.is_some_and(|share| share < 0.01),
        },
        Statement {
            paper: "lowering time falls with load (4.3)",
            model: yes_or_no(lowering.falls_with_load()),
            holds: lowering.falls_with_load(),
        },
        Statement {
            paper: "lowering time falls with current (4.3)",
            model: yes_or_no(lowering.falls_with_current()),
            holds: lowering.falls_with_current(),
        },
    ]
}

impl From<Panel> for Travel {
    fn from(panel: Panel) -> Self {
        Self {
            currents_a: panel.currents_a,
            loads_kg: panel.loads_kg,
            times_s: panel.times_s,
        }
    }
}
