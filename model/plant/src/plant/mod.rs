//! The plant in motion.

mod conditions;
mod copy;
mod instruments;
mod rest;
mod run_signals;

use crate::components::lag::Lag;
use crate::constants::Dynamics;
use crate::hooks::acting::{EVERY, kinds, with_kinds};
use crate::hooks::effect::AddedEffect;
use crate::hooks::effect_hooks::{EffectHooks, RunConditions};
use crate::hooks::place::Place;
use crate::hooks::reading::Reading;
use crate::hooks::signals::Signals;
use crate::model::Model;
use crate::solver::circuit::Circuit;
use crate::solver::dynamic::Steps;
use crate::solver::flows::Flows;
use crate::solver::forces::Forces;
use crate::solver::moment::Moment;
use crate::solver::openings::Openings;
use crate::solver::{dynamic, steady};
use crate::state::{HitchRig, MechanicalState, Rig};
use crate::valve::Currents;

/// Most steps of the spools within one step of the quasi-static piston, while a current changes.
const SPOOL_STEPS: f64 = 2.0;

/// The plant in motion.
pub struct Plant<'m> {
    model: &'m Model,
    rig: Rig,
    steps: Steps,
    hooks: EffectHooks,
    /// Kinds of effects among the hooks.
    kinds: u8,
    spools: [Lag; 2],
    spool_currents: Currents,
    /// Rate of change of the spools' currents over the last step, A/s.
    turning_a_s: f64,
    openings: Openings,
    state: MechanicalState,
    /// Whether the quasi-static piston was at rest at both ends of the last step, so that no inertia is left.
    stands: bool,
    lowest_m: f64,
    flows: Flows,
    input: Currents,
    reading: Reading,
    /// Only updated for user-defined terms.
    signals: Signals,
}

impl<'m> Plant<'m> {
    /// A plant at rest with the currents `at_rest`, with the model's effects attached.
    #[must_use]
    pub fn new(model: &'m Model, rig: Rig, oil_temperature_c: f64, at_rest: Currents) -> Self {
        let mut hooks = attached(model, oil_temperature_c);
        let effective = hooks
            .currents
            .iter_mut()
            .fold(at_rest, |currents, stage| stage.rest(currents));
        let spools = [effective.lift_a, effective.lower_a];
        let lag_s = (model.spool_lag_s() + hooks.spool_lag_extra_s).max(0.0);
        let spools = spools.map(|a| Lag::at_rest(lag_s, a));
        let mut plant = Self {
            model,
            rig,
            steps: Steps::FINE,
            kinds: kinds(&hooks),
            hooks,
            spools,
            spool_currents: effective,
            turning_a_s: 0.0,
            openings: Openings::default(),
            state: MechanicalState::default(),
            stands: false,
            lowest_m: 0.0,
            flows: Flows::default(),
            input: at_rest,
            reading: Reading::default(),
            signals: run_signals::signals_of_run(rig, oil_temperature_c),
        };
        plant.state = plant.state_at_rest();
        if let Rig::Hitch(rig) = rig {
            plant.lowest_m = plant.forces(&rig).lowest_m();
            plant.place_on_ground(&rig);
        }
        plant.store_signals();
        let openings = plant.shift(effective.lift_a, effective.lower_a);
        if plant.hooks.compensator_lag_s > 0.0 {
            let steady_pa = plant
                .circuit()
                .steady_pressure_pa(openings.lift, &plant.state);
            plant.state.compensator_pa = steady_pa;
        }
        plant.refresh();
        plant.store_signals();
        let mut reading = plant.truth();
        for sensor in &mut plant.hooks.sensors {
            sensor.rest(&mut reading);
        }
        plant.reading = plant.with_sensor_terms(reading);
        plant
    }

    /// The plant with other time steps.
    #[must_use]
    pub fn in_steps(self, steps: Steps) -> Self {
        Self { steps, ..self }
    }

    /// Advances by `dt_s` while the coil currents change linearly to `currents`.
    pub fn step(&mut self, currents: Currents, dt_s: f64) {
        let longest_s = self.longest_step_s(currents.largest_difference_a(self.input) / dt_s);
        // Slack for rounding: 0.02 s read from a log as a difference must not need another step.
        let pieces = (dt_s / longest_s - 1e-6).ceil().max(1.0) as usize;
        let (from, spools) = (self.input, self.spool_currents);
        for piece in 1..=pieces {
            let share = piece as f64 / pieces as f64;
            self.integrate(from.towards(currents, share), dt_s / pieces as f64);
            if piece == pieces || !self.hooks.sensors.is_empty() {
                self.read(dt_s / pieces as f64);
            }
        }
        self.turning_a_s = self.spool_currents.largest_difference_a(spools) / dt_s;
    }

    /// Longest step, s, at a rate of change of the coil currents, A/s.
    fn longest_step_s(&self, driven_a_s: f64) -> f64 {
        let turning_a_s = self.turning_a_s.max(driven_a_s);
        match (self.rig, self.model.constants().dynamics) {
            (Rig::Hitch(rig), Dynamics::Dynamic) => {
                let (forces, circuit) = (self.forces(&rig), self.circuit());
                dynamic::longest_step_s(&forces, &circuit, self.state, self.steps)
            }
            (Rig::Hitch(rig), Dynamics::Steady) => {
                let lands = steady::lands(&self.forces(&rig), self.state.piston_m);
                let own_s = steady::longest_step_s(self.steps, &self.hooks, turning_a_s, lands);
                // A spool that is driven fast does not stick.
                if driven_a_s <= steady::JUMP_A_S {
                    own_s.min(SPOOL_STEPS * self.hooks.largest_change_a / driven_a_s)
                } else {
                    own_s
                }
            }
            (Rig::Flow { .. }, _) => {
                steady::longest_step_s(self.steps, &self.hooks, turning_a_s, false)
            }
        }
    }

    /// Updates the readings, `dt_s` after the last update.
    fn read(&mut self, dt_s: f64) {
        self.refresh_unless_balanced();
        self.reading = self.truth();
        for sensor in &mut self.hooks.sensors {
            sensor.advance(&mut self.reading, dt_s);
        }
        if !self.hooks.terms.is_empty() {
            self.reading = self.with_sensor_terms(self.reading);
        }
    }

    /// The present readings of the instruments.
    #[must_use]
    pub fn reading(&self) -> Reading {
        self.reading
    }

    /// The present piston travel, speed and cylinder pressure.
    #[must_use]
    pub fn state(&self) -> MechanicalState {
        self.state
    }

    /// The present flows and pump pressure.
    #[must_use]
    pub fn flows(&self) -> Flows {
        self.flows
    }

    /// Rocker angle, rad; NaN on a flow bench.
    #[inline]
    #[must_use]
    pub fn rocker_angle_rad(&self) -> f64 {
        match self.rig {
            Rig::Hitch(_) => {
                let posture = self.model.linkage().at(self.state.piston_m);
                posture.rocker_angle_rad
            }
            Rig::Flow { .. } => f64::NAN,
        }
    }

    /// Angular frequency of the load on its oil with shut valves, at the present travel and pressure, rad/s; NaN on a
    /// flow bench.
    #[must_use]
    pub fn load_frequency_rad_s(&self) -> f64 {
        match self.rig {
            Rig::Hitch(rig) => {
                dynamic::load_frequency_rad_s(&self.forces(&rig), &self.circuit(), &self.state)
            }
            Rig::Flow { .. } => f64::NAN,
        }
    }

    /// Pump pressure with the lift valve closed, Pa.
    #[must_use]
    pub fn idle_pressure_pa(&self) -> f64 {
        self.circuit().idle_pressure_pa()
    }

    /// The circuit with effects of any kind.
    fn circuit(&self) -> Circuit<'_, EVERY> {
        Circuit::new(self.model, &self.hooks, &self.signals)
    }

    /// The forces with effects of any kind.
    fn forces<'a>(&'a self, rig: &'a HitchRig) -> Forces<'a, EVERY> {
        Forces::new(self.model, &self.hooks, &self.signals, rig)
    }

    fn moment(&self) -> Moment<'_, EVERY> {
        self.circuit().moment
    }

    /// Starts a step of a lagging compensator in the quasi-static plant.
    fn catch_up(&mut self, start: Openings, dt_s: f64) {
        let circuit = self.circuit();
        let (reached_pa, share) = circuit.catching_up(start, &self.state, dt_s);
        (self.state.compensator_pa, self.state.catching_up) = (reached_pa, share);
    }

    /// Ends a step of a lagging compensator.
    fn settle(&mut self, end: Openings) {
        if self.hooks.compensator_lag_s > 0.0 {
            self.state.compensator_pa = self.circuit().compensator_pa(end.lift, &self.state);
        }
        self.state.catching_up = 0.0;
    }

    /// One integration step.
    fn integrate(&mut self, currents: Currents, dt_s: f64) {
        let from = self.input;
        self.input = currents;
        match (self.rig, self.model.constants().dynamics) {
            (Rig::Flow { .. }, _) => {
                let start = self.openings;
                let end = self.open(from, currents, dt_s);
                self.catch_up(start, dt_s);
                self.settle(end);
            }
            (Rig::Hitch(rig), Dynamics::Steady) => {
                let start = self.openings;
                let end = self.open(from, currents, dt_s);
                let idles = self.circuit().idles(&self.state);
                if self.stands && self.hooks.stays_at_rest() && start.shut() && end.shut() && idles
                {
                    return;
                }
                self.catch_up(start, dt_s);
                let before = steady::Before {
                    speed_m_s: self.state.speed_m_s,
                    dt_s,
                };
                let (model, hooks, signals) = (self.model, &self.hooks, &self.signals);
                let (state, lowest_m) = (&self.state, self.lowest_m);
                let piston_m = with_kinds!(self.kinds, KINDS => {
                    let forces = Forces::<KINDS>::new(model, hooks, signals, &rig);
                    let circuit = Circuit::new(model, hooks, signals);
                    steady::step(&forces, &circuit, state, end, lowest_m, dt_s)
                });
                let moved_m = piston_m - self.state.piston_m;
                self.state.bristles_m = self.hooks.bent_m(self.state.bristles_m, moved_m, dt_s);
                self.state.piston_m = piston_m;
                self.balance(&rig, Some(before));
                self.settle(end);
                self.stands = before.speed_m_s == 0.0 && self.state.speed_m_s == 0.0;
            }
            (Rig::Hitch(rig), Dynamics::Dynamic) => {
                let middle = from.towards(currents, 0.5);
                let start = self.openings;
                let half = self.open(from, middle, 0.5 * dt_s);
                let end = self.open(middle, currents, 0.5 * dt_s);
                let openings = [start, half, end];
                let (model, hooks, signals) = (self.model, &self.hooks, &self.signals);
                let state = &mut self.state;
                with_kinds!(self.kinds, KINDS => {
                    let forces = Forces::<KINDS>::new(model, hooks, signals, &rig);
                    let circuit = Circuit::new(model, hooks, signals);
                    if dynamic::rests(&forces, &circuit, state, &openings) {
                        return;
                    }
                    dynamic::step(&forces, &circuit, state, &openings, dt_s);
                });
            }
        }
        if !self.hooks.terms.is_empty() {
            self.refresh_unless_balanced();
            self.store_signals();
        }
    }

    /// Advances effects and spools while the currents change linearly, and returns the openings.
    ///
    /// The step is divided such that no current changes by more than resolves a spool's jump: the instant within a step
    /// of the load does not matter, but whether a jump happened does.
    #[inline(always)]
    fn open(&mut self, from: Currents, to: Currents, dt_s: f64) -> Openings {
        let (change_a, largest_a) = (to.largest_difference_a(from), self.hooks.largest_change_a);
        if change_a > largest_a {
            let pieces = (change_a / largest_a).ceil();
            let piece_s = dt_s / pieces;
            for piece in 1..pieces as usize {
                self.take_spools(from.towards(to, piece as f64 / pieces), piece_s);
            }
            self.take_spools(to, piece_s);
        } else {
            self.take_spools(to, dt_s);
        }
        let Currents { lift_a, lower_a } = self.spool_currents;
        self.shift(lift_a, lower_a)
    }

    /// Advances the spools by `dt_s` to the currents.
    #[inline(always)]
    fn take_spools(&mut self, currents: Currents, dt_s: f64) {
        let effective = self
            .hooks
            .currents
            .iter_mut()
            .fold(currents, |currents, stage| stage.advance(currents, dt_s));
        self.spool_currents = Currents {
            lift_a: self.spools[0].advance(effective.lift_a, dt_s),
            lower_a: self.spools[1].advance(effective.lower_a, dt_s),
        };
    }

    /// Sets the openings at effective currents, A, including user-defined terms.
    #[inline(always)]
    fn shift(&mut self, lift_a: f64, lower_a: f64) -> Openings {
        let (mut lift_a, mut lower_a) = (lift_a, lower_a);
        if !self.hooks.terms.is_empty() {
            self.signals.lift_current_a = lift_a;
            self.signals.lower_current_a = lower_a;
            lift_a += self.hooks.term(Place::LiftCurrent, &self.signals);
            lower_a += self.hooks.term(Place::LowerCurrent, &self.signals);
            self.signals.lift_current_a = lift_a;
            self.signals.lower_current_a = lower_a;
        }
        let openings = self.circuit().openings(lift_a, lower_a);
        self.openings = openings;
        openings
    }

    /// Stores the present signals for the terms of the next step.
    fn store_signals(&mut self) {
        if self.hooks.terms.is_empty() {
            return;
        }
        let now = self.moment().signals(&self.state);
        self.signals = Signals {
            pump_pressure_pa: self.flows.pump_pressure_pa,
            lift_flow_m3_s: self.flows.lift_m3_s,
            lower_flow_m3_s: self.flows.lower_m3_s,
            ..now
        };
    }

    /// Updates the quasi-static speed, pressure and flows at the present openings and travel.
    fn balance(&mut self, rig: &HitchRig, before: Option<steady::Before>) {
        let (model, hooks, signals) = (self.model, &self.hooks, &self.signals);
        let balance = with_kinds!(self.kinds, KINDS => {
            let forces = Forces::<KINDS>::new(model, hooks, signals, rig);
            let circuit = Circuit::new(model, hooks, signals);
            steady::balance(&forces, &circuit, self.openings, &self.state, before)
        });
        self.state.speed_m_s = balance.speed_m_s;
        self.state.pressure_pa = balance.pressure_pa;
        self.flows = balance.flows;
    }

    /// Updates the flows at the present state, unless the step has done so.
    fn refresh_unless_balanced(&mut self) {
        if !matches!(
            (self.rig, self.model.constants().dynamics),
            (Rig::Hitch(_), Dynamics::Steady)
        ) {
            self.refresh();
        }
    }

    /// Updates the flows at the present state.
    fn refresh(&mut self) {
        match (self.rig, self.model.constants().dynamics) {
            (Rig::Hitch(rig), Dynamics::Steady) => self.balance(&rig, None),
            _ => self.flows = self.circuit().solve(self.openings, &self.state),
        }
    }
}

/// The hooks with the effects of a model, at an oil temperature, C.
fn attached(model: &Model, oil_temperature_c: f64) -> EffectHooks {
    let mut hooks = EffectHooks {
        compensator_lag_s: model.pump_response_s(),
        ..EffectHooks::default()
    };
    for effect in ordered_by_rank(&model.effects) {
        let conditions = RunConditions {
            oil_temperature_c,
            constants: model.constants(),
            linkage: model.linkage(),
        };
        effect.attach(conditions, &mut hooks);
    }
    hooks
}

/// Effects in the order of the machine, from the coil to the instruments, then user-defined terms, regardless of the
/// order in which they were added: the order of a solenoid's hysteresis and a spool's stiction matters.
fn ordered_by_rank(effects: &[AddedEffect]) -> Vec<&AddedEffect> {
    let mut ordered: Vec<&AddedEffect> = effects.iter().collect();
    ordered.sort_by_key(|added| added.effect.rank());
    ordered
}
