//! Values of the machine: those of its data sheets, and those that differ from them.

use crate::polyline::value_at;

pub use crate::second_rig::data_sheet::{BAR, GRAVITY_M_S2, LPM};

/// Bore of each of the two cylinders, mm.
pub const BORE_MM: f64 = 90.0;
/// Area of both, m2.
pub const AREA_M2: f64 = 2.0 * std::f64::consts::PI * 0.045 * 0.045;
/// Stroke, m.
pub const STROKE_M: f64 = 0.2;
/// Oil behind the pistons at zero travel, m3.
pub const DEAD_VOLUME_M3: f64 = 0.6e-3;
/// Bulk modulus of oil and hoses, Pa.
pub const BULK_MODULUS_PA: f64 = 1.1e9;
/// Pistons and rods, kg.
pub const PISTON_KG: f64 = 40.0;
/// Viscous friction at the pistons, N s/m.
pub const VISCOUS_N_S_M: f64 = 30_000.0;

/// Displacement times speed of the pump, l/min: 45 cm3 at 2200 rev/min.
pub const PUMP_FLOW_LPM: f64 = 99.0;
/// Net flow at full displacement, m3/s, at a volumetric efficiency of 93 %.
pub const PUMP_M3_S: f64 = PUMP_FLOW_LPM * 0.93 * LPM;
/// Pump pressure without a request, Pa.
pub const STANDBY_PA: f64 = 22.0 * BAR;
/// Pressure limiter of the pump, Pa.
pub const LIMIT_PA: f64 = 200.0 * BAR;
/// Time constant of the pump pressure, s.
pub const PUMP_RESPONSE_S: f64 = 0.04;
/// Cracking pressure of the check valve, Pa.
pub const CRACKING_PA: f64 = 3.0 * BAR;
/// Drop at which the lift valve's curve holds, Pa.
pub const LIFT_REFERENCE_PA: f64 = 17.0 * BAR;
/// Drop at which the lowering valve's curve holds, Pa.
pub const LOWER_REFERENCE_PA: f64 = 50.0 * BAR;
/// Drop at which the flow of either valve turns laminar, Pa.
pub const TRANSITION_PA: f64 = 0.1 * BAR;
/// Lag of the spools, s.
pub const SPOOL_LAG_S: f64 = 0.03;

/// Load-sensing margin on the machine, Pa; its data sheet says 20 bar.
pub const MARGIN_PA: f64 = 20.8 * BAR;
/// Links and frame as mass at the hitch point, kg; the drawing says 180 kg.
pub const DEAD_WEIGHT_KG: f64 = 195.0;
/// Leakage of the lowering valve after a season, l/min for each bar; it has none when it is new.
pub const WORN_LPM_BAR: f64 = 0.006;

/// Curve of the lift valve: mA, US gallons a minute.
pub const LIFT_CURVE: [(f64, f64); 8] = [
    (0.0, 0.0),
    (400.0, 0.0),
    (500.0, 0.9),
    (700.0, 4.2),
    (900.0, 8.5),
    (1200.0, 15.0),
    (1500.0, 20.4),
    (1600.0, 21.1),
];
/// Curve of the lowering valve: mA, US gallons a minute.
pub const LOWER_CURVE: [(f64, f64); 8] = [
    (0.0, 0.0),
    (450.0, 0.0),
    (550.0, 1.2),
    (750.0, 5.6),
    (950.0, 11.0),
    (1250.0, 19.6),
    (1500.0, 26.1),
    (1600.0, 27.7),
];
/// m3/s in a US gallon a minute.
pub const GPM: f64 = 3.785_411_784e-3 / 60.0;

/// Flow of a valve at its reference drop, m3/s, at a current, A.
#[must_use]
pub fn flow_m3_s(curve: &[(f64, f64)], current_a: f64) -> f64 {
    value_at(curve, 1e3 * current_a) * GPM
}

/// Rocker angle, degree, at a share of the stroke.
#[must_use]
pub fn angle_deg(share: f64) -> f64 {
    28.0 + 95.0 * share + 4.0 * (std::f64::consts::PI * share).sin()
}

/// Height of the hitch point over the ground, m, at a share of the stroke.
#[must_use]
pub fn height_m(share: f64) -> f64 {
    0.22 + 0.80 * share + 0.03 * (std::f64::consts::PI * share).sin()
}

/// Height over travel, and its derivative, 1/m, at a travel, m.
#[must_use]
pub fn transmission(travel_m: f64) -> (f64, f64) {
    let turn = std::f64::consts::PI / STROKE_M;
    let phase = turn * travel_m;
    (
        0.80 / STROKE_M + 0.03 * turn * phase.cos(),
        -0.03 * turn * turn * phase.sin(),
    )
}

/// State of the lowering valve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wear {
    /// Tight.
    New,
    /// With a leakage of [`WORN_LPM_BAR`].
    Worn,
}

impl Wear {
    /// Leakage out of the cylinders, m3/s, at a pressure, Pa.
    #[must_use]
    pub fn leakage_m3_s(self, pressure_pa: f64) -> f64 {
        match self {
            Self::New => 0.0,
            Self::Worn => WORN_LPM_BAR * LPM / BAR * pressure_pa,
        }
    }
}
