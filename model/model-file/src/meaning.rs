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
static MEANINGS: [Meaning; 61] = [
    meaning(("pump", ""), "Pump at constant speed.", ""),
    meaning(("pump", "kind"), "\"fixed-displacement\" with a bypass compensator, or \"load-sensing\": of variable displacement", "Circuit diagram: a pump with an arrow through it and a load-sensing line is load-sensing"),
    meaning(("pump", "theoretical_flow_lpm"), "Largest displacement times speed, l/min", "Pump data sheet: displacement in cm3/rev times rev/min over 1000"),
    meaning(("pump", "volumetric_efficiency"), "Delivered over theoretical flow, no unit", "Pump data sheet: efficiency curve at working pressure; 0.85 to 0.95 is usual"),
    meaning(("pump", "standby_pressure_bar"), "Pump pressure while no valve asks for oil, bar", "Pump data sheet: standby pressure; a gauge shows it at idle"),
    meaning(("pump", "response_time_ms"), "Time constant of the pump pressure, ms", "Pump data sheet: time to 63 % of the stroke, 30 to 100 ms; only a dynamic model uses it"),
    meaning(("relief_valve", ""), "Relief valve at the pump, or pressure limiter of a load-sensing pump.", ""),
    meaning(("relief_valve", "set_pressure_bar"), "Setting, bar", "Circuit diagram or the tag of the valve; check with a gauge at the end of the stroke"),
    meaning(("compensator", ""), "Bypass pressure compensator, or controller of a load-sensing pump.", ""),
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
    meaning(("solenoid", ""), "Solenoid of either valve; the closed loop and the regulation of the currents use it. The table may be left out.", ""),
    meaning(("solenoid", "resistance_ohm"), "Resistance of the coil at 20 degC with wiring and driver, ohm", "Valve data sheet: resistance of the coil, or rated voltage over rated current; add 0.2 to 0.5 ohm for wiring and driver"),
    meaning(("solenoid", "inductance_mh"), "Inductance of the coil, mH", "Rarely stated; time constant of a current step times the resistance"),
    meaning(("spool", ""), "Both spools; only a dynamic model uses it.", ""),
    meaning(("spool", "time_constant_ms"), "First-order lag behind the current, ms", "Valve data sheet: step response, time to 63 % of the stroke"),
    meaning(("cylinder", ""), "Single-acting lift cylinders.", ""),
    meaning(("cylinder", "cylinders"), "Number of cylinders in parallel", "Drawing of the hitch; most tractors from category III on have 2"),
    meaning(("cylinder", "bore_mm"), "Bore, mm", "Cylinder data sheet; that of each"),
    meaning(("cylinder", "stroke_mm"), "Stroke, mm", "Cylinder data sheet"),
    meaning(("cylinder", "dead_volume_l"), "Oil in lines and cylinders with the pistons in, l", "Length and bore of line and hose; only a dynamic model uses it"),
    meaning(("cylinder", "viscous_friction_n_s_m"), "Viscous friction at all pistons, N s/m", "Rarely stated; hitch model fit estimates it; only a dynamic model uses it"),
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
    meaning(("linkage", "stroke_mm"), "Travels of the piston, mm, from 0 to the stroke, rising", "Measured on the machine"),
    meaning(("linkage", "angle_deg"), "Angles of the rocker shaft at these travels, degree, rising", "Measured with the angle sensor"),
    meaning(("linkage", "height_mm"), "Heights of the hitch point at these travels, mm, rising", "Measured from the ground"),
    meaning(("masses", ""), "Moving masses without the load.", ""),
    meaning(("masses", "dead_weight_kg"), "Links and frame, as mass at the hitch point, kg", "Weigh the empty hitch at the hitch point"),
    meaning(("masses", "piston_kg"), "All pistons and rods, kg", "Cylinder data sheet"),
    meaning(("loads", ""), "Loads with which loop and tune try the controller. 0: from the relief setting. The table may be left out.", ""),
    meaning(("loads", "light_kg"), "A light implement at the hitch point, kg", "Data sheets of the implements"),
    meaning(("loads", "usual_kg"), "The most common implement, kg", "Data sheets of the implements"),
    meaning(("loads", "heavy_kg"), "The heaviest implement, kg", "Data sheets of the implements, or the lift capacity of the hitch"),
    meaning(("sensors", ""), "Noise of the sensors, one sigma, in the closed loop. The table may be left out.", ""),
    meaning(("sensors", "rocker_angle_noise_deg"), "Rocker angle, degree", "Standard deviation of a log at rest"),
    meaning(("sensors", "cylinder_pressure_noise_bar"), "Cylinder pressure, bar", "Standard deviation of a log at rest"),
    meaning(("sensors", "pump_pressure_noise_bar"), "Pump pressure, bar", "Standard deviation of a log at rest"),
    meaning(("sensors", "current_noise_a"), "Measured current of a coil, A", "Standard deviation of a log of a constant current"),
];

/// The documentation of a constant, or of a table if the key is empty.
pub fn meaning_of(table: &str, key: &str) -> Option<&'static Meaning> {
    let mut all = MEANINGS.iter();
    all.find(|meaning| meaning.table == table && meaning.key == key)
}
