//! The hydraulic circuit at one instant: flows and pump pressure for a cylinder pressure.

use crate::components::orifice_valve::OrificeValve;
use crate::components::pump::PumpKind;
use crate::constants::Constants;
use crate::hooks::acting::Acting;
use crate::hooks::effect_hooks::EffectHooks;
use crate::hooks::elements::{FlowFactor, Line, ReliefOverride};
use crate::hooks::place::Place;
use crate::hooks::signals::Signals;
use crate::model::Model;
use crate::solver::flows::Flows;
use crate::solver::moment::Moment;
use crate::solver::openings::{Opening, Openings};
use crate::state::MechanicalState;

/// Pressure deviation below which a lagging compensator, and a hose's creeping wall, is at rest, Pa.
pub const AT_REST_PA: f64 = 10.0;

/// The circuit between pump, tank and cylinder port.
pub struct Circuit<'a, const KINDS: u8> {
    /// The components.
    pub constants: &'a Constants,
    /// The attached effects.
    pub hooks: Acting<'a, KINDS>,
    /// The signals for terms.
    pub moment: Moment<'a, KINDS>,
}

/// Largest factor of terms on a valve's flow.
const GREATEST_FACTOR: f64 = 10.0;

impl<'a, const KINDS: u8> Circuit<'a, KINDS> {
    /// The circuit of a model with effects of `KINDS`; `before` are the signals for terms.
    #[inline(always)]
    #[must_use]
    pub fn new(model: &'a Model, hooks: &'a EffectHooks, before: &'a Signals) -> Self {
        let hooks = Acting::only(hooks);
        Self {
            constants: model.constants(),
            hooks,
            moment: Moment {
                model,
                hooks,
                before,
            },
        }
    }

    /// Openings of the valves at effective currents, A.
    #[inline(always)]
    #[must_use]
    pub fn openings(&self, lift_a: f64, lower_a: f64) -> Openings {
        let Constants {
            lift_valve,
            lower_valve,
            ..
        } = self.constants;
        Openings {
            lift: self.opening(lift_valve, lift_a, self.hooks.all().lift_flow_factor),
            lower: self.opening(lower_valve, lower_a, self.hooks.all().lower_flow_factor),
        }
    }

    /// Opening of a valve at an effective current, A.
    #[inline(always)]
    fn opening(&self, valve: &OrificeValve, current_a: f64, factor: FlowFactor) -> Opening {
        let curve = &valve.curve;
        let table_m3_s = curve.flow_m3_s(current_a);
        Opening {
            flow_m3_s: table_m3_s * factor.at(table_m3_s, curve.saturation_m3_s()),
            beyond_threshold_a: if self.depends_on_travel() {
                (current_a - curve.threshold_a()).max(0.0)
            } else {
                0.0
            },
        }
    }

    #[inline(always)]
    fn depends_on_travel(&self) -> bool {
        self.hooks.oil().flow_number_1_a_sqrt_pa.is_some()
            || !self.hooks.oil().lower_travel_factor.is_empty()
    }

    /// The lowering valve's opening with the travel of its spool reduced by flow forces at a drop, Pa.
    #[inline(always)]
    fn travelled(&self, opening: Opening, drop_pa: f64) -> Opening {
        if self.hooks.oil().lower_travel_factor.is_empty() {
            opening
        } else {
            self.travelled_less(opening, drop_pa)
        }
    }

    #[cold]
    #[inline(never)]
    fn travelled_less(&self, opening: Opening, drop_pa: f64) -> Opening {
        let curve = &self.constants.lower_valve.curve;
        let flow_m3_s = |beyond_a: f64| curve.flow_m3_s(curve.threshold_a() + beyond_a);
        let beyond_a = opening.beyond_threshold_a * self.hooks.oil().lower_travel_factor(drop_pa);
        let free_m3_s = flow_m3_s(opening.beyond_threshold_a);
        if free_m3_s <= 0.0 {
            return opening;
        }
        Opening {
            flow_m3_s: opening.flow_m3_s * flow_m3_s(beyond_a) / free_m3_s,
            beyond_threshold_a: beyond_a,
        }
    }

    /// Ratio of a valve's discharge coefficient to that of a wide opening: `tanh` of its flow number (McCloy & Martin).
    #[inline(always)]
    fn discharge(&self, opening: Opening, drop_pa: f64) -> f64 {
        match self.hooks.oil().flow_number_1_a_sqrt_pa {
            Some(flow_number) => {
                (flow_number * opening.beyond_threshold_a * drop_pa.max(0.0).sqrt()).tanh()
            }
            None => 1.0,
        }
    }

    /// Solves the circuit for a state of piston and oil.
    #[inline(always)]
    #[must_use]
    pub fn solve(&self, openings: Openings, state: &MechanicalState) -> Flows {
        let (lift_m3_s, pump_pressure_pa) = self.lift(openings.lift, state);
        let leakage_m3_s = self.hooks.oil().leakage_m3_s(state.pressure_pa);
        Flows {
            lift_m3_s,
            lower_m3_s: self.lower_m3_s(openings.lower, state),
            leakage_m3_s: leakage_m3_s + self.moment.term(Place::Leakage, state, |_| ()),
            pump_pressure_pa,
        }
    }

    /// Pump pressure, Pa, set by the compensator while lifting against the cylinder pressure of a state.
    #[inline(always)]
    #[must_use]
    pub fn lifting_pressure_pa(&self, state: &MechanicalState) -> f64 {
        let compensator = &self.constants.compensator;
        compensator.lifting_pressure_pa(state.pressure_pa)
            + self.hooks.supply().margin_pa(state.pressure_pa)
            + self.moment.term(Place::CompensatorMargin, state, |_| ())
    }

    /// The lift valve's opening with user-defined terms applied.
    #[inline(always)]
    fn lift_opening(&self, opening: Opening, state: &MechanicalState) -> Opening {
        if self.hooks.own().terms.is_empty() {
            return opening;
        }
        let term = self
            .moment
            .term(Place::LiftFlowFactor, state, move |signals| {
                signals.lift_flow_m3_s = opening.flow_m3_s;
            });
        opening.scaled((1.0 + term).clamp(0.0, GREATEST_FACTOR))
    }

    /// The lowering valve's opening with user-defined terms applied.
    #[inline(always)]
    fn lower_opening(&self, opening: Opening, state: &MechanicalState) -> Opening {
        if self.hooks.own().terms.is_empty() {
            return opening;
        }
        let term = self
            .moment
            .term(Place::LowerFlowFactor, state, move |signals| {
                signals.lower_flow_m3_s = self.lower_valve_m3_s(opening, state.pressure_pa);
            });
        opening.scaled((1.0 + term).clamp(0.0, GREATEST_FACTOR))
    }

    /// Pressure downstream of the lowering valve, Pa, at a flow through it, m3/s.
    fn return_pressure_pa(&self, flow_m3_s: f64, state: &MechanicalState) -> f64 {
        let term = self
            .moment
            .term(Place::ReturnPressure, state, move |signals| {
                signals.lower_flow_m3_s = flow_m3_s;
            });
        self.hooks.oil().return_pressure_pa(flow_m3_s) + term
    }

    /// Drop across the lift orifice out of that from pump to cylinder, Pa.
    #[inline(always)]
    #[must_use]
    pub fn lift_drop_pa(&self, pump_pressure_pa: f64, cylinder_pressure_pa: f64) -> f64 {
        let check_valve = &self.constants.check_valve;
        let load_pa = cylinder_pressure_pa + self.hooks.supply().cracking_extra_pa;
        check_valve.remaining_drop_pa(pump_pressure_pa, load_pa)
    }

    /// Flow through lift valve and check valve, m3/s, over the drop less the cracking pressure, Pa.
    #[inline(always)]
    fn lift_valve_m3_s(&self, opening: Opening, drop_pa: f64) -> f64 {
        let lift_valve = &self.constants.lift_valve;
        let flow_m3_s =
            lift_valve.flow_m3_s(opening.flow_m3_s, drop_pa) * self.discharge(opening, drop_pa);
        let check_valve = &self.hooks.supply().check_valve;
        if check_valve.is_free() || flow_m3_s == 0.0 {
            return flow_m3_s;
        }
        check_valve.behind_orifice_m3_s(flow_m3_s, drop_pa)
    }

    /// Lift flow, m3/s, and pump pressure, Pa.
    #[inline(always)]
    fn lift(&self, opening: Opening, state: &MechanicalState) -> (f64, f64) {
        let constants = self.constants;
        let wanted_pa = self.compensator_pa(opening, state);
        if opening.shut() {
            return (0.0, wanted_pa);
        }
        let flow_at = self.lift_flow_at(opening, state);
        let pumped_m3_s = move |pump_pressure_pa: f64| {
            constants.pump.flow_m3_s() - self.hooks.supply().pump_slip_m3_s(pump_pressure_pa)
        };
        let flow_m3_s = flow_at(wanted_pa);
        if flow_m3_s <= pumped_m3_s(wanted_pa) {
            return (flow_m3_s, wanted_pa);
        }
        // The compensator is closed and does not reach its margin: the pump's full flow determines the drop (equation
        // 5).
        let drop_pa = self.lift_drop_pa(wanted_pa, state.pressure_pa);
        let turbulent = self.hooks.oil().flow_number_1_a_sqrt_pa.is_none();
        let short_pa = if self.hooks.supply().pump_slip.is_empty() && turbulent {
            let ratio = pumped_m3_s(wanted_pa) / flow_m3_s;
            drop_pa * (1.0 - ratio * ratio)
        } else {
            let spare = move |short_pa: f64| {
                pumped_m3_s(wanted_pa - short_pa) - flow_at(wanted_pa - short_pa)
            };
            crate::solver::root::rising(spare, 0.0, drop_pa, 10.0)
        };
        (pumped_m3_s(wanted_pa - short_pa), wanted_pa - short_pa)
    }

    /// Lift flow, m3/s, as a function of pump pressure, Pa.
    #[inline(always)]
    fn lift_flow_at(
        &self,
        opening: Opening,
        state: &MechanicalState,
    ) -> impl Fn(f64) -> f64 + Copy {
        let opening = self.lift_opening(opening, state);
        let cylinder_pressure_pa = state.pressure_pa;
        move |pump_pressure_pa| {
            let drop_pa = self.lift_drop_pa(pump_pressure_pa, cylinder_pressure_pa);
            self.lift_valve_m3_s(opening, drop_pa)
        }
    }

    /// Steady pump pressure, Pa, of compensator and relief valve for an opening of the lift valve.
    #[inline(always)]
    #[must_use]
    pub fn steady_pressure_pa(&self, opening: Opening, state: &MechanicalState) -> f64 {
        if opening.shut() {
            return self.idle_pressure_pa();
        }
        let flow_at = self.lift_flow_at(opening, state);
        let without_flow_pa = self.lifting_pressure_pa(state);
        let drooped_pa = self.drooped_pa(without_flow_pa, state.pressure_pa, flow_at);
        self.relieved_pa(drooped_pa, flow_at)
    }

    /// Whether the compensator is at its idle pressure, as it always is without a lag.
    #[inline(always)]
    #[must_use]
    pub fn idles(&self, state: &MechanicalState) -> bool {
        (state.compensator_pa - self.idle_pressure_pa()).abs() < AT_REST_PA
    }

    /// Pump pressure with the lift valve closed, Pa.
    #[inline(always)]
    #[must_use]
    pub fn idle_pressure_pa(&self) -> f64 {
        let idle_pa = match self.constants.pump.kind {
            PumpKind::FixedDisplacement => self.constants.compensator.idle_pressure_pa(),
            PumpKind::LoadSensing => self.constants.pump.standby_pressure_pa,
        };
        idle_pa + self.hooks.supply().idle_extra_pa
    }

    /// Rate of the pump pressure of a lagging compensator, Pa/s; zero without a lag.
    #[inline(always)]
    #[must_use]
    pub fn compensator_pa_s(&self, openings: Openings, state: &MechanicalState) -> f64 {
        let lag_s = self.hooks.supply().compensator_lag_s;
        if lag_s > 0.0 {
            (self.steady_pressure_pa(openings.lift, state) - state.compensator_pa) / lag_s
        } else {
            0.0
        }
    }

    /// Start value of a lagging compensator for a step of the quasi-static plant, Pa, and the share of the deviation at
    /// the step's end that it has made up by then: exact for a steady pressure that changes linearly,
    /// `p_1 = e p_0 + b s_0 + (1 - e - b) s_1` with `e = exp(-dt / lag)` and `b = (1 - e) lag / dt - e`.
    #[must_use]
    pub fn catching_up(
        &self,
        openings: Openings,
        state: &MechanicalState,
        dt_s: f64,
    ) -> (f64, f64) {
        let lag_s = self.hooks.supply().compensator_lag_s;
        if lag_s == 0.0 {
            return (state.compensator_pa, 0.0);
        }
        let left = (-dt_s / lag_s).exp();
        let before = (1.0 - left) * lag_s / dt_s - left;
        let reached_pa =
            left * state.compensator_pa + before * self.steady_pressure_pa(openings.lift, state);
        (reached_pa / (left + before), 1.0 - left - before)
    }

    /// Present pump pressure of the compensator for an opening of the lift valve, Pa.
    #[inline(always)]
    #[must_use]
    pub fn compensator_pa(&self, opening: Opening, state: &MechanicalState) -> f64 {
        if self.hooks.supply().compensator_lag_s == 0.0 {
            return self.steady_pressure_pa(opening, state);
        }
        if state.catching_up == 0.0 {
            return state.compensator_pa;
        }
        let lacking_pa = self.steady_pressure_pa(opening, state) - state.compensator_pa;
        state.compensator_pa + state.catching_up * lacking_pa
    }

    /// The pump pressure, Pa, that the compensator sets with the lift flow `flow_at` that pressure at a cylinder pressure;
    /// without flow it would set `wanted_pa`.
    #[inline(always)]
    fn drooped_pa(
        &self,
        wanted_pa: f64,
        cylinder_pressure_pa: f64,
        flow_at: impl Fn(f64) -> f64,
    ) -> f64 {
        if self.hooks.supply().margin_lost_to_flow_pa_s_m3 == 0.0 {
            wanted_pa
        } else {
            self.drooped_with_flow_pa(wanted_pa, cylinder_pressure_pa, flow_at)
        }
    }

    /// [`Circuit::drooped_pa`] with a margin that decreases with the flow.
    ///
    /// The margin that it loses per flow acts as a laminar resistance in series with the orifice, which gives the pressure in
    /// closed form for the square-root law, and a good guess for any other.
    #[cold]
    #[inline(never)]
    fn drooped_with_flow_pa(
        &self,
        wanted_pa: f64,
        cylinder_pressure_pa: f64,
        flow_at: impl Fn(f64) -> f64,
    ) -> f64 {
        let lost_pa_s_m3 = self.hooks.supply().margin_lost_to_flow_pa_s_m3;
        let free_m3_s = flow_at(wanted_pa);
        if free_m3_s <= 0.0 {
            return wanted_pa;
        }
        let resistance = Line {
            laminar_pa_s_m3: lost_pa_s_m3,
            ..Line::default()
        };
        let drop_pa = self.lift_drop_pa(wanted_pa, cylinder_pressure_pa);
        let guess_m3_s = resistance.behind_orifice_m3_s(free_m3_s, drop_pa);
        let excess = |pressure_pa: f64| {
            let lost_pa = lost_pa_s_m3 * flow_at(pressure_pa);
            (pressure_pa + lost_pa - wanted_pa, pressure_pa)
        };
        let range_pa = (wanted_pa - lost_pa_s_m3 * free_m3_s, wanted_pa);
        let guess_pa = wanted_pa - lost_pa_s_m3 * guess_m3_s;
        crate::solver::root::steep(excess, guess_pa, range_pa, 10.0)
    }

    /// The pump pressure, Pa, limited by the relief valve, where the compensator would set `wanted_pa`; `flow_at` is
    /// the lift flow as a function of it.
    #[inline(always)]
    fn relieved_pa(&self, wanted_pa: f64, flow_at: impl Fn(f64) -> f64) -> f64 {
        match self.hooks.supply().relief {
            // A load-sensing pump reduces its displacement at the limit, so no flow passes a valve that has an override.
            Some(relief) if self.constants.pump.kind == PumpKind::FixedDisplacement => {
                self.overridden_pa(relief, wanted_pa, flow_at)
            }
            _ => self.constants.relief_valve.limit_pa(wanted_pa),
        }
    }

    /// [`Circuit::relieved_pa`] of a relief valve with an override.
    #[cold]
    #[inline(never)]
    fn overridden_pa(
        &self,
        relief: ReliefOverride,
        wanted_pa: f64,
        flow_at: impl Fn(f64) -> f64,
    ) -> f64 {
        let crack_pa = self.constants.relief_valve.set_pressure_pa - relief.below_setting_pa;
        if wanted_pa <= crack_pa || relief.override_pa <= 0.0 {
            return wanted_pa.min(crack_pa);
        }
        // It passes at most the pump's flow less the lift flow: p - p_crack = override (1 - Q/Q_pump).
        let pump_m3_s = self.constants.pump.flow_m3_s();
        let excess = |pressure_pa: f64| {
            let left = 1.0 - flow_at(pressure_pa) / pump_m3_s;
            pressure_pa - crack_pa - relief.override_pa * left
        };
        let highest_pa = wanted_pa.min(crack_pa + relief.override_pa);
        crate::solver::root::rising(excess, crack_pa, highest_pa, 10.0)
    }

    /// Flow through the lowering valve, m3/s, over a drop, Pa.
    #[inline(always)]
    fn lower_valve_m3_s(&self, opening: Opening, drop_pa: f64) -> f64 {
        let lower_valve = &self.constants.lower_valve;
        let opening = self.travelled(opening, drop_pa);
        let flow_m3_s = lower_valve.flow_m3_s(opening.flow_m3_s, drop_pa);
        flow_m3_s * self.hooks.oil().lower_drop_factor(drop_pa) * self.discharge(opening, drop_pa)
    }

    /// Lowering flow, m3/s; the valve's drop is reduced by the return line.
    #[inline(always)]
    fn lower_m3_s(&self, opening: Opening, state: &MechanicalState) -> f64 {
        if opening.shut() {
            return 0.0;
        }
        let opening = self.lower_opening(opening, state);
        let free_m3_s = self.lower_valve_m3_s(opening, state.pressure_pa);
        if self.hooks.oil().return_line.is_free() && self.hooks.own().terms.is_empty() {
            free_m3_s
        } else {
            self.behind_return_line_m3_s(opening, free_m3_s, *state)
        }
    }

    /// Lowering flow, m3/s, with a return line, where it is `free_m3_s` without.
    #[cold]
    #[inline(never)]
    fn behind_return_line_m3_s(
        &self,
        opening: Opening,
        free_m3_s: f64,
        state: MechanicalState,
    ) -> f64 {
        let terms = self.hooks.own().has_term(Place::ReturnPressure);
        let line = &self.hooks.oil().return_line;
        if (line.is_free() && !terms) || free_m3_s == 0.0 {
            return free_m3_s;
        }
        let square_root_law = self.constants.lower_valve.transition_drop_pa == 0.0
            && self.hooks.oil().lower_drop_factor.is_empty()
            && self.hooks.oil().lower_travel_factor.is_empty()
            && self.hooks.oil().flow_number_1_a_sqrt_pa.is_none();
        if square_root_law && !terms {
            return line.behind_orifice_m3_s(free_m3_s, state.pressure_pa);
        }
        let passed_m3_s = |flow_m3_s: f64| {
            let drop_pa = state.pressure_pa - self.return_pressure_pa(flow_m3_s, &state);
            self.lower_valve_m3_s(opening, drop_pa)
        };
        // Root of f(Q) = Q - valve(p - p_T(Q)), which increases with Q. It lies between zero and the free flow, or
        // above if a term draws oil off.
        let highest_m3_s = if terms {
            free_m3_s.max(passed_m3_s(0.0)).max(passed_m3_s(free_m3_s))
        } else {
            free_m3_s
        };
        let excess = |flow_m3_s: f64| flow_m3_s - passed_m3_s(flow_m3_s);
        crate::solver::root::rising(excess, 0.0, highest_m3_s, highest_m3_s * 1e-7)
    }
}
