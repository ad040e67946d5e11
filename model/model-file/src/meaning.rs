//! The meaning of each constant of a model file, and where data sheets state it.

/// Documentation of a table or a constant, for users who fill in a model file.
pub struct Meaning {
    /// Table.
    pub table: &'static str,
    /// Key; empty for the table itself.
    pub key: &'static str,
    /// Description.
    pub what: &'static str,
    /// Source in data sheets.
    pub found: &'static str,
}

const fn meaning(
    (table, key): (&'static str, &'static str),
    what: &'static str,
    found: &'static str,
) -> Meaning {
    Meaning {
        table,
        key,
        what,
        found,
    }
}

/// Tables and constants, in the order of the file.
#[rustfmt::skip]
static MEANINGS: [Meaning; 42] = [
    meaning(("pump", ""), "Fixed-displacement pump with an open-centre bypass compensator.", ""),
    meaning(("pump", "theoretical_flow_lpm"), "Displacement times speed, l/min", "Pump data sheet: displacement in cm3/rev times rev/min over 1000"),
    meaning(("pump", "volumetric_efficiency"), "Delivered over theoretical flow, no unit", "Pump data sheet: efficiency curve at working pressure; 0.85 to 0.95 is usual"),
    meaning(("relief_valve", ""), "Relief valve at the pump, ideal: no override.", ""),
    meaning(("relief_valve", "set_pressure_bar"), "Setting, bar", "Circuit diagram or the tag of the valve; check with a gauge at the end of the stroke"),
    meaning(("compensator", ""), "Bypass pressure compensator.", ""),
    meaning(("compensator", "margin_bar"), "Pump pressure over the load pressure, bar", "Valve block data sheet: margin, spring setting or standby pressure"),
    meaning(("check_valve", ""), "Load-holding check valve between lift valve and cylinder.", ""),
    meaning(("check_valve", "cracking_pressure_bar"), "Pressure at which it opens, bar", "Check valve data sheet: cracking pressure, or the type code of the spring"),
    meaning(("lift_valve", ""), "Lift valve: flow over solenoid current at a stated pressure drop.", ""),
    meaning(("lift_valve", "reference_drop_bar"), "Pressure drop at which the curve holds, bar", "Stated beside the curve; of a valve behind a compensator: margin less cracking pressure"),
    meaning(("lift_valve", "transition_drop_bar"), "Drop below which the flow turns laminar, bar", "Not on data sheets: 0.1 for a dynamic model, 0 for none"),
    meaning(("lift_valve", "current_a"), "Currents of the curve, A, rising; the last is the current limit", "Valve data sheet: flow over current; start with 0"),
    meaning(("lift_valve", "flow_lpm"), "Flows at these currents, l/min, not falling; 0 where it is shut", "The same curve"),
    meaning(("lower_valve", ""), "Lowering valve: flow over solenoid current at a stated pressure drop.", ""),
    meaning(("lower_valve", "reference_drop_bar"), "Pressure drop at which the curve holds, bar", "Stated beside the curve"),
    meaning(("lower_valve", "transition_drop_bar"), "Drop below which the flow turns laminar, bar", "Not on data sheets: 0.1 for a dynamic model, 0 for none"),
    meaning(("lower_valve", "current_a"), "Currents of the curve, A, rising; the last is the current limit", "Valve data sheet: flow over current; start with 0"),
    meaning(("lower_valve", "flow_lpm"), "Flows at these currents, l/min, not falling; 0 where it is shut", "The same curve"),
    meaning(("spool", ""), "Both spools; only a dynamic model uses it.", ""),
    meaning(("spool", "time_constant_ms"), "First-order lag behind the current, ms", "Valve data sheet: step response, time to 63 % of the stroke"),
    meaning(("cylinder", ""), "Single-acting lift cylinder; of two, the one with the same total area.", ""),
    meaning(("cylinder", "bore_mm"), "Bore, mm", "Cylinder data sheet; of two alike cylinders 1.414 times the bore"),
    meaning(("cylinder", "stroke_mm"), "Stroke, mm", "Cylinder data sheet"),
    meaning(("cylinder", "dead_volume_l"), "Oil in line and cylinder with the piston in, l", "Length and bore of line and hose; only a dynamic model uses it"),
    meaning(("cylinder", "viscous_friction_n_s_m"), "Viscous friction at the piston, N s/m", "Rarely stated; hitch model fit estimates it; only a dynamic model uses it"),
    meaning(("oil", ""), "Oil.", ""),
    meaning(("oil", "density_kg_m3"), "Density, kg/m3", "Oil data sheet, at 15 degC"),
    meaning(("oil", "bulk_modulus_pa"), "Bulk modulus of oil and line, Pa", "Oil data sheet, less for hoses and air: 1e9 to 1.5e9; only a dynamic model uses it"),
    meaning(("linkage", ""), "Linkage, from the rocker shaft; x to the rear, y up.", ""),
    meaning(("linkage", "rocker_arm_m"), "Rocker arm from shaft to connecting rod, m", "Drawing of the hitch"),
    meaning(("linkage", "lift_arm_m"), "Lift arm from shaft to lift rod, m", "Drawing of the hitch"),
    meaning(("linkage", "lift_rod_m"), "Lift rod, m", "Drawing of the hitch; measure it, it is adjustable"),
    meaning(("linkage", "lower_link_m"), "Lower link from pivot to hitch point, m", "Drawing of the hitch"),
    meaning(("linkage", "lift_rod_joint_m"), "Joint of the lift rod on the lower link, from its pivot, m", "Drawing of the hitch"),
    meaning(("linkage", "connecting_rod_m"), "Connecting rod from piston to rocker arm, m", "Drawing of the hitch"),
    meaning(("linkage", "pivot_x_m"), "Pivot of the lower link, x, m", "Drawing of the hitch"),
    meaning(("linkage", "pivot_y_m"), "Pivot of the lower link, y, m", "Drawing of the hitch"),
    meaning(("linkage", "cylinder_axis_y_m"), "Height of the cylinder axis, y, m", "Drawing of the hitch"),
    meaning(("masses", ""), "Moving masses without the load.", ""),
    meaning(("masses", "dead_weight_kg"), "Links and frame, as mass at the hitch point, kg", "Weigh the empty hitch at the hitch point"),
    meaning(("masses", "piston_kg"), "Piston and rod, kg", "Cylinder data sheet"),
];

/// The documentation of a constant, or of a table if the key is empty.
pub fn meaning_of(table: &str, key: &str) -> Option<&'static Meaning> {
    let mut all = MEANINGS.iter();
    all.find(|meaning| meaning.table == table && meaning.key == key)
}
