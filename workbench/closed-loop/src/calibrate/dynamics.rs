//! Ramps, end of the approach, and observer for the dynamics of a model: softness of its oil, lag of its spools, lag of its
//! compensator.
//!
//! The base calibration fits the declared dynamics of the rig. A machine that differs keeps what the load feels there:
//!
//! ```text
//! swing about the set point after a cut at the creep speed c     c / (w sqrt(1 + w^2 T^2))
//! largest deceleration of the load by a ramp of the duration r   v (1 - e^(-r / T)) / r
//! ramp and observer of a soft load                               in periods of its swing on the oil, 2 pi / w
//! ramp of a load on a compensator with lag                       in periods of its swing on it, sqrt(v / 2 K)
//! ```
//!
//! with the lag `T` of the spool, the speed `v` of the open valve, and `K = A d / (M T_c)` of a compensator with the lag
//! `T_c` that leaves the drop `d` at the valve. Faster or stiffer machines keep the base.

use hitch_effects::find;
use hitch_model_file::dynamic;
use hitch_plant::{AddedEffect, Currents, Dynamics, HitchRig, Model, Plant, Rig};
use hitch_quantities::Calibration;
use hitch_quantities::calibration::valve_table::ValveTable;
use hitch_quantities::units::{MicrometrePerSecond, MillimetrePerSecondSquared, Millisecond};

use super::effect_size::found_in;

/// Share of air in the oil up to which the defaults meet the limits of motion.
const USUAL_AIR: f64 = 0.02;
/// Shares of the travel at which the softest swing is looked for.
const TRAVEL_SHARES: [f64; 3] = [0.1, 0.5, 0.9];
/// Error of a spool lag relative to it. The distance that it causes after a cut stays within the stop band.
const LAG_ERROR: f64 = 0.1;
/// Compensator lag for which the gentle ramps of the base are, s: the largest one of a healthy machine.
const USUAL_COMPENSATOR_LAG_S: f64 = 0.012;
/// Oil temperature at which the swing is computed, C; the stiffness does not depend on it.
const OIL_TEMPERATURE_C: f64 = 40.0;

/// Adapts `calibration`, whose valve tables and lags are those of `model`.
pub fn adapt(model: &Model, calibration: &mut Calibration) {
    let usual_rad_s = usual_rad_s();
    let softest_rad_s = softest_rad_s(model).min(usual_rad_s);
    let area_mm2 = f64::from(calibration.hydraulics.piston_area.0).max(1.0);
    let speed_m_s = |table: &ValveTable| 1e-3 * f64::from(table.saturation().0) / area_mm2;
    let speeds_m_s = [&calibration.lift, &calibration.lower].map(speed_m_s);
    let usual_s = dynamic().constants().spool_time_constant_s;
    let hydraulics = &calibration.hydraulics;
    let lags_s = [hydraulics.spool_lag, hydraulics.lower_spool_lag]
        .map(|lag| (1e-3 * f64::from(lag.0)).max(usual_s));
    let first_order = has_first_order_spools(model);
    let position = &mut calibration.position;
    let softness = softest_rad_s / usual_rad_s;

    let stop_band_mm = 1e-3 * f64::from(position.stop_band.0);
    let longest_s = lags_s[0].max(lags_s[1]);
    let shortest_s = lags_s[0].min(lags_s[1]);
    let kept = swing_s(usual_rad_s, usual_s) / swing_s(softest_rad_s, shortest_s);
    let creep_mm_s = 1e-3 * f64::from(position.creep_speed.0);
    let by_lag_mm_s = if first_order {
        (stop_band_mm / (LAG_ERROR * longest_s)).max(creep_mm_s)
    } else {
        creep_mm_s
    };
    let creep_mm_s = (creep_mm_s * kept).min(by_lag_mm_s);
    position.creep_speed = MicrometrePerSecond((1e3 * creep_mm_s).round() as i32);

    // Without it, the estimate follows the swing, most of all while lowering.
    let motion = &mut calibration.motion;
    let slower = |time: Millisecond, factor: f64| Millisecond((f64::from(time.0) * factor) as i32);
    motion.position_time = slower(motion.position_time, 1.0 / softness);
    motion.lowering_time = slower(motion.lowering_time, 1.0 / (softness * softness));

    let steepest = position.abort_deceleration;
    for (ramp, speed_m_s, lag_s) in [
        (&mut position.lift_deceleration, speeds_m_s[0], lags_s[0]),
        (&mut position.lower_deceleration, speeds_m_s[1], lags_s[1]),
    ] {
        let soft_m_s2 = softness * 1e-3 * f64::from(ramp.0);
        let felt_m_s2 = felt_deceleration_m_s2(soft_m_s2, speed_m_s, usual_s);
        let behind_m_s2 = if first_order {
            deceleration_behind_m_s2(felt_m_s2, speed_m_s, lag_s)
        } else {
            soft_m_s2
        };
        *ramp = in_mm_s2(behind_m_s2.min(1e-3 * f64::from(steepest.0.max(ramp.0))));
    }
    compensator(model, speeds_m_s[0], calibration);
}

/// Lag of the compensator, and the gentle ramps for it.
fn compensator(model: &Model, speed_m_s: f64, calibration: &mut Calibration) {
    let lag_s = found_in(model, "compensator-droop", Some("lagging")).unwrap_or(0.0);
    let lag = Millisecond((1e3 * lag_s).round() as i32);
    if lag <= Millisecond::ZERO {
        return;
    }
    calibration.hydraulics.compensator_lag = lag;
    let rig = dynamic();
    let rig_m_s = 1e-3 * f64::from(Calibration::nominal().lift.saturation().0)
        / f64::from(Calibration::nominal().hydraulics.piston_area.0);
    let ratio = (speed_m_s * yield_m_s3(model, lag_s)
        / (rig_m_s * yield_m_s3(&rig, USUAL_COMPENSATOR_LAG_S)))
    .sqrt();
    let position = &mut calibration.position;
    for (ramp, usual) in [
        (
            &mut position.swinging_acceleration,
            position.lift_acceleration,
        ),
        (
            &mut position.swinging_deceleration,
            position.lift_deceleration,
        ),
    ] {
        *ramp = in_mm_s2(ratio * 1e-3 * f64::from(ramp.0)).min(usual);
    }
}

/// Whether the spools follow their currents as the observer assumes. The stop of others is not predicted well enough for
/// a steeper ramp.
fn has_first_order_spools(model: &Model) -> bool {
    let lag = model
        .effects
        .iter()
        .find(|added| added.effect.id() == "spool-lag");
    lag.is_none_or(|added| added.effect.form().is_none() && added.values.get(1) == Some(&0.0))
}

/// `K = A d / (M T_c)` with the heaviest usual load in mid-stroke, m/s3.
fn yield_m_s3(model: &Model, lag_s: f64) -> f64 {
    let constants = model.constants();
    let middle_m = 0.5 * constants.cylinder.stroke_m;
    let [.., heavy_kg] = model.usual_loads_kg();
    let inertia_kg = constants
        .masses
        .inertia_kg(heavy_kg, model.linkage().dh_dx(middle_m));
    let drop_pa = constants.lift_valve.reference_drop_pa;
    constants.cylinder.area_m2() * drop_pa / (inertia_kg * lag_s)
}

/// Lowest angular frequency of a load on its oil that the defaults are for, rad/s: the rig with aerated oil.
fn usual_rad_s() -> f64 {
    let air = find("entrained-air").map(|effect| {
        let mut air = AddedEffect::typical(effect);
        air.values[0] = USUAL_AIR;
        air
    });
    softest_rad_s(&dynamic().with_effects(air.into_iter().collect()))
}

/// Lowest angular frequency of a usual load on its oil, rad/s; infinite in a quasi-static model.
fn softest_rad_s(model: &Model) -> f64 {
    if model.constants().dynamics == Dynamics::Steady {
        return f64::INFINITY;
    }
    let (low_rad, high_rad) = model.linkage().swing_rad();
    let mut softest_rad_s = f64::INFINITY;
    for load_kg in model.usual_loads_kg() {
        for share in TRAVEL_SHARES {
            let rig = Rig::Hitch(HitchRig {
                load_kg,
                start_angle_rad: low_rad + share * (high_rad - low_rad),
            });
            let plant = Plant::new(model, rig, OIL_TEMPERATURE_C, Currents::default());
            softest_rad_s = softest_rad_s.min(plant.load_frequency_rad_s());
        }
    }
    softest_rad_s
}

/// Swing of a load after a cut for each speed, s.
fn swing_s(load_rad_s: f64, lag_s: f64) -> f64 {
    1.0 / (load_rad_s * (load_rad_s * lag_s).hypot(1.0))
}

/// Largest deceleration of a load by a ramp, behind a spool.
fn felt_deceleration_m_s2(ramp_m_s2: f64, speed_m_s: f64, lag_s: f64) -> f64 {
    let duration_s = speed_m_s / ramp_m_s2;
    ramp_m_s2 * -(-duration_s / lag_s).exp_m1()
}

/// The ramp whose largest deceleration behind a spool is `felt_m_s2`; infinite if the spool alone is gentler.
fn deceleration_behind_m_s2(felt_m_s2: f64, speed_m_s: f64, lag_s: f64) -> f64 {
    if speed_m_s / lag_s <= felt_m_s2 {
        return f64::INFINITY;
    }
    // The felt deceleration falls with the duration.
    let (mut short_s, mut long_s) = (0.0, speed_m_s / felt_m_s2);
    for _ in 0..50 {
        let middle_s = 0.5 * (short_s + long_s);
        if felt_deceleration_m_s2(speed_m_s / middle_s, speed_m_s, lag_s) > felt_m_s2 {
            short_s = middle_s
        } else {
            long_s = middle_s
        }
    }
    speed_m_s / long_s
}

fn in_mm_s2(deceleration_m_s2: f64) -> MillimetrePerSecondSquared {
    MillimetrePerSecondSquared((1e3 * deceleration_m_s2).round() as i32)
}
