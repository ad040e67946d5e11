//! The quasi-static plant: the paper's model.
//!
//! Stiff oil and no inertia: the piston's speed comes from the flow balance `A v = Q_lift - Q_lower - Q_leak`, the
//! cylinder pressure from the static balance `p A = F_weight(x) + F_friction(v)`.
//!
//! The balance knows no contact force, so at a stop the piston stands while pressure and flow stay what they were
//! (RIG.md defines it so); dead-heading the pump over the relief valve is the dynamic plant's business.

use super::circuit::{Circuit, Flows, Openings};
use super::{HitchRig, MechanicalState};
use crate::model::Model;

/// Longest step, s: half a sample of a 50 Hz log.
pub const LONGEST_STEP_S: f64 = 0.01;

/// What the balances give at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Balance {
    /// Piston speed, m/s.
    pub speed_m_s: f64,
    /// Cylinder pressure, Pa.
    pub pressure_pa: f64,
    /// Flows and pump pressure.
    pub flows: Flows,
}

/// Flow and force balance at piston travel `piston_m`.
#[must_use]
pub fn balance(
    model: &Model,
    circuit: &Circuit,
    rig: &HitchRig,
    openings: Openings,
    piston_m: f64,
) -> Balance {
    let constants = model.constants();
    let area_m2 = constants.cylinder.area_m2();
    let weight_n = constants
        .masses
        .weight_force_n(rig.load_kg, model.linkage().dh_dx(piston_m));
    let free = {
        let pressure_pa = weight_n / area_m2;
        let flows = circuit.solve(openings, pressure_pa);
        Balance {
            speed_m_s: flows.net_m3_s() / area_m2,
            pressure_pa,
            flows,
        }
    };
    if circuit.sites.friction.is_empty() || free.speed_m_s == 0.0 {
        free
    } else {
        with_friction(circuit, openings, weight_n, area_m2, free.speed_m_s)
    }
}

/// Friction slows the motion, so the speed lies between rest and the frictionless speed.
fn with_friction(
    circuit: &Circuit,
    openings: Openings,
    weight_n: f64,
    area_m2: f64,
    free_m_s: f64,
) -> Balance {
    let at = |speed_m_s: f64| {
        let pressure_pa = (weight_n + circuit.sites.friction_n(speed_m_s)) / area_m2;
        let flows = circuit.solve(openings, pressure_pa);
        Balance {
            speed_m_s,
            pressure_pa,
            flows,
        }
    };
    let excess = |speed_m_s: f64| speed_m_s - at(speed_m_s).flows.net_m3_s() / area_m2;
    let (low, high) = (free_m_s.min(0.0), free_m_s.max(0.0));
    at(super::root::rising(excess, low, high, 1e-9))
}

/// One step of Heun's method from a known balance to the openings at its end; returns the piston's travel there, m.
#[must_use]
pub fn step(
    model: &Model,
    circuit: &Circuit,
    rig: &HitchRig,
    state: MechanicalState,
    end: Openings,
    dt_s: f64,
) -> f64 {
    let stroke_m = model.constants().cylinder.stroke_m;
    let within = |piston_m: f64| piston_m.clamp(0.0, stroke_m);
    let guess_m = within(state.piston_m + dt_s * state.speed_m_s);
    let there = balance(model, circuit, rig, end, guess_m);
    within(state.piston_m + 0.5 * dt_s * (state.speed_m_s + there.speed_m_s))
}
