//! Unknowns of a fit of the base model, and the tolerances of data sheets.

use hitch_model_file::Valve;
use hitch_plant::units::{M3_S_PER_LPM, PA_PER_BAR};
use hitch_plant::{Constants, Dynamics};

/// Tolerance of a threshold current, A, one sigma: coil, spring and overlap vary between valves.
pub const THRESHOLD_SIGMA_A: f64 = 0.05;

/// A constant with its tolerance.
#[derive(Debug)]
pub struct Scalar {
    /// Its name in a model file, `table.key`.
    pub name: &'static str,
    /// Display unit of the key.
    pub unit: &'static str,
    /// One unit of the key in SI.
    pub si: f64,
    /// Standard deviation of its logarithm: tolerance of the data sheet or the drawing.
    pub tolerance: f64,
    /// Whether only the dynamic model uses it.
    pub dynamic: bool,
    /// Whether it is identifiable separately from all others.
    pub separable: bool,
    /// Accessor of the constant in the model, in SI.
    pub place: fn(&mut Constants) -> &mut f64,
}

/// The constants that a fit estimates. Tolerances: pump with efficiency 5 %, springs 10 % to 20 %, bore 2 %, weight of
/// the links 10 %, lengths 1 %; lag, stiffness and friction are rarely stated and may be off by a third and more.
///
/// The cracking pressure only affects the flow of the lift valve, whose flow curve can compensate any value.
#[rustfmt::skip]
pub static SCALARS: [Scalar; 13] = [
    Scalar { name: "pump.theoretical_flow_lpm", unit: "l/min", si: M3_S_PER_LPM, tolerance: 0.05, dynamic: false, separable: true, place: |c| &mut c.pump.theoretical_flow_m3_s },
    Scalar { name: "pump.standby_pressure_bar", unit: "bar", si: PA_PER_BAR, tolerance: 0.1, dynamic: false, separable: true, place: |c| &mut c.pump.standby_pressure_pa },
    Scalar { name: "pump.response_time_ms", unit: "ms", si: 1e-3, tolerance: 0.3, dynamic: true, separable: true, place: |c| &mut c.pump.response_time_s },
    Scalar { name: "relief_valve.set_pressure_bar", unit: "bar", si: PA_PER_BAR, tolerance: 0.1, dynamic: false, separable: true, place: |c| &mut c.relief_valve.set_pressure_pa },
    Scalar { name: "compensator.margin_bar", unit: "bar", si: PA_PER_BAR, tolerance: 0.15, dynamic: false, separable: true, place: |c| &mut c.compensator.margin_pa },
    Scalar { name: "check_valve.cracking_pressure_bar", unit: "bar", si: PA_PER_BAR, tolerance: 0.2, dynamic: false, separable: false, place: |c| &mut c.check_valve.cracking_pressure_pa },
    Scalar { name: "cylinder.bore_mm", unit: "mm", si: 1e-3, tolerance: 0.02, dynamic: false, separable: true, place: |c| &mut c.cylinder.bore_m },
    Scalar { name: "linkage.rocker_arm_m", unit: "m", si: 1.0, tolerance: 0.01, dynamic: false, separable: true, place: |c| &mut c.linkage.rocker_arm_m },
    Scalar { name: "linkage.connecting_rod_m", unit: "m", si: 1.0, tolerance: 0.01, dynamic: false, separable: true, place: |c| &mut c.linkage.connecting_rod_m },
    Scalar { name: "masses.dead_weight_kg", unit: "kg", si: 1.0, tolerance: 0.1, dynamic: false, separable: true, place: |c| &mut c.masses.dead_weight_kg },
    Scalar { name: "spool.time_constant_ms", unit: "ms", si: 1e-3, tolerance: 0.3, dynamic: true, separable: true, place: |c| &mut c.spool_time_constant_s },
    Scalar { name: "cylinder.viscous_friction_n_s_m", unit: "N s/m", si: 1.0, tolerance: 0.5, dynamic: true, separable: true, place: |c| &mut c.cylinder.viscous_friction_n_s_m },
    Scalar { name: "oil.bulk_modulus_pa", unit: "Pa", si: 1.0, tolerance: 0.3, dynamic: true, separable: true, place: |c| &mut c.oil.bulk_modulus_pa },
];

/// Error of a sensor, an effect of the catalogue with one parameter.
#[derive(Debug)]
pub struct Sensor {
    /// The effect's identifier.
    pub effect: &'static str,
    /// Display unit.
    pub unit: &'static str,
    /// One display unit in the unit of the effect's parameter.
    pub size: f64,
    /// Tolerance in the unit of the effect's parameter, one sigma.
    pub tolerance: f64,
}

/// The sensors that a fit of the base model calibrates: a hall sensor has 1 % of gain error, a pressure sensor for
/// 250 bar an offset of 0.4 % of that. A gain of the pressure sensor is not separable from the bore, since the flow
/// curves correct any flow.
#[rustfmt::skip]
pub static SENSORS: [Sensor; 2] = [
    Sensor { effect: "angle-sensor-gain", unit: "%", size: 0.01, tolerance: 0.01 },
    Sensor { effect: "pressure-sensor-offset", unit: "bar", size: 1.0, tolerance: 1.0 },
];

/// One unknown of the fit.
#[derive(Debug, Clone, Copy)]
pub enum Parameter {
    /// Logarithm of a constant over its declared value.
    Scalar(&'static Scalar),
    /// Shift of a valve's curve along the current, A.
    Threshold(Valve),
    /// Error of a sensor beyond the declared one, in the unit of its effect.
    Sensor(&'static Sensor),
    /// Logarithm of the flow at a point of a valve's curve, by its index, over the declared one.
    Flow(Valve, usize),
}

impl Parameter {
    /// Whether it is identifiable separately from all others.
    #[must_use]
    pub fn is_separable(&self) -> bool {
        !matches!(self, Self::Scalar(scalar) if !scalar.separable)
    }

    /// Whether it is an error of a sensor.
    #[must_use]
    pub fn is_sensor(&self) -> bool {
        matches!(self, Self::Sensor(_))
    }

    /// Its name in a model file, `table.key`; `None` for a sensor, which is an effect.
    #[must_use]
    pub fn name(&self) -> Option<String> {
        match self {
            Self::Scalar(scalar) => Some(scalar.name.to_owned()),
            Self::Threshold(valve) => Some(format!("{}.current_a", valve.table())),
            Self::Flow(valve, _) => Some(format!("{}.flow_lpm", valve.table())),
            Self::Sensor(_) => None,
        }
    }

    /// Whether it belongs to a flow curve.
    #[must_use]
    pub fn is_flow(&self) -> bool {
        matches!(self, Self::Flow(..))
    }
}

/// All unknowns of a model. Constants that are zero have no logarithm and stay zero.
#[must_use]
pub fn parameters(declared: &Constants) -> Vec<Parameter> {
    let mut copy = declared.clone();
    let is_dynamic = declared.dynamics == Dynamics::Dynamic;
    let scalars = SCALARS
        .iter()
        .filter(|scalar| is_dynamic || !scalar.dynamic)
        .filter(|scalar| *(scalar.place)(&mut copy) > 0.0)
        .map(Parameter::Scalar)
        .collect::<Vec<_>>();
    let valves = [Valve::Lift, Valve::Lower];
    let thresholds = valves.map(Parameter::Threshold);
    let flows = valves.into_iter().flat_map(|valve| {
        let curve = &valve.of(declared).curve;
        let points = curve.flows_m3_s().iter().enumerate();
        let open: Vec<usize> = points
            .filter(|(_, flow)| **flow > 0.0)
            .map(|(point, _)| point)
            .collect();
        open.into_iter()
            .map(move |point| Parameter::Flow(valve, point))
    });
    scalars.into_iter().chain(thresholds).chain(flows).collect()
}
