//! The dynamic plant: oil compressibility, inertia, viscous friction, end stops.
//!
//! `p' = (Q_lift - Q_lower - Q_leak - Q_hose - A v) / (V(x)/E + C)`,
//! `M(x) v' = p A - F_weight(x) - M'(x) v^2 / 2 - b v - F_friction(v)`, `x' = v` (docs/plant.md). Classical Runge-Kutta of
//! order four: the ringing at 10 to 40 Hz requires a high order, step control is pointless with the noisy measured
//! current, and fixed steps keep the result smooth in the parameters. If an orifice with a small drop makes the
//! pressure stiff, the step is divided for stability.
//!
//! Oil does not carry tension: if the piston moves on after its valve has closed, a void forms, which has to close
//! before the pressure rises again. Within a step the void is represented by a pressure below the vacuum.
//!
//! The end stops are rigid: they absorb the piston's speed and the force that drives it. They deflect less than the oil
//! under the 70 kN of a dead-headed pump, so a spring would only add stiffness to the equations.

use crate::constants::Constants;
use crate::hooks::acting::Acting;
use crate::model::Model;
use crate::solver::circuit::{AT_REST_PA, Circuit};
use crate::solver::forces::Forces;
use crate::solver::openings::Openings;
use crate::state::MechanicalState;

/// Step sizes of the integrator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// Longest step in rad of the oscillation of the load on the oil.
    longest_rad: f64,
    /// Longest step, s, at any frequency, to resolve the lag of the spools.
    longest_s: f64,
    /// Step of the quasi-static plant, s, while the spools rest or follow a ramp.
    pub(crate) quasi_static_s: f64,
    /// The same during a jump of a current or the lag of a spool after it, and at ground contact, when the flow is not
    /// linear in time.
    pub(crate) jump_s: f64,
    /// Factor on the longest step that effects ask for.
    pub(crate) effect_step_factor: f64,
}

impl Steps {
    /// Classical Runge-Kutta with amplitude errors of the ringing of 2e-3 and phase errors of 5e-3 rad per period
    /// (`h^6 / 144` and `h^5 / 120` per step).
    pub const FINE: Self = Self {
        longest_rad: 0.55,
        longest_s: 0.004,
        // A sample of a 50 Hz log.
        quasi_static_s: 0.02,
        jump_s: 0.005,
        effect_step_factor: 1.0,
    };

    /// For differences between simulations with the same steps. The amplitude error is 4e-2 and the phase error 5e-2
    /// rad per period, most of which cancels in the differences; with steps a quarter longer the errors are three times
    /// as large and no longer cancel.
    pub const COARSE: Self = Self {
        longest_rad: 1.0,
        longest_s: 0.008,
        quasi_static_s: 0.1,
        jump_s: 0.02,
        effect_step_factor: 4.0,
    };
}

/// Speed, m/s, and acceleration, m/s2, below which an undriven hitch is at rest: the remaining oscillation is less than
/// a hundredth of any instrument's last digit.
const AT_REST_M_S: f64 = 5e-7;
const AT_REST_M_S2: f64 = 4e-5;

/// Largest product of rate and step of the integrator; its stability limit is 2.78.
const STABLE: f64 = 1.5;

/// Tolerance on the margin of a working compensator in the solution of the circuit, Pa.
const TOLERANCE_PA: f64 = 100.0;

/// Drop, Pa, below which an orifice's flow is negligible.
const SMALLEST_DROP_PA: f64 = 1000.0;

/// Lowest pressure of a cylinder, the vacuum, Pa gauge.
const VACUUM_PA: f64 = -1.0e5;

/// Rates of travel, speed, pressure, lag of the hose's wall, and compensator pressure.
type Derivative = [f64; 5];

/// [`Derivative`] of a state. This is the innermost loop; it is inlined, as passing values would wait for their stores.
#[inline(always)]
fn derivative<const KINDS: u8>(
    forces: &Forces<KINDS>,
    circuit: &Circuit<KINDS>,
    openings: &Openings,
    state: &MechanicalState,
) -> Derivative {
    let model = forces.model;
    let cylinder = &circuit.constants.cylinder;
    let area_m2 = cylinder.area_m2();
    let torn = state.pressure_pa < VACUUM_PA;
    let pressure_pa = state.pressure_pa.max(VACUUM_PA);
    let state = MechanicalState {
        pressure_pa,
        ..*state
    };
    let hose = &circuit.hooks.oil().hose;
    let flows = circuit.solve(*openings, &state);
    let (dh_dx, d2h_dx2_1_m) = model.linkage().transmission(state.piston_m);
    let masses = &circuit.constants.masses;
    let load_kg = forces.rig.load_kg;
    let heavier = 1.0 + circuit.hooks.piston().inertia_share;
    let (shaft_kg, shaft_kg_m) = forces.shaft_inertia_kg(state.piston_m);
    let inertia_kg = masses.inertia_kg(load_kg, dh_dx) * heavier + shaft_kg;
    let slope = masses.half_inertia_slope_kg_m(load_kg, dh_dx, d2h_dx2_1_m) * heavier + shaft_kg_m;
    let speed_m_s = state.speed_m_s;
    let weight_n = forces.weight_at_n(dh_dx, &state);
    let force_n = pressure_pa * area_m2 - weight_n + forces.ground_n(state.piston_m, speed_m_s)
        - slope * speed_m_s * speed_m_s
        - cylinder.viscous_friction_n_s_m * speed_m_s
        - forces.friction_n(&state, weight_n);
    let stopped = cylinder.stops(state.piston_m, speed_m_s, force_n);
    let (speed_m_s, force_n) = if stopped {
        (0.0, 0.0)
    } else {
        (speed_m_s, force_n)
    };
    let gained_m3_s =
        flows.net_m3_s() - hose.creep_m3_s(state.wall_behind_pa) - area_m2 * speed_m_s;
    let rise_pa_s = stiffness_pa_m3(circuit, state.piston_m, pressure_pa) * gained_m3_s;
    let seen_pa_s = if torn { 0.0 } else { rise_pa_s };
    [
        speed_m_s,
        force_n / inertia_kg,
        rise_pa_s,
        hose.behind_pa_s(seen_pa_s, state.wall_behind_pa),
        circuit.compensator_pa_s(*openings, &state),
    ]
}

/// Pressure increase per volume of oil, Pa/m3: reciprocal of `V/E(p) + C`, oil and hoses.
#[inline(always)]
fn stiffness_pa_m3<const KINDS: u8>(
    circuit: &Circuit<KINDS>,
    piston_m: f64,
    pressure_pa: f64,
) -> f64 {
    let constants = circuit.constants;
    let modulus_pa =
        constants.oil.bulk_modulus_pa * circuit.hooks.oil().stiffness_factor(pressure_pa);
    let volume_m3 = constants.cylinder.volume_m3(piston_m.max(0.0));
    modulus_pa / (volume_m3 + circuit.hooks.oil().hose.at_once_m3_pa * modulus_pa)
}

/// Stiffness of the oil alone, without air and hoses, Pa/m3: conversion of a void into a pressure.
#[inline(always)]
fn oil_stiffness_pa_m3(constants: &Constants, piston_m: f64) -> f64 {
    constants.oil.bulk_modulus_pa / constants.cylinder.volume_m3(piston_m.max(0.0))
}

/// The state with its void represented by a pressure below the vacuum.
#[inline(always)]
fn stretched(model: &Model, state: &MechanicalState) -> MechanicalState {
    if state.void_m3 == 0.0 {
        return *state;
    }
    let missing_pa = oil_stiffness_pa_m3(model.constants(), state.piston_m) * state.void_m3;
    MechanicalState {
        pressure_pa: state.pressure_pa - missing_pa,
        void_m3: 0.0,
        ..*state
    }
}

/// The state with a pressure below the vacuum represented by a void.
#[inline(always)]
fn torn(model: &Model, state: MechanicalState) -> MechanicalState {
    let missing_pa = VACUUM_PA - state.pressure_pa;
    if missing_pa <= 0.0 {
        return MechanicalState {
            void_m3: 0.0,
            ..state
        };
    }
    MechanicalState {
        pressure_pa: VACUUM_PA,
        void_m3: missing_pa / oil_stiffness_pa_m3(model.constants(), state.piston_m),
        ..state
    }
}

/// The state with a piston beyond a stop put back to it, at rest; the oil is compressed or expanded accordingly.
#[inline(always)]
fn within_stops<const KINDS: u8>(
    circuit: &Circuit<KINDS>,
    state: MechanicalState,
) -> MechanicalState {
    let cylinder = &circuit.constants.cylinder;
    let piston_m = state.piston_m.clamp(0.0, cylinder.stroke_m);
    let beyond_m = state.piston_m - piston_m;
    if beyond_m == 0.0 {
        return state;
    }
    let stiffness = stiffness_pa_m3(circuit, piston_m, state.pressure_pa.max(VACUUM_PA));
    MechanicalState {
        piston_m,
        speed_m_s: 0.0,
        pressure_pa: state.pressure_pa + stiffness * cylinder.area_m2() * beyond_m,
        ..state
    }
}

/// The state after `dt_s` at a rate.
#[inline(always)]
fn moved<const KINDS: u8>(
    hooks: Acting<KINDS>,
    state: &MechanicalState,
    rate: Derivative,
    dt_s: f64,
) -> MechanicalState {
    let piston_m = state.piston_m + dt_s * rate[0];
    let travel_m = piston_m - state.piston_m;
    let compensator_pa = if hooks.supply().compensator_lag_s == 0.0 {
        state.compensator_pa
    } else {
        state.compensator_pa + dt_s * rate[4]
    };
    MechanicalState {
        piston_m,
        speed_m_s: state.speed_m_s + dt_s * rate[1],
        pressure_pa: state.pressure_pa + dt_s * rate[2],
        wall_behind_pa: state.wall_behind_pa + dt_s * rate[3],
        bristles_m: hooks.piston().bent_m(state.bristles_m, travel_m, dt_s),
        compensator_pa,
        ..*state
    }
}

/// Rate at which the orifices settle the pressure within a step, 1/s: `E/V dQ/dp`, with `dQ/dp = Q / 2 dp` of each
/// orifice whose drop depends on the cylinder pressure. The flow is proportional to the square root of the drop, so the
/// rate increases as the drop decreases: the drop at the end of the step is used.
#[inline(always)]
fn settling_rate<const KINDS: u8>(
    circuit: &Circuit<KINDS>,
    openings: Openings,
    state: &MechanicalState,
    dt_s: f64,
) -> f64 {
    let constants = circuit.constants;
    let flows = circuit.solve(openings, state);
    let stiffness = oil_stiffness_pa_m3(constants, state.piston_m);
    let gained_m3_s = flows.net_m3_s() - constants.cylinder.area_m2() * state.speed_m_s;
    let rise_pa = stiffness * gained_m3_s * dt_s;
    let slope = |flow_m3_s: f64, drop_pa: f64, lost_pa: f64, transition_pa: f64| {
        let least_pa = (0.5 * transition_pa).max(SMALLEST_DROP_PA);
        let before_pa = drop_pa.max(least_pa);
        let after_pa = (drop_pa - lost_pa.max(0.0)).max(least_pa);
        0.5 * flow_m3_s / (before_pa * after_pa).sqrt()
    };
    let lower = slope(
        flows.lower_m3_s,
        state.pressure_pa,
        -rise_pa,
        constants.lower_valve.transition_drop_pa,
    );
    // A working compensator without lag keeps the lift valve's drop constant regardless of the cylinder pressure, up to
    // the relief pressure.
    let drooped_pa = circuit.hooks.supply().margin_lost_to_flow_pa_s_m3 * flows.lift_m3_s;
    let wanted_pa = circuit.lifting_pressure_pa(state);
    let lagging = circuit.hooks.supply().compensator_lag_s > 0.0;
    let keeps = flows.pump_pressure_pa + drooped_pa >= wanted_pa - TOLERANCE_PA;
    let compensated = keeps && !lagging;
    let room_pa = if compensated {
        (constants.relief_valve.set_pressure_pa - wanted_pa).max(0.0)
    } else {
        0.0
    };
    let lift = if compensated && rise_pa <= room_pa {
        0.0
    } else if lagging {
        // The flow may start at any instant, and its rate is higher while the drop is small.
        1.5 * openings.lift.flow_m3_s / constants.lift_valve.reference_drop_pa
    } else {
        let drop_pa = circuit.lift_drop_pa(flows.pump_pressure_pa, state.pressure_pa);
        slope(
            flows.lift_m3_s,
            drop_pa,
            rise_pa - room_pa,
            constants.lift_valve.transition_drop_pa,
        )
    };
    (lower + lift) * stiffness
}

/// Settling rate of a hose's creeping wall and of the pressure with it, 1/s.
#[inline(always)]
fn creeping_rate<const KINDS: u8>(circuit: &Circuit<KINDS>, state: &MechanicalState) -> f64 {
    let hose = &circuit.hooks.oil().hose;
    if hose.creeping_m3_pa == 0.0 {
        return 0.0;
    }
    let stiffness = stiffness_pa_m3(circuit, state.piston_m, state.pressure_pa.max(VACUUM_PA));
    hose.catching_up_1_s * (1.0 + hose.creeping_m3_pa * stiffness)
}

/// Settling rate of a lagging compensator, 1/s.
#[inline(always)]
fn lagging_rate<const KINDS: u8>(circuit: &Circuit<KINDS>) -> f64 {
    match circuit.hooks.supply().compensator_lag_s {
        0.0 => 0.0,
        lag_s => 1.0 / lag_s,
    }
}

/// Longest step, s, that resolves the oscillation of the load on the oil at the present piston position.
#[must_use]
pub fn longest_step_s<const KINDS: u8>(
    forces: &Forces<KINDS>,
    circuit: &Circuit<KINDS>,
    state: MechanicalState,
    steps: Steps,
) -> f64 {
    let dh_dx = forces.model.linkage().dh_dx(state.piston_m);
    let area_m2 = circuit.constants.cylinder.area_m2();
    let stiffness_n_m = area_m2 * area_m2 * oil_stiffness_pa_m3(circuit.constants, state.piston_m);
    let masses = &circuit.constants.masses;
    let ringing_rad_s = (stiffness_n_m / masses.inertia_kg(forces.rig.load_kg, dh_dx)).sqrt();
    (steps.longest_rad / ringing_rad_s).min(steps.longest_s)
}

/// Angular frequency of the load on its oil with shut valves, rad/s: `A sqrt(K / M)` with the stiffness `K` of oil, air and
/// hoses at the present pressure.
#[must_use]
pub fn load_frequency_rad_s<const KINDS: u8>(
    forces: &Forces<KINDS>,
    circuit: &Circuit<KINDS>,
    state: &MechanicalState,
) -> f64 {
    let dh_dx = forces.model.linkage().dh_dx(state.piston_m);
    let constants = circuit.constants;
    let of_load_kg = constants.masses.inertia_kg(forces.rig.load_kg, dh_dx);
    let (shaft_kg, _) = forces.shaft_inertia_kg(state.piston_m);
    let inertia_kg = of_load_kg * (1.0 + circuit.hooks.piston().inertia_share) + shaft_kg;
    let stiffness_pa_m3 = stiffness_pa_m3(circuit, state.piston_m, state.pressure_pa);
    constants.cylinder.area_m2() * (stiffness_pa_m3 / inertia_kg).sqrt()
}

/// Whether the hitch stays at rest in a step with these openings.
#[must_use]
pub fn rests<const KINDS: u8>(
    forces: &Forces<KINDS>,
    circuit: &Circuit<KINDS>,
    state: &MechanicalState,
    openings: &[Openings; 3],
) -> bool {
    circuit.hooks.all().stays_at_rest()
        && openings.iter().all(Openings::shut)
        && state.void_m3 == 0.0
        && state.speed_m_s.abs() < AT_REST_M_S
        && state.wall_behind_pa.abs() < AT_REST_PA
        && circuit.idles(state)
        && derivative(forces, circuit, &Openings::default(), state)[1].abs() < AT_REST_M_S2
}

/// One step of a state with the openings at its start, middle and end.
///
/// The state is changed in place: a copy of what was just written would wait for the stores.
pub fn step<const KINDS: u8>(
    forces: &Forces<KINDS>,
    circuit: &Circuit<KINDS>,
    state: &mut MechanicalState,
    openings: &[Openings; 3],
    dt_s: f64,
) {
    // A wider opening settles faster.
    let [first, _, last] = openings;
    let widest = if first.wider_than(last) { first } else { last };
    let settling = if widest.shut() {
        0.0
    } else {
        settling_rate(circuit, *widest, state, dt_s)
    };
    let rate = creeping_rate(circuit, state)
        .max(lagging_rate(circuit))
        .max(settling);
    let pieces = rate * dt_s / STABLE;
    if pieces <= 1.0 || pieces.is_nan() {
        return runge_kutta(forces, circuit, state, openings, dt_s);
    }
    let pieces = pieces.ceil().min(256.0) as usize;
    let piece_s = dt_s / pieces as f64;
    let at = |piece: f64| between(openings, piece / pieces as f64);
    let mut start = at(0.0);
    for piece in 0..pieces {
        let (middle, end) = (at(piece as f64 + 0.5), at(piece as f64 + 1.0));
        runge_kutta(forces, circuit, state, &[start, middle, end], piece_s);
        start = end;
    }
}

/// Openings at a share of the step, interpolated linearly between start, middle and end.
#[inline(always)]
fn between(openings: &[Openings; 3], share: f64) -> Openings {
    let [start, middle, end] = openings;
    let (from, to, part) = if share <= 0.5 {
        (start, middle, 2.0 * share)
    } else {
        (middle, end, 2.0 * share - 1.0)
    };
    from.towards(to, part)
}

fn runge_kutta<const KINDS: u8>(
    forces: &Forces<KINDS>,
    circuit: &Circuit<KINDS>,
    state: &mut MechanicalState,
    openings: &[Openings; 3],
    dt_s: f64,
) {
    let hooks = circuit.hooks;
    let start = stretched(forces.model, state);
    let [first, middle, last] = openings;
    // A single call site, so that the compiler inlines the derivative.
    let stages = [
        (0.0, 1.0, first),
        (0.5, 2.0, middle),
        (0.5, 2.0, middle),
        (1.0, 1.0, last),
    ];
    let (mut rate, mut sum) = ([0.0; 5], [0.0; 5]);
    for (share, weight, openings) in stages {
        let state = moved(hooks, &start, rate, share * dt_s);
        rate = derivative(forces, circuit, openings, &state);
        for (sum, rate) in sum.iter_mut().zip(rate) {
            *sum += weight * rate;
        }
    }
    let mean = sum.map(|sum| sum / 6.0);
    let end = torn(
        forces.model,
        within_stops(circuit, moved(hooks, &start, mean, dt_s)),
    );
    // Forces too large for any integrator, from a term or from invalid constants: the plant stops.
    if end.is_finite() {
        *state = end;
    } else {
        state.speed_m_s = 0.0;
    }
}
