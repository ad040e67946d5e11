//! The hooks of the plant at which physical effects act.
//!
//! An effect (see [`Effect`](crate::hooks::effect::Effect)) attaches closures or small components with state here; the
//! plant evaluates them at the corresponding point of its equations. Without any, every sum is empty and the plant is
//! the paper's.

use std::sync::Arc;

use dyn_clone::{DynClone, clone_trait_object};

use crate::components::linkage::Linkage;
use crate::constants::Constants;
use crate::hooks::elements::{Bristles, FlowFactor, Ground, Hose, Line, ReliefOverride};
use crate::hooks::place::Place;
use crate::hooks::reading::Reading;
use crate::hooks::signals::Signals;
use crate::state::MechanicalState;
use crate::valve::Currents;

/// A stage between coil current and effective spool current; it may have state (hysteresis, lag).
pub trait CurrentStage: DynClone + Send + Sync + std::fmt::Debug {
    /// Sets the stage to rest at these currents and returns its output.
    fn rest(&mut self, currents: Currents) -> Currents;
    /// Advances by `dt_s` while the currents change linearly to `currents`; returns the output.
    fn advance(&mut self, currents: Currents, dt_s: f64) -> Currents;
}

/// A stage between a physical quantity and the reading of its instrument; it may have state (lag).
pub trait SensorStage: DynClone + Send + Sync + std::fmt::Debug {
    /// Sets the instrument to rest at this reading.
    fn rest(&mut self, reading: &mut Reading);
    /// Advances by `dt_s` to the true `reading` and replaces it by the instrument's reading.
    fn advance(&mut self, reading: &mut Reading, dt_s: f64);
    /// The true rocker angle, degree, at which an instrument at rest shows `shown_deg`.
    fn angle_behind_deg(&self, shown_deg: f64) -> f64 {
        shown_deg
    }
}

clone_trait_object!(CurrentStage);
clone_trait_object!(SensorStage);

/// A function of one quantity; the units are given where it is used.
pub type Law = Box<dyn Fn(f64) -> f64 + Send + Sync>;
/// A factor on the weight's force, from the piston travel, m, and the load's share in the weight; the rest is that of
/// the links.
pub type WeightFactor = Box<dyn Fn(f64, f64) -> f64 + Send + Sync>;
/// A force on the piston against its motion, N, from its state and the weight's force on it, N.
pub type FrictionForce = Box<dyn Fn(&MechanicalState, f64) -> f64 + Send + Sync>;

/// A user-defined term, in the SI unit of its place, from the state of the plant.
pub type TermFunction = Box<dyn Fn(&Signals) -> f64 + Send + Sync>;

/// Everything that the active effects have attached to one plant.
pub struct EffectHooks {
    /// Stages between coil current and effective spool current, in order.
    pub currents: Vec<Box<dyn CurrentStage>>,
    /// Factor on the lift valve's flow.
    pub lift_flow_factor: FlowFactor,
    /// Factor on the lowering valve's flow.
    pub lower_flow_factor: FlowFactor,
    /// Factors on the lowering valve's flow, from its pressure drop, Pa.
    pub lower_drop_factor: Vec<Law>,
    /// Factors on the travel of the lowering spool beyond its opening point, from the valve's pressure drop, Pa.
    pub lower_travel_factor: Vec<Law>,
    /// Laminar transition of both valves: twice the flow number over the critical one is this value times the current
    /// beyond the threshold, A, and the square root of the drop, Pa. `None` for turbulent flow.
    pub flow_number_1_a_sqrt_pa: Option<f64>,
    /// Added to the compensator's margin, Pa, from the cylinder pressure, Pa.
    pub margin: Vec<Law>,
    /// Added to the pump pressure with the lift valve closed, Pa.
    pub idle_extra_pa: f64,
    /// Added to the model's own lag of the spools, s; negative for spools faster than declared.
    pub spool_lag_extra_s: f64,
    /// Decrease of the compensator's margin per lift flow, Pa/(m3/s).
    pub margin_lost_to_flow_pa_s_m3: f64,
    /// Time constant of the compensator, s.
    pub compensator_lag_s: f64,
    /// Added to the check valve's cracking pressure, Pa.
    pub cracking_extra_pa: f64,
    /// Flow resistance of the open check valve.
    pub check_valve: Line,
    /// Pump flow lost to slip, m3/s, from the pump pressure, Pa.
    pub pump_slip: Vec<Law>,
    /// Override of the relief valve; `None` for an ideal one.
    pub relief: Option<ReliefOverride>,
    /// Flow resistance downstream of the lowering valve.
    pub return_line: Line,
    /// Flow out of the cylinder past the valves, m3/s, from the cylinder pressure, Pa.
    pub leakage: Vec<Law>,
    /// Factors on the oil's bulk modulus, from the cylinder pressure, Pa; dynamic plant only.
    pub stiffness_factor: Vec<Law>,
    /// Compliance of hoses and fittings; dynamic plant only.
    pub hose: Hose,
    /// Friction at the piston.
    pub friction: Vec<FrictionForce>,
    /// Friction with state at the piston.
    pub bristles: Option<Bristles>,
    /// Factors on the weight's force.
    pub weight_factor: Vec<WeightFactor>,
    /// Inertia in addition to the model's own, as a share of load and dead weight.
    pub inertia_share: f64,
    /// Additional inertia of the rocker shaft, kg m2, independent of the load.
    pub shaft_inertia_kg_m2: f64,
    /// Longest step, s, that resolves fast changes: a pressure that depends on the acceleration over the last step, or
    /// a sensor with state; quasi-static plant only.
    pub longest_step_s: f64,
    /// Largest change of a coil current per step of the spools, A, that resolves the instant of a spool's jump.
    pub largest_change_a: f64,
    /// Ground under the hitch.
    pub ground: Option<Ground>,
    /// Instruments, in order.
    pub sensors: Vec<Box<dyn SensorStage>>,
    /// User-defined terms, with the place where each acts.
    pub terms: Vec<(Place, TermFunction)>,
}

impl EffectHooks {
    /// Hooks without any effect.
    pub const NONE: Self = Self {
        currents: Vec::new(),
        lift_flow_factor: FlowFactor::ONE,
        lower_flow_factor: FlowFactor::ONE,
        lower_drop_factor: Vec::new(),
        lower_travel_factor: Vec::new(),
        flow_number_1_a_sqrt_pa: None,
        margin: Vec::new(),
        idle_extra_pa: 0.0,
        spool_lag_extra_s: 0.0,
        margin_lost_to_flow_pa_s_m3: 0.0,
        compensator_lag_s: 0.0,
        cracking_extra_pa: 0.0,
        check_valve: Line::FREE,
        pump_slip: Vec::new(),
        relief: None,
        return_line: Line::FREE,
        leakage: Vec::new(),
        stiffness_factor: Vec::new(),
        hose: Hose::STIFF,
        friction: Vec::new(),
        bristles: None,
        weight_factor: Vec::new(),
        inertia_share: 0.0,
        shaft_inertia_kg_m2: 0.0,
        longest_step_s: f64::INFINITY,
        largest_change_a: f64::INFINITY,
        ground: None,
        sensors: Vec::new(),
        terms: Vec::new(),
    };
}

impl Default for EffectHooks {
    fn default() -> Self {
        Self::NONE
    }
}

/// Sum of an empty list: negative zero, which changes no number that it is added to.
const NONE: f64 = -0.0;

/// Sum of laws. The empty sum is inlined: most plants have few effects, and this is in the innermost loop.
#[inline(always)]
fn sum(laws: &[Law], of: f64) -> f64 {
    if laws.is_empty() {
        NONE
    } else {
        sum_of_some(laws, of)
    }
}

#[cold]
#[inline(never)]
fn sum_of_some(laws: &[Law], of: f64) -> f64 {
    laws.iter().fold(NONE, |sum, law| sum + law(of))
}

/// Product of laws.
#[inline(always)]
fn product(laws: &[Law], of: f64) -> f64 {
    if laws.is_empty() {
        1.0
    } else {
        product_of_some(laws, of)
    }
}

#[cold]
#[inline(never)]
fn product_of_some(laws: &[Law], of: f64) -> f64 {
    laws.iter().fold(1.0, |product, law| product * law(of))
}

impl EffectHooks {
    /// Whether a user-defined term acts at a place.
    #[inline(always)]
    #[must_use]
    pub fn has_term(&self, place: Place) -> bool {
        self.terms.iter().any(|(at, _)| *at == place)
    }

    /// Limits the steps of the quasi-static plant to `longest_s`, s.
    pub fn limit_step(&mut self, longest_s: f64) {
        self.longest_step_s = self.longest_step_s.min(longest_s);
    }

    /// Limits the change of any current within a step of the spools to `largest_a`, A, and with it the steps of the
    /// quasi-static plant, whose piston follows at once.
    pub fn limit_change(&mut self, largest_a: f64) {
        self.largest_change_a = self.largest_change_a.min(largest_a);
    }

    /// Sum of the terms at a place, in its SI unit; values that are not finite are skipped.
    #[must_use]
    pub fn term(&self, place: Place, signals: &Signals) -> f64 {
        let here = self.terms.iter().filter(|(at, _)| *at == place);
        let values = here.map(|(_, term)| term(signals));
        values.filter(|value| value.is_finite()).sum()
    }

    /// Sum of the friction forces, N, in a state with a weight's force, N.
    #[inline(always)]
    #[must_use]
    pub fn friction_n(&self, state: &MechanicalState, weight_n: f64) -> f64 {
        if self.friction.is_empty() {
            NONE
        } else {
            self.some_friction_n(*state, weight_n)
        }
    }

    /// The state is passed by value, so that without friction the solver need not keep it in memory.
    #[cold]
    #[inline(never)]
    fn some_friction_n(&self, state: MechanicalState, weight_n: f64) -> f64 {
        let forces = self.friction.iter();
        forces.fold(NONE, |sum, force| sum + force(&state, weight_n))
    }

    /// Force of the bristles, N, at a deflection, m.
    #[inline(always)]
    #[must_use]
    pub fn bristles_n(&self, bent_m: f64) -> f64 {
        self.bristles
            .map_or(0.0, |bristles| bristles.force_n * bent_m / bristles.reach_m)
    }

    /// [`Bristles::bent_m`]; zero without bristles.
    #[inline(always)]
    #[must_use]
    pub fn bent_m(&self, before_m: f64, moved_m: f64, dt_s: f64) -> f64 {
        self.bristles
            .map_or(0.0, |bristles| bristles.bent_m(before_m, moved_m, dt_s))
    }

    /// Factor on the weight's force at a piston travel, m, with the load's share in the weight.
    #[inline(always)]
    #[must_use]
    pub fn weight_factor(&self, piston_m: f64, load_share: impl FnOnce() -> f64) -> f64 {
        if self.weight_factor.is_empty() {
            1.0
        } else {
            self.some_weight_factor(piston_m, load_share())
        }
    }

    #[cold]
    #[inline(never)]
    fn some_weight_factor(&self, piston_m: f64, load_share: f64) -> f64 {
        let factors = self.weight_factor.iter();
        factors.fold(1.0, |product, factor| {
            product * factor(piston_m, load_share)
        })
    }

    /// Pressure downstream of the lowering valve, Pa, at a flow through it, m3/s.
    #[inline(always)]
    #[must_use]
    pub fn return_pressure_pa(&self, flow_m3_s: f64) -> f64 {
        self.return_line.pressure_pa(flow_m3_s)
    }

    /// Whether a hitch at rest with both valves closed stays at rest.
    #[inline(always)]
    #[must_use]
    pub fn stays_at_rest(&self) -> bool {
        let straighten = |bristles: Bristles| bristles.creep_m_s > 0.0;
        self.leakage.is_empty() && self.terms.is_empty() && !self.bristles.is_some_and(straighten)
    }

    /// Sum of the leakage flows, m3/s, at a cylinder pressure, Pa.
    #[inline(always)]
    #[must_use]
    pub fn leakage_m3_s(&self, cylinder_pressure_pa: f64) -> f64 {
        sum(&self.leakage, cylinder_pressure_pa)
    }

    /// Factor on the lowering valve's flow at its pressure drop, Pa.
    #[inline(always)]
    #[must_use]
    pub fn lower_drop_factor(&self, drop_pa: f64) -> f64 {
        product(&self.lower_drop_factor, drop_pa)
    }

    /// Factor on the travel of the lowering spool beyond its opening point, at the valve's pressure drop, Pa.
    #[inline(always)]
    #[must_use]
    pub fn lower_travel_factor(&self, drop_pa: f64) -> f64 {
        product(&self.lower_travel_factor, drop_pa)
    }

    /// Sum of the additions to the compensator's margin, Pa, at a cylinder pressure, Pa.
    #[inline(always)]
    #[must_use]
    pub fn margin_pa(&self, cylinder_pressure_pa: f64) -> f64 {
        sum(&self.margin, cylinder_pressure_pa)
    }

    /// Pump flow lost to slip, m3/s, at a pump pressure, Pa.
    #[inline(always)]
    #[must_use]
    pub fn pump_slip_m3_s(&self, pump_pressure_pa: f64) -> f64 {
        sum(&self.pump_slip, pump_pressure_pa)
    }

    /// Factor on the oil's bulk modulus at a cylinder pressure, Pa.
    #[inline(always)]
    #[must_use]
    pub fn stiffness_factor(&self, cylinder_pressure_pa: f64) -> f64 {
        product(&self.stiffness_factor, cylinder_pressure_pa)
    }
}

/// The run and the plant that an effect is attached to.
#[derive(Debug, Clone, Copy)]
pub struct RunConditions<'m> {
    /// Oil temperature, degree Celsius.
    pub oil_temperature_c: f64,
    /// Constants of the plant's components.
    pub constants: &'m Constants,
    /// The plant's linkage.
    pub linkage: &'m Arc<Linkage>,
}
