//! The quasi-static plant: the paper's model.
//!
//! Stiff oil and no inertia: the piston's speed comes from the flow balance `A v = Q_lift - Q_lower - Q_leak`, the
//! cylinder pressure from the static balance `p A = F_weight(x) + F_friction(v)`.
//!
//! The balance contains no contact force: at a stop the piston rests while pressure and flow keep their values (defined
//! so in docs/plant.md). A dead-headed pump with the relief valve open requires the dynamic plant.

use crate::hooks::effect_hooks::EffectHooks;
use crate::hooks::place::Place;
use crate::solver::circuit::Circuit;
use crate::solver::dynamic::Steps;
use crate::solver::flows::Flows;
use crate::solver::forces::Forces;
use crate::solver::openings::Openings;
use crate::state::MechanicalState;

/// Rate of change above which a current counts as jumping, A/s.
pub(crate) const JUMP_A_S: f64 = 2.5;

/// Largest descent of the piston in a step, m.
const STEP_M: f64 = 0.003;

/// Largest additional piston speed due to user-defined terms, m/s.
const FASTEST_M_S: f64 = 0.5;

/// Whether the hitch stands on the ground or may reach it within a step.
#[must_use]
pub fn lands<const KINDS: u8>(forces: &Forces<KINDS>, piston_m: f64) -> bool {
    forces.hooks.piston().ground.is_some() && forces.ground_n(piston_m - STEP_M, 0.0) > 0.0
}

/// Longest step, s, with the attached effects, at a rate of change of the spools' currents, A/s; `lands` near the
/// ground.
#[must_use]
pub fn longest_step_s(steps: Steps, hooks: &EffectHooks, turning_a_s: f64, lands: bool) -> f64 {
    let own_s = if turning_a_s > JUMP_A_S || lands {
        steps.jump_s
    } else {
        steps.quasi_static_s
    };
    own_s.min(steps.effect_step_factor * hooks.longest_step_s)
}

/// Solution of the balances at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Balance {
    /// Piston speed, m/s.
    pub speed_m_s: f64,
    /// Cylinder pressure, Pa.
    pub pressure_pa: f64,
    /// Flows and pump pressure.
    pub flows: Flows,
}

/// State at the start of a step, for the inertia of an accelerated load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Before {
    /// Piston speed at the start, m/s.
    pub speed_m_s: f64,
    /// Time since then, s.
    pub dt_s: f64,
}

/// Flow and force balance at the present piston position and bristle deflection.
#[inline(always)]
#[must_use]
pub fn balance<const KINDS: u8>(
    forces: &Forces<KINDS>,
    circuit: &Circuit<KINDS>,
    openings: Openings,
    &MechanicalState {
        piston_m,
        bristles_m,
        compensator_pa,
        catching_up,
        ..
    }: &MechanicalState,
    before: Option<Before>,
) -> Balance {
    let area_m2 = circuit.constants.cylinder.area_m2();
    let weight_n = forces.weight_n(piston_m);
    let held_n = (weight_n - forces.ground_n(piston_m, 0.0)).max(0.0);
    let last = MechanicalState {
        bristles_m,
        compensator_pa,
        catching_up,
        ..forces.before(piston_m)
    };
    let at_force = |speed_m_s: f64, force_n: f64| {
        let pressure_pa = force_n / area_m2;
        let state = MechanicalState {
            pressure_pa,
            ..last
        };
        let flows = circuit.solve(openings, &state);
        Balance {
            speed_m_s,
            pressure_pa,
            flows,
        }
    };
    let friction_n = |speed_m_s: f64| {
        let state = MechanicalState { speed_m_s, ..last };
        forces.friction_n(&state, weight_n)
    };
    let terms = circuit.hooks.own().has_term(Place::Friction);
    // Deflected bristles also act on a piston at rest, and so may a term, such as a spring.
    let free = at_force(0.0, held_n + friction_n(0.0));
    let free_m_s = free.flows.net_m3_s() / area_m2;
    let inertia_kg = inertia_kg(forces, piston_m);
    let before = before.filter(|_| inertia_kg > 0.0);
    if before.is_none()
        && ((circuit.hooks.piston().friction.is_empty() && !terms) || free_m_s == 0.0)
    {
        return Balance {
            speed_m_s: free_m_s,
            ..free
        };
    }
    // Friction and inertia oppose a change of speed, so the speed lies between zero, the previous speed and the free
    // speed.
    let at = |speed_m_s: f64| {
        let inertia_n = before.map_or(0.0, |b| inertia_kg * (speed_m_s - b.speed_m_s) / b.dt_s);
        at_force(speed_m_s, held_n + friction_n(speed_m_s) + inertia_n)
    };
    let excess = |speed_m_s: f64| {
        let balance = at(speed_m_s);
        (speed_m_s - balance.flows.net_m3_s() / area_m2, balance)
    };
    let speed_before = before.map_or(0.0, |b| b.speed_m_s);
    // A term may be a driving force: then any speed that the valves permit is possible.
    let beyond_m_s = if terms { FASTEST_M_S } else { 0.0 };
    let low = free_m_s.min(speed_before).min(0.0) - beyond_m_s;
    let high = free_m_s.max(speed_before).max(0.0) + beyond_m_s;
    crate::solver::root::steep(excess, free_m_s, (low, high), 1e-9)
}

/// Inertia at the piston that effects add to the quasi-static plant, kg.
fn inertia_kg<const KINDS: u8>(forces: &Forces<KINDS>, piston_m: f64) -> f64 {
    let (share, (shaft_kg, _)) = (
        forces.hooks.piston().inertia_share,
        forces.shaft_inertia_kg(piston_m),
    );
    if share == 0.0 {
        return shaft_kg;
    }
    let dh_dx = forces.model.linkage().dh_dx(piston_m);
    let masses = &forces.model.constants().masses;
    share * masses.inertia_kg(forces.rig.load_kg, dh_dx) + shaft_kg
}

/// One step of Heun's method from a known balance to the openings at its end; returns the piston travel there, m.
///
/// `lowest_m` is the travel at which the piston rests on its stop or the hitch on the ground.
#[must_use]
pub fn step<const KINDS: u8>(
    forces: &Forces<KINDS>,
    circuit: &Circuit<KINDS>,
    state: &MechanicalState,
    end: Openings,
    lowest_m: f64,
    dt_s: f64,
) -> f64 {
    let stroke_m = circuit.constants.cylinder.stroke_m;
    let within = |piston_m: f64| piston_m.clamp(lowest_m, stroke_m);
    let guess_m = within(state.piston_m + dt_s * state.speed_m_s);
    let before = Before {
        speed_m_s: state.speed_m_s,
        dt_s,
    };
    let guess = MechanicalState {
        piston_m: guess_m,
        bristles_m: circuit
            .hooks
            .piston()
            .bent_m(state.bristles_m, guess_m - state.piston_m, dt_s),
        ..*state
    };
    let there = balance(forces, circuit, end, &guess, Some(before));
    within(state.piston_m + 0.5 * dt_s * (state.speed_m_s + there.speed_m_s))
}
