//! The constants of a model file: table, key, unit and range of each.

use std::ops::RangeInclusive;

use hitch_plant::units::{M3_S_PER_LPM, PA_PER_BAR};
use hitch_plant::{
    CheckValve, Compensator, Constants, Cylinder, Dynamics, LinkageDimensions, Masses, Oil,
    OrificeValve, Pump, PumpKind, ReliefValve, SensorNoise, Solenoid, UsualLoads, ValveCurve,
};

const M3_PER_L: f64 = 1e-3;
const H_PER_MH: f64 = 1e-3;
const S_PER_MS: f64 = 1e-3;
/// Metre in a millimetre.
pub const M_PER_MM: f64 = 1e-3;
/// Radian in a degree.
pub const RAD_PER_DEG: f64 = std::f64::consts::PI / 180.0;

/// Ends of keys, and the unit that each stands for.
const UNITS: [(&str, &str); 10] = [
    ("_n_s_m", "N s/m"),
    ("_kg_m3", "kg/m3"),
    ("_lpm", "l/min"),
    ("_bar", "bar"),
    ("_pa", "Pa"),
    ("_ms", "ms"),
    ("_mm", "mm"),
    ("_kg", "kg"),
    ("_l", "l"),
    ("_m", "m"),
];

/// The machines that have a constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Had {
    /// All.
    Always,
    /// Those with a load-sensing pump.
    LoadSensing,
    /// Those whose linkage is not measured.
    Dimensions,
}

/// How well a data sheet or a drawing states a constant that a fit estimates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Standard deviation of its logarithm.
    pub sigma: f64,
    /// Which fits estimate it.
    pub role: Role,
}

/// Which fits estimate a constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Every fit.
    Usual,
    /// Those of the dynamic model, which alone uses it.
    Dynamic,
    /// Every fit, but it is not identifiable separately from the others.
    Inseparable,
}

/// A constant of a model file.
#[derive(Debug)]
pub struct Constant {
    /// Its table.
    pub table: &'static str,
    /// Key, including the unit.
    pub key: &'static str,
    /// Size of the key's unit in SI.
    pub unit: f64,
    /// Allowed range, in the unit of the key.
    pub range: RangeInclusive<f64>,
    /// Accessor in the model, in SI.
    pub place: fn(&mut Constants) -> &mut f64,
    /// The machines that have it.
    pub had: Had,
    /// Its tolerance, if a fit estimates it.
    pub tolerance: Option<Tolerance>,
}

/// The variants of a machine, on which its constants depend.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Variant {
    /// Whether its pump is load-sensing.
    pub load_sensing: bool,
    /// Whether its linkage is measured.
    pub measured_linkage: bool,
}

impl Variant {
    /// The variant of a machine.
    pub fn of(constants: &Constants) -> Self {
        Self {
            load_sensing: constants.pump.kind == PumpKind::LoadSensing,
            measured_linkage: constants.linkage_table.is_some(),
        }
    }

    /// Whether the machine has a constant.
    pub fn has(self, constant: &Constant) -> bool {
        match constant.had {
            Had::Always => true,
            Had::LoadSensing => self.load_sensing,
            Had::Dimensions => !self.measured_linkage,
        }
    }

    /// Its constants, in the order of the file.
    pub fn constants(self) -> impl Iterator<Item = &'static Constant> {
        CONSTANTS.iter().filter(move |constant| self.has(constant))
    }

    /// The constants of a table.
    pub fn constants_of(self, table: &str) -> impl Iterator<Item = &'static Constant> {
        self.constants()
            .filter(move |constant| constant.table == table)
    }

    /// The keys of a table, with those that choose a variant.
    pub fn keys(self, table: &str) -> Vec<&'static str> {
        let curve = CURVES.iter().any(|curve| curve.table == table);
        let more: &[&'static str] = match table {
            "pump" => &[KIND],
            "cylinder" => &[CYLINDERS],
            "linkage" if self.measured_linkage => &LINKAGE_COLUMNS,
            _ if curve => &[CURRENT, FLOW],
            _ => &[],
        };
        let numbers = self.constants_of(table).map(|constant| constant.key);
        match table {
            "pump" | "cylinder" => more.iter().copied().chain(numbers).collect(),
            _ => numbers.chain(more.iter().copied()).collect(),
        }
    }
}

/// The constants that a fit estimates, with their tolerances.
pub fn fitted_constants() -> impl Iterator<Item = (&'static Constant, Tolerance)> {
    let constants = CONSTANTS.iter();
    constants.filter_map(|constant| Some((constant, constant.tolerance?)))
}

/// Sets constants that the machine does not have to zero.
pub fn clear_others(constants: &mut Constants) {
    let variant = Variant::of(constants);
    for constant in CONSTANTS.iter().filter(|constant| !variant.has(constant)) {
        *(constant.place)(constants) = 0.0;
    }
}

/// Key of the kind of a pump.
pub const KIND: &str = "kind";
/// The kinds of pumps, as written.
pub const KINDS: [(&str, PumpKind); 2] = [
    ("fixed-displacement", PumpKind::FixedDisplacement),
    ("load-sensing", PumpKind::LoadSensing),
];
/// Key of the number of cylinders.
pub const CYLINDERS: &str = "cylinders";
/// Range of the number of cylinders.
pub const CYLINDER_COUNT: RangeInclusive<f64> = 1.0..=4.0;
/// Keys of a measured linkage: travel, angle, height.
pub const LINKAGE_COLUMNS: [&str; 3] = ["stroke_mm", "angle_deg", "height_mm"];

/// A valve's flow curve.
pub struct Curve {
    /// Its table.
    pub table: &'static str,
    /// Accessor in the model.
    pub place: fn(&mut Constants) -> &mut OrificeValve,
}

/// Key of the currents of a flow curve, A.
pub const CURRENT: &str = "current_a";
/// Key of the flows of a flow curve, l/min.
pub const FLOW: &str = "flow_lpm";

/// All flow curves.
pub const CURVES: [Curve; 2] = [
    Curve {
        table: "lift_valve",
        place: |c| &mut c.lift_valve,
    },
    Curve {
        table: "lower_valve",
        place: |c| &mut c.lower_valve,
    },
];

/// Tables, in the order of the file.
pub const TABLES: [&str; 14] = [
    "pump",
    "relief_valve",
    "compensator",
    "check_valve",
    "lift_valve",
    "lower_valve",
    "solenoid",
    "spool",
    "cylinder",
    "oil",
    "linkage",
    "masses",
    "loads",
    "sensors",
];

const fn constant(
    (table, key): (&'static str, &'static str),
    unit: f64,
    range: RangeInclusive<f64>,
    place: fn(&mut Constants) -> &mut f64,
) -> Constant {
    Constant {
        table,
        key,
        unit,
        range,
        place,
        had: Had::Always,
        tolerance: None,
    }
}

impl Constant {
    const fn only(self, had: Had) -> Self {
        Self { had, ..self }
    }

    /// A constant that a fit estimates, with the standard deviation of its logarithm.
    const fn within(self, sigma: f64, role: Role) -> Self {
        let tolerance = Some(Tolerance { sigma, role });
        Self { tolerance, ..self }
    }

    /// Its name, `table.key`.
    #[must_use]
    pub fn name(&self) -> String {
        format!("{}.{}", self.table, self.key)
    }

    /// The unit of its key; empty for a pure number.
    #[must_use]
    pub fn unit_text(&self) -> &'static str {
        let unit = UNITS.iter().find(|(end, _)| self.key.ends_with(end));
        unit.map_or("", |(_, unit)| unit)
    }
}

/// All constants except the flow curves.
///
/// Tolerances: pump with efficiency 5 %, springs 10 % to 20 %, bore 2 %, weight of the links 10 %, lengths 1 %; lag, stiffness and
/// friction are rarely stated and may be off by a third and more. The cracking pressure only affects the flow of the lift valve,
/// whose flow curve can compensate any value.
#[rustfmt::skip]
pub static CONSTANTS: [Constant; 38] = [
    constant(("pump", "theoretical_flow_lpm"), M3_S_PER_LPM, 0.1..=1000.0, |c| &mut c.pump.theoretical_flow_m3_s).within(0.05, Role::Usual),
    constant(("pump", "volumetric_efficiency"), 1.0, 0.01..=1.0, |c| &mut c.pump.volumetric_efficiency),
    constant(("pump", "standby_pressure_bar"), PA_PER_BAR, 0.1..=300.0, |c| &mut c.pump.standby_pressure_pa).only(Had::LoadSensing).within(0.1, Role::Usual),
    constant(("pump", "response_time_ms"), S_PER_MS, 0.0..=1000.0, |c| &mut c.pump.response_time_s).only(Had::LoadSensing).within(0.3, Role::Dynamic),
    constant(("relief_valve", "set_pressure_bar"), PA_PER_BAR, 1.0..=1000.0, |c| &mut c.relief_valve.set_pressure_pa).within(0.1, Role::Usual),
    constant(("compensator", "margin_bar"), PA_PER_BAR, 0.1..=100.0, |c| &mut c.compensator.margin_pa).within(0.15, Role::Usual),
    constant(("check_valve", "cracking_pressure_bar"), PA_PER_BAR, 0.0..=100.0, |c| &mut c.check_valve.cracking_pressure_pa).within(0.2, Role::Inseparable),
    constant(("lift_valve", "reference_drop_bar"), PA_PER_BAR, 0.01..=500.0, |c| &mut c.lift_valve.reference_drop_pa),
    constant(("lift_valve", "transition_drop_bar"), PA_PER_BAR, 0.0..=10.0, |c| &mut c.lift_valve.transition_drop_pa),
    constant(("lower_valve", "reference_drop_bar"), PA_PER_BAR, 0.01..=500.0, |c| &mut c.lower_valve.reference_drop_pa),
    constant(("lower_valve", "transition_drop_bar"), PA_PER_BAR, 0.0..=10.0, |c| &mut c.lower_valve.transition_drop_pa),
    constant(("solenoid", "resistance_ohm"), 1.0, 0.5..=20.0, |c| &mut c.solenoid.resistance_ohm),
    constant(("solenoid", "inductance_mh"), H_PER_MH, 0.5..=100.0, |c| &mut c.solenoid.inductance_h),
    constant(("spool", "time_constant_ms"), S_PER_MS, 0.0..=10_000.0, |c| &mut c.spool_time_constant_s).within(0.3, Role::Dynamic),
    constant(("cylinder", "bore_mm"), M_PER_MM, 5.0..=1000.0, |c| &mut c.cylinder.bore_m).within(0.02, Role::Usual),
    constant(("cylinder", "stroke_mm"), M_PER_MM, 5.0..=5000.0, |c| &mut c.cylinder.stroke_m),
    constant(("cylinder", "dead_volume_l"), M3_PER_L, 0.001..=100.0, |c| &mut c.cylinder.dead_volume_m3),
    constant(("cylinder", "viscous_friction_n_s_m"), 1.0, 0.0..=1e7, |c| &mut c.cylinder.viscous_friction_n_s_m).within(0.5, Role::Dynamic),
    constant(("oil", "density_kg_m3"), 1.0, 500.0..=1500.0, |c| &mut c.oil.density_kg_m3),
    constant(("oil", "bulk_modulus_pa"), 1.0, 1e7..=1e10, |c| &mut c.oil.bulk_modulus_pa).within(0.3, Role::Dynamic),
    constant(("linkage", "rocker_arm_m"), 1.0, 0.01..=10.0, |c| &mut c.linkage.rocker_arm_m).only(Had::Dimensions).within(0.01, Role::Usual),
    constant(("linkage", "lift_arm_m"), 1.0, 0.01..=10.0, |c| &mut c.linkage.lift_arm_m).only(Had::Dimensions),
    constant(("linkage", "lift_rod_m"), 1.0, 0.01..=10.0, |c| &mut c.linkage.lift_rod_m).only(Had::Dimensions),
    constant(("linkage", "lower_link_m"), 1.0, 0.01..=10.0, |c| &mut c.linkage.lower_link_m).only(Had::Dimensions),
    constant(("linkage", "lift_rod_joint_m"), 1.0, 0.01..=10.0, |c| &mut c.linkage.lift_rod_joint_m).only(Had::Dimensions),
    constant(("linkage", "connecting_rod_m"), 1.0, 0.01..=10.0, |c| &mut c.linkage.connecting_rod_m).only(Had::Dimensions).within(0.01, Role::Usual),
    constant(("linkage", "pivot_x_m"), 1.0, -10.0..=10.0, |c| &mut c.linkage.pivot_x_m).only(Had::Dimensions),
    constant(("linkage", "pivot_y_m"), 1.0, -10.0..=10.0, |c| &mut c.linkage.pivot_y_m).only(Had::Dimensions),
    constant(("linkage", "cylinder_axis_y_m"), 1.0, -10.0..=10.0, |c| &mut c.linkage.cylinder_axis_y_m).only(Had::Dimensions),
    constant(("masses", "dead_weight_kg"), 1.0, 0.0..=10_000.0, |c| &mut c.masses.dead_weight_kg).within(0.1, Role::Usual),
    constant(("masses", "piston_kg"), 1.0, 0.1..=10_000.0, |c| &mut c.masses.piston_kg),
    constant(("loads", "light_kg"), 1.0, 0.0..=20_000.0, |c| &mut c.usual_loads.light_kg),
    constant(("loads", "usual_kg"), 1.0, 0.0..=20_000.0, |c| &mut c.usual_loads.usual_kg),
    constant(("loads", "heavy_kg"), 1.0, 0.0..=20_000.0, |c| &mut c.usual_loads.heavy_kg),
    constant(("sensors", "rocker_angle_noise_deg"), 1.0, 0.0..=5.0, |c| &mut c.sensor_noise.rocker_angle_deg),
    constant(("sensors", "cylinder_pressure_noise_bar"), 1.0, 0.0..=10.0, |c| &mut c.sensor_noise.cylinder_pressure_bar),
    constant(("sensors", "pump_pressure_noise_bar"), 1.0, 0.0..=10.0, |c| &mut c.sensor_noise.pump_pressure_bar),
    constant(("sensors", "current_noise_a"), 1.0, 0.0..=0.1, |c| &mut c.sensor_noise.current_a),
];

/// Constants before reading: NaN, so that a missing one is detected, except for those that a file need not state:
/// solenoid, loads and sensors.
pub fn unset() -> Constants {
    const UNSET: f64 = f64::NAN;
    let valve = || OrificeValve {
        curve: ValveCurve::shut(),
        reference_drop_pa: UNSET,
        transition_drop_pa: UNSET,
    };
    Constants {
        dynamics: Dynamics::Steady,
        pump: Pump {
            theoretical_flow_m3_s: UNSET,
            volumetric_efficiency: UNSET,
            kind: PumpKind::FixedDisplacement,
            standby_pressure_pa: UNSET,
            response_time_s: UNSET,
        },
        relief_valve: ReliefValve {
            set_pressure_pa: UNSET,
        },
        compensator: Compensator { margin_pa: UNSET },
        check_valve: CheckValve {
            cracking_pressure_pa: UNSET,
        },
        lift_valve: valve(),
        lower_valve: valve(),
        solenoid: Solenoid::default(),
        spool_time_constant_s: UNSET,
        cylinder: Cylinder {
            count: 1,
            bore_m: UNSET,
            stroke_m: UNSET,
            dead_volume_m3: UNSET,
            viscous_friction_n_s_m: UNSET,
        },
        oil: Oil {
            density_kg_m3: UNSET,
            bulk_modulus_pa: UNSET,
        },
        linkage: LinkageDimensions {
            rocker_arm_m: UNSET,
            lift_arm_m: UNSET,
            lift_rod_m: UNSET,
            lower_link_m: UNSET,
            lift_rod_joint_m: UNSET,
            connecting_rod_m: UNSET,
            pivot_x_m: UNSET,
            pivot_y_m: UNSET,
            cylinder_axis_y_m: UNSET,
        },
        linkage_table: None,
        masses: Masses {
            dead_weight_kg: UNSET,
            piston_kg: UNSET,
        },
        usual_loads: UsualLoads::default(),
        sensor_noise: SensorNoise::default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_names_every_constant() {
        let mut constants = unset();
        for constant in &CONSTANTS {
            *(constant.place)(&mut constants) = 0.0;
        }
        let shown = format!("{constants:?}");
        assert!(!shown.contains("NaN"), "{shown}");
    }
}
